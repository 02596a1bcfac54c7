#include "tests/spectral/random_material.h"
#include "tests/spectral/same_material.h"

#include "spectral/formats/material_table_load.h"
#include "spectral/formats/material_write.h"

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
