#include "tests/check.h"

#include "base/summary.h"

static void many_materials_make_one_note(void **state) {
  (void)state;
  static const abbe_summary_row rows[] = {{ABBE_NOTE_LOST, "no place for wit"},
                                          {ABBE_NOTE_CHANGED, "said otherwise"},
                                          {ABBE_NOTE_LOST, "never met"}};
  abbe_summary summary = {0};
  abbe_report report = {0};
  const char *const names[] = {"a", "b", "c", "d", "e", "f"};
  for (int i = 0; i < 6; i++) abbe_summary_add(&summary, 0, names[i]);
  abbe_summary_add(&summary, 1, "only");
  abbe_summary_add(&summary, 99, "beyond");
  abbe_summary_report(&summary, rows, 3, &report);
  assert_int_equal(report.count, 2);
  assert_string_equal(report.note[0].text, "no place for wit (6 materials: a, b, c, d, …)");
  assert_int_equal(report.note[0].kind, ABBE_NOTE_LOST);
  assert_string_equal(report.note[1].text, "said otherwise (1 material: only)");
  abbe_report_free(&report);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(many_materials_make_one_note)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
