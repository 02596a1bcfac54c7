#define _XOPEN_SOURCE 700
#include "tests/check.h"

#include "base/file.h"
#include "spectral/editing/record_draft.h"
#include "spectral/materials/material_numbers.h"

#include <unistd.h>

static const char table[] = "# A table\nmaterials:\n"
                            "  - name: K5 # a crown\n    model: cauchy\n"
                            "    coefficients: [1.5220, # high\n      0.00459]\n"
                            "    range_nm: [380, 780]\n    source: \"me: 3 May\"\n"
                            "  - {name: flint, model: constant, coefficients: [1.6], source: x}\n";

static char path[] = "/tmp/abbe-test-record-draft-XXXXXX";
static void set_up(void) {
  strcpy(path + strlen(path) - 6, "XXXXXX");
  int fd = mkstemp(path);
  assert_false(fd < 0);
  assert_int_equal(close(fd), 0);
  OK(abbe_file_write(path, table, strlen(table), &error));
}

static void tear_down(void) {
  assert_false(unlink(path));
}

static abbe_record_draft *open_draft(const char *name) {
  abbe_record_draft *d = NULL;
  OK(abbe_record_draft_open(path, name, &d, &error));
  return d;
}

static size_t field(const abbe_record_draft *d, const char *key) {
  for (size_t i = 0; i < abbe_record_draft_count(d); i++)
    if (strcmp(abbe_record_draft_field(d, i)->key, key) == 0) return i;
  fail_msg("no field %s", key);
  return 0;
}

static const char *text(const abbe_record_draft *d, const char *key) {
  return abbe_record_draft_field(d, field(d, key))->text;
}

static void put(abbe_record_draft *d, const char *key, const char *value) {
  OK(abbe_record_draft_set(d, field(d, key), value, &error));
}

static void check_file(const char *part, bool wanted) {
  FREED char *found = NULL;
  size_t size = 0;
  OK(abbe_file_read(path, 1 << 20, &found, &size, &error));
  if ((strstr(found, part) != NULL) != wanted) fail_msg("'%s' in\n%s", part, found);
}

static double n_d(const abbe_material *m) {
  abbe_material_numbers numbers;
  assert_non_null(m);
  abbe_material_numbers_make(m, &numbers);
  return numbers.n_d;
}

EACH(set_up, tear_down);

TEST(fields_are_those_of_the_record) {
  abbe_record_draft *d = open_draft("k5");
  assert_string_equal(text(d, "name"), "K5");
  assert_string_equal(text(d, "coefficients.0"), "1.5220");
  assert_string_equal(text(d, "coefficients.1"), "0.00459");
  assert_string_equal(text(d, "range_nm"), "380 780");
  assert_string_equal(text(d, "source"), "me: 3 May");
  assert_string_equal(text(d, "warning"), "");
  assert_near(n_d(abbe_record_draft_material(d)), 1.535296, 5e-7);
  assert_false(abbe_record_draft_is_changed(d));
  abbe_record_draft_free(d);
  d = open_draft("flint");
  assert_string_equal(text(d, "range_nm"), "");
  abbe_record_draft_free(d);
}

TEST(changes_are_live_and_undone) {
  abbe_record_draft *d = open_draft("K5");
  assert_false(abbe_record_draft_undo(d));
  put(d, "coefficients.0", "1.509");
  assert_near(n_d(abbe_record_draft_material(d)), 1.522296, 5e-7);
  assert_near(n_d(abbe_record_draft_original(d)), 1.535296, 5e-7);
  assert_true(abbe_record_draft_is_changed(d));
  assert_true(abbe_record_draft_field(d, field(d, "coefficients.0"))->changed);
  assert_false(abbe_record_draft_field(d, field(d, "coefficients.1"))->changed);
  put(d, "name", "k5: mine");
  assert_true(abbe_record_draft_undo(d));
  assert_true(abbe_record_draft_undo(d));
  assert_false(abbe_record_draft_undo(d));
  assert_false(abbe_record_draft_is_changed(d));
  assert_true(abbe_record_draft_redo(d));
  assert_true(abbe_record_draft_redo(d));
  assert_false(abbe_record_draft_redo(d));
  assert_string_equal(text(d, "name"), "k5: mine");
  assert_true(abbe_record_draft_undo(d));
  put(d, "warning", "w"); /* forgets what was undone */
  assert_false(abbe_record_draft_redo(d));
  put(d, "warning", "");
  assert_string_equal(text(d, "warning"), "");
  abbe_material tried;
  size_t i = field(d, "coefficients.0");
  OK(abbe_record_draft_try(d, i, "1.6", &tried, &error));
  assert_near(n_d(&tried), 1.613296, 5e-7);
  abbe_material_free(&tried);
  assert_int_not_equal(abbe_record_draft_try(d, i, "1.", &tried, &last_error), ABBE_NO_MEMORY);
  abbe_material_free(&tried);
  assert_string_equal(text(d, "coefficients.0"), "1.509");
  abbe_record_draft_free(d);
}

TEST(a_fix_is_put_in) {
  abbe_record_draft *d = open_draft("k5");
  OK(abbe_record_draft_put(d, "coefficients", "[1.509, 0.00459]", &error));
  assert_string_equal(text(d, "coefficients.0"), "1.509");
  assert_string_equal(text(d, "coefficients.1"), "0.00459");
  OK(abbe_record_draft_put(d, "model", "sellmeier", &error));
  assert_string_equal(text(d, "model"), "sellmeier");
  REFUSED(ABBE_UNSUPPORTED, "", abbe_record_draft_put(d, "fit", "{}", &error));
  assert_int_not_equal(abbe_record_draft_put(d, "coefficients", "[1.509", &last_error), ABBE_OK);
  assert_true(abbe_record_draft_undo(d));
  OK(abbe_record_draft_save(d, &error));
  check_file("coefficients: [1.509, # high\n      0.00459]\n", true);
  abbe_record_draft_free(d);
}

TEST(what_is_saved_is_what_was_changed) {
  abbe_record_draft *d = open_draft("k5");
  put(d, "coefficients.0", "1.5090");
  put(d, "range_nm", "400:700");
  put(d, "extrapolate", "true");
  put(d, "temperature_c", "20");
  OK(abbe_record_draft_save(d, &error));
  assert_false(abbe_record_draft_is_changed(d));
  check_file("# A table\nmaterials:\n  - name: K5 # a crown\n    model: cauchy\n"
             "    coefficients: [1.5090, # high\n      0.00459]\n    range_nm: [400, 700]\n"
             "    temperature_c: 20\n    extrapolate: true\n    source: \"me: 3 May\"\n"
             "  - {name: flint, model: constant, coefficients: [1.6], source: x}\n",
             true);
  put(d, "name", "k5-b");
  put(d, "temperature_c", "");
  OK(abbe_record_draft_resize(d, true, &error));
  put(d, "coefficients.2", "1e-5");
  OK(abbe_record_draft_save(d, &error));
  check_file(
      "- name: k5-b # a crown\n    model: cauchy\n    coefficients: [1.509, 0.00459, 1e-05]\n"
      "    range_nm: [400, 700]\n    extrapolate: true\n",
      true);
  while (abbe_record_draft_undo(d)) continue;
  OK(abbe_record_draft_save(d, &error));
  check_file("- name: K5 # a crown\n    model: cauchy\n    coefficients: [1.522, 0.00459]\n"
             "    range_nm: [380, 780]\n    source: \"me: 3 May\"\n",
             true);
  abbe_record_draft_free(d);
}

TEST(wrong_values_are_refused_or_held) {
  abbe_record_draft *d = open_draft("k5");
  const struct {
    const char *key, *value, *part;
  } cases[] = {
      {"coefficients.0", "red", "wants a number"},
      {"coefficients.0", "", "cannot be empty"},
      {"coefficients.0", "1 2", "wants a number"},
      {"coefficients.0", "nan", "wants a number"},
      {"range_nm", "380", "no range"},
      {"range_nm", "380 780 1", "no range"},
      {"name", "", ""},
      {"name", " x", ""},
      {"source", "", "cannot be empty"},
      {"temperature_c", "hot", "wants a number"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    REFUSED(ABBE_INVALID_ARGUMENT, cases[i].part,
            abbe_record_draft_set(d, field(d, cases[i].key), cases[i].value, &error));
  }
  assert_false(abbe_record_draft_is_changed(d));
  put(d, "model", "sellmeier"); /* wants an odd number of coefficients: for a while no material */
  assert_null(abbe_record_draft_material(d));
  assert_contains(abbe_record_draft_trouble(d), "'coefficients'");
  assert_null(strstr(abbe_record_draft_trouble(d), "the record"));
  REFUSED(ABBE_SCHEMA, "not saved", abbe_record_draft_save(d, &error));
  OK(abbe_record_draft_resize(d, true, &error));
  assert_non_null(abbe_record_draft_material(d));
  put(d, "name", "FLINT"); /* taken in the file: seen when it is saved */
  REFUSED(ABBE_INVALID_ARGUMENT, "taken", abbe_record_draft_save(d, &error));
  check_file(table, true);
  put(d, "name", "k5");
  OK(abbe_file_write(path, "materials: []\n", 14, &error));
  REFUSED(ABBE_IO, "", abbe_record_draft_save(d, &error));
  check_file("K5", false);
  abbe_record_draft_free(d);
  REFUSED(ABBE_NOT_FOUND, "", abbe_record_draft_open(path, "k5", &d, &error));
  REFUSED(ABBE_UNSUPPORTED, "", abbe_record_draft_open("default", "k5", &d, &error));
}

TEST(undo_reaches_back_a_thousand_changes) {
  abbe_record_draft *d = open_draft("flint");
  char value[16];
  for (int i = 0; i < 1100; i++) {
    snprintf(value, sizeof value, "1.%d", 1000 + i);
    put(d, "coefficients.0", value);
  }
  int back = 0;
  while (abbe_record_draft_undo(d)) back++;
  assert_int_equal(back, 999);
  assert_string_equal(text(d, "coefficients.0"), "1.1100");
  abbe_record_draft_free(d);
}
