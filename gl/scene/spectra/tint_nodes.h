/* tint_nodes.h: what refractors and mirrors take of the bands of photons' wavelengths, by what a
 * path passed of them (gl/plan/examine/tints.h). Internal to gl/.
 */
#ifndef ABBE_GL_SCENE_SPECTRA_TINT_NODES_H
#define ABBE_GL_SCENE_SPECTRA_TINT_NODES_H

#include "gl/plan/facts/plan_facts.h"
#include "spectral/wavelengths.h"

enum { ABBE_TINT_TEXELS = 2 };

/* out: [w->count][refractors] attenuation of two parts of the half of the band below the node, and
 * of two above it, each of a half's brightness, as they leave their mean of a usual path; then the
 * most by which it differs within a half, and abbe_tint_of(). Of one node both halves are the whole
 * band. */
void abbe_tint_nodes_fill(const abbe_scene *scene, const abbe_plan *plan, const abbe_wavelengths *w,
                          float (*out)[ABBE_TINT_TEXELS][4]);

#endif
