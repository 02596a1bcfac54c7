#include "tests/check.h"
#include "tests/spectral/shipped_table.h"

#include "spectral/editing/table_edit.h"

static abbe_table_edit *open_edit(const char *text) {
  abbe_table_edit *edit = NULL;
  OK(abbe_table_edit_parse(text, strlen(text), "t.yaml", &edit, &error));
  return edit;
}

static abbe_table_fix fix_of(abbe_table_edit *edit) {
  abbe_table_fix fix;
  OK(abbe_table_fix_make(edit, &shipped, &fix, &error));
  return fix;
}

GROUP(shipped_load, shipped_free);

/* Only the bytes of the wrong values change. */
TEST(wrong_values_change_and_nothing_else) {
  abbe_table_edit *edit = open_edit("# my glasses\n"
                                    "materials:\n"
                                    "  - name: bak4   # from a book\n"
                                    "    model: cauchy\n"
                                    "    coefficients: [1.5690, 0.00531]\n"
                                    "    range_nm: [0.38, 0.78] # um?\n"
                                    "    source: a book\n"
                                    "  - {name: good, model: cauchy, coefficients: [1.50, 0.0040], "
                                    "range_nm: [380, 780], source: s1}\n");
  abbe_table_fix fix = fix_of(edit);
  assert_int_equal(fix.fixed, 2);
  assert_int_equal(fix.refused, 0);
  size_t size = 0;
  assert_string_equal(abbe_table_edit_text(edit, &size),
                      "# my glasses\n"
                      "materials:\n"
                      "  - name: bak4   # from a book\n"
                      "    model: cauchy\n"
                      "    coefficients: [1.553619, 0.00531]\n"
                      "    range_nm: [380, 780] # um?\n"
                      "    source: a book\n"
                      "  - {name: good, model: cauchy, coefficients: [1.50, 0.0040], range_nm: "
                      "[380, 780], source: s1}\n");
  fix = fix_of(edit);
  assert_int_equal(fix.fixed, 0);
  abbe_table_edit_free(edit);
}

/* New coefficients make a recorded fit stale, which is the next to fix. */
TEST(a_fix_brings_out_the_next) {
  abbe_table_edit *edit = open_edit(
      "materials:\n- name: a\n  model: cauchy\n  coefficients: [1.5046, 4200]\n"
      "  range_nm: [380, 780]\n  source: s1\n  fit:\n"
      "    cauchy2: {coefficients: [1.5046, 0.0052], max_error: 1.0e-6, range_nm: [380, 780]}\n");
  abbe_table_fix fix = fix_of(edit);
  assert_int_equal(fix.fixed, 2);
  size_t size = 0;
  assert_contains(abbe_table_edit_text(edit, &size), "coefficients: [1.5046, 0.0042]\n");
  assert_contains(abbe_table_edit_text(edit, &size), "cauchy2: {coefficients: [1.5046, 0.0042], ");
  abbe_table_edit_free(edit);
}

TEST(doubt_and_shared_names_are_left_alone) {
  const char *const text = "materials:\n"
                           "- {name: mystery, model: cauchy, coefficients: [1.5690, 0.00531], "
                           "range_nm: [380, 780], source: s1}\n"
                           "- {name: twin, model: cauchy, coefficients: [1.5046, 4200], range_nm: "
                           "[380, 780], source: s1}\n"
                           "- {name: TWIN, model: cauchy, coefficients: [1.6046, 6200], range_nm: "
                           "[380, 780], source: s1}\n";
  abbe_table_edit *edit = open_edit(text);
  abbe_table_fix fix = fix_of(edit);
  size_t size = 0;
  assert_int_equal(fix.fixed, 0);
  assert_int_equal(fix.refused, 2);
  assert_contains(fix.why, "twin: the name stands twice");
  assert_string_equal(abbe_table_edit_text(edit, &size), text);
  abbe_table_edit_free(edit);
}
