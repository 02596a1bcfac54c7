/* surface_curvature.h: how the normals of surfaces turn around sampled places, by regression over
 * the denser points around them [WandStrasser2003]. */
#ifndef ABBE_SCENES_SAMPLES_SURFACE_CURVATURE_H
#define ABBE_SCENES_SAMPLES_SURFACE_CURVATURE_H

#include "base/error.h"
#include "scenes/samples/surface_samples.h"

/* Along along[0] and along[1], unit tangents that with the normal are a right-handed frame, the
 * normal turns by curvature[0] and curvature[1] (1/m, the first of the greater amount; above 0
 * where normals spread) towards them. */
typedef struct abbe_surface_curvature {
  double along[2][3];
  double curvature[2];
} abbe_surface_curvature;

/* Fits a linear normal for each sample, over the candidates within a spacing whose normals are less
 * than 60 degrees from its own: their mean normal is that of the tangent plane. out: [count].
 * Places with too few candidates are flat. ABBE_NO_MEMORY. */
abbe_result abbe_surface_curvature_fit(const abbe_surface_samples *samples,
                                       abbe_surface_curvature *out, abbe_error *error);

#endif
