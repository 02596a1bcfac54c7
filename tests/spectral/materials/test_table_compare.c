#include "tests/check.h"

#include "spectral/formats/material_import.h"
#include "spectral/materials/table_compare.h"

static abbe_material_table parse(const char *text) {
  abbe_material_table table;
  OK(abbe_material_table_parse(text, strlen(text), "t", &table, &error));
  return table;
}

#define A "{name: a, model: cauchy, coefficients: [1.5, 0.004], range_nm: [400, 800], source: s}"
#define B "{name: b, model: constant, coefficients: [1.6], source: s}"
#define C "{name: c, model: tabulated, points: [[400, 1.5], [500, 1.4]], source: s}"

TEST(rows_are_matched) {
  OWNED(abbe_material_table, first) = parse("materials: [" A ", " B ", " C "]");
  OWNED(abbe_material_table, second) =
      parse("materials:\n- {name: new, model: constant, coefficients: [2], source: s}\n"
            "- {name: B2, model: constant, coefficients: [1.6], source: other}\n"
            "- {name: A, model: cauchy, coefficients: [1.501, 0.004], range_nm: [300, 700], "
            "source: s}\n");
  MADE(abbe_table_difference, d, abbe_table_compare(&first, &second, &d, &error));
  assert_int_equal(d.count, 4);
  assert_int_equal(d.row[0].kind, ABBE_ROW_CHANGED);
  assert_int_equal(d.row[0].parts, 1u << ABBE_ROW_PART_COEFFICIENTS | 1u << ABBE_ROW_PART_RANGE);
  assert_near(d.row[0].min_nm, 400, 0);
  assert_near(d.row[0].max_nm, 700, 0);
  assert_near(d.row[0].index.max, 0.001, 1e-12);
  assert_near(d.row[0].index.mean, 0.001, 1e-12); /* second - first */
  assert_int_equal(d.row[1].kind, ABBE_ROW_RENAMED);
  assert_string_equal(d.row[1].second->name, "B2");
  assert_int_equal(d.row[1].parts, 1u << ABBE_ROW_PART_SOURCE);
  assert_near(d.row[1].index.max, 0, 0);
  assert_int_equal(d.row[2].kind, ABBE_ROW_ONLY_IN_FIRST);
  assert_null(d.row[2].second);
  assert_true(isnan(d.row[2].index.max));
  assert_int_equal(d.row[3].kind, ABBE_ROW_ONLY_IN_SECOND);
  assert_string_equal(d.row[3].second->name, "new");
  assert_int_equal(d.kinds[ABBE_ROW_CHANGED], 1);
  assert_int_equal(d.kinds[ABBE_ROW_SAME], 0);
}

TEST(a_table_is_the_same_as_itself) {
  MADE(abbe_material_table, first, abbe_material_table_load("default", &first, &error));
  MADE(abbe_material_table, second, abbe_material_table_load("default", &second, &error));
  MADE(abbe_table_difference, d, abbe_table_compare(&first, &second, &d, &error));
  assert_int_equal(d.kinds[ABBE_ROW_SAME], first.count);
}

/* One key changed at a time is one part that differs, and no other. */
TEST(each_part_is_seen) {
  const char *base = "name: a, model: tabulated, range_nm: [400, 500], source: s";
  const struct {
    const char *before, *after;
    abbe_row_part part;
  } cases[] = {
      {"", ", description: d", ABBE_ROW_PART_DESCRIPTION},
      {", points: [[400, 1.5], [500, 1.4], [510, 1]]",
       ", points: [[400, 1.5], [500, 1.4], [511, 1]]", ABBE_ROW_PART_POINTS},
      {", points: [[400, 1.5], [500, 1.4], [510, 1]], interpolation: linear",
       ", points: [[400, 1.5], [500, 1.4], [510, 1]], interpolation: spline", ABBE_ROW_PART_POINTS},
      {"", ", extrapolate: true", ABBE_ROW_PART_EXTRAPOLATE},
      {"", ", temperature_c: 0", ABBE_ROW_PART_TEMPERATURE},
      {"", ", n_d: 1.5", ABBE_ROW_PART_PUBLISHED},
      {", warning: v", ", warning: w", ABBE_ROW_PART_WARNING},
      {"", ", comment: c", ABBE_ROW_PART_COMMENT},
      {"", ", absorption: {colour: [1, 1, 0.5], distance_m: 1}", ABBE_ROW_PART_ABSORPTION},
      {", absorption: {k: [[400, 1]]}",
       ", absorption: {k: [[400, 1]]}, fluorescence: {yield: 1, emission: [[500, 1], [600, 0]]}",
       ABBE_ROW_PART_FLUORESCENCE},
      {"", ", catalogue: {status: standard}", ABBE_ROW_PART_CATALOGUE},
      {", fit: {cauchy2: {coefficients: [1, 2], max_error: 1}}",
       ", fit: {cauchy2: {coefficients: [1, 2], max_error: 2}}", ABBE_ROW_PART_FIT},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    const char *points =
        strstr(cases[i].before, "points") ? "" : ", points: [[400, 1.5], [500, 1.4]]";
    char text[2][512];
    for (int k = 0; k < 2; k++)
      snprintf(text[k], sizeof text[k], "materials: [{%s%s%s}]", base, points,
               k == 0 ? cases[i].before : cases[i].after);
    OWNED(abbe_material_table, first) = parse(text[0]), second = parse(text[1]);
    MADE(abbe_table_difference, d, abbe_table_compare(&first, &second, &d, &error));
    if (d.row[0].parts != 1u << cases[i].part)
      fail_msg("%s: %x", abbe_row_part_name(cases[i].part), d.row[0].parts);
  }
}
