/* glow.h: fluorescence in the tracer: which wavelengths excite a refractor, and which it emits.
 *
 * Light that is absorbed at one wavelength comes back at a longer one, from where it was absorbed,
 * in all directions alike and unpolarised. Photons go that way; paths of the camera go back from
 * what they see to what excites it. Photons are counted: a flux keeps its number of them, times the
 * yield. From there on it is in watts of its own wavelength, and its colours are those of the
 * sampling's row of glow for the light that it came from (spectral_sampling.h).
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_MEDIUM_GLOW_H
#define ABBE_VALIDATION_TRACE_MEDIUM_GLOW_H

#include "validation/trace/transport/media.h"
#include "validation/trace/transport/spectral_sampling.h"

/* Zeroed: nothing glows. */
typedef struct abbe_glow {
  const abbe_spectral_sampling *sampling;
  size_t steps;
  uint32_t *row;     /* [refractors][steps] of two rows of `emitted`, for what excites in a step: */
  float (*yield)[2]; /* [refractors][steps] photons by photon that excites, by the first of the
                        two and by the one after it */
  float *excites;    /* [refractors][steps + 1] share of what is absorbed at the steps' edges */
  float *emitted; /* [rows][steps + 1] share of a row's photons of shorter wavelengths than that */
  float *chosen;  /* [refractors][steps + 1] the same of what paths of the camera go back to */
} abbe_glow;

/* Tables of the refractors, and of media what their paths need of them: extinctions, and
 * media->haze.glow, which `out` outlives. sampling outlives it too. ABBE_NO_MEMORY. */
abbe_result abbe_glow_make(const abbe_geometry *geometry, const abbe_spectral_sampling *sampling,
                           abbe_media *media, abbe_glow *out, abbe_error *error);
void abbe_glow_free(abbe_glow *glow);

/* What a medium takes to glow, a frame unit, of all that it absorbs along unit d within step k at
 * the share f of it. */
static inline float abbe_glow_rate(const abbe_media *m, int i, uint32_t k, float f,
                                   const float d[3], uint8_t wave) {
  if (!abbe_haze_glows(&m->haze, i)) return 0;
  const abbe_glow *g = m->haze.glow;
  const float *at = g->excites + (size_t)i * (g->steps + 1) + k;
  const float share = at[0] + f * (at[1] - at[0]);
  return share > 0 ? share * abbe_media_loss(m, i, k, f, d, wave) : 0;
}

/* Photons that refractor i emits by photon that excites it within a step. */
static inline double abbe_glow_photons(const abbe_glow *g, int i, uint32_t step) {
  const float *yield = g->yield[(size_t)i * g->steps + step];
  return (double)yield[0] + (double)yield[1];
}

/* The wavelength of a photon that refractor i emits, excited within *step, of u in [0, 1); false:
 * none that is traced. */
bool abbe_glow_emit(const abbe_glow *glow, int i, float u, uint32_t *step, float *within);

/* Of a path of the camera that sees refractor i glow within *step: goes back, by u in [0, 1), to a
 * wavelength that excites it. Returns the radiance by radiance there and by what is taken of it to
 * glow, a frame unit; 0: there is none. */
float abbe_glow_excite(const abbe_glow *glow, int i, float u, uint32_t *step, float *within);

/* Watts within step `shown` of refractor i's emission for one that is taken within step `step`, as
 * paths of the camera count them. */
float abbe_glow_yield(const abbe_glow *glow, int i, uint32_t step, uint32_t shown);

/* A direction of u and v in [0, 1), all alike. */
void abbe_glow_turn(float u, float v, float out[3]);

#endif
