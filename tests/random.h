/* random.h: numbers for property tests, the same in every run: SplitMix64 [Steele2014]. */
#ifndef ABBE_TESTS_RANDOM_H
#define ABBE_TESTS_RANDOM_H

#include "base/maths.h"

#include <math.h>
#include <stdint.h>

static inline uint64_t random_bits(uint64_t *state) {
  uint64_t z = *state += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/* Evenly in [low, high). */
static inline double random_between(uint64_t *state, double low, double high) {
  return low + (high - low) * (double)(random_bits(state) >> 11) * 0x1p-53;
}

/* A direction, all alike. */
static inline void random_unit(uint64_t *state, double d[3]) {
  do
    for (int k = 0; k < 3; k++) d[k] = random_between(state, -1, 1);
  while (!(abbe_vector_length(d) > 0.1) || abbe_vector_length(d) > 1);
  abbe_vector_normalise(d);
}

/* Of mean 0 and variance 1, by Box and Muller. */
static inline double random_normal(uint64_t *state) {
  double radius = sqrt(-2 * log(1 - random_between(state, 0, 1)));
  return radius * cos(6.283185307179586 * random_between(state, 0, 1));
}

#endif
