/* half.h: numbers of 16 bits, as OpenEXR and graphics devices store them: 11 bits of a mantissa, to
 * 65504, in steps of 6e-8 below 6e-5.
 *
 * Internal to scenes/ and gl/: it is not installed.
 */
#ifndef ABBE_SCENES_VOLUME_HALF_H
#define ABBE_SCENES_VOLUME_HALF_H

#include <math.h>
#include <stdint.h>

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

static inline double abbe_half_value(uint16_t half) {
  const int exponent = half >> 10 & 31, mantissa = half & 1023;
  const double size = exponent == 0 ? ldexp(mantissa, -24) : ldexp(mantissa + 1024, exponent - 25);
  return half & 0x8000 ? -size : size;
}

#endif
