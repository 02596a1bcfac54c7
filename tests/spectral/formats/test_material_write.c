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

/* Lines of points have at most 100 characters with what parts them, are full, and some just so. */
TEST(lines_of_points_are_full) {
  enum { WIDTH = 100 };
  MADE(abbe_material_table, table, abbe_material_table_load("default", &table, &error));
  FREED char *text = NULL;
  OWNED(abbe_material_table, back) = reread(&table, &text);
  size_t before = 0, just = 0; /* characters of a line of points that goes on; 0: no such line */
  for (char *rest = text, *line; (line = strtok_r(rest, "\n", &rest)) != NULL;) {
    const size_t length = strlen(line), blank = strspn(line, " ");
    const bool points = line[blank] == '[' && strchr("-.0123456789", line[blank + 1]) != NULL;
    const size_t first = points ? strcspn(line + blank, "]") + 1 : 0;
    assert_true(!points || length < WIDTH);
    if (points && before > 0) assert_true(before + 1 + first + 2 > WIDTH);
    before = points && line[length - 1] == ',' ? length : 0;
    just += before + 1 == WIDTH;
  }
  assert_true(just > 0);
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
  m.dispersion.c[0] = 1.5;
  abbe_material_table table = {.count = 1, .material = &m};
  for (int buffered = 0; buffered < 2; buffered++) {
    FILE *full = fopen("/dev/full", "w");
    if (!buffered) setvbuf(full, NULL, _IONBF, 0);
    REFUSED(ABBE_IO, "", abbe_material_table_write(&table, full, &error));
    REFUSED(ABBE_IO, "", abbe_csv_write(&m, NULL, full, NULL, &error));
    if (!buffered) REFUSED(ABBE_IO, "", abbe_material_write(&m, full, &error));
    fclose(full);
  }
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

/* Fields of a catalogue each alone, texts that are empty, and a matrix of fluorescence. */
TEST(single_fields_come_back_the_same) {
  static const char *const rows[] = {
      "catalogue: {melt_frequency: 3}",
      "catalogue: {expansion_range_k: [243, 343, 293, 573]}",
      "catalogue: {ratings: [1, -1, 2, 3, 4, 5]}",
      "catalogue: {thermal: [1e-6, 0, 0, 0, 0, 0.2]}",
      "fit: {cauchy3: {coefficients: [1.5, 0.004, 0], max_error: 0.1, range_nm: [400, 700]}}",
      "absorption: {attenuation_per_m: [[400, 1]]}\n  fluorescence: {matrix: [{nm: 400, emission: "
      "[[500, 0], [600, 0.01]]}, {nm: 420, emission: [[500, 0], [600, 0.01]]}]}"};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    const char *yaml =
        printed("materials:\n- name: a\n  model: cauchy\n  coefficients: [1.5, 0.004]\n"
                "  range_nm: [1, 700]\n  source: s\n  %s\n",
                rows[i]);
    MADE(abbe_material_table, table,
         abbe_material_table_parse(yaml, strlen(yaml), "t.yaml", &table, &error));
    FREED char *text = NULL;
    OWNED(abbe_material_table, back) = reread(&table, &text);
    assert_same_record(&table.material[0], &back.material[0]);
    assert_int_equal(back.material[0].fluorescence.rows, table.material[0].fluorescence.rows);
    OWNED(abbe_csv_points, p) = csv_write_reread(&table.material[0], NULL, NULL);
    assert_true(p.n.count > 2);
  }
}

/* A code keeps what codes are of, and a table of a megabyte is read again before it is handed out.
 */
TEST(codes_and_large_tables) {
  enum { POINTS = 60000 };
  static double nm[POINTS], n[POINTS];
  abbe_material m =
      FIELDS(.name = (char[]){"m"}, .source = (char[]){"s"}, .min_nm = 400, .max_nm = 700,
             .temperature_c = NAN, .dispersion = {.model = ABBE_DISPERSION_TABULATED});
  for (int i = 0; i < POINTS; i++) nm[i] = 400 + 0.5 * i, n[i] = 1.5 + 1e-9 * i;
  m.catalogue.code = (char[]){"517_642'.25"};
  OK(abbe_spectrum_make(nm, n, POINTS, ABBE_INTERPOLATION_LINEAR, &m.dispersion.table, &error));
  const abbe_material_table table = {.count = 1, .material = &m};
  FREED char *text = NULL;
  OWNED(abbe_material_table, back) = reread(&table, &text);
  assert_true(strlen(text) > 1000000);
  assert_int_equal(abbe_spectrum_count(back.material[0].dispersion.table), POINTS);
  assert_string_equal(back.material[0].catalogue.code, "517642.25");
  abbe_dispersion_free(&m.dispersion);
}

/* A conductor's points are those of its table. */
TEST(conductors_are_written_as_they_are) {
  MADE(abbe_material_table, table, abbe_material_table_load(NULL, &table, &error));
  const abbe_material *gold = NULL;
  OK(abbe_material_table_find(&table, "gold", &gold, &error));
  abbe_material m = *gold;
  m.source = (char[]){"two\nlines"};
  m.comment = (char[]){""};
  const abbe_material_table one = {.count = 1, .material = &m};
  FREED char *text = NULL;
  OWNED(abbe_material_table, back) = reread(&one, &text);
  assert_null(back.material[0].comment);
  OWNED(abbe_csv_points, p) = csv_write_reread(&m, NULL, NULL);
  const abbe_dispersion *d = &gold->dispersion;
  assert_int_equal(p.n.count, abbe_spectrum_count(d->table));
  for (size_t i = 0; i < p.n.count; i++) {
    assert_near(p.n.point[i].value, abbe_spectrum_value(d->table)[i], 0);
    assert_near(p.k.point[i].value, abbe_spectrum_value(d->k)[i], 0);
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
  static const double ranges[][2] = {{0.5, 700}, {700, 700}, {700, 400}, {400, 2e6}};
  for (int i = 0; i < 4; i++)
    REFUSED(
        ABBE_INVALID_ARGUMENT, "is no range of at most",
        abbe_csv_write(&m, &(abbe_csv_sampling){ranges[i][0], ranges[i][1], 50}, to, NULL, &error));
  REFUSED(ABBE_OUT_OF_RANGE, "glass has no index at 780 nm",
          abbe_csv_write(&m, &(abbe_csv_sampling){400, 780, 5}, to, NULL, &error));
  m.extrapolate = true; /* over a pole at 77 nm, below which n is not real */
  m.dispersion =
      (abbe_dispersion){.model = ABBE_DISPERSION_SELLMEIER2, .count = 3, .c = {0, 1.04, 0.005929}};
  REFUSED(ABBE_INVALID_ARGUMENT, "75 nm",
          abbe_csv_write(&m, &(abbe_csv_sampling){50, 100, 25}, to, NULL, &error));
  OK(abbe_csv_write(&m, &(abbe_csv_sampling){50, 100, 50}, to, NULL, &error));
  m = glass();
  m.dispersion.c[0] = -1;
  REFUSED(ABBE_INVALID_ARGUMENT, "no real index", abbe_csv_write(&m, NULL, to, NULL, &error));
  const abbe_material_table wrong = {.count = 1, .material = &m};
  REFUSED(ABBE_INVALID_ARGUMENT, "no real index", abbe_material_table_write(&wrong, to, &error));
  m = glass();
  m.min_nm = 900; /* of light that nobody sees it is written where it is */
  m.max_nm = 950;
  OWNED(abbe_csv_points, far) = csv_write_reread(&m, NULL, NULL);
  assert_true(far.n.point[0].lambda_nm == 900 && far.n.point[far.n.count - 1].lambda_nm == 950);
  m.min_nm = 300;
  m.max_nm = 350;
  OWNED(abbe_csv_points, ultra) = csv_write_reread(&m, NULL, NULL);
  assert_true(ultra.n.point[0].lambda_nm == 300);
  m = glass();
  REFUSED(ABBE_INVALID_ARGUMENT, "at most 65536 points",
          abbe_csv_write(&m, &(abbe_csv_sampling){400, 700, 1e-4}, to, NULL, &error));
  fclose(to);
  FILE *full = fopen("/dev/full", "w");
  REFUSED(ABBE_IO, "", abbe_csv_write(&m, NULL, full, NULL, &error));
  fclose(full);
}
