/* crystal_faces.h: directions about a face that looks up, for the tests of crystals. */
#ifndef ABBE_TESTS_SPECTRAL_CRYSTAL_FACES_H
#define ABBE_TESTS_SPECTRAL_CRYSTAL_FACES_H

#include "tests/check.h"

#include "base/maths.h"

static const double up[3] = {0, 0, 1};

static inline double radians(double degree) {
  return degree * ABBE_PI / 180;
}
static inline double degrees(double radian) {
  return radian * 180 / ABBE_PI;
}
static inline double dot(const double a[3], const double b[3]) {
  return abbe_vector_dot(a, b);
}
/* Evenly from 0 to 1, the same in every run. */
static inline double next(void) {
  static uint64_t state = 88172645463325252ull;
  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return (double)(state >> 11) * 0x1p-53;
}
static inline void direction(double out[3]) {
  double square;
  do {
    for (int k = 0; k < 3; k++) out[k] = 2 * next() - 1;
    square = dot(out, out);
  } while (!(square > 0.01 && square < 1));
  for (int k = 0; k < 3; k++) out[k] /= sqrt(square);
}
/* Downwards, at an angle to the face's normal in the plane of x and z. */
static inline void down(double degree, double out[3]) {
  out[0] = sin(radians(degree));
  out[1] = 0;
  out[2] = -cos(radians(degree));
}

#endif
