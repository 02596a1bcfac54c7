/* random.h: counter-based random numbers: the same counters give the same numbers on any thread.
 *
 * Four 32-bit words are mixed into four others [JarzynskiOlano2020]; nothing is stored.
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRANSPORT_RANDOM_H
#define ABBE_VALIDATION_TRACE_TRANSPORT_RANDOM_H

#include <stdint.h>

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

/* The 53 high bits of high and low, one behind the other, as a number in [0, 1): for what is drawn
 * from many entries, whose fractions need bits of their own. */
static inline double abbe_random_double(uint32_t high, uint32_t low) {
  return (double)(((uint64_t)high << 32 | low) >> 11) * 0x1p-53;
}

/* The place of bits, a fraction of 2^32, in part i of `count` equal parts of the whole. Numbers are
 * shifted and shared out as whole ones: a float's sum drops its last bit where it passes 1, and may
 * round to the next part. */
static inline uint32_t abbe_random_part(uint32_t bits, uint32_t i, uint32_t count) {
  return (uint32_t)(((uint64_t)i << 32 | bits) / count);
}

#endif
