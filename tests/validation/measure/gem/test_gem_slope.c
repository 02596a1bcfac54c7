#include "validation/measure/gem/gem_slope.h"

#include "tests/validation/measure/gem/gem_stones.h"

/* Every plane leans and moves in a way of its own; by: the derivative of its n and d. */
static void lean(const abbe_gem_stone *stone, double (*by)[4]) {
  for (size_t i = 0; i < stone->plane_count; i++) {
    const double *n = stone->plane[i], turn[3] = {sin(3.0 * i), cos(5.0 * i), sin(1 + 2.0 * i)};
    by[i][0] = turn[1] * n[2] - turn[2] * n[1];
    by[i][1] = turn[2] * n[0] - turn[0] * n[2];
    by[i][2] = turn[0] * n[1] - turn[1] * n[0];
    if (fabs(n[2]) < 1e-9) memset(by[i], 0, sizeof by[i]); /* seen from its edge it stays so */
    by[i][3] = cos(7.0 * i);
  }
}

static double moved(abbe_gem_stone *stone, const abbe_weights *weights, const double (*by)[4],
                    double h, const abbe_gem_slope_desc *q) {
  abbe_gem_slope slope;
  for (size_t i = 0; i < stone->plane_count; i++)
    for (int k = 0; k < 4; k++) stone->plane[i][k] += h * by[i][k];
  OK(abbe_gem_slope_make(stone, weights, q, &slope, &error));
  for (size_t i = 0; i < stone->plane_count; i++)
    for (int k = 0; k < 4; k++) stone->plane[i][k] -= h * by[i][k];
  const double value = slope.value.value;
  abbe_gem_slope_free(&slope);
  return value;
}

/* By differences of the same lines, whose light is exact: of every measure, level and tilted, of
 * clear and dark glass, and of fire. */
TEST(derivatives_are_those_of_differences) {
  static const abbe_gem_amount measures[] = {
      ABBE_GEM_ISO,        ABBE_GEM_COS,        ABBE_GEM_RETURN,    ABBE_GEM_DOWN,
      ABBE_GEM_GEMRAY_ISO, ABBE_GEM_GEMRAY_COS, ABBE_GEM_GEMRAY_SC2};
  for (int i = 0; i < 14; i++) {
    abbe_material m = glass(1.7);
    const double nm[1] = {550}, per_m[1] = {i < 7 ? 0 : 100}, h = 1e-8;
    OK(abbe_spectrum_make(nm, per_m, 1, ABBE_INTERPOLATION_LINEAR, &m.attenuation, &error));
    OWNED(judged, j) = judged_make(design_a, &m, 1);
    const abbe_gem_slope_desc q = {.measure = measures[i % 7],
                                   .fire = i % 3 == 0,
                                   .spread = 0.02,
                                   .axis_rad = 0.3,
                                   .tilt_rad = i % 2 * 0.2,
                                   .head_rad = 0.25,
                                   .soft_rad = 0.1,
                                   .least_share = 1e-9,
                                   .meetings = 12,
                                   .lines = 3,
                                   .threads = 2};
    double by[128][4];
    lean(&j.stone, by);
    abbe_gem_slope slope;
    OK(abbe_gem_slope_make(&j.stone, &j.weights, &q, &slope, &error));
    const double got = abbe_gem_slope_by(&slope, (const double(*)[4])by).value;
    const double exact = (moved(&j.stone, &j.weights, (const double(*)[4])by, h, &q) -
                          moved(&j.stone, &j.weights, (const double(*)[4])by, -h, &q)) /
                         (2 * h);
    if (!(fabs(got - exact) <= 1e-4 * (fabs(exact) + slope.value.value)))
      fail_msg("measure %d: %.10g and not %.10g", i, got, exact);
    abbe_gem_slope_free(&slope);
    abbe_spectrum_free(m.attenuation);
  }
}

/* Without softening, and with paths as long as a view's, it is what a view shows: level and tilted,
 * in the mean of wavelengths of which some count little. */
TEST(its_value_is_a_views) {
  abbe_material m = glass(0);
  m.dispersion = (abbe_dispersion){.model = ABBE_DISPERSION_CAUCHY, .count = 2, .c = {1.5, 0.02}};
  OWNED(judged, j) = judged_make(design_a, &m, 6);
  for (int i = 0; i < 4; i++) {
    static const abbe_gem_amount measures[] = {ABBE_GEM_ISO, ABBE_GEM_RETURN, ABBE_GEM_GEMRAY_SC2};
    const double tilt = i % 2 * 0.2;
    const abbe_gem_view_desc desc = {.tilt_rad = tilt, .head_rad = 0.25, .side = 48, .threads = 2};
    abbe_gem_view view = judged_view(&j, &desc);
    const abbe_gem_slope_desc q = {.measure = measures[i % 3],
                                   .tilt_rad = tilt,
                                   .head_rad = 0.25,
                                   .least_share = 1e-4,
                                   .meetings = ABBE_GEM_SLOPE_MEETINGS,
                                   .lines = 24,
                                   .threads = 2};
    MADE(abbe_gem_slope, slope, abbe_gem_slope_make(&j.stone, &j.weights, &q, &slope, &error));
    const abbe_gem_number seen = abbe_gem_view_amount(&view, measures[i % 3]);
    assert_near(slope.value.value, seen.value, 3.5 * hypot(seen.error, slope.value.error));
    assert_true(slope.value.error < 0.01);
    abbe_gem_view_free(&view);
  }
}
