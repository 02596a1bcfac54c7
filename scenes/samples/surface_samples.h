/* surface_samples.h: a few points that stand for surfaces, spread over them by area
 * [WandStrasser2003].
 *
 * Candidates are many points, uniform by area, at random or evenly. They are gone through in their
 * order, and each that is nearer to a kept one than a radius is dropped, so that samples are as
 * dense on all surfaces, whatever way these face. It knows no light.
 */
#ifndef ABBE_SCENES_SAMPLES_SURFACE_SAMPLES_H
#define ABBE_SCENES_SAMPLES_SURFACE_SAMPLES_H

#include "base/error.h"
#include "scenes/mesh/mesh.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define ABBE_SURFACE_MAX_SAMPLES 4096

typedef struct abbe_surface_point {
  double position[3], normal[3]; /* m; unit, interpolated between the corners' */
  uint32_t mesh;                 /* which of those given */
} abbe_surface_point;

typedef struct abbe_surface_samples {
  size_t count;
  abbe_surface_point *sample; /* [count] */
  double *share;              /* [count] m2: of the candidates that are nearest to it; they sum to
                                 area */
  double area;                /* area of all meshes, m2 */
  double spacing;             /* sqrt(area / count), m */
  double reach;               /* the radius, m */
  size_t candidate_count;
  abbe_surface_point *candidate; /* [candidate_count], in their order */
  uint32_t *owner;               /* [candidate_count] the sample nearest to each */
} abbe_surface_samples;

/* What is asked for. Zeros: 1 sample. */
typedef struct abbe_surface_sampling {
  size_t count;  /* at most so many are kept, and nearly as many */
  uint64_t seed; /* seed of the candidates */
  bool sided;    /* points whose normals are more than 90 degrees apart are on different sides of a
                    sheet: neither drops the other */
  bool even; /* candidates follow an additive recurrence, which fills the surfaces evenly: shares
                are then closer to the area that is nearest */
} abbe_surface_sampling;

/* Makes samples of all faces of the meshes together; faces without area are never met.
 * ABBE_INVALID_ARGUMENT for more than ABBE_SURFACE_MAX_SAMPLES, ABBE_GEOMETRY where there is no
 * area, ABBE_NO_MEMORY. */
abbe_result abbe_surface_samples_make(const abbe_mesh *const *mesh, size_t mesh_count,
                                      const abbe_surface_sampling *sampling,
                                      abbe_surface_samples *out, abbe_error *error);
void abbe_surface_samples_free(abbe_surface_samples *samples);

/* How the normals of surfaces turn around sampled places, by regression over the denser points
 * around them [WandStrasser2003]. */

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
