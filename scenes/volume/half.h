/* half.h: numbers of 16 bits, as OpenEXR and graphics devices store them: 11 bits of a mantissa, to
 * 65504, in steps of 6e-8 below 6e-5.
 */
#ifndef ABBE_SCENES_VOLUME_HALF_H
#define ABBE_SCENES_VOLUME_HALF_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* The nearest one, of two as near the even one; what is too large becomes the largest. */
static inline uint16_t abbe_half_of(double x) {
  const uint16_t sign = signbit(x) ? 0x8000 : 0;
  const double size = fabs(x);
  if (!(size > 0)) return sign;
  if (size >= 65504) return sign | 0x7bff;
  int exponent;
  frexp(size, &exponent);
  if (exponent < -13) exponent = -13; /* steps of 2^-24 */
  const double steps = nearbyint(ldexp(size, 11 - exponent));
  /* a mantissa that is rounded up to the next power of two carries into the exponent by itself */
  const long bits = (exponent + 13) * 1024L + (long)steps;
  return sign | (uint16_t)bits;
}

/* The same of a float, in fewer steps. */
static inline uint16_t abbe_half_of_float(float x) {
  uint32_t bits;
  memcpy(&bits, &x, sizeof bits);
  const uint16_t sign = (uint16_t)(bits >> 16 & 0x8000);
  float size = fabsf(x);
  if (!(size > 0)) return sign;
  if (size >= 65504) return sign | 0x7bff;
  if (size < 0x1p-14f) { /* added to a half, its steps are those of the sum */
    size += 0.5f;
    memcpy(&bits, &size, sizeof bits);
    return sign | (uint16_t)(bits - 0x3f000000u);
  }
  bits = (bits & 0x7fffffffu) - (112u << 23);
  return sign | (uint16_t)((bits + 0xfffu + (bits >> 13 & 1)) >> 13);
}

/* Neither infinite nor NaN. */
static inline bool abbe_half_is_finite(uint16_t half) {
  return (half & 0x7c00) != 0x7c00;
}

static inline double abbe_half_value(uint16_t half) {
  const uint32_t bits = (uint32_t)(half & 0x7fff) << 13; /* a float with exponents 112 too small */
  float size;
  memcpy(&size, &bits, sizeof size);
  size *= 0x1p112f;
  return (double)(half & 0x8000 ? -size : size);
}

#endif
