#include "tests/check.h"
#include "tests/colorimetry/colord.h"

#include "base/file.h"
#include "colorimetry/illuminant.h"

#include <unistd.h>

static abbe_illuminant make(const char *name) {
  abbe_illuminant light = {0};
  abbe_error error = {0};
  if (abbe_illuminant_make(name, &light, &error) != ABBE_OK) fail_msg("%s", error.text);
  return light;
}

/* colord normalises by the power at 560 nm and rounds to the digits it prints. */
static void compare(const char *name, const char *file, double tolerance) {
  static double cie[600];
  double start = 0, end = 0;
  size_t count = colord_read(file, cie, 600, &start, &end);
  abbe_illuminant light = make(name);
  for (size_t i = 0; i < count; i++) {
    double nm = start + (end - start) * (double)i / (double)(count - 1);
    double ours = abbe_illuminant_power(&light, nm) / 100;
    if (fabs(ours - cie[i]) > tolerance) fail_msg("%s at %g nm: %g, %g", name, nm, ours, cie[i]);
  }
  abbe_illuminant_free(&light);
}

static void test_d65_is_the_cies(void **state) {
  (void)state;
  compare("D65", "illuminant/CIE-D65.sp", 1e-12);
}

/* colord keeps three decimals, some of them means of rounded neighbours */
static void test_d50_is_the_cies(void **state) {
  (void)state;
  compare("D50", "illuminant/CIE-D50.sp", 1.01e-3);
}

static void test_a_is_the_cies(void **state) {
  (void)state;
  compare("A", "illuminant/CIE-A.sp", 1e-5);
}

static void test_e_is_flat(void **state) {
  (void)state;
  compare("E", "illuminant/CIE-E.sp", 0);
}

static void test_interpolation_and_ends(void **state) {
  (void)state;
  abbe_illuminant light = {0};
  assert_string_equal(abbe_illuminant_name(&light), "D65");
  assert_true(fabs(abbe_illuminant_power(&light, 302.5) - (0.0341 + 1.6643) / 2) < 1e-14);
  assert_true(abbe_illuminant_power(&light, 830) == 60.3125);
  static const double outside[] = {-5, 0, 299.9, 830.1, INFINITY, NAN};
  for (int i = 0; i < 6; i++) assert_true(abbe_illuminant_power(&light, outside[i]) == 0);
  abbe_illuminant a = make("a");
  assert_true(fabs(abbe_illuminant_power(&a, 560) - 100) < 1e-12);
  assert_true(abbe_illuminant_power(&a, 1e-3) >= 0 && abbe_illuminant_power(&a, 0) == 0);
}

static char *write_text(const char *text) {
  static char path[128];
  snprintf(path, sizeof path, "/tmp/abbe_test_illuminant_%ld.txt", (long)getpid());
  assert_int_equal(abbe_file_write(path, text, strlen(text), NULL), ABBE_OK);
  return path;
}

static void test_a_file_of_ones_own(void **state) {
  (void)state;
  char *path = write_text("# a lamp\n400, 0\r\n\n 500;10 # middle\n600\t20");
  abbe_illuminant light = make(path);
  assert_int_equal(light.kind, ABBE_ILLUMINANT_TABULATED);
  assert_true(fabs(abbe_illuminant_power(&light, 550) - 15) < 1e-12);
  assert_true(abbe_illuminant_power(&light, 399) == 0);
  assert_true(abbe_illuminant_power(&light, 601) == 0);
  abbe_illuminant_free(&light);
  abbe_illuminant_free(&light);
  unlink(path);
}

/* A spreadsheet's and a spectrometer's: what the reader of measured points takes, a light takes. */
static void test_files_in_other_dresses(void **state) {
  (void)state;
  static const char *const dresses[] = {
      "\xef\xbb\xbf"
      "400 0\r\n500 10\r\n600 20\r\n",
      "wavelength_nm,power\n400,0\n500,10\n600,20\n",
      "Wellenlaenge [um];W/(m2 nm)\n0,4;0\n0,5;10,0\n0,6;20,0\n",
      "nm\tcounts\n600\t20\n500\t10\n400\t0\n",
  };
  for (size_t i = 0; i < sizeof dresses / sizeof dresses[0]; i++) {
    char *path = write_text(dresses[i]);
    abbe_illuminant light = make(path);
    assert_true(fabs(abbe_illuminant_power(&light, 550) - 15) < 1e-12);
    assert_true(abbe_illuminant_power(&light, 399) == 0);
    abbe_illuminant_free(&light);
    unlink(path);
  }
}

static void test_bad_files(void **state) {
  (void)state;
  static const struct {
    const char *text, *says;
    abbe_result result;
  } bad[] = {
      {"", "holds no points", ABBE_SCHEMA},     {"500 1\n", "at least two rows", ABBE_SCHEMA},
      {"400 0\n500 0\n", "all 0", ABBE_SCHEMA}, {"400 1\n400 2\n", ":2:", ABBE_SCHEMA},
      {"500 1\n400 -2\n", ":2:", ABBE_SCHEMA},  {"400 1\n500 -2\n", "-2", ABBE_SCHEMA},
      {"400 nan\n500 1\n", ":1:", ABBE_PARSE},  {"400 1\n500 1e999\n", ":2:", ABBE_PARSE},
      {"-400 1\n500 1\n", ":1:", ABBE_SCHEMA},  {"nm,power\n400,1\n", "two rows", ABBE_SCHEMA},
      {"400 1 2\n500 1\n", ":1:", ABBE_PARSE},  {"400\n500 1\n", ":1:", ABBE_PARSE},
      {"400,,1\n500 1\n", ":1:", ABBE_PARSE}};
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
    char *path = write_text(bad[i].text);
    abbe_illuminant light = {0};
    abbe_error error = {0};
    abbe_result result = abbe_illuminant_make(path, &light, &error);
    if (result != bad[i].result || strstr(error.text, bad[i].says) == NULL ||
        strstr(error.text, path) == NULL || light.spectrum != NULL)
      fail_msg("case %zu: %d, %s", i, (int)result, error.text);
    unlink(path);
  }
}

static void test_unknown_names(void **state) {
  (void)state;
  abbe_illuminant light = {0};
  abbe_error error = {0};
  assert_int_equal(abbe_illuminant_make("D56", &light, &error), ABBE_NOT_FOUND);
  assert_non_null(strstr(error.text, "D56"));
  assert_int_equal(abbe_illuminant_make("/no/such/lamp.csv", &light, &error), ABBE_IO);
  assert_non_null(strstr(error.text, "/no/such/lamp.csv"));
  assert_int_equal(abbe_illuminant_make("/tmp", &light, &error), ABBE_IO);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_d65_is_the_cies),        cmocka_unit_test(test_d50_is_the_cies),
      cmocka_unit_test(test_a_is_the_cies),          cmocka_unit_test(test_e_is_flat),
      cmocka_unit_test(test_interpolation_and_ends), cmocka_unit_test(test_a_file_of_ones_own),
      cmocka_unit_test(test_files_in_other_dresses), cmocka_unit_test(test_bad_files),
      cmocka_unit_test(test_unknown_names)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
