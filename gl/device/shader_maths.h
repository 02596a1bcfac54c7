/* shader_maths.h: GLSL's functions, by their names, for what the processor's own threads do as a
 * shader does it. Internal to gl/.
 */
#ifndef ABBE_GL_DEVICE_SHADER_MATHS_H
#define ABBE_GL_DEVICE_SHADER_MATHS_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

typedef struct v2 {
  float x, y;
} v2;
typedef struct v3 {
  float x, y, z;
} v3;

static inline float least(float a, float b) {
  return a < b ? a : b;
}
static inline float most(float a, float b) {
  return a > b ? a : b;
}
static inline float clamp(float x, float low, float high) {
  return least(most(x, low), high);
}
static inline float mix(float a, float b, float t) {
  return a + t * (b - a);
}
static inline v2 off2(v2 a, v2 b) {
  return (v2){a.x - b.x, a.y - b.y};
}
static inline v2 times2(float s, v2 a) {
  return (v2){s * a.x, s * a.y};
}
static inline float dot2(v2 a, v2 b) {
  return a.x * b.x + a.y * b.y;
}
static inline float length2(v2 a) {
  return sqrtf(dot2(a, a));
}
static inline v3 plus(v3 a, v3 b) {
  return (v3){a.x + b.x, a.y + b.y, a.z + b.z};
}
static inline v3 off(v3 a, v3 b) {
  return (v3){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline v3 times(float s, v3 a) {
  return (v3){s * a.x, s * a.y, s * a.z};
}
static inline float dot(v3 a, v3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline float length(v3 a) {
  return sqrtf(dot(a, a));
}
static inline v3 mix3(v3 a, v3 b, float t) {
  return plus(a, times(t, off(b, a)));
}
static inline v3 vector_at(const float *f) {
  return (v3){f[0], f[1], f[2]};
}
static inline uint32_t bits_of(float x) {
  uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}

/* unpackSnorm2x16, one of the two. */
static inline float snorm_of(uint32_t word, int half) {
  const int16_t bits = (int16_t)(word >> 16 * half & 0xffffu);
  return most((float)bits / 32767.0f, -1);
}

/* exp(x) for x of at most 0, to 2e-7 of it, for many side by side. */
static inline float exponential(float x) {
  const float in = most(x, -87), t = in * 1.44269504f, turn = 12582912; /* 1.5 x 2^23 */
  const float whole = (t + turn) - turn,
              rest = (in - whole * 0.693359375f) + whole * 2.12194440e-4f;
  const float of =
      ((((1.9875691e-4f * rest + 1.3981999e-3f) * rest + 8.3334519e-3f) * rest + 4.1665796e-2f) *
           rest +
       1.6666665e-1f) *
          rest +
      0.5f;
  const int32_t power = ((int32_t)whole + 127) << 23;
  float scale;
  memcpy(&scale, &power, sizeof scale);
  return (of * rest * rest + rest + 1) * scale;
}

static inline v3 normalize(v3 a) {
  return times(1 / length(a), a);
}
static inline v3 cross(v3 a, v3 b) {
  return (v3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* Without branches, for many side by side. */
static inline float cos2_refracted(float cos_i, float eta) {
  const float along = eta * cos_i, by_along = (1 - eta) * (1 + eta) + along * along;
  const float by_sine = 1 - eta * eta * ((1 - cos_i) * (1 + cos_i));
  return ((eta <= 1) | (along < 1)) ? by_along : by_sine;
}

static inline float fresnel(float cos_i, float eta) {
  const float c = clamp(cos_i, 0, 1), t2 = cos2_refracted(c, eta);
  const float t = sqrtf(clamp(t2, 0, 1)), s = eta * c + t, p = eta * t + c;
  const float contrast = (eta - 1) * (eta + 1), r_s = contrast / (s * s);
  const float r_p = contrast / (p * p) * (c * c * (1 + eta * eta) - eta * eta);
  const float reflected = least(0.5f * (r_s * r_s + r_p * r_p), 1);
  const float whole = t2 <= 0 ? 1 : reflected;
  return eta == 1 ? 0 : whole;
}

/* optics.glsl: d travels, n is on the side that it comes from. */
static inline bool refract_direction(v3 d, v3 n, float eta, v3 *t) {
  const float cos_i = clamp(-dot(d, n), 0, 1), cos2_t = eta == 1 ? 1 : cos2_refracted(cos_i, eta);
  *t = d;
  if (cos2_t <= 0) return false;
  if (eta == 1) return true;
  const float bend = (eta - 1) * ((eta + 1) / (eta * cos_i + sqrtf(least(cos2_t, 1))));
  *t = normalize(plus(times(eta, d), times(bend, n)));
  return true;
}

static inline v3 reflect(v3 d, v3 n) {
  return off(d, times(2 * dot(d, n), n));
}

static inline v3 keep_side(v3 face_n, v3 d) {
  const float along = dot(d, face_n);
  return along > 0 ? d : normalize(plus(d, times(1e-3f - along, face_n)));
}

#endif
