#include "tests/check.h"

#include "spectral/formats/material_import.h"

#define AGF "CC maker\nNM A 2 0 1.5168 64.17\nCD 1.03961212 0.00600069867 0 0 0 0\nLD 0.3 2.5\n"
#define RII                                                                                        \
  "REFERENCES: r\nDATA:\n- {type: formula 5, wavelength_range: 0.4 0.7, coefficients: 1.5}\n"
#define CSV "# mine\nwavelength_nm,n,k\n400,1.5,1e-6\n500,1.49,0\n600,1.48,0\n"
#define YAML "# a table\nmaterials:\n- {name: Y, model: constant, coefficients: [1.5], source: s}\n"

TEST(the_text_says_what_it_is) {
  const struct {
    const char *text;
    abbe_import_format format;
  } rows[] = {{AGF, ABBE_IMPORT_AGF},
              {RII, ABBE_IMPORT_RII},
              {CSV, ABBE_IMPORT_CSV},
              {YAML, ABBE_IMPORT_YAML},
              {"", ABBE_IMPORT_AUTO},
              {"hello\nworld\n", ABBE_IMPORT_AUTO},
              {"12\n", ABBE_IMPORT_AUTO},
              {"  500\t1.5\n", ABBE_IMPORT_CSV},
              {"\"500\";\"1,5\"\n", ABBE_IMPORT_CSV},
              {"20 C\nhello\n", ABBE_IMPORT_AUTO},
              {"20 C, prism\n500,1.5\n", ABBE_IMPORT_CSV},
              {"  DATA:\n", ABBE_IMPORT_RII}};
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
    assert_int_equal(abbe_import_detect(rows[i].text, strlen(rows[i].text)), rows[i].format);
  static const char wide[] = "\xff\xfeN\0M\0 \0A\0\n\0";
  assert_int_equal(abbe_import_detect(wide, sizeof wide - 1), ABBE_IMPORT_AGF);
}

/* What a remark says is not what the file is. */
TEST(remarks_decide_nothing) {
  const char *const remarks[] = {"20 \xc2\xb0"
                                 "C",
                                 "500 1.5", "materials: one", "NM is the unit", "0.5, 1.5, 0.1"};
  for (size_t i = 0; i < sizeof remarks / sizeof remarks[0]; i++) {
    const char *text = printed("COMMENTS: |\n  %s\n%s", remarks[i], RII);
    assert_int_equal(abbe_import_detect(text, strlen(text)), ABBE_IMPORT_RII);
    MADE(abbe_material_table, table,
         abbe_import_parse(text, strlen(text), "A/nk/B.yml", NULL, &table, NULL, &error));
    assert_string_equal(table.material[0].comment, remarks[i]);
  }
  static const char dated[] = "2012 11 30, the maker's own\n" AGF;
  assert_int_equal(abbe_import_detect(dated, strlen(dated)), ABBE_IMPORT_AGF);
}

TEST(all_kinds_go_into_one_table) {
  const struct {
    const char *text, *path;
  } files[] = {
      {AGF, "maker.agf"}, {RII, "a/SiO2/nk/Me.yml"}, {CSV, "dir/my glass.csv"}, {YAML, "t.yaml"}};
  const char *const names[] = {"A", "SiO2-Me", "my glass", "Y"};
  OWNED(abbe_material_table, table) = {0};
  OWNED(abbe_report, report) = {0};
  for (int i = 0; i < 4; i++)
    OK(abbe_import_parse(files[i].text, strlen(files[i].text), files[i].path, NULL, &table, &report,
                         &error));
  assert_int_equal(table.count, 4);
  for (int i = 0; i < 4; i++) {
    assert_string_equal(table.material[i].name, names[i]);
    OK(abbe_material_check(&table.material[i], &error));
  }
  assert_string_equal(table.description, "maker");
  const abbe_material *points = &table.material[2];
  assert_string_equal(points->source, "measured points in my glass.csv");
  assert_near(points->min_nm, 400, 0);
  assert_near(abbe_material_attenuation(points, 400), 4 * acos(-1) * 1e-6 / 400e-9, 1e-9);
  /* the same again is dropped */
  OK(abbe_import_parse(YAML, strlen(YAML), "t.yaml", NULL, &table, &report, &error));
  OK(abbe_material_table_unique(&table, &report, &error));
  assert_int_equal(table.count, 4);
  assert_int_equal(report.kinds[ABBE_NOTE_SKIPPED], 1);
}

TEST(options_name_what_the_file_does_not) {
  const abbe_import_options options = {.format = ABBE_IMPORT_CSV,
                                       .name = "prism",
                                       .source = "own measurement",
                                       .csv = {.unit_nm = 1000, .third = ABBE_CSV_K}};
  const char text[] = "0.4 1.5 1e-6\n0.5 1.49 0\n";
  MADE(abbe_material_table, table,
       abbe_import_parse(text, strlen(text), "x", &options, &table, NULL, &error));
  assert_string_equal(table.material[0].name, "prism");
  assert_string_equal(table.material[0].source, "own measurement");
  assert_near(table.material[0].max_nm, 500, 0);
  assert_non_null(table.material[0].attenuation);
}

static void refuses(const char *text, const abbe_import_options *options, abbe_result code,
                    const char *part) {
  OWNED(abbe_material_table, table) = {0};
  REFUSED(code, part, abbe_import_parse(text, strlen(text), "x", options, &table, NULL, &error));
  assert_int_equal(table.count, 0);
}

TEST(what_cannot_be_read_is_named) {
  refuses("hello", NULL, ABBE_PARSE, "x: is none of what can be read: a Zemax catalogue has NM");
  refuses("nm,k\n400,1\n", NULL, ABBE_SCHEMA, "holds k but no n");
  refuses(AGF, &(abbe_import_options){.format = ABBE_IMPORT_RII}, ABBE_SCHEMA, "no list 'DATA'");
  refuses(RII, &(abbe_import_options){.format = ABBE_IMPORT_AGF}, ABBE_PARSE, "no NM line");
  refuses("NM A 77\n", NULL, ABBE_SCHEMA, "none of its 1 glasses");
  abbe_material_table table = {0};
  assert_int_equal(abbe_import_load("/nowhere", NULL, &table, NULL, NULL), ABBE_IO);
}
