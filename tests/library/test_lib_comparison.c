/* Comparisons by handle: equal pictures, known factors, masks, what is refused. */
#include "tests/check.h"

#include "library/lib_comparison.h"

HOLDS(abbe_lib_comparison);
HOLDS(abbe_lib_picture);

enum { SIDE = 16 };

static abbe_lib_picture *ramp(double factor) {
  static const char *const names[] = {"R", "G", "B"};
  abbe_lib_picture *p = NULL;
  OK(abbe_lib_picture_make(SIDE, SIDE, 3, names, NULL, &p, &error));
  for (int i = 0; i < 3 * SIDE * SIDE; i++)
    abbe_lib_picture_pixels(p)[i] = (float)(factor * (1 + i % 7));
  return p;
}

static double value_of(const abbe_lib_comparison *c, const char *metric) {
  double value, noise, limit;
  OK(abbe_lib_comparison_value(c, metric, false, &value, &noise, &limit, &error));
  return value;
}

TEST(a_factor_is_found) {
  HELD(abbe_lib_picture, a) = ramp(1);
  HELD(abbe_lib_picture, b) = ramp(2);
  abbe_lib_comparison *c = NULL;
  OK(abbe_lib_comparison_make(a, a, NULL, NULL, 0, &c, &error));
  assert_near(value_of(c, "relative_rmse"), 0, 0);
  assert_near(value_of(c, "energy_ratio"), 1, 1e-12);
  assert_near(value_of(c, "ciede2000_max"), 0, 0);
  assert_int_equal(abbe_lib_comparison_pixels(c, false), SIDE * SIDE);
  assert_string_equal(abbe_lib_comparison_verdict(c, "energy_ratio", false), "unknown");
  abbe_lib_comparison_free(c);
  OK(abbe_lib_comparison_make(a, b, NULL, NULL, 0, &c, &error));
  assert_near(value_of(c, "energy_ratio"), 2, 1e-6);
  assert_true(value_of(c, "ciede2000_mean") > 1);
  abbe_lib_comparison_free(c);
  const char *const best[] = {"best_scale=1", "structure=1"};
  OK(abbe_lib_comparison_make(a, b, NULL, best, 2, &c, &error));
  assert_near(value_of(c, "relative_rmse"), 0, 1e-6);
  assert_near(value_of(c, "ssim"), 1, 1e-6);
  abbe_lib_comparison_free(c);
}

TEST(a_drawn_mask_is_kept) {
  static const char *const name[] = {"Y"};
  HELD(abbe_lib_picture, a) = ramp(1), *b = ramp(1);
  HELD(abbe_lib_picture, mask) = NULL;
  abbe_lib_comparison *c = NULL;
  double value, noise, limit;
  abbe_lib_picture_pixels(b)[0] = 100;
  OK(abbe_lib_picture_make(SIDE, SIDE, 1, name, NULL, &mask, &error));
  for (int i = 1; i < 11; i++) abbe_lib_picture_pixels(mask)[i] = 1;
  OK(abbe_lib_comparison_make(a, b, mask, NULL, 0, &c, &error));
  assert_int_equal(abbe_lib_comparison_pixels(c, true), 10);
  OK(abbe_lib_comparison_value(c, "relative_rmse", true, &value, &noise, &limit, &error));
  assert_near(value, 0, 0);
  assert_true(value_of(c, "relative_rmse") > 0.1);
  abbe_lib_comparison_free(c);
  const char *const caustic[] = {"mask=caustic"};
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_lib_comparison_make(a, b, mask, caustic, 1, &c, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_lib_comparison_make(a, b, NULL, caustic, 1, &c,
                                   &error)); /* the reference has no such layers */
  assert_null(c);
}

TEST(what_is_none_is_refused) {
  static const char *const name[] = {"R", "G", "B"};
  HELD(abbe_lib_picture, a) = ramp(1);
  HELD(abbe_lib_picture, small) = NULL;
  HELD(abbe_lib_comparison, c) = NULL;
  double value, noise, limit;
  OK(abbe_lib_picture_make(4, 4, 3, name, NULL, &small, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_lib_comparison_make(a, small, NULL, NULL, 0, &c, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "4 x 4",
          abbe_lib_comparison_make(a, a, small, NULL, 0, &c, &error));
  OK(abbe_lib_comparison_make(a, a, NULL, NULL, 0, &c, &error));
  REFUSED(ABBE_NOT_FOUND, "",
          abbe_lib_comparison_value(c, "beauty", false, &value, &noise, &limit, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_lib_comparison_value(c, "relative_rmse", true, &value, &noise, &limit, &error));
  assert_null(abbe_lib_comparison_verdict(c, "beauty", false));
  assert_int_equal(abbe_lib_comparison_pixels(c, true), 0);
}

TEST(metrics_have_names) {
  size_t count = 0;
  while (abbe_lib_comparison_metric(count) != NULL) count++;
  assert_true(count >= 14);
  assert_string_equal(abbe_lib_comparison_metric(0), "relative_rmse");
}
