/* haze.h: media that scatter or glow, in the tracer: what a way through them leaves of light and
 * how it is turned.
 *
 * Tables over the sampler's wavelengths in frame units, a row a refractor and the air's last.
 * What becomes of scattered light is the walks' business. Its oracle is scenes/medium/medium.h.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRANSPORT_HAZE_H
#define ABBE_VALIDATION_TRACE_TRANSPORT_HAZE_H

#include "base/error.h"
#include "validation/trace/transport/geometry.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct abbe_glow;

/* Zeroed: nothing scatters, and the air is clear. */
typedef struct abbe_haze {
  size_t refractors, steps;
  float *scattering; /* [refractors + 1][steps + 1] at the steps' edges; NULL: there is no haze */
  float *extinction; /* the same, with absorption */
  bool *scatters;    /* [refractors + 1] at some wavelength */
  bool *coloured;    /* [refractors + 1] its extinction or scattering varies */
  float *g;          /* [refractors + 1] */
  bool *glows;       /* [refractors + 1] it is fluorescent, and its paths are followed on, by: */
  const struct abbe_glow *glow; /* NULL: none is (medium/glow.h) */
  bool once;                    /* refractors scatter light once; else as often as it comes */
  bool air;                     /* the air has a region: */
  float low[3], high[3];
} abbe_haze;

/* attenuation: of refractors, [refractors][steps + 1], frame units, or NULL. all: also where
 * nothing scatters. ABBE_NO_MEMORY. */
abbe_result abbe_haze_make(const abbe_geometry *geometry, const double *lambda_nm, size_t steps,
                           const float *attenuation, bool all, abbe_haze *out, abbe_error *error);
void abbe_haze_free(abbe_haze *haze);

/* Refuses by name a refractor in which paths would be scattered too often to be followed.
 * ABBE_UNSUPPORTED. */
abbe_result abbe_haze_check(const abbe_haze *haze, const abbe_geometry *geometry,
                            abbe_error *error);

static inline bool abbe_haze_is(const abbe_haze *h) {
  return h->scattering != NULL;
}

/* Medium i of them (-1: the air). */
static inline size_t abbe_haze_row(const abbe_haze *h, int i) {
  return i < 0 ? h->refractors : (size_t)i;
}
static inline bool abbe_haze_scatters(const abbe_haze *h, int i) {
  return abbe_haze_is(h) && h->scatters[abbe_haze_row(h, i)];
}
/* Whether it scatters light as often as it comes. */
static inline bool abbe_haze_turns(const abbe_haze *h, int i) {
  return i >= 0 && abbe_haze_scatters(h, i) && !h->once;
}
/* Whether light that it absorbs comes back at other wavelengths. */
static inline bool abbe_haze_glows(const abbe_haze *h, int i) {
  return i >= 0 && h->glow != NULL && h->glows[i];
}
static inline bool abbe_haze_is_coloured(const abbe_haze *h, int i) {
  return abbe_haze_is(h) && h->coloured[abbe_haze_row(h, i)];
}

static inline float abbe_haze_look(const float *table, const abbe_haze *h, int i, uint32_t k,
                                   float f) {
  const float *at = table + abbe_haze_row(h, i) * (h->steps + 1) + k;
  return at[0] + f * (at[1] - at[0]);
}
/* Within step k at the share f of it, a frame unit; of a haze that is one. */
static inline float abbe_haze_scattering(const abbe_haze *h, int i, uint32_t k, float f) {
  return abbe_haze_look(h->scattering, h, i, k, f);
}
static inline float abbe_haze_extinction(const abbe_haze *h, int i, uint32_t k, float f) {
  return abbe_haze_look(h->extinction, h, i, k, f);
}

/* The part [*from, *to] of a straight way in medium i that haze fills; false where there is none.
 * All of it in a refractor; in the air that of the region, so that *to may come as infinite. */
static inline bool abbe_haze_clip(const abbe_haze *h, int i, const float o[3], const float d[3],
                                  float *from, float *to) {
  if (!abbe_haze_is(h) || (i < 0 && !h->air)) return false;
  for (int k = 0; i < 0 && k < 3; k++) {
    if (d[k] == 0 && !(o[k] >= h->low[k] && o[k] <= h->high[k])) return false;
    if (d[k] == 0) continue;
    const float a = (h->low[k] - o[k]) / d[k], b = (h->high[k] - o[k]) / d[k];
    *from = fmaxf(*from, fminf(a, b));
    *to = fminf(*to, fmaxf(a, b));
  }
  return *from < *to;
}

/* What is left of light on the way [from, to] of o + t d in medium i. */
static inline float abbe_haze_left(const abbe_haze *h, int i, const float o[3], const float d[3],
                                   float from, float to, uint32_t k, float f) {
  if (!abbe_haze_clip(h, i, o, d, &from, &to)) return 1;
  return expf(-(to - from) * abbe_haze_extinction(h, i, k, f));
}

/* Share of the scattered light a steradian, where its way turns by the angle of that cosine.
 * [HenyeyGreenstein1941] */
static inline float abbe_haze_phase(const abbe_haze *h, int i, float cosine) {
  const float g = h->g[abbe_haze_row(h, i)], square = 1 + g * g - 2 * g * cosine;
  return 0.0795774715f * (1 - g * g) / (square * sqrtf(square));
}

/* A direction that light along d is turned to, by the phase function and u and v in [0, 1). */
void abbe_haze_turn(const abbe_haze *haze, int i, const float d[3], float u, float v, float out[3]);

/* A place on [0, length], by the share u in [0, 1) of what a medium of that extinction takes on all
 * of it; *density: of such places, a unit of length. */
static inline float abbe_haze_place(float extinction, float length, float u, float *density) {
  const float depth = extinction * length;
  if (!(depth > 1e-3f)) { /* evenly, where exponentials round */
    *density = 1 / length;
    return u * length;
  }
  const float taken = -expm1f(-depth), at = -log1pf(-u * taken) / extinction;
  *density = extinction * expf(-extinction * at) / taken;
  return fminf(at, length);
}

#endif
