/* The default profile against a baseline: numbers worked out by hand. */
#include "tests/validation/tradeoff/sweep_row.h"

#include "validation/tradeoff/baseline_comparison.h"

static void add(abbe_sweep_table *table, const char *profile, size_t photons, double ms, double e) {
  bool plain = strcmp(profile, "default") == 0;
  abbe_sweep_row row = sweep_row(profile, photons);
  row.setting.map = 1024;
  if (!plain) snprintf(row.setting.fill, sizeof row.setting.fill, "smear");
  row.number[ABBE_SWEEP_FRAME_MS] = ms;
  row.number[ABBE_SWEEP_CAUSTIC_DE] = e;
  OK(abbe_sweep_table_add(table, &row, &error));
}

static abbe_baseline_comparison compare_with(const abbe_sweep_table *table, const char *profile) {
  abbe_baseline_comparison c;
  OK(abbe_baseline_comparison_make(table, profile, ABBE_SWEEP_FRAME_MS, ABBE_SWEEP_CAUSTIC_DE, &c,
                                   &error));
  return c;
}

TEST(by_hand) {
  OWNED(abbe_sweep_table, t) = {0};
  abbe_baseline_comparison d = compare_with(&t, "thesis");
  assert_null(d.baseline);
  assert_int_equal(d.front, 0);
  assert_true(isnan(d.equal_error_speedup) && isnan(d.front_ratio));
  add(&t, "default", 64, 10, 8);
  add(&t, "default", 128, 40, 4);
  add(&t, "default", 256, 160, 2);
  add(&t, "thesis", 128, 60, 30);
  add(&t, "thesis", 512, 200, 20); /* its own settings */
  add(&t, "thesis", 1024, 400, 10);
  add(&t, "thesis", 256, 300, 25); /* not on its front */
  d = compare_with(&t, "thesis");
  assert_int_equal(d.baseline->setting.photons, 512);
  assert_near(d.equal_error_speedup, 200 / 10.0, 1e-12);
  assert_near(d.equal_time_error_ratio, 2 / 20.0, 1e-12);
  /* Its front: (60, 30), (200, 20), (400, 10): speedups 6, 20, 40; ratios 4/30, 2/20, 2/10. */
  assert_int_equal(d.front, 3);
  assert_int_equal(d.beaten, 3);
  assert_near(d.front_speedup, 6, 1e-12);
  assert_near(d.front_ratio, 0.2, 1e-12);
  /* A point that is cheaper than all, or better than all, has no answer, and that is said. */
  add(&t, "thesis-cie", 512, 500, 3);
  add(&t, "thesis-cie", 1024, 900, 1.5);
  d = compare_with(&t, "thesis-cie");
  assert_near(d.equal_error_speedup, 500 / 160.0, 1e-12);
  assert_near(d.equal_time_error_ratio, 2 / 3.0, 1e-12);
  assert_int_equal(d.beaten, 1);
  assert_true(isnan(d.front_speedup));
  assert_near(d.front_ratio, 2 / 1.5, 1e-12);
  add(&t, "thesis-cie", 64, 5, 90);
  d = compare_with(&t, "thesis-cie");
  assert_true(isnan(d.front_ratio));
  assert_contains(abbe_baseline_text("thesis-cie"), "physical units");
}
