#include "tests/check.h"

#include "colorimetry/plot/chart_panel.h"

static void check_labels(abbe_axis axis, size_t wanted, const char *labels, int wanted_exponent) {
  abbe_axis_tick tick[ABBE_AXIS_MAX_TICKS];
  int exponent = 7;
  size_t count = abbe_axis_ticks(&axis, wanted, tick, &exponent);
  char text[1024] = "";
  for (size_t i = 0; i < count; i++) {
    assert_int_equal(tick[i].major, tick[i].label[0] != '\0');
    assert_true(tick[i].value >= axis.min * (1 - 1e-6) - 1e-12 || axis.min < 0);
    if (i > 0) assert_true(tick[i].value > tick[i - 1].value);
    if (!tick[i].major) continue;
    if (text[0] != '\0') strcat(text, " ");
    strcat(text, tick[i].label);
  }
  assert_string_equal(text, labels);
  assert_int_equal(exponent, wanted_exponent);
}

TEST(ticks_are_round) {
  check_labels((abbe_axis){380, 780, false, false}, 8, "400 450 500 550 600 650 700 750", 0);
  check_labels((abbe_axis){0, 1, false, false}, 5, "0.0 0.2 0.4 0.6 0.8 1.0", 0);
  check_labels((abbe_axis){-1, 1, false, true}, 4, "−1.0 −0.5 0.0 0.5 1.0", 0);
  check_labels((abbe_axis){1.5163, 1.5171, false, false}, 4, "1.5164 1.5166 1.5168 1.5170", 0);
  check_labels((abbe_axis){-2.5e-5, 3.1e-5, false, false}, 5, "−2 0 2", -5);
  check_labels((abbe_axis){-4.2e-5, 3.5e-5, false, false}, 2, "−4 −2 0 2", -5);
  check_labels((abbe_axis){0, 3e6, false, false}, 3, "0 1 2 3", 6);
}

TEST(decades_are_ticks_of_a_log_axis) {
  check_labels((abbe_axis){0.01, 100, true, false}, 6, "0.01 0.1 1 10 100", 0);
  check_labels((abbe_axis){3e-6, 2e-3, true, false}, 6, "10⁻⁵ 10⁻⁴ 0.001", 0);
  check_labels((abbe_axis){1, 1e12, true, false}, 5, "1 1000 10⁶ 10⁹ 10¹²", 0);
  check_labels((abbe_axis){2, 8, true, false}, 4, "2 4 6 8", 0);
  /* one power of ten is no scale: two and five times it, or powers of ten closer together */
  check_labels((abbe_axis){150, 6000, true, false}, 3, "200 500 1000 2000 5000", 0);
  check_labels((abbe_axis){0.003, 0.08, true, false}, 3, "0.005 0.01 0.02 0.05", 0);
  check_labels((abbe_axis){7, 6000, true, false}, 3, "10 100 1000", 0);
  abbe_axis axis = {1, 100, true, false};
  abbe_axis_tick tick[ABBE_AXIS_MAX_TICKS];
  int exponent;
  assert_int_equal(abbe_axis_ticks(&axis, 5, tick, &exponent), 19);
  assert_near(tick[4].value, 5, 1e-12);
  assert_false(tick[4].major);
}

TEST(values_have_places) {
  abbe_axis linear = {10, 20, false, false}, logarithmic = {1, 100, true, false};
  assert_near(abbe_axis_at(&linear, 12.5), 0.25, 1e-15);
  assert_near(abbe_axis_at(&linear, 25), 1.5, 1e-15);
  assert_near(abbe_axis_at(&logarithmic, 10), 0.5, 1e-15);
  assert_true(isnan(abbe_axis_at(&logarithmic, 0)));
  assert_true(isnan(abbe_axis_at(&logarithmic, -1)));
  linear.reversed = true;
  assert_near(abbe_axis_at(&linear, 10), 1, 0);
}

TEST(an_axis_shows_its_values) {
  abbe_axis a = abbe_axis_make(0, 10, 0.1, false, false);
  assert_near(a.min, -1, 1e-12);
  assert_near(a.max, 11, 1e-12);
  a = abbe_axis_make(1, 100, 0.5, true, false);
  assert_near(a.min, 0.1, 1e-12);
  assert_near(a.max, 1000, 1e-9);
  const double single[] = {0, 3, -2};
  for (int i = 0; i < 3; i++) {
    a = abbe_axis_make(single[i], single[i], 0.1, false, false);
    assert_true(a.min < single[i] && single[i] < a.max);
  }
  a = abbe_axis_make(INFINITY, -INFINITY, 0.1, false, false);
  assert_true(a.min < a.max && isfinite(a.min) && isfinite(a.max));
  const double far[] = {1e-320, 1e-300, 1, 1e300, 1.7e308};
  for (int i = 0; i < 5; i++)
    for (int k = i; k < 5; k++)
      for (int log = 0; log < 2; log++) {
        abbe_axis_tick tick[ABBE_AXIS_MAX_TICKS];
        int exponent = 0;
        a = abbe_axis_make(log ? far[i] : -far[k], far[k], 0.1, log, false);
        assert_true(a.min < a.max && isfinite(a.max - a.min) && (!log || a.min > 0));
        assert_true(abbe_axis_ticks(&a, 5, tick, &exponent) <= ABBE_AXIS_MAX_TICKS);
        assert_int_in_range(exponent + 400, 0, 800);
      }
  a = abbe_axis_make(INFINITY, -INFINITY, 0.1, true, false);
  assert_true(0 < a.min && a.min < a.max && isfinite(a.max));
}
