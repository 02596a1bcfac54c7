#include "validation/measure/compare.h"

#include <gsl/gsl_cdf.h>
#include <math.h>

void abbe_ztest_add(abbe_ztest *test, double difference, double variance) {
  if (!(variance > 0 && isfinite(variance) && isfinite(difference))) {
    test->untested++;
    test->untested_differ += !(difference == 0);
    return;
  }
  double square = difference * difference / variance, z = sqrt(square);
  test->count++;
  test->over2 += z > 2;
  test->over3 += z > 3;
  test->sum_square += square;
  test->max = fmax(test->max, z);
}

static double share(const abbe_ztest *test, double part) {
  return test->count > 0 ? part / (double)test->count : NAN;
}

double abbe_ztest_share_over2(const abbe_ztest *test) {
  return share(test, (double)test->over2);
}

double abbe_ztest_share_over3(const abbe_ztest *test) {
  return share(test, (double)test->over3);
}

double abbe_ztest_mean_square(const abbe_ztest *test) {
  return share(test, test->sum_square);
}

double abbe_ztest_expected_share(double z, double freedom) {
  return 2 * (freedom > 0 ? gsl_cdf_tdist_Q(z, freedom) : gsl_cdf_ugaussian_Q(z));
}

double abbe_ztest_expected_mean_square(double freedom) {
  if (!(freedom > 0)) return 1;
  return freedom > 2 ? freedom / (freedom - 2) : INFINITY;
}

/* By halving the interval: GSL's own inverse may fail to converge, and this is done once. */
double abbe_ztest_critical(size_t count, double level, double freedom) {
  if (count < 1 || !(level > 0 && level < 1)) return NAN;
  double chance = -expm1(log1p(-level) / (double)count), low = 0, high = 1;
  while (abbe_ztest_expected_share(high, freedom) > chance && high < 1e12) high *= 2;
  for (int i = 0; i < 100 && high - low > 1e-12 * high; i++) {
    double middle = low + (high - low) / 2;
    if (abbe_ztest_expected_share(middle, freedom) > chance)
      low = middle;
    else
      high = middle;
  }
  return low + (high - low) / 2;
}
