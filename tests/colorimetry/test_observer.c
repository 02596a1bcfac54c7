#include "tests/check.h"
#include "tests/colorimetry/colord.h"

#include "colorimetry/observer.h"

static void test_table_is_the_cies(void **state) {
  (void)state;
  double cie[300], start = 0, end = 0;
  size_t count = colord_read("cmf/CIE1931-2deg-XYZ.cmf", cie, 300, &start, &end);
  assert_int_equal(count, 285);
  assert_true(start == ABBE_OBSERVER_MIN_NM && end == ABBE_OBSERVER_MAX_NM);
  for (int i = 0; i < 95; i++) {
    double xyz[3];
    abbe_observer_xyz(360 + 5 * i, xyz);
    for (int k = 0; k < 3; k++) assert_true(fabs(xyz[k] - cie[95 * k + i]) <= 1e-15);
  }
}

static void test_between_knots(void **state) {
  (void)state;
  for (int i = 0; i < 94; i++) {
    double low[3], high[3];
    abbe_observer_xyz(360 + 5 * i, low);
    abbe_observer_xyz(365 + 5 * i, high);
    for (double t = 0; t <= 5; t += 0.01) {
      double xyz[3];
      abbe_observer_xyz(360 + 5 * i + t, xyz);
      for (int k = 0; k < 3; k++)
        assert_true(xyz[k] >= fmin(low[k], high[k]) - 1e-15 &&
                    xyz[k] <= fmax(low[k], high[k]) + 1e-15 && xyz[k] >= 0);
    }
  }
}

/* The sums of the CIE's 1 nm table; interpolating every fifth value comes within 2 in 10^4. */
static void test_near_the_1_nm_table(void **state) {
  (void)state;
  static const double sums[3] = {106.865469, 106.856917, 106.892251};
  double sum[3] = {0};
  for (int nm = 360; nm <= 830; nm++) {
    double xyz[3];
    abbe_observer_xyz(nm, xyz);
    for (int k = 0; k < 3; k++) sum[k] += xyz[k];
  }
  for (int k = 0; k < 3; k++)
    if (fabs(sum[k] / sums[k] - 1) > 2e-4) fail_msg("component %d sums to %.6f", k, sum[k]);
}

static void test_zero_outside(void **state) {
  (void)state;
  static const double outside[] = {-1, 0, 359.999, 830.001, 1e300, INFINITY, -INFINITY, NAN};
  for (size_t i = 0; i < sizeof outside / sizeof outside[0]; i++) {
    double xyz[3] = {1, 1, 1};
    abbe_observer_xyz(outside[i], xyz);
    assert_true(xyz[0] == 0 && xyz[1] == 0 && xyz[2] == 0);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_table_is_the_cies), cmocka_unit_test(test_between_knots),
      cmocka_unit_test(test_near_the_1_nm_table), cmocka_unit_test(test_zero_outside)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
