/* What single lines of a catalogue say oddly, and what is made of it. */
#include "tests/check.h"
#include "tests/spectral/formats/agf_bk7.h"

#include "spectral/formats/material_import.h"

static abbe_report report;

static abbe_material_table parse(const char *text) {
  abbe_material_table table;
  abbe_report_free(&report);
  OK(abbe_agf_parse(text, strlen(text), "glass/maker.agf", &table, &report, &error));
  return table;
}

static void end(void) {
  abbe_report_free(&report);
}

GROUP(NULL, end);

#define CD "CD 1.03961212 0.00600069867\n"

/* Notes that one glass earns, and none for what is right. */
TEST(what_a_glass_says_oddly_is_noted) {
  static const struct {
    const char *lines, *note; /* NULL: none */
    abbe_note_kind kind;
  } rows[] = {
      {"NM A 2 0 1.5 60\n" CD "LD 0.3 2.5\n", NULL, 0},
      {"NM A 5 0 1.5 60\nCD 1.5\nLD 0.0001 2.5\n", "is cut to 1 to 2500 nm", ABBE_NOTE_LOST},
      {"NM A 5 0 1.5 60\nCD 1.5\nLD 0.3 2000\n", "is cut to 300 to 1e+06 nm", ABBE_NOTE_LOST},
      {"NM A 2 0 1.5 60\n" CD "LD 2.5 0\n", "404.66 to 656.27 nm are taken", ABBE_NOTE_ASSUMED},
      {"NM A 2 0 1.5 60\n" CD "LD 0.3 0.3\n", "404.66 to 656.27 nm are taken", ABBE_NOTE_ASSUMED},
      {"NM A 2 0 1.5 60\n" CD "LD 0,3 2,5\n", "decimal commas", ABBE_NOTE_CHANGED},
      {"NM A 5 0 1.5 60\nCD 1,5e5 1,5e-9\nLD 0.3 2.5\n", "decimal commas", ABBE_NOTE_CHANGED},
      {"NM A 2 0 1,5 60\n" CD "LD 0.3 2.5\n", "decimal commas", ABBE_NOTE_CHANGED},
      {"NM A 2 0 1.5 60\nCD +1,03961212e+0\t6,00069867E-03\nLD 0.3 2.5\n", "decimal commas",
       ABBE_NOTE_CHANGED},
      {"NM A 2 0 1.5 60 1\n" CD "LD 0.3 2.5\n", "exclude it", ABBE_NOTE_LOST},
      {"NM A 2 0 1.5 60\nED 0 0 0 0 1\n" CD "LD 0.3 2.5\n", "ignore expansion", ABBE_NOTE_LOST},
      {"NM "
       "a-name-that-is-too-long-for-any-table-by-far-for-it-has-more-letters-than-a-line-of-text-"
       "of-ours 2 0 1.5 60\n" CD "LD 0.3 2.5\n",
       "is not a name", ABBE_NOTE_SKIPPED},
      {"NM A 2x 0 1.5 60\n" CD "LD 0.3 2.5\n", "its formula is '2x'", ABBE_NOTE_SKIPPED},
      {"NM A 0 0 1.5 60\n" CD "LD 0.3 2.5\n", "its formula is '0'", ABBE_NOTE_SKIPPED},
      {"NM A 2 0 1.5 60\nCD 1.04 1,5x\nLD 0.3 2.5\n", "no number", ABBE_NOTE_SKIPPED},
      {"NM A 2 0 1.5 60\nCD 1.04 0.006x\nLD 0.3 2.5\n", "no number", ABBE_NOTE_SKIPPED},
      {"NM A 2 0 1.5 60\nCD 1.04 1e999\nLD 0.3 2.5\n", "no number", ABBE_NOTE_SKIPPED},
      {"NM A 2 0 1.5 60\nCD ? ?x\nLD 0.3 2.5\n", "no number", ABBE_NOTE_SKIPPED},
      {"NM A 2 0 1.5 60\n" CD "LD 0.3 2.5\nIT 0.0001 0.5 1\n", "1 IT lines", ABBE_NOTE_LOST},
      {"NM A 2 0 1.5 60\n" CD "LD 0.3 2.5\nIT 2000 0.5 1\n", "1 IT lines", ABBE_NOTE_LOST},
      {"NM A 2 0 1.5 60\n" CD "LD 0.3 2.5\nIT 0.4 -0.5 1\n", "1 IT lines", ABBE_NOTE_LOST},
      {"NM A 2 0 1.5 60\n" CD "LD 0.3 2.5\nIT 0.4 0.5 1e13\n", "1 IT lines", ABBE_NOTE_LOST}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    OWNED(abbe_material_table, t) = parse(printed(BK7 "%s", rows[i].lines));
    if (report.count != (rows[i].note != NULL))
      fail_msg("%s: %s", rows[i].lines, report.note[0].text);
    assert_int_equal(t.count, 2 - report.kinds[ABBE_NOTE_SKIPPED]);
    if (rows[i].note == NULL) continue;
    assert_int_equal(report.note[0].kind, rows[i].kind);
    assert_contains(report.note[0].text, rows[i].note);
  }
}

/* What is no number of a glass is none of it, without a word: catalogues are full of such. */
TEST(numbers_that_none_can_have) {
  OWNED(abbe_material_table, t) =
      parse("NM A 2 0 1e4 1e7 0 9 1\nGC source:\nGC again\n1 2 3\n\nITALY\tmade it\nNMR\n" CD
            "TD 1e-6 0 0 0 0 0.2 1e5\nLD 0.3 2.5");
  const abbe_material *m = &t.material[0];
  assert_int_equal(t.count, 1);
  assert_true(m->published_n_d == 0 && m->published_v_d == 0);
  assert_null(m->catalogue.status);
  assert_null(m->comment);
  assert_true(isnan(m->temperature_c));
  assert_near(m->catalogue.thermal[0], 1e-6, 0);
  assert_contains(m->source, "Zemax catalogue maker.agf, A");
  assert_int_equal(report.count, 0);
}

/* Texts are cut where a letter ends, words where their place does, and the first remark is the
 * title. */
TEST(long_texts_are_cut) {
  enum { LONG = 1200 };
  char letters[LONG + 1], digits[80];
  memset(letters, 'a', LONG);
  letters[LONG] = '\0';
  memcpy(letters + 999, "\xc3\xa9", 2); /* one letter of two bytes, of which one has room */
  memset(digits, '1', sizeof digits - 1);
  digits[79] = '\0';
  OWNED(abbe_material_table, t) = parse(
      printed("CC %s\nCC second\nNM N%.40s 2 %s 1.5 60\nGC a\tb\n" CD
              "LD 0.3 2.5 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26\n"
              "ED 0,%s\n",
              letters, letters, digits, digits));
  assert_int_equal(strlen(t.description), 999);
  assert_int_equal(t.count, 1);
  assert_string_equal(t.material[0].comment, "a b");
  assert_int_equal(strlen(t.material[0].catalogue.code), 23);
  const char *title = strstr(t.material[0].source, "; ");
  assert_non_null(title); /* has no blank to be cut at */
  assert_int_equal(strspn(title + 2, "a"), 60);
}

/* More transmittances than a spectrum holds, at one wavelength each. */
TEST(transmittances_have_a_most) {
  enum { LINES = ABBE_SPECTRUM_MAX_COUNT + 3, EACH = 32 };
  FREED char *text = malloc((LINES + 8) * EACH);
  assert_non_null(text);
  size_t used = (size_t)sprintf(text, "NM A 2 0 1.5 60\n" CD "LD 0.3 2.5\n");
  for (int i = 0; i < LINES; i++)
    used += (size_t)sprintf(text + used, "IT %.6f 0.9 10\n", 0.3 + 1e-5 * i);
  OWNED(abbe_material_table, t) = parse(text);
  assert_int_equal(abbe_spectrum_count(t.material[0].attenuation), ABBE_SPECTRUM_MAX_COUNT);
  assert_int_equal(report.count, 1);
  assert_contains(report.note[0].text, "3 IT lines");
}
