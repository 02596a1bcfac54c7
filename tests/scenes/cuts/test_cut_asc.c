#include "scenes/cuts/cut_file.h"

#include "tests/scenes/cuts/designs.h"

TEST(design_d_has_all_of_the_grammar) {
  OWNED(abbe_cut, cut) = design_parse(design_d);
  assert_int_equal(cut.gear, -96);
  assert_near(cut.offset, 48, 0);
  assert_int_equal(cut.folds, 3);
  assert_false(cut.mirror);
  assert_near(cut.refractive_index, 1.66, 0);
  assert_int_equal(cut.tier_count, 8);
  assert_int_equal(cut.facet_count, 18);
  assert_string_equal(cut.facet[0].name, "87");
  assert_string_equal(cut.facet[2].name, "G");
  assert_near(cut.facet[2].index, 64, 0);
  assert_int_equal(cut.tier[3].count, 3);
  assert_string_equal(cut.tier[3].instruction, "Meet nothing, 3 n or 96");
  assert_true(cut.tier[4].angle_deg == 0 && signbit(cut.tier[4].angle_deg));
  assert_near(cut.facet[12].n[2], -1, 0);
  assert_near(cut.facet[17].n[2], 1, 0);
}

static void expect_notes(const char *text, const char *a, const char *b) {
  OWNED(abbe_report, report) = {0};
  char all[4096] = "";
  MADE(abbe_cut, cut, abbe_cut_asc_parse(text, strlen(text), "x.asc", &cut, &report, &error));
  for (size_t i = 0; i < report.count; i++) {
    strncat(all, report.note[i].text, sizeof all - strlen(all) - 2);
    strcat(all, "\n");
  }
  assert_contains(all, a);
  assert_contains(all, b);
}

#define CUBE "a 90 1 96 24 48 72\na 0 1\na -0 1\n"

TEST(odd_lines_are_met) {
  const char glued[] =
      "\xef\xbb\xbfGemCad 4.51\r\ng64 0.0\r\ny8y\r\nI1.54\r\nHTitle \xb0\r\n; g 3\r\n"
      "a \xe2\x88\x92"
      "90 1 64 n top 16\r\n 32 48 G rough\r\nG and polish\r\na0 1\r\n"
      "a 0 -2 n C\r\n\r\nF one\r\nF two\r\n";
  OWNED(abbe_cut, cut) = design_parse(glued);
  assert_int_equal(cut.gear, 64);
  assert_int_equal(cut.folds, 8);
  assert_true(cut.mirror);
  assert_near(cut.refractive_index, 1.54, 0);
  assert_string_equal(cut.tier[0].instruction, "rough and polish");
  assert_int_equal(cut.tier[0].count, 4);
  assert_near(cut.tier[0].angle_deg, -90, 0);
  assert_true(signbit(cut.tier[2].angle_deg));
  assert_near(cut.facet[5].d, 2, 0);
  assert_string_equal(cut.facet[5].name, "C");
  assert_string_equal(cut.footnote[1], "two");
  abbe_cut_free(&cut);
  cut = design_parse("96 12\n" CUBE);
  assert_int_equal(cut.gear, 96);
  assert_near(cut.offset, 12, 0);
  assert_near(cut.facet[4].index, 12, 0);
  expect_notes(CUBE, "96 teeth are assumed", "");
  expect_notes("g 96 0\ng 96 0\nweather is fine\n" CUBE, "the last one holds", "weather");
  expect_notes("g 96 0\ny -8 y\ny 8.5 n\n" CUBE, "'-8 y'", "'8.5 n' is no number of folds");
  expect_notes("g 96 0\na 30 -4 96 what n\n" CUBE, "magnitude", "'what'");
  expect_notes("g 96 0\ny 2000 n\na 30 1 96 nano\n" CUBE, "'2000 n'", "'nano' is neither");
  expect_notes("g\t96\t0\n# a remark\ny 8\tY\nI 200\n" CUBE, "index of 200", "");
  abbe_cut_free(&cut);
  cut = design_parse("g\t96\t0\n# a remark\ny 8\tY\n" CUBE);
  assert_true(cut.folds == 8 && cut.mirror);
  expect_notes("g 96 0\nI 0.5\nH 1\nH 2\nH 3\nH 4\nH five\n" CUBE, "index of 0.5", "five");
}

static void refuse(const char *text, const char *part) {
  abbe_cut cut;
  abbe_error error = {0};
  const abbe_result result = abbe_cut_asc_parse(text, strlen(text), "x.asc", &cut, NULL, &error);
  assert_true(result == ABBE_PARSE || result == ABBE_SCHEMA);
  assert_contains(error.text, part);
  assert_null(cut.facet);
  assert_null(cut.tier);
}

TEST(bad_files_are_refused_with_the_line) {
  refuse("", "no facet");
  refuse("GemCad 5.0\nH only a title\n", "no facet");
  refuse("g 0 0\n", "x.asc:1: a gear has");
  refuse("g 96.5 0\n", "x.asc:1: a gear has");
  refuse("g 1e9 0\n", "x.asc:1: a gear has");
  refuse("g x 0\n", "x.asc:1: the number of the gear's teeth is wanted here, and there is 'x'");
  refuse("g 96 0\na\n", "x.asc:2: a tier's angle is wanted here, and there is nothing");
  refuse("g 96 0\na 45\n", "x.asc:2: a tier's distance is wanted");
  refuse("g 96 0\na 95 1 96\n", "x.asc:2: a tier's angle is from -90 to 90 degrees, not 95");
  refuse("g 96 0\na 45 0 96\n", "x.asc:2: a tier's distance");
  refuse("g 96 0\na 45 1e300 96\n", "x.asc:2: a tier's distance");
  refuse("g 96 0\na 45 nan 96\n", "x.asc:2: a tier's distance is wanted here, and there is 'nan'");
  refuse("g 96 0\na 45 1 96 -Inf\n", "x.asc:2: '-Inf' is no index");
  refuse("g 96 0\na 45 1 96\nnan\n", "x.asc:3: 'nan' is no index");
  refuse("g 96 0\na 45 1 1e999\n", "x.asc:2: '1e999' is no index");
  refuse("g 96 0\na 45 1 96\n3,5 24\n", "x.asc:3: '3,5' is no index");
  refuse("g 96 0\na 45 1 3 1/2\n", "x.asc:2: '1/2' is no index");
  refuse("g 96 0\na 45 1 3 +1/2\n", "x.asc:2: '+1/2' is no index");
  refuse("g 96 0\na 45 1 +inf\n", "x.asc:2: '+inf' is no index");
  refuse("g 96 1e7\n", "x.asc:1: the gear's offset 1e+07 is not an index");
  refuse("g 96 0\na 45 1 1e7\n", "x.asc:2: 1e+07 is no index");
  refuse("g 96 0\na 45 1 96 24 48\n", "3 facets enclose nothing");
  abbe_cut cut;
  REFUSED(ABBE_PARSE, "no text",
          abbe_cut_asc_parse("\0\1\2\3\0\0\0", 7, "x.asc", &cut, NULL, &error));
}

TEST(too_many_facets_are_refused) {
  const size_t size = 3 * 5000 + 32;
  FREED char *text = calloc(1, size);
  strcpy(text, "g 96 0\na 45 1");
  for (size_t i = 0, at = strlen(text); i < 5000; i++, at += 2) memcpy(text + at, " 1", 2);
  abbe_cut cut;
  REFUSED(ABBE_UNSUPPORTED, "x.asc:2: more than 4096 facets",
          abbe_cut_asc_parse(text, strlen(text), "x.asc", &cut, NULL, &error));
}

static char *written(const abbe_cut *cut) {
  char *text = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&text, &size);
  OK(abbe_cut_asc_write(cut, to, NULL, &error));
  fclose(to);
  return text;
}

TEST(what_is_written_reads_back) {
  const char *const designs[] = {design_a, design_b, design_c, design_d};
  for (size_t i = 0; i < sizeof designs / sizeof *designs; i++) {
    OWNED(abbe_cut, cut) = design_parse(designs[i]);
    if (i == 2) cut.tier[0].distance = 1 / 3.0, abbe_cut_place(&cut);
    FREED char *text = written(&cut);
    OWNED(abbe_cut, back) = design_parse(text);
    assert_int_equal(back.gear, cut.gear);
    assert_int_equal(back.facet_count, cut.facet_count);
    assert_int_equal(back.tier_count, cut.tier_count);
    assert_near(back.offset, cut.offset, 0);
    assert_near(back.refractive_index, cut.refractive_index, 0);
    for (size_t f = 0; f < cut.facet_count; f++) {
      for (int k = 0; k < 3; k++) assert_near(back.facet[f].n[k], cut.facet[f].n[k], 0);
      assert_near(back.facet[f].d, cut.facet[f].d, 0);
      assert_string_equal(abbe_cut_facet_name(&back, f), abbe_cut_facet_name(&cut, f));
    }
    if (cut.tier[3].instruction)
      assert_string_equal(back.tier[3].instruction, cut.tier[3].instruction);
    FREED char *again = written(&back);
    assert_string_equal(text, again);
  }
}

/* The letters of a name, a byte each, must not come back as one that is dropped. */
TEST(names_that_look_like_utf_8_are_changed) {
  static const char *const names[] = {"\xc3\xaf\xc2\xbb\xc2\xbf", "\xc3\x82\xe2\x80\xa6"};
  for (int i = 0; i < 2; i++) {
    OWNED(abbe_cut, cut) = design_parse(printed("g 96 0\n%sa 45 1 96 n %s 24\n", CUBE, names[i]));
    FREED char *text = written(&cut);
    assert_contains(text, i == 0 ? "n ??? 24" : "n ?? 24");
    OWNED(abbe_cut, back) = design_parse(text);
    assert_int_equal(back.facet_count, 8);
  }
}

/* 25 facets of a tier: a line has 24. */
TEST(long_tiers_go_on_below) {
  char text[400] = "g 96 0\na 0 1\na -0 1\na 90 1";
  for (int i = 1; i <= 25; i++) strcat(text, printed(" %d", i));
  OWNED(abbe_cut, cut) = design_parse(text);
  FREED char *back = written(&cut);
  assert_contains(back, " 24\n25\n");
}

TEST(gemcads_own_digits_stay) {
  OWNED(abbe_cut, cut) = design_parse(design_a);
  FREED char *text = written(&cut);
  assert_string_equal(text, design_a);
}
