#include "tests/check.h"
#include "tests/colorimetry/colord.h"

#include "colorimetry/observer.h"

static void compare_with_the_cies(const char *file, abbe_observer observer) {
  double cie[300], start = 0, end = 0;
  size_t count = colord_read(file, cie, 300, &start, &end);
  assert_int_equal(count, 285);
  assert_true(start == ABBE_OBSERVER_MIN_NM && end == ABBE_OBSERVER_MAX_NM);
  for (int i = 0; i < 95; i++) {
    double xyz[3];
    abbe_observer_xyz_of(observer, 360 + 5 * i, xyz);
    for (int k = 0; k < 3; k++) assert_true(fabs(xyz[k] - cie[95 * k + i]) <= 1e-15);
  }
}

TEST(tables_are_the_cies) {
  compare_with_the_cies("cmf/CIE1931-2deg-XYZ.cmf", ABBE_OBSERVER_CIE_1931);
  compare_with_the_cies("cmf/CIE1964-10deg-XYZ.cmf", ABBE_OBSERVER_CIE_1964);
  for (double nm = 350; nm < 840; nm += 0.7) {
    double a[3], b[3];
    abbe_observer_xyz(nm, a);
    abbe_observer_xyz_of(ABBE_OBSERVER_CIE_1931, nm, b);
    assert_memory_equal(a, b, sizeof a);
  }
}

/* ybar of 2015 is 1 at 556 and 557 nm, its greatest [CIE170-2]; and each observer's equal-energy
 * light is white, by their normalisation: x = y = 1/3. */
TEST(observers_of_2015) {
  static const abbe_observer observer[2] = {ABBE_OBSERVER_CIE_2015_2, ABBE_OBSERVER_CIE_2015_10};
  static const double peak_nm[2] = {555, 555}, peak[2] = {0.999181, 0.9988};
  for (int o = 0; o < 2; o++) {
    double sum[3] = {0}, xyz[3];
    for (int nm = 390; nm <= 830; nm += 5) {
      abbe_observer_xyz_of(observer[o], nm, xyz);
      for (int k = 0; k < 3; k++) sum[k] += xyz[k];
    }
    const double all = sum[0] + sum[1] + sum[2];
    for (int k = 0; k < 3; k++) assert_near(sum[k] / all, 1.0 / 3, 1e-4);
    abbe_observer_xyz_of(observer[o], peak_nm[o], xyz);
    assert_near(xyz[1], peak[o], 2e-3);
    abbe_observer_xyz_of(observer[o], 389.9, xyz);
    assert_true(xyz[0] == 0 && xyz[1] == 0 && xyz[2] == 0);
  }
}

TEST(names) {
  for (int i = 0; i < ABBE_OBSERVER_COUNT; i++)
    assert_int_equal(abbe_observer_find(abbe_observer_name((abbe_observer)i)), i);
  assert_int_equal(abbe_observer_find("2006-10"), ABBE_OBSERVER_CIE_2015_10);
  assert_int_equal(abbe_observer_find("1932"), ABBE_OBSERVER_COUNT);
  for (int i = 0; i < ABBE_OBSERVER_COUNT; i++)
    assert_int_equal(abbe_observer_find(abbe_observer_text((abbe_observer)i)), i);
  assert_string_equal(abbe_observer_text(ABBE_OBSERVER_CIE_1964), "CIE 1964, 10 degrees");
  double xyz[3] = {1, 1, 1};
  abbe_observer_xyz_of(ABBE_OBSERVER_COUNT, 500, xyz);
  assert_true(xyz[0] == 0 && xyz[1] == 0 && xyz[2] == 0);
}

TEST(between_knots) {
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

/* By hand from the table's first three rows: the end's slope is that of the parabola through them,
 * 1.5 s1 - 0.5 s2 [Steffen1990]. */
TEST(between_the_first_knots) {
  const double x[3] = {0.0001299, 0.0002321, 0.0004149};
  const double first = x[1] - x[0], mean = (x[2] - x[0]) / 2, end = 1.5 * first - 0.5 * (x[2] - x[1]);
  double xyz[3];
  abbe_observer_xyz(362.5, xyz);
  assert_near(xyz[0], (x[0] + x[1]) / 2 + (end - mean) / 8, 1e-18);
}

/* The sums of the CIE's 1 nm table; interpolating every fifth value comes within 2 in 10^4. */
TEST(near_the_1_nm_table) {
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

TEST(zero_outside) {
  static const double outside[] = {-1, 0, 359.999, 830.001, 1e300, INFINITY, -INFINITY, NAN};
  for (size_t i = 0; i < sizeof outside / sizeof outside[0]; i++) {
    double xyz[3] = {1, 1, 1};
    abbe_observer_xyz(outside[i], xyz);
    assert_true(xyz[0] == 0 && xyz[1] == 0 && xyz[2] == 0);
  }
}
