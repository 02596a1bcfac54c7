/* mirrors.h: what mirrors reflect, in single precision: metals by their n and k, others by one
 * number; and where to, smooth ones and rough ones.
 *
 * Its oracles are abbe_optics_fresnel_conductor and spectral/microfacets.h.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRANSPORT_MIRRORS_H
#define ABBE_VALIDATION_TRACE_TRANSPORT_MIRRORS_H

#include "base/error.h"
#include "validation/trace/transport/geometry.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

/* One mirror's facets and grooves (scenes/shapes/shape.h), in the frame; x 0: smooth. */
typedef struct abbe_mirror_lobe {
  float x, y, around, axis[3], centre[3];
} abbe_mirror_lobe;

typedef struct abbe_mirrors {
  size_t count, steps;
  abbe_mirror_lobe *lobe; /* [count] */
  float *reflectance;     /* [count] at all angles and wavelengths; below 0: a metal */
  float (*nk)[2];         /* [count][steps + 1] at the steps' edges */
} abbe_mirrors;

/* Tables of the geometry's mirrors over the steps + 1 wavelengths lambda_nm, ascending. Errors as
 * abbe_material_nk: ABBE_OUT_OF_RANGE where a metal is not known over all of them. */
abbe_result abbe_mirrors_make(const abbe_geometry *geometry, const double *lambda_nm, size_t steps,
                              abbe_mirrors *out, abbe_error *error);
void abbe_mirrors_free(abbe_mirrors *mirrors);

/* Whether it reflects all wavelengths alike. */
static inline bool abbe_mirrors_is_grey(const abbe_mirrors *m, size_t mirror) {
  return m->reflectance[mirror] >= 0;
}

/* Unpolarised reflectance of a metal for cos_i in [0, 1]. [BornWolf1999] */
static inline float abbe_mirrors_metal(float cos_i, float n, float k) {
  const float c2 = cos_i * cos_i, s2 = 1 - c2, t0 = n * n - k * k - s2;
  const float t1 = sqrtf(t0 * t0 + 4 * n * n * k * k), a2 = 0.5f * (t1 + t0);
  const float t2 = 2 * cos_i * sqrtf(a2 > 0 ? a2 : 0);
  const float s = (t1 + c2 - t2) / (t1 + c2 + t2);
  const float p = (c2 * t1 + s2 * s2 - t2 * s2) / (c2 * t1 + s2 * s2 + t2 * s2);
  return 0.5f * s * (1 + p);
}

/* n and k of a metal within step k at the share f of it. */
static inline void abbe_mirrors_nk(const abbe_mirrors *m, size_t mirror, uint32_t k, float f,
                                   float nk[2]) {
  const float(*at)[2] = (const float(*)[2])m->nk + mirror * (m->steps + 1) + k;
  for (int c = 0; c < 2; c++) nk[c] = at[0][c] + f * (at[1][c] - at[0][c]);
}

/* Unpolarised reflectance for cos_i in [0, 1], within step k at the share f of it. */
static inline float abbe_mirrors_reflect(const abbe_mirrors *m, size_t mirror, float cos_i,
                                         uint32_t k, float f) {
  if (m->reflectance[mirror] >= 0) return m->reflectance[mirror];
  float nk[2];
  abbe_mirrors_nk(m, mirror, k, f, nk);
  return abbe_mirrors_metal(cos_i, nk[0], nk[1]);
}

static inline bool abbe_mirrors_is_rough(const abbe_mirrors *m, size_t mirror) {
  return m->lobe[mirror].x > 0;
}

/* Where light along unit d meets a rough mirror: frame; n: unit, on the light's side; x along the
 * grooves, y across; wo: back along d, in x, y and n. */
typedef struct abbe_rough_hit {
  abbe_microfacets facets;
  double x[3], y[3], n[3], wo[3];
} abbe_rough_hit;

void abbe_mirrors_meet(const abbe_mirrors *m, size_t mirror, const float p[3], const float n[3],
                       const float d[3], abbe_rough_hit *out);

/* A way on, drawn of u in [0, 1)^2: unit `out`, its density in *pdf, 1/sr, the cosine to the
 * facet's normal in *cos_h. Returns the share of what the facet reflects that goes there. */
float abbe_mirrors_scatter(const abbe_rough_hit *hit, const float u[2], float out[3], float *pdf,
                           float *cos_h);

/* The lobe of light from there, along -to: radiance by irradiance, 1/sr, of facets that reflect
 * all; the density of abbe_mirrors_scatter, and the cosine to the facet's normal. */
float abbe_mirrors_lobe(const abbe_rough_hit *hit, const float to[3], float *pdf, float *cos_h);

#endif
