/* interface.h: light at a smooth interface between two clear media, in single precision.
 *
 * The tracer's own form of Snell's and Fresnel's laws; its oracle is spectral/optics.h. Directions
 * are those in which the light travels; n is the unit normal on the side that it comes from.
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRANSPORT_INTERFACE_H
#define ABBE_VALIDATION_TRACE_TRANSPORT_INTERFACE_H

#include <math.h>

/* Unpolarised reflectance for cos_i in [0, 1] and eta = n_i / n_t > 0; the cosine of the angle of
 * refraction in *cos_t, 0 at total reflection. Exactly 0 where eta = 1. [BornWolf1999] */
static inline float abbe_interface_reflectance(float cos_i, float eta, float *cos_t) {
  /* (1 - eta)(1 + eta) + (eta cos_i)^2: no cancellation near eta = 1 */
  float square = (1 - eta) * (1 + eta) + eta * eta * cos_i * cos_i;
  float c = sqrtf(square > 0 ? square : 0);
  *cos_t = c;
  float s = (eta * cos_i - c) / (eta * cos_i + c);
  float p = (cos_i - eta * c) / (cos_i + eta * c);
  float share = 0.5f * (s * s + p * p);
  /* 0 / 0 at grazing incidence counts as reflected */
  share = square > 0 && share <= 1 ? share : 1;
  return eta == 1 ? 0 : share;
}

static inline void abbe_interface_refract(const float d[3], const float n[3], float eta,
                                          float cos_i, float cos_t, float out[3]) {
  float along = eta * cos_i - cos_t;
  for (int k = 0; k < 3; k++) out[k] = eta * d[k] + along * n[k];
  float scale = 1 / sqrtf(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
  for (int k = 0; k < 3; k++) out[k] *= scale;
}

static inline void abbe_interface_reflect(const float d[3], const float n[3], float cos_i,
                                          float out[3]) {
  for (int k = 0; k < 3; k++) out[k] = d[k] + 2 * cos_i * n[k];
  float scale = 1 / sqrtf(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
  for (int k = 0; k < 3; k++) out[k] *= scale;
}

/* An interpolated normal may send light to the wrong side of its face, of unit normal ng: d is then
 * bent until it runs just along the side wanted, +1 or -1 of ng. */
static inline void abbe_interface_keep_side(const float ng[3], float side, float d[3]) {
  const float least = 1e-3f;
  float along = side * (d[0] * ng[0] + d[1] * ng[1] + d[2] * ng[2]);
  if (along > 0) return;
  for (int k = 0; k < 3; k++) d[k] += (least - along) * side * ng[k];
  float scale = 1 / sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  for (int k = 0; k < 3; k++) d[k] *= scale;
}

#endif
