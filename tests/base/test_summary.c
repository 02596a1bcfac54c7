#include "tests/check.h"

#include "base/report.h"

static const abbe_summary_row rows[] = {{ABBE_NOTE_LOST, "no place for wit"},
                                        {ABBE_NOTE_CHANGED, "said otherwise"},
                                        {ABBE_NOTE_LOST, "never met"}};

/* The notes after each name was added to row 0, parted by newlines. */
static const char *notes_of(const char *const *names, size_t count) {
  static char text[1024];
  abbe_summary summary = {0};
  for (size_t i = 0; i < count; i++) abbe_summary_add(&summary, 0, names[i]);
  FILLED(abbe_report, report, abbe_summary_report(&summary, rows, 3, &report));
  text[0] = '\0';
  for (size_t i = 0; i < report.count; i++) {
    assert_int_equal(report.note[i].kind, ABBE_NOTE_LOST);
    snprintf(text + strlen(text), sizeof text - strlen(text), "%s%s", i > 0 ? "\n" : "",
             report.note[i].text);
  }
  return text;
}

TEST(many_materials_make_one_note) {
  const char *const names[] = {"a", "b", "c", "d", "e", "f"};
  assert_string_equal(notes_of(names, 0), "");
  assert_string_equal(notes_of(names, 1), "no place for wit (1 material: a)");
  assert_string_equal(notes_of(names, 4), "no place for wit (4 materials: a, b, c, d)");
  assert_string_equal(notes_of(names, 5), "no place for wit (5 materials: a, b, c, d, …)");
  assert_string_equal(notes_of(names, 6), "no place for wit (6 materials: a, b, c, d, …)");
}

TEST(long_names_are_cut_and_fit) {
  const char *const name = "a-name-of-forty-letters-that-goes-on-and-on";
  const char *const names[] = {name, name, name, name};
  assert_string_equal(notes_of(names, 2),
                      "no place for wit (2 materials: a-name-of-forty-letters-that-goes-on, "
                      "a-name-of-forty-letters-that-goes-on)");
  assert_contains(notes_of(names, 4), "(4 materials: ");
}

TEST(each_row_that_is_met_is_a_note_of_its_kind) {
  abbe_summary summary = {0};
  abbe_summary_add(&summary, 1, "only");
  abbe_summary_add(&summary, 0, "first");
  abbe_summary_add(&summary, 99, "beyond");
  abbe_summary_add(&summary, ABBE_SUMMARY_MAX_ROWS, "beyond");
  FILLED(abbe_report, report, abbe_summary_report(&summary, rows, 3, &report));
  assert_int_equal(report.count, 2);
  assert_int_equal(report.note[0].kind, ABBE_NOTE_LOST);
  assert_string_equal(report.note[0].text, "no place for wit (1 material: first)");
  assert_int_equal(report.note[1].kind, ABBE_NOTE_CHANGED);
  assert_string_equal(report.note[1].text, "said otherwise (1 material: only)");
  assert_int_equal(report.kinds[ABBE_NOTE_LOST], 1);
  abbe_summary_report(&summary, rows, 3, NULL); /* nobody wants to know */
}
