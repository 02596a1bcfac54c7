#include "tests/check.h"

#include "spectral/dispersion/index_points.h"

static const abbe_dispersion a = {.model = ABBE_DISPERSION_CAUCHY, .count = 2, .c = {1.51, 0.0040}};
static const abbe_dispersion b = {.model = ABBE_DISPERSION_CAUCHY, .count = 2, .c = {1.50, 0.0040}};
static const abbe_dispersion steeper = {
    .model = ABBE_DISPERSION_CAUCHY, .count = 2, .c = {1.50, 0.0050}};

TEST(a_shift_is_its_own_size_everywhere) {
  abbe_index_difference d;
  OK(abbe_index_difference_of_curves(&a, &b, 380, 780, &d, &error));
  assert_near(d.rms, 0.01, 1e-14);
  assert_near(d.max, 0.01, 1e-14);
  assert_near(d.mean, 0.01, 1e-14);
  OK(abbe_index_difference_of_curves(&b, &a, 380, 780, &d, &error));
  assert_near(d.mean, -0.01, 1e-14);
  assert_near(d.max, 0.01, 1e-14);
  OK(abbe_index_difference_of_curves(&a, &a, 380, 780, &d, &error));
  assert_near(d.rms, 0, 0);
  assert_near(d.max, 0, 0);
}

/* 0.001 / L^2: its mean square over L by hand is 1e-6 times (1/3) (a^-3 - b^-3) / (b - a). */
TEST(a_steeper_curve_differs_most_in_the_violet) {
  abbe_index_difference d;
  OK(abbe_index_difference_of_curves(&steeper, &b, 380, 780, &d, &error));
  assert_near(d.max_nm, 380, 0);
  assert_near(d.max, 0.001 / (0.38 * 0.38), 1e-14);
  double mean_square = (pow(0.38, -3) - pow(0.78, -3)) / 3 / 0.4;
  assert_near(d.rms, 0.001 * sqrt(mean_square), 2e-6 * 3);
  assert_near(d.mean, 0.001 * (1 / 0.38 - 1 / 0.78) / 0.4, 2e-6 * 3);
}

TEST(points_outside_the_range_are_left_out) {
  double lambda_nm[] = {300, 500, 600, 900}, n[] = {9, 1.5, 1.5, 9};
  const abbe_dispersion flat = {.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {1.51}};
  const abbe_index_points points = {.count = 4, .lambda_nm = lambda_nm, .n = n};
  abbe_index_difference d;
  OK(abbe_index_difference_of_points(&flat, &points, 380, 780, &d, &error));
  assert_near(d.max, 0.01, 1e-14);
  assert_near(d.max_nm, 500, 0);
  OK(abbe_index_difference_of_points(&flat, &points, -INFINITY, INFINITY, &d, &error));
  assert_near(d.max, 7.49, 1e-12);
}

TEST(no_common_ground_is_refused) {
  double lambda_nm[] = {500}, n[] = {1.5};
  const abbe_index_points points = {.count = 1, .lambda_nm = lambda_nm, .n = n};
  const abbe_dispersion pole = {.model = ABBE_DISPERSION_SELLMEIER2, .count = 3, .c = {0, 1, 0.3}};
  abbe_index_difference d;
  REFUSED(ABBE_INVALID_ARGUMENT, "600:700",
          abbe_index_difference_of_points(&a, &points, 600, 700, &d, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "no real index at 500 nm",
          abbe_index_difference_of_points(&pole, &points, 0, INFINITY, &d, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_index_difference_of_curves(&a, &pole, 380, 780, &d, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_index_difference_of_curves(&a, &b, 780, 380, &d, &error));
}
