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
  OK(abbe_gem_slope_make(stone, weights, q, 1, &slope, &error));
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
    OK(abbe_gem_slope_make(&j.stone, &j.weights, &q, 1, &slope, &error));
    const double got =
        abbe_gem_slope_by(&slope, &(abbe_gem_change){.plane = (const double(*)[4])by}).value;
    const double exact = (moved(&j.stone, &j.weights, (const double(*)[4])by, h, &q) -
                          moved(&j.stone, &j.weights, (const double(*)[4])by, -h, &q)) /
                         (2 * h);
    if (!(fabs(got - exact) <= 1e-4 * (fabs(exact) + slope.value.value)))
      fail_msg("measure %d: %.10g and not %.10g", i, got, exact);
    abbe_gem_slope_free(&slope);
    abbe_spectrum_free(m.attenuation);
  }
}

/* By the index, the loss, and what the index grows by, of every measure and of fire alone. */
TEST(derivatives_by_the_material_are_those_of_differences) {
  static const abbe_gem_amount measures[] = {ABBE_GEM_ISO, ABBE_GEM_COS, ABBE_GEM_RETURN,
                                             ABBE_GEM_GEMRAY_SC2, ABBE_GEM_AMOUNT_COUNT};
  for (int i = 0; i < 15; i++) {
    abbe_material m = glass(1.7);
    const double nm[1] = {550}, per_m[1] = {100}, one = 1;
    OK(abbe_spectrum_make(nm, per_m, 1, ABBE_INTERPOLATION_LINEAR, &m.attenuation, &error));
    OWNED(judged, j) = judged_make(design_a, &m, 1);
    abbe_gem_slope_desc q = {.measure = measures[i % 5],
                             .fire = i % 5 == 4 || i % 2,
                             .spread = 0.02,
                             .axis_rad = 0.3,
                             .tilt_rad = 0.2,
                             .head_rad = 0.25,
                             .soft_rad = 0.1,
                             .least_share = 1e-9,
                             .meetings = 12,
                             .lines = 3,
                             .threads = 2};
    MADE(abbe_gem_slope, slope, abbe_gem_slope_make(&j.stone, &j.weights, &q, 1, &slope, &error));
    const abbe_gem_change change = {
        .n = i / 5 == 0 ? &one : NULL, .loss = i / 5 == 1 ? &one : NULL, .spread = i / 5 == 2};
    const double got = abbe_gem_slope_by(&slope, &change).value;
    /* Tables are of floats: the steps are what these come to. */
    double value[2], at[2];
    for (int s = 0; s < 2; s++) {
      const double off = s == 0 ? -0x1p-17 : 0x1p-17;
      float *to = i / 5 == 0 ? j.stone.media.n : j.stone.media.attenuation;
      const float was = *to;
      if (i / 5 < 2) *to += (float)off;
      at[s] = i / 5 < 2 ? (double)*to : q.spread + off;
      if (i / 5 == 2) q.spread += off;
      abbe_gem_slope moved_slope;
      OK(abbe_gem_slope_make(&j.stone, &j.weights, &q, 1, &moved_slope, &error));
      value[s] = moved_slope.value.value;
      abbe_gem_slope_free(&moved_slope);
      *to = was;
      q.spread = 0.02;
    }
    const double exact = (value[1] - value[0]) / (at[1] - at[0]);
    if (!(fabs(got - exact) <= 1e-4 * (fabs(exact) + slope.value.value)))
      fail_msg("%d: %.10g and not %.10g", i, got, exact);
    abbe_spectrum_free(m.attenuation);
  }
}

static bool stop(void *user, double done) {
  ++*(int *)user;
  return done < 0.5;
}

/* By the same lines: of measures that are asked for together there is what each alone has. */
TEST(measures_are_made_together_and_stopped) {
  abbe_material m = glass(1.7);
  OWNED(judged, j) = judged_make(design_a, &m, 1);
  static const abbe_gem_amount measures[] = {ABBE_GEM_ISO, ABBE_GEM_GEMRAY_COS,
                                             ABBE_GEM_AMOUNT_COUNT};
  abbe_gem_slope_desc q[3];
  abbe_gem_slope all[3], alone;
  double by[128][4];
  lean(&j.stone, by);
  for (int i = 0; i < 3; i++)
    q[i] = (abbe_gem_slope_desc){.measure = measures[i],
                                 .fire = i == 2,
                                 .spread = 0.02,
                                 .head_rad = 0.25,
                                 .soft_rad = 0.1,
                                 .lines = 3,
                                 .threads = 2};
  const abbe_gem_change change = {.plane = (const double(*)[4])by, .spread = 1};
  OK(abbe_gem_slope_make(&j.stone, &j.weights, q, 3, all, &error));
  for (int i = 0; i < 3; i++) {
    OK(abbe_gem_slope_make(&j.stone, &j.weights, &q[i], 1, &alone, &error));
    assert_true(all[i].value.value == alone.value.value && alone.value.value > 0);
    const abbe_gem_number is = abbe_gem_slope_by(&all[i], &change);
    const abbe_gem_number was = abbe_gem_slope_by(&alone, &change);
    assert_near(is.value, was.value, 1e-12 * fabs(was.value));
    assert_near(is.error, was.error, 1e-9 * fabs(was.error));
    abbe_gem_slope_free(&alone);
    abbe_gem_slope_free(&all[i]);
  }
  int told = 0;
  q[0].progress = stop;
  q[0].user = &told;
  q[0].threads = 1;
  REFUSED(ABBE_CANCELLED, "stopped", abbe_gem_slope_make(&j.stone, &j.weights, q, 3, all, &error));
  assert_int_equal(told, 12);
}

/* A slab seen from straight above returns 2 R / (1 + R) where it is clear; where it weakens light
 * to T on the way through, R + (1 - R)^2 R T^2 / (1 - R^2 T^2). */
static double slab_returns(double n, double loss, double thick) {
  const double r = pow((n - 1) / (n + 1), 2), t = exp(-2 * loss * thick);
  return r + (1 - r) * (1 - r) * r * t / (1 - r * r * t);
}

TEST(a_slabs_return_changes_as_is_known) {
  abbe_material m = glass(1.7);
  const double nm[1] = {550}, per_m[1] = {40}, one = 1, h = 1e-6;
  OK(abbe_spectrum_make(nm, per_m, 1, ABBE_INTERPOLATION_LINEAR, &m.attenuation, &error));
  OWNED(judged, j) = judged_make(slab, &m, 1);
  const abbe_gem_slope_desc q = {
      .measure = ABBE_GEM_ISO, .least_share = 1e-9, .meetings = 20, .lines = 4, .threads = 1};
  MADE(abbe_gem_slope, slope, abbe_gem_slope_make(&j.stone, &j.weights, &q, 1, &slope, &error));
  const double n = (double)j.stone.media.n[0], a = (double)j.stone.media.attenuation[0];
  double low = INFINITY, high = -INFINITY, by[8][4] = {{0}};
  for (size_t i = 0; i < j.stone.plane_count; i++) {
    if (fabs(j.stone.plane[i][2]) < 0.5) continue;
    low = fmin(low, j.stone.plane[i][2] * j.stone.plane[i][3]);
    high = fmax(high, j.stone.plane[i][2] * j.stone.plane[i][3]);
    by[i][3] = 0.5; /* thicker by one */
  }
  const double thick = high - low;
  assert_near(slope.value.value, slab_returns(n, a, thick), 1e-7);
  const struct {
    abbe_gem_change change;
    double n, loss, thick;
  } rows[] = {{{.n = &one}, h, 0, 0},
              {{.loss = &one}, 0, h, 0},
              {{.plane = (const double(*)[4])by}, 0, 0, h}};
  for (int i = 0; i < 3; i++) {
    const double up = slab_returns(n + rows[i].n, a + rows[i].loss, thick + rows[i].thick);
    const double down = slab_returns(n - rows[i].n, a - rows[i].loss, thick - rows[i].thick);
    const double exact = (up - down) / (2 * h);
    assert_near(abbe_gem_slope_by(&slope, &rows[i].change).value, exact, 1e-5 * fabs(exact));
  }
  abbe_spectrum_free(m.attenuation);
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
    MADE(abbe_gem_slope, slope, abbe_gem_slope_make(&j.stone, &j.weights, &q, 1, &slope, &error));
    const abbe_gem_number seen = abbe_gem_view_amount(&view, measures[i % 3]);
    assert_near(slope.value.value, seen.value, 3.5 * hypot(seen.error, slope.value.error));
    assert_true(slope.value.error < 0.01);
    abbe_gem_view_free(&view);
  }
}
