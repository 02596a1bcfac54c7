#include "tests/check.h"

#include "spectral/materials/material_query.h"

static abbe_material_table table;

static void setup(void) {
  static const char text[] =
      "materials:\n"
      "- {name: n-bk7, model: cauchy, coefficients: [1.5046, 0.0042], range_nm: [300, 2500], "
      "source: '[Schott2017] data sheet'}\n"
      "- {name: N-SF11, model: cauchy, coefficients: [1.7358, 0.0172], range_nm: [370, 2500], "
      "source: '[Schott2017]'}\n"
      "- {name: flat, model: constant, coefficients: [1.5], source: made up}\n"
      "- {name: infrared, model: cauchy, coefficients: [2.4, 0.05], range_nm: [900, 9000], source: "
      "paper}\n"
      "- {name: fluorite, model: cauchy, coefficients: [1.4269, 0.0024], range_nm: [230, 9700], "
      "source: '[Malitson1963]'}\n";
  OK(abbe_material_table_parse(text, sizeof text - 1, "t", &table, &error));
}

static void teardown(void) {
  abbe_material_table_free(&table);
}

static void expect(abbe_material_query query, const char *wanted) {
  char got[400] = "";
  FREED size_t *rows = NULL;
  size_t count = 0;
  OK(abbe_material_query_run(&table, &query, &rows, &count, &error));
  for (size_t i = 0; i < count; i++) {
    strcat(got, i > 0 ? " " : "");
    strcat(got, table.material[rows[i]].name);
  }
  assert_string_equal(got, wanted);
}

GROUP(setup, teardown);

TEST(rows_are_chosen) {
  expect((abbe_material_query){0}, "n-bk7 N-SF11 flat infrared fluorite");
  expect((abbe_material_query){.name = "sf"}, "N-SF11");
  expect((abbe_material_query){.name = "n-*"}, "n-bk7 N-SF11");
  expect((abbe_material_query){.name = "N-[b]?7"}, "n-bk7");
  expect((abbe_material_query){.name = "nothing"}, "");
  expect((abbe_material_query){.source = "schott2017"}, "n-bk7 N-SF11");
  expect((abbe_material_query){.source = "*sheet"}, "n-bk7");
  expect((abbe_material_query){.n_d_min = 1.5, .n_d_max = 1.6}, "n-bk7 flat");
  expect((abbe_material_query){.v_d_min = 60, .v_d_max = 100}, "n-bk7 fluorite");
  expect((abbe_material_query){.v_d_min = 60, .v_d_max = INFINITY}, "n-bk7 flat fluorite");
  expect((abbe_material_query){.n_d_min = 1.5, .n_d_max = 2, .name = "f"}, "N-SF11 flat");
}

TEST(rows_are_sorted_and_those_without_come_last) {
  expect((abbe_material_query){.sort = ABBE_MATERIAL_KEY_NAME},
         "flat fluorite infrared n-bk7 N-SF11");
  expect((abbe_material_query){.sort = ABBE_MATERIAL_KEY_NAME, .descending = true},
         "N-SF11 n-bk7 infrared fluorite flat");
  expect((abbe_material_query){.sort = ABBE_MATERIAL_KEY_ND},
         "fluorite flat n-bk7 N-SF11 infrared");
  expect((abbe_material_query){.sort = ABBE_MATERIAL_KEY_ND, .descending = true},
         "N-SF11 n-bk7 flat fluorite infrared");
  expect((abbe_material_query){.sort = ABBE_MATERIAL_KEY_VD},
         "N-SF11 n-bk7 fluorite flat infrared");
  expect((abbe_material_query){.sort = ABBE_MATERIAL_KEY_BG, .descending = true},
         "N-SF11 n-bk7 fluorite flat infrared");
  expect((abbe_material_query){.sort = ABBE_MATERIAL_KEY_FROM},
         "flat fluorite n-bk7 N-SF11 infrared");
  expect((abbe_material_query){.sort = ABBE_MATERIAL_KEY_TO, .name = "n"}, "n-bk7 N-SF11 infrared");
  expect((abbe_material_query){.sort = ABBE_MATERIAL_KEY_SOURCE},
         "fluorite N-SF11 n-bk7 flat infrared");
  expect((abbe_material_query){.descending = true}, "fluorite infrared flat N-SF11 n-bk7");
}

TEST(keys_are_named) {
  size_t *rows, count;
  assert_string_equal(abbe_material_key_name(ABBE_MATERIAL_KEY_PGF), "p_gF");
  assert_string_equal(abbe_material_key_name((abbe_material_key)-1), "unknown");
  const abbe_material_query wrong = {.sort = (abbe_material_key)99};
  REFUSED(ABBE_INVALID_ARGUMENT, "99",
          abbe_material_query_run(&table, &wrong, &rows, &count, &error));
  expect((abbe_material_query){.sort = ABBE_MATERIAL_KEY_PGF, .name = "flat"}, "flat");
}
