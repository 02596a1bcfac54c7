/* random.h: counter-based random numbers: the same counters give the same numbers on any thread.
 *
 * Four 32-bit words are mixed into four others [JarzynskiOlano2020]; nothing is stored.
 */
#ifndef ABBE_VALIDATION_TRANSPORT_RANDOM_H
#define ABBE_VALIDATION_TRANSPORT_RANDOM_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

static inline void abbe_random_bits(uint32_t a, uint32_t b, uint32_t c, uint32_t d,
                                    uint32_t out[4]) {
  a = a * 1664525u + 1013904223u;
  b = b * 1664525u + 1013904223u;
  c = c * 1664525u + 1013904223u;
  d = d * 1664525u + 1013904223u;
  for (int round = 0; round < 2; round++) {
    a += b * d;
    b += c * a;
    c += a * b;
    d += b * c;
    if (round == 1) break;
    a ^= a >> 16;
    b ^= b >> 16;
    c ^= c >> 16;
    d ^= d >> 16;
  }
  out[0] = a;
  out[1] = b;
  out[2] = c;
  out[3] = d;
}

/* The 24 high bits as a number in [0, 1). */
static inline float abbe_random_float(uint32_t bits) {
  return (float)(bits >> 8) * 0x1p-24f;
}

/* Four independent numbers, uniform in [0, 1). */
static inline void abbe_random4(uint32_t a, uint32_t b, uint32_t c, uint32_t d, float out[4]) {
  uint32_t bits[4];
  abbe_random_bits(a, b, c, d, bits);
  for (int k = 0; k < 4; k++) out[k] = abbe_random_float(bits[k]);
}

/* x + shift modulo 1, for x >= 0 and shift in [0, 1): never 1. */
static inline float abbe_random_shift(float x, float shift) {
  float y = x + shift;
  y -= (float)(int32_t)y;
  return y < 1 ? y : 0;
}

#ifdef __cplusplus
}
#endif
#endif
