#include "tests/check.h"

#include "base/report.h"
#include "base/text.h"

TEST(notes_are_kept_in_order) {
  OWNED(abbe_report, report) = {0};
  abbe_report_add(&report, ABBE_NOTE_SKIPPED, 12, "N-BK7", "no formula %d", 99);
  abbe_report_add(&report, ABBE_NOTE_LOST, 0, NULL, "a \x1b[2J");
  abbe_report_add(NULL, ABBE_NOTE_LOST, 0, NULL, "unheard");
  abbe_report_add(&report, (abbe_note_kind)77, 0, NULL, "no such kind");
  assert_int_equal(report.count, 2);
  assert_int_equal(report.note[0].kind, ABBE_NOTE_SKIPPED);
  assert_int_equal(report.note[0].line, 12);
  assert_string_equal(report.note[0].name, "N-BK7");
  assert_string_equal(report.note[0].text, "no formula 99");
  assert_string_equal(report.note[1].name, "");
  assert_string_equal(report.note[1].text, "a \xe2\x90\x9b[2J");
  assert_int_equal(report.kinds[ABBE_NOTE_SKIPPED], 1);
  assert_string_equal(abbe_note_kind_word(ABBE_NOTE_ASSUMED), "assumed");
  assert_string_equal(abbe_note_kind_word((abbe_note_kind)-1), "unknown");
  abbe_report_free(&report);
}

/* Of a long text whole letters are kept, of a long path its end. */
TEST(texts_are_cut_between_letters) {
  char text[800] = "", path[800] = "";
  for (int i = 0; i < 390; i++) strcat(text, "\xc3\xa4");
  snprintf(path, sizeof path, "%s%s", "x/", text);
  memcpy(path + strlen(path) - 2, "/z", 2);
  OWNED(abbe_report, report) = {.file = path};
  abbe_report_add(&report, ABBE_NOTE_LOST, 0, text, "x%s", text);
  const abbe_note *n = &report.note[0];
  assert_int_equal(strlen(n->text), 319);
  assert_int_equal(strlen(n->name), 94);
  assert_int_equal(strlen(n->file), 126);
  const char *const cut[] = {n->text, n->name, n->file};
  for (int i = 0; i < 3; i++)
    for (const char *c = cut[i]; *c != '\0'; c += abbe_utf8_letter(c))
      assert_true(abbe_utf8_letter(c) > 0);
  assert_string_equal(n->file + 124, "/z");
}

TEST(there_is_an_end_to_what_is_kept) {
  OWNED(abbe_report, report) = {0};
  for (int i = 0; i < ABBE_REPORT_MAX_NOTES + 5; i++)
    abbe_report_add(&report, ABBE_NOTE_CHANGED, (size_t)i, "x", "%d", i);
  assert_int_equal(report.count, ABBE_REPORT_MAX_NOTES);
  assert_int_equal(report.kinds[ABBE_NOTE_CHANGED], ABBE_REPORT_MAX_NOTES + 5);
  assert_string_equal(report.note[ABBE_REPORT_MAX_NOTES - 1].text, "9999");
}

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
