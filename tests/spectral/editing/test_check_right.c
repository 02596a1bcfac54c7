/* Rows that are right, however odd they look, are left alone by the check. */
#include "tests/check.h"
#include "tests/spectral/editing/checked_record.h"

#include "spectral/editing/check.h"

/* What is found about one record. */
static abbe_findings check_record(const char *record) {
  OWNED(abbe_material_table, table) = checked_parse(record);
  assert_int_equal(table.count, 1);
  return checked_table(&table);
}

static size_t doubts_in(const abbe_findings *found) {
  size_t count = 0;
  for (size_t i = 0; i < found->count; i++)
    count += found->finding[i].weight >= ABBE_FINDING_DOUBTFUL;
  return count;
}

static void assert_doubts(const char *record, size_t count) {
  OWNED(abbe_findings, found) = check_record(record);
  if (doubts_in(&found) != count)
    fail_msg("%zu doubts, not %zu: %s\n%s", doubts_in(&found), count, record,
             found.count > 0 ? found.finding[0].evidence : "nothing is found");
  for (size_t i = 0; i < found.count && count == 0; i++) assert_false(found.finding[i].certain);
}

GROUP(shipped_load, shipped_free);

/* n_d follows from the coefficients as far as these are printed. */
TEST(few_digits_are_no_wrong_digit) {
  const struct {
    const char *record;
    size_t doubtful;
  } rows[] = {
      {"- {name: a, model: sellmeier2, coefficients: [0, 1.1523, 0.0155], range_nm: [380, 1000], "
       "source: s1, n_d: 1.48545, v_d: 38.25}",
       0},
      {"- {name: a, model: sellmeier2, coefficients: [0, 1.152300001, 0.0155000001], range_nm: "
       "[380, 1000], source: s1, n_d: 1.48545, v_d: 38.25}",
       2},
      {"- {name: a, model: sellmeier2, coefficients: [0, 1.1523, 0.0155], range_nm: [380, 1000], "
       "source: s1, n_d: 1.4857, v_d: 38.7}",
       2},
      /* the powers of a polynomial are exact */
      {"- {name: a, model: polynomial, coefficients: [2.2718929, -0.010108077, 2, 0.010592509, -2, "
       "0.00020816965, -4], range_nm: [365, 1014], source: s1, n_d: 1.51696}",
       1}};
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
    assert_doubts(rows[i].record, rows[i].doubtful);
}

/* What is not clear bends light in its own way, and gases hardly at all. */
TEST(metals_dyes_and_gases_are_well) {
  const char *const right[] = {
      /* a metal's n is small and rises */
      "- {name: a, model: tabulated, points: [[200, 1.1], [380, 0.2], [600, 0.1], [780, 0.14], "
      "[2000, 0.7]], source: s1, absorption: {k: [[200, 1.3], [330, 0.4], [380, 1.9], [2000, "
      "14]]}}",
      /* a dye beside its band, and the infrared beyond one */
      "- {name: a, model: tabulated, points: [[380, 1.45], [520, 1.2], [580, 2.2], [780, 1.7]], "
      "source: s1, absorption: {k: [[380, 0.1], [550, 1.2], [700, 0]]}}",
      "- {name: a, model: tabulated, points: [[380, 1.5], [780, 1.48], [8000, 0.6], [9500, 2.8]], "
      "source: s1, absorption: {k: [[380, 0], [7000, 0], [9000, 1.9]]}}",
      /* a faint band, and n no more than it */
      "- {name: a, model: tabulated, points: [[380, 1.5], [500, 1.49], [560, 1.492], [780, 1.48]], "
      "source: s1, absorption: {k: [[380, 0], [530, 0.003], [600, 0]]}}",
      /* the vacuum beside air; X-rays */
      "- {name: a, model: cauchy, coefficients: [0.999733, -1.5e-6], range_nm: [380, 780], source: "
      "s1}",
      "- {name: a, model: tabulated, points: [[2, 0.9997], [20, 0.96], [45, 0.8]], source: s1}"};
  for (size_t i = 0; i < sizeof right / sizeof right[0]; i++) assert_doubts(right[i], 0);
  /* the same without a word of absorption are not */
  const char *const wrong[] = {
      "- {name: a, model: tabulated, points: [[380, 0.5], [600, 0.4], [780, 0.3]], source: s1}",
      "- {name: a, model: tabulated, points: [[380, 1.5], [500, 1.49], [560, 1.492], [780, 1.48]], "
      "source: s1, absorption: {k: [[380, 0], [530, 0.0003], [600, 0]]}}"};
  for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) assert_doubts(wrong[i], 1);
}

/* What a formula does where nobody vouches for it is no fault of it. */
TEST(rows_are_judged_inside_their_range) {
  const char *const right[] = {
      "- {name: a, model: sellmeier2, coefficients: [1.45, 2.9, 0.14, 0.95, 1380], range_nm: "
      "[1000, 12000], source: s1}",
      "- {name: a, model: sellmeier2, coefficients: [0, 3.9, 0.056, 0.18, 0.233], range_nm: [520, "
      "1400], source: s1}",
      "- {name: a, model: sellmeier2, coefficients: [0, 9.8, 0.09, 0.8, 1.2], range_nm: [1360, "
      "11000], source: s1}",
      "- {name: a, model: sellmeier2, coefficients: [0, 1.83, 0.0225, 1.67, 0.0625, 1.1, 0.12, "
      "0.05, 0.2, 12.4, 27000], range_nm: [600, 39000], source: s1}",
      /* n_d and V_d that are printed, and no data there to hold them against */
      "- {name: a, model: sellmeier2, coefficients: [1.45, 2.9, 0.14, 0.95, 1380], range_nm: "
      "[1000, 12000], source: 's1; n_d 2.55, V_d 70'}",
      "- {name: a, model: cauchy, coefficients: [1.6, 0.01], range_nm: [700, 900], extrapolate: "
      "true, source: 's1; n_d 1.65, V_d 30', warning: w}",
      "- {name: a, model: cauchy, coefficients: [1.5, 0.004], range_nm: [500, 900], source: s1, "
      "n_d: 1.51159, v_d: 30}",
      "- {name: BK7, model: cauchy, coefficients: [1.7, 0.01], range_nm: [700, 900], extrapolate: "
      "true, source: s1, warning: w}",
  };
  for (size_t i = 0; i < sizeof right / sizeof right[0]; i++) assert_doubts(right[i], 0);
  /* poles of the infrared that were not squared put a resonance inside the range */
  OWNED(abbe_findings, found) =
      check_record("- {name: a, model: sellmeier2, coefficients: [1.45, 2.9, 0.374, 0.95, 37.1], "
                   "range_nm: [1000, 12000], source: s1}");
  assert_int_equal(doubts_in(&found), 1);
  assert_int_equal(found.finding[0].kind, ABBE_FINDING_POLES);
  assert_true(found.finding[0].certain);
  assert_string_equal(found.finding[0].value, "sellmeier");
}
