/* Spherical harmonics of the light's direction: orthonormal, the low ones as printed everywhere,
 * given back from nodes, and what is left over above their degree. */
#include "tests/check.h"
#include "tests/random.h"

#include "base/maths.h"
#include "scenes/volume/caustic_volume.h"

static const double up[3] = {0, 0, 1};

TEST(low_degrees) {
  uint64_t seed = 1;
  for (int i = 0; i < 100; i++) {
    double d[3], y[9];
    random_unit(&seed, d);
    abbe_light_harmonics_at(2, d, y);
    const double c = sqrt(15 / (4 * ABBE_PI));
    const double known[9] = {sqrt(1 / (4 * ABBE_PI)),
                             sqrt(3 / (4 * ABBE_PI)) * d[1],
                             sqrt(3 / (4 * ABBE_PI)) * d[2],
                             sqrt(3 / (4 * ABBE_PI)) * d[0],
                             c * d[0] * d[1],
                             c * d[1] * d[2],
                             sqrt(5 / (16 * ABBE_PI)) * (3 * d[2] * d[2] - 1),
                             c * d[0] * d[2],
                             c / 2 * (d[0] * d[0] - d[1] * d[1])};
    for (int k = 0; k < 9; k++) assert_near(y[k], known[k], 1e-14);
  }
}

/* By Gauss-Legendre-like quadrature: midpoints in azimuth are exact, in z nearly. */
TEST(they_are_orthonormal) {
  enum { DEGREE = 6, COUNT = 49, Z = 4000, TURN = 16 };
  static double sum[COUNT][COUNT];
  for (int i = 0; i < Z * TURN; i++) {
    double y[COUNT];
    const double z = 2 * (i / TURN + 0.5) / Z - 1, a = 2 * ABBE_PI * (i % TURN) / TURN;
    const double d[3] = {sqrt(1 - z * z) * cos(a), sqrt(1 - z * z) * sin(a), z};
    abbe_light_harmonics_at(DEGREE, d, y);
    for (int j = 0; j < COUNT; j++)
      for (int k = 0; k < COUNT; k++) sum[j][k] += y[j] * y[k] * 4 * ABBE_PI / (Z * TURN);
  }
  for (int j = 0; j < COUNT; j++)
    for (int k = 0; k < COUNT; k++) assert_near(sum[j][k], j == k, 1e-4);
}

/* The square of a sum over the sphere is that of its coefficients; those above the degree are what
 * a fit of dense nodes leaves. */
TEST(fits) {
  abbe_light_nodes nodes;
  OK(abbe_light_nodes_make(642, up, &nodes, &error));
  enum { LOW = 5, LOWS = 36, HIGH = 8, HIGHS = 81 };
  double *fit = calloc(HIGHS * nodes.count, sizeof *fit), coefficient[HIGHS], y[HIGHS];
  uint64_t seed = 4;
  for (int k = 0; k < HIGHS; k++) coefficient[k] = random_between(&seed, -1, 1);
  double *value = calloc(nodes.count, sizeof *value);
  for (size_t j = 0; j < nodes.count; j++) {
    abbe_light_harmonics_at(HIGH, nodes.direction[j], y);
    for (int k = 0; k < HIGHS; k++) value[j] += coefficient[k] * y[k];
  }
  /* its own degree is given back to rounding */
  OK(abbe_light_harmonics_fit(&nodes, HIGH, fit, &error));
  for (size_t k = 0; k < HIGHS; k++) {
    double back = 0;
    for (size_t j = 0; j < nodes.count; j++) back += fit[k * nodes.count + j] * value[j];
    assert_near(back, coefficient[k], 1e-12);
  }
  /* a lower one leaves the rest: mean square over the nodes, of the sphere's area */
  OK(abbe_light_harmonics_fit(&nodes, LOW, fit, &error));
  double own[LOWS] = {0}, left = 0, above = 0;
  for (size_t k = 0; k < LOWS; k++)
    for (size_t j = 0; j < nodes.count; j++) own[k] += fit[k * nodes.count + j] * value[j];
  for (size_t j = 0; j < nodes.count; j++) {
    double sum = 0;
    abbe_light_harmonics_at(LOW, nodes.direction[j], y);
    for (int k = 0; k < LOWS; k++) sum += own[k] * y[k];
    left += pow(value[j] - sum, 2) * 4 * ABBE_PI / (double)nodes.count;
  }
  for (int k = LOWS; k < HIGHS; k++) above += coefficient[k] * coefficient[k];
  assert_near(left / above, 1, 0.05); /* nodes are not quite evenly spaced */
  free(fit);
  free(value);
  abbe_light_nodes_free(&nodes);
}

TEST(too_few_nodes) {
  abbe_light_nodes nodes;
  double fit[16 * 12];
  OK(abbe_light_nodes_make(12, up, &nodes, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "16 coefficients",
          abbe_light_harmonics_fit(&nodes, 3, fit, &error));
  OK(abbe_light_harmonics_fit(&nodes, 2, fit, &error));
  abbe_light_nodes_free(&nodes);
}
