#include "validation/measure/compare.h"

#include "tests/check.h"

TEST(counts) {
  abbe_ztest t = {0};
  static const double z[] = {0, 1, -2, 2.5, -3.5, 3};
  for (int i = 0; i < 6; i++) abbe_ztest_add(&t, z[i] * 0.25, 0.0625);
  abbe_ztest_add(&t, 0, 0);
  abbe_ztest_add(&t, 1e-30, 0);
  abbe_ztest_add(&t, 1, NAN);
  abbe_ztest_add(&t, NAN, 1);
  abbe_ztest_add(&t, 1, INFINITY);
  assert_int_equal(t.count, 6);
  assert_near(abbe_ztest_share_over2(&t), 3.0 / 6, 1e-15);
  assert_near(abbe_ztest_share_over3(&t), 1.0 / 6, 1e-15);
  assert_near(abbe_ztest_mean_square(&t), (1 + 4 + 6.25 + 12.25 + 9) / 6, 1e-12);
  assert_near(t.max, 3.5, 1e-12);
  assert_int_equal(t.untested, 5);
  assert_int_equal(t.untested_differ, 4);
}

TEST(nothing_tested) {
  abbe_ztest t = {0};
  assert_true(isnan(abbe_ztest_share_over2(&t)) && isnan(abbe_ztest_mean_square(&t)));
  assert_true(isnan(abbe_ztest_critical(0, 0.01, 0)));
  assert_true(isnan(abbe_ztest_critical(5, 0, 0)) && isnan(abbe_ztest_critical(5, 1, 0)));
}

/* As tables of the normal distribution and of Student's t print them. */
TEST(tabulated_quantiles) {
  assert_near(abbe_ztest_expected_share(2, 0), 0.04550026, 1e-8);
  assert_near(abbe_ztest_expected_share(3, 0), 0.00269980, 1e-8);
  assert_near(abbe_ztest_critical(1, 0.05, 0), 1.959964, 1e-6);
  assert_near(abbe_ztest_critical(1, 0.01, 0), 2.575829, 1e-6);
  assert_near(abbe_ztest_critical(1, 0.05, 10), 2.228139, 1e-6);
  assert_near(abbe_ztest_critical(1, 0.01, 5), 4.032143, 1e-6);
  assert_near(abbe_ztest_critical(1, 0.05, 1), 12.70620, 1e-5);
  assert_near(abbe_ztest_expected_mean_square(10), 1.25, 0);
  assert_near(abbe_ztest_expected_mean_square(0), 1, 0);
  assert_true(isinf(abbe_ztest_expected_mean_square(2)));
}

/* Of count elements none exceeds it with the chance 1 - level: by the definition of the chance. */
TEST(sidak) {
  static const size_t counts[] = {2, 100, 196608, 100000000};
  static const double freedoms[] = {0, 15, 63, 1e6};
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 4; k++) {
      double z = abbe_ztest_critical(counts[i], 0.01, freedoms[k]);
      double none = exp((double)counts[i] * log1p(-abbe_ztest_expected_share(z, freedoms[k])));
      assert_near(none, 0.99, 1e-6);
    }
  assert_true(isfinite(abbe_ztest_critical(1000000, 0.01, 1)));
}
