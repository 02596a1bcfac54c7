#include "tests/check.h"

#include "spectral/dispersion/csv_points.h"
#include "spectral/formats/material_import.h"
#include "spectral/formats/material_write.h"
#include "tests/spectral/random_material.h"
#include "tests/spectral/same_material.h"

static abbe_material_table reread(const abbe_material_table *table, char **text) {
  size_t size = 0;
  FILE *to = open_memstream(text, &size);
  assert_non_null(to);
  abbe_error why = {0};
  OK(abbe_material_table_write(table, to, &error));
  fclose(to);
  abbe_material_table back;
  if (abbe_material_table_parse(*text, size, "t.yaml", &back, &why) != ABBE_OK)
    fail_msg("%s\n%s", why.text, *text);
  return back;
}

TEST(shipped_tables_come_back_the_same) {
  const char *const names[] = {"default", "thesis"};
  for (int t = 0; t < 2; t++) {
    MADE(abbe_material_table, table, abbe_material_table_load(names[t], &table, &error));
    FREED char *text = NULL;
    OWNED(abbe_material_table, back) = reread(&table, &text);
    assert_int_equal(back.count, table.count);
    assert_string_equal(back.description, table.description);
    for (size_t i = 0; i < back.count; i++)
      assert_same_record(&table.material[i], &back.material[i]);
  }
}

TEST(random_records_come_back_the_same) {
  srand(11);
  for (int round = 0; round < 20; round++) {
    OWNED(abbe_material_table, table) = {0};
    for (size_t i = 0; i < 25; i++) {
      abbe_material m = random_material(i);
      OK(abbe_material_check(&m, &error));
      OK(abbe_material_table_append(&table, &m, &error));
    }
    FREED char *text = NULL;
    OWNED(abbe_material_table, back) = reread(&table, &text);
    assert_int_equal(back.count, 25);
    for (size_t i = 0; i < back.count; i++)
      assert_same_record(&table.material[i], &back.material[i]);
  }
}

/* Names and texts that YAML would take for something else. */
TEST(odd_texts_come_back_the_same) {
  const char *const odd[] = {"true",
                             "null",
                             "1.5",
                             "-",
                             "a: b",
                             "# c",
                             "\"q\"",
                             "'q'",
                             "[x]",
                             "{y: 1}",
                             "*a",
                             "&a",
                             "!t",
                             "a\\b",
                             "%x",
                             "@",
                             "yes",
                             " lead",
                             "trail ",
                             "a\nb\tc",
                             "\x7f",
                             "\x1b[2J",
                             "\xc2\x85 \xc2\x9f",
                             "\xe2\x80\xa8",
                             "\xef\xbb\xbf bom",
                             "\xef\xbf\xbe",
                             "Schott\xc2\xae"};
  for (size_t i = 0; i < sizeof odd / sizeof odd[0]; i++) {
    abbe_material m =
        FIELDS(.name = strdup("x"), .source = strdup("s"), .comment = strdup(odd[i]), .min_nm = 1,
               .max_nm = 1e6, .temperature_c = NAN,
               .dispersion = {.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {1.5}});
    MADE(abbe_material_table, table, abbe_material_table_append(&table, &m, &error));
    FREED char *text = NULL;
    OWNED(abbe_material_table, back) = reread(&table, &text);
    assert_string_equal(back.material[0].comment, odd[i]);
  }
}

TEST(what_could_not_be_read_again_is_not_written) {
  abbe_material m =
      FIELDS(.name = (char[]){"x"}, .source = (char[]){"s"}, .min_nm = 400, .max_nm = 700,
             .dispersion = {.model = ABBE_DISPERSION_CAUCHY, .count = 1, .c = {-1}});
  FREED char *text = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&text, &size);
  REFUSED(ABBE_INVALID_ARGUMENT, "x: its cauchy formula has no real index",
          abbe_material_write(&m, to, &error));
  fclose(to);
  assert_int_equal(size, 0);
  FILE *full = fopen("/dev/full", "w");
  m.dispersion.c[0] = 1.5;
  abbe_material_table table = {.count = 1, .material = &m};
  REFUSED(ABBE_IO, "", abbe_material_table_write(&table, full, &error));
  fclose(full);
}

/* What is written can be read again: a table with more values than a reader takes is refused. */
TEST(too_large_a_table_is_refused) {
  enum { POINTS = 60000, COUNT = 6 };
  static double lambda_nm[POINTS], value[POINTS];
  static char names[COUNT][4], source[] = "s";
  abbe_material list[COUNT] = {{0}};
  for (int i = 0; i < POINTS; i++) {
    lambda_nm[i] = 400 + 0.5 * i;
    value[i] = 1.5;
  }
  for (int i = 0; i < COUNT; i++) {
    snprintf(names[i], sizeof names[i], "m%d", i);
    list[i] = (abbe_material){.name = names[i],
                              .source = source,
                              .min_nm = 400,
                              .max_nm = 700,
                              .temperature_c = NAN,
                              .dispersion = {.model = ABBE_DISPERSION_TABULATED}};
    OK(abbe_spectrum_make(lambda_nm, value, POINTS, ABBE_INTERPOLATION_LINEAR,
                          &list[i].dispersion.table, &error));
  }
  const abbe_material_table table = {.count = COUNT, .material = list};
  FREED char *text = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&text, &size);
  REFUSED(ABBE_INVALID_ARGUMENT, "6 materials are ", abbe_material_table_write(&table, to, &error));
  assert_contains(last_error.text, "more than 1000000 values");
  assert_contains(last_error.text, "a file that ends in .sqlite");
  fclose(to);
  assert_int_equal(size, 0);
  for (int i = 0; i < COUNT; i++) abbe_dispersion_free(&list[i].dispersion);
}

static abbe_csv_points csv_write_reread(const abbe_material *m, const abbe_csv_sampling *sampling,
                                        abbe_report *report) {
  FREED char *text = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&text, &size);
  OK(abbe_csv_write(m, sampling, to, report, &error));
  fclose(to);
  abbe_csv_points points;
  OK(abbe_csv_points_parse(text, size, "x.csv", NULL, &points, NULL, &error));
  return points;
}

TEST(written_points_are_the_materials) {
  srand(4);
  for (size_t i = 0; i < 200; i++) {
    OWNED(abbe_material, m) = random_material(i);
    OWNED(abbe_report, report) = {0};
    OWNED(abbe_csv_points, p) = csv_write_reread(&m, NULL, &report);
    for (size_t k = 0; k < p.n.count; k++) {
      double n = 0;
      OK(abbe_material_n(&m, p.n.point[k].lambda_nm, &n, &error));
      assert_near(p.n.point[k].value, n, 1e-14);
    }
    if (m.dispersion.table != NULL)
      assert_int_equal(p.n.count, abbe_spectrum_count(m.dispersion.table));
    else
      assert_int_equal(p.n.count, 81); /* 380 to 780 */
    assert_int_equal(p.k.count, m.attenuation != NULL ? p.n.count : 0);
    assert_true(report.kinds[ABBE_NOTE_LOST] > 0);
  }
}

static char name[] = "glass", source[] = "s";

static abbe_material glass(void) {
  return (abbe_material){.name = name,
                         .source = source,
                         .min_nm = 400,
                         .max_nm = 700,
                         .dispersion = {ABBE_DISPERSION_CAUCHY, 2, {1.5, 0.004}, NULL}};
}

/* The error that is told is that of straight lines through the points. */
TEST(sampling_is_asked_for_and_its_error_told) {
  abbe_material m = glass();
  OWNED(abbe_report, report) = {0};
  OWNED(abbe_csv_points, p) = csv_write_reread(&m, &(abbe_csv_sampling){450, 525, 50}, &report);
  assert_int_equal(p.n.count, 3);
  assert_near(p.n.point[1].lambda_nm, 500, 0);
  assert_near(p.n.point[2].lambda_nm, 525, 0);
  double worst = 0.004 * ((1 / 0.45 / 0.45 + 1 / 0.5 / 0.5) / 2 - 1 / 0.475 / 0.475);
  assert_contains(report.note[0].text, printed("off by up to %.2g", worst));
}

TEST(what_cannot_be_sampled_is_refused) {
  abbe_material m = glass();
  FREED char *text = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&text, &size);
  REFUSED(ABBE_OUT_OF_RANGE, "glass has no index at 380 nm",
          abbe_csv_write(&m, &(abbe_csv_sampling){380, 780, 5}, to, NULL, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_csv_write(&m, &(abbe_csv_sampling){400, 700, -1}, to, NULL, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "at most 65536 points",
          abbe_csv_write(&m, &(abbe_csv_sampling){400, 700, 1e-4}, to, NULL, &error));
  fclose(to);
  FILE *full = fopen("/dev/full", "w");
  REFUSED(ABBE_IO, "", abbe_csv_write(&m, NULL, full, NULL, &error));
  fclose(full);
}
