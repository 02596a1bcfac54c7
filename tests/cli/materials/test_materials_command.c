/* The program's `materials`, as a person and as a program meet it. */
#include "tests/cli/run_output.h"

#include "base/file.h"

#include <cjson/cJSON.h>
#include <unistd.h>

static double number(const cJSON *object, const char *key) {
  const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
  return cJSON_IsNumber(item) ? item->valuedouble : NAN;
}

TEST(json_answers_programs) {
  assert_int_equal(run("materials show n-bk7 --at 587.5618 --at 1000 --json"), 0);
  cJSON *json = cJSON_Parse(output);
  assert_non_null(json);
  assert_string_equal(cJSON_GetObjectItem(json, "name")->valuestring, "n-bk7");
  assert_near(number(json, "n_d"), 1.5168, 5e-6);
  assert_near(number(json, "v_d"), 64.17, 5e-3);
  cJSON *n = cJSON_GetObjectItem(json, "n");
  assert_int_equal(cJSON_GetArraySize(n), 2);
  assert_near(number(cJSON_GetArrayItem(n, 0), "lambda_nm"), 587.5618, 0);
  assert_near(number(cJSON_GetArrayItem(n, 0), "n"), number(json, "n_d"), 0);
  assert_true(cJSON_IsFalse(cJSON_GetObjectItem(cJSON_GetArrayItem(n, 1), "extrapolated")));
  assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(json, "fits")), 2);
  assert_true(cJSON_IsNull(cJSON_GetObjectItem(json, "warning")));
  cJSON_Delete(json);
}

TEST(an_index_is_shown_at_a_temperature_and_a_pressure) {
  assert_int_equal(run("materials show n-bk7 --temperature 30 --pressure 0.5"), 0);
  assert_contains(output, "temperature   20 C\n  shown         at 30 C in air of 0.5 atm");
  assert_contains(output, "dn/dT         3.0 relative to air, 1.6 to vacuum, 1e-6/K at e and 30 C");
  assert_int_equal(run("materials show n-bk7 --temperature -40 --at 587.5618 --json"), 0);
  cJSON *json = cJSON_Parse(output);
  const cJSON *first = cJSON_GetArrayItem(cJSON_GetObjectItem(json, "n"), 0);
  assert_near(number(first, "n"), 1.5166348, 5e-8);
  assert_near(number(first, "n_absolute"), 1.5171546, 5e-8);
  assert_near(number(cJSON_GetObjectItem(json, "shown_at"), "temperature_c"), -40, 0);
  cJSON_Delete(json);
  assert_int_equal(run("materials show diamond"), 0);
  assert_contains(output, "dn/dT         not given");
  assert_int_equal(run("materials show diamond --temperature 40"), 1);
  assert_contains(output, "diamond has no index at 40 C: its record gives no dn/dT");
  assert_int_equal(run("materials show n-bk7 --temperature 293"), 2);
  assert_int_equal(run("materials show n-bk7 --pressure -1"), 2);
}

TEST(lists_hold_every_material) {
  assert_int_equal(run("materials list --json"), 0);
  cJSON *json = cJSON_Parse(output);
  assert_non_null(json);
  assert_true(cJSON_GetArraySize(cJSON_GetObjectItem(json, "materials")) >= 17);
  cJSON_Delete(json);
  assert_int_equal(run("materials list --table thesis"), 0);
  assert_contains(output, "historical");
  assert_contains(output, "baf10");
  assert_int_equal(run("materials list"), 0);
  assert_contains(output, "cubic-zirconia");
}

TEST(extrapolation_is_reported_or_refused) {
  assert_int_equal(run("materials show diamond --at 770"), 0);
  assert_contains(output, "extrapolated\n");
  assert_contains(output, "warning");
  assert_int_equal(run("materials show diamond --at 770 --json"), 0);
  cJSON *json = cJSON_Parse(output);
  assert_non_null(json);
  const cJSON *first = cJSON_GetArrayItem(cJSON_GetObjectItem(json, "n"), 0);
  assert_true(cJSON_IsTrue(cJSON_GetObjectItem(first, "extrapolated")));
  cJSON_Delete(json);
  assert_int_equal(run("materials show n-bk7 --at 500 --at 2600 --json"), 1);
  assert_string_equal(output,
                      "abbe materials show: n-bk7 has no index at 2600 nm: its data reach from 300 "
                      "to 2500 nm, and its record does not say 'extrapolate: true'\n");
}

TEST(numbers_outside_the_data_are_not_told) {
  char path[] = "/tmp/abbe-test-materials-XXXXXX";
  int fd = mkstemp(path);
  assert_true(fd >= 0);
  close(fd);
  const char *text = "materials:\n- name: infrared glass\n  model: cauchy\n"
                     "  coefficients: [1.5, 0.004]\n  range_nm: [600, 1000]\n  source: s\n"
                     "- name: flat\n  model: constant\n  coefficients: [1.5]\n  source: s\n";
  OK(abbe_file_write(path, text, strlen(text), &error));
  assert_int_equal(run(printed("materials show 'infrared glass' --table %s --json", path)), 0);
  cJSON *json = cJSON_Parse(output);
  assert_true(cJSON_IsNull(cJSON_GetObjectItem(json, "n_d")));
  assert_true(cJSON_IsNull(cJSON_GetObjectItem(json, "v_d")));
  assert_true(cJSON_IsNull(cJSON_GetObjectItem(json, "temperature_c")));
  assert_near(number(json, "n_C"), 1.5 + 0.004e6 / (656.2725 * 656.2725), 1e-12);
  cJSON_Delete(json);
  assert_int_equal(run(printed("materials show 'infrared glass' --table %s --fit", path)), 1);
  assert_contains(output, "no index at 380 nm");
  assert_int_equal(run(printed("materials show flat --table %s", path)), 0);
  assert_contains(output, "V_d infinite");
  unlink(path);
}

TEST(a_density_is_set_shown_and_listed) {
  char path[] = "/tmp/abbe-test-materials-XXXXXX";
  int fd = mkstemp(path);
  assert_true(fd >= 0);
  close(fd);
  const char *text = "materials:\n- name: heavy\n  model: constant\n  coefficients: [1.5]\n"
                     "  source: s\n- name: unknown\n  model: constant\n  coefficients: [1.6]\n"
                     "  source: s\n";
  OK(abbe_file_write(path, text, strlen(text), &error));
  assert_int_equal(run(printed("materials set heavy density_g_cm3=4.73 --table %s", path)), 0);
  assert_int_equal(run(printed("materials show heavy --table %s", path)), 0);
  assert_contains(output, "  density       4.73 g/cm3\n");
  assert_int_equal(run(printed("materials show heavy --table %s --json", path)), 0);
  cJSON *json = cJSON_Parse(output);
  assert_near(number(json, "density_g_cm3"), 4.73, 0);
  cJSON_Delete(json);
  assert_int_equal(run(printed("materials list --table %s --json", path)), 0);
  json = cJSON_Parse(output);
  const cJSON *list = cJSON_GetObjectItem(json, "materials");
  assert_near(number(cJSON_GetArrayItem(list, 0), "density_g_cm3"), 4.73, 0);
  assert_true(cJSON_IsNull(cJSON_GetObjectItem(cJSON_GetArrayItem(list, 1), "density_g_cm3")));
  cJSON_Delete(json);
  assert_int_equal(run(printed("materials list --table %s --columns name,density", path)), 0);
  assert_contains(output, "heavy     4.73\n");
  assert_int_equal(run(printed("materials set heavy density_g_cm3=4730 --table %s", path)), 1);
  assert_contains(output, "density_g_cm3");
  unlink(path);
}

/* What --fit prints is what the shipped record holds. */
TEST(a_printed_fit_is_the_recorded_one) {
  assert_int_equal(run("materials show diamond --fit"), 0);
  FREED char *table = NULL;
  char *line = NULL;
  size_t size = 0;
  OK(abbe_file_read(ABBE_SOURCE_DIR "/spectral/materials/materials.yaml", 1 << 20, &table, &size,
                    &error));
  int lines = 0;
  for (line = strtok(output, "\n"); line != NULL; line = strtok(NULL, "\n"), lines++)
    assert_contains(table, line);
  assert_int_equal(lines, 3);
}

TEST(wrong_use_is_2_and_says_what_is_right) {
  const struct {
    const char *arguments, *part;
    int code;
  } cases[] = {
      {"materials", "a verb is wanted", 2},
      {"materials lst", "did you mean 'list'?", 2},
      {"materials show", "Name a material", 2},
      {"materials list diamond", "did you mean show?", 2},
      {"materials list --at 500", "--at", 2},
      {"materials list --fit", "--fit", 2},
      {"materials show diamond --fit --json", "--fit goes without", 2},
      {"materials show diamond more", "one argument too many", 2},
      {"materials show diamond --at red", "--at 'red'", 2},
      {"materials show diamond --at nan", "--at 'nan'", 2},
      {"materials show diamond --at 0", "--at '0'", 2},
      {"materials show diamond --at -5", "--at '-5'", 2},
      {"materials show diamond --colour", "--colour", 2},
      {"materials show diamnod", "did you mean 'diamond'?", 1},
      {"materials show x --table /no/such.yaml", "/no/such.yaml", 1},
      {"materials list > /dev/full", "could not be written", 1},
      {"material list", "did you mean 'materials'?", 2},
      {"materials --help", "abbe materials show diamond --at 430.8", 0},
      {"help materials", "Examples:", 0},
      {"materials show --help", "abbe materials show diamond --at 430.8", 0},
      {"materials list --help", "abbe materials list --table thesis", 0},
      {"materials help show", "Usage: abbe materials show", 0},
      {"help materials show", "Usage: abbe materials show", 0},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    int code = run(cases[i].arguments);
    if (code != cases[i].code) fail_msg("abbe %s: %d\n%s", cases[i].arguments, code, output);
    assert_contains(output, cases[i].part);
  }
}
