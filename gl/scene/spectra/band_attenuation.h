/* band_attenuation.h: attenuation in parts of the bands of photons' wavelengths, in order of
 * wavelength, for hits that keep the optical depth of their path in each. Internal to gl/.
 */
#ifndef ABBE_GL_SCENE_SPECTRA_BAND_ATTENUATION_H
#define ABBE_GL_SCENE_SPECTRA_BAND_ATTENUATION_H

#include "gl/plan/facts/plan_facts.h"
#include "gl/scene/spectra/mirror_nodes.h"
#include "spectral/wavelengths.h"

/* Of a node's band: four parts below the node, and four above it. */
enum { ABBE_HALF_PARTS = 4 };

/* Texels of a sampling of so many nodes: of each node and refractor two, attenuation, 1/m, or a
 * mirror's factors; then of each light and node two, what of the half's Y each part is. */
size_t abbe_band_attenuation_texels(const abbe_plan *plan, size_t nodes);

/* ABBE_OUT_OF_RANGE where a metal is not known, ABBE_NO_MEMORY. */
abbe_result abbe_band_attenuation_fill(const abbe_scene *scene, const abbe_plan *plan,
                                       const abbe_wavelengths *w, float (*out)[4],
                                       abbe_error *error);

#endif
