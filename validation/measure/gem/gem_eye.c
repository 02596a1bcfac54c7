#include "validation/measure/gem/gem_eye.h"

#include "validation/trace/transport/random.h"

#include <math.h>

/* A vector of the stone's, seen from the eye's frame before the stone turned: turned back. */
static void turn(const double axis[2], double c, double s, const double in[3], double out[3]) {
  const double along = axis[0] * in[0] + axis[1] * in[1];
  const double cross[3] = {axis[1] * in[2], -axis[0] * in[2], axis[0] * in[1] - axis[1] * in[0]};
  for (int k = 0; k < 3; k++)
    out[k] = c * in[k] + s * cross[k] + (1 - c) * along * (k < 2 ? axis[k] : 0);
}

abbe_gem_eye abbe_gem_eye_make(double axis_rad, double tilt_rad) {
  static const double base[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double axis[2] = {cos(axis_rad), sin(axis_rad)};
  abbe_gem_eye eye;
  double *to[3] = {eye.right, eye.up, eye.to_eye};
  /* the stone turns one way, and the eye in its axes the other */
  for (int k = 0; k < 3; k++) turn(axis, cos(tilt_rad), -sin(tilt_rad), base[k], to[k]);
  return eye;
}

void abbe_gem_eye_ray(const abbe_gem_eye *eye, size_t side, size_t column, size_t row, double u,
                      double v, double o[3], double d[3]) {
  const double x = 2 * ((double)column + u) / (double)side - 1;
  const double y = 1 - 2 * ((double)row + v) / (double)side;
  for (int k = 0; k < 3; k++) {
    o[k] = x * eye->right[k] + y * eye->up[k] + 2 * eye->to_eye[k];
    d[k] = -eye->to_eye[k];
  }
}

uint32_t abbe_gem_eye_place(size_t side, size_t column, size_t row, size_t repeat, double *u,
                            double *v) {
  uint32_t bits[4];
  abbe_random_bits((uint32_t)column, (uint32_t)row, (uint32_t)side, (uint32_t)repeat, bits);
  *u = (double)abbe_random_float(bits[0]);
  *v = (double)abbe_random_float(bits[1]);
  /* of a pixel's repeats, so that its first choices are spread evenly [Roberts2018] */
  abbe_random_bits((uint32_t)column, (uint32_t)row, (uint32_t)side, 0, bits);
  return bits[2] + (uint32_t)repeat * 2654435769u;
}
