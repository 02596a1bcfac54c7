/* band_attenuation.h: attenuation in parts of the wavelengths' bands, for hits that keep the length
 * of their path inside: what is left of a band follows from it, and not from its node alone.
 * Internal to gl/.
 */
#ifndef ABBE_GL_SCENE_SPECTRA_BAND_ATTENUATION_H
#define ABBE_GL_SCENE_SPECTRA_BAND_ATTENUATION_H

#include "gl/plan/facts/plan_facts.h"
#include "spectral/wavelengths.h"

enum { ABBE_HALF_PARTS = 4 };

/* Float copies of what the shaders read as texels (photon_absorption.glsl). */
typedef struct abbe_band_half {
  float attenuation[ABBE_HALF_PARTS]; /* 1/m */
  float share[ABBE_HALF_PARTS];       /* of the half's Y */
} abbe_band_half;

typedef struct abbe_node_bands {
  abbe_band_half below, above; /* the node */
} abbe_node_bands;

/* Opaque, and no float overflows, 1/m. */
#define ABBE_BAND_MOST_PER_M 1e30

/* out: [light views][refractors][w->count]; returns its end. */
abbe_node_bands *abbe_band_attenuation_fill(const abbe_scene *scene, const abbe_plan *plan,
                                            const abbe_wavelengths *w, abbe_node_bands *out);

#endif
