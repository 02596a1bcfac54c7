#include "tests/check.h"

#include "spectral/dispersion/points.h"

TEST(points_are_put_in_order_and_the_first_of_equals_stays) {
  abbe_points points = {0};
  const double lambda_nm[] = {600, 500, 600, 400, 500, 600};
  for (int i = 0; i < 6; i++)
    OK(abbe_points_add(&points, (abbe_point){lambda_nm[i], i, 0}, &error));
  size_t dropped = 9;
  OK(abbe_points_sort(&points, &dropped, &error));
  assert_int_equal(dropped, 3);
  assert_int_equal(points.count, 3);
  const double wanted[3][2] = {{400, 3}, {500, 1}, {600, 0}};
  for (int i = 0; i < 3; i++) {
    assert_near(points.point[i].lambda_nm, wanted[i][0], 0);
    assert_near(points.point[i].value, wanted[i][1], 0);
  }
  abbe_spectrum *spectrum = NULL;
  OK(abbe_points_spectrum(&points, ABBE_INTERPOLATION_LINEAR, &spectrum, &error));
  assert_near(abbe_spectrum_at(spectrum, 450), 2, 1e-14);
  abbe_spectrum_free(spectrum);
  abbe_points_free(&points);
  assert_int_equal(abbe_points_spectrum(&points, ABBE_INTERPOLATION_LINEAR, &spectrum, NULL),
                   ABBE_INVALID_ARGUMENT);
}

TEST(a_long_list_ends_where_a_spectrum_does) {
  OWNED(abbe_points, points) = {0};
  for (int i = 0; i < ABBE_SPECTRUM_MAX_COUNT; i++)
    OK(abbe_points_add(&points, (abbe_point){70000 - i, i, 0}, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "more than 65536 points",
          abbe_points_add(&points, (abbe_point){1, 1, 0}, &error));
  size_t dropped = 1;
  OK(abbe_points_sort(&points, &dropped, &error));
  assert_int_equal(dropped, 0);
  for (size_t i = 1; i < points.count; i++)
    assert_true(points.point[i - 1].lambda_nm < points.point[i].lambda_nm);
}
