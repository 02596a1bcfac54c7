#include "tests/check.h"

#include "spectral/dispersion/index_points.h"

#include "base/file.h"

#include <unistd.h>

static abbe_index_points parse(const char *text) {
  abbe_index_points points;
  OK(abbe_index_points_parse(text, strlen(text), "p.csv", &points, &error));
  return points;
}

TEST(a_plain_file_is_read) {
  OWNED(abbe_index_points, p) =
      parse("# own measurement\n\n656.3,1.5143\r\n587.6, 1.5168\n486.1,1.5224");
  assert_int_equal(p.count, 3);
  assert_near(p.lambda_nm[0], 486.1, 0); /* in order, whatever the file's */
  assert_near(p.n[0], 1.5224, 0);
  assert_near(p.lambda_nm[2], 656.3, 0);
  assert_near(p.n[1], 1.5168, 0);
  assert_null(p.uncertainty);
  assert_false(p.exact);
  abbe_index_points_free(&p);
}

TEST(units_are_named_or_plain) {
  const struct {
    const char *text;
    double first_nm;
  } cases[] = {
      {"wavelength_um,n\n0.5876,1.5\n", 587.6},
      {"Wavelength [\xc2\xb5m];n\n0.5876;1.5\n", 587.6},
      {"\xef\xbb\xbfwavelength (nm),n,uncertainty\n587.6,1.5,1e-5\n", 587.6},
      {"nm,n\n50,1.5\n", 50},
      {"0.5876,1.5\n1.0140,1.4\n", 587.6},
      {"10.6 2.4\n0.5 2.5\n", 500},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    OWNED(abbe_index_points, p) = parse(cases[i].text);
    assert_near(p.lambda_nm[0], cases[i].first_nm, 1e-10);
  }
}

TEST(uncertainties_are_kept_and_wavelengths_may_repeat) {
  OWNED(abbe_index_points, p) = parse("600,1.51,2e-5\n500,1.52,1e-5\n600,1.512,3e-5\n");
  assert_int_equal(p.count, 3);
  assert_near(p.uncertainty[0], 1e-5, 0);
  assert_near(p.uncertainty[1], 2e-5, 0); /* of equal wavelengths the earlier line is first */
  assert_near(p.uncertainty[2], 3e-5, 0);
}

TEST(bad_lines_are_named) {
  const struct {
    const char *text, *part;
    abbe_result code;
  } cases[] = {
      {"", "no points", ABBE_SCHEMA},
      {"wavelength,n\n# nothing\n", "no points", ABBE_SCHEMA},
      {"500,1.5\n600,x\n", "p.csv:2: this is not a number: 'x'", ABBE_PARSE},
      {"500,1.5\n600,1.5e\n", "p.csv:2: this is not a number: '1.5e'", ABBE_PARSE},
      {"500,1.5\n600\n", "p.csv:2: a line wants a wavelength above 0 and an index", ABBE_PARSE},
      {"500,1.5,1e-5\n600,1.4\n", "1 of 2 points have an uncertainty", ABBE_SCHEMA},
      {"500,1.5,-1e-5\n", "p.csv:1: n lies from", ABBE_PARSE},
      {"500,0\n", "p.csv:1: n lies from 0.001", ABBE_PARSE},
      {"-500,1.5\n-400,1.5\n", "p.csv:1: a line wants a wavelength above 0", ABBE_PARSE},
      {"wl_nm,n\n0.5,1.5\n", "outside 1 to 1e+06 nm; a first line", ABBE_SCHEMA},
      {"0.5,1.5\n600,1.5\n", "from 0.5 to 600 are in no unit", ABBE_PARSE},
      {"wl_um,k\n0.5,1e-6\n", "has no indices", ABBE_SCHEMA},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    abbe_index_points p;
    abbe_error error = {0};
    abbe_result result =
        abbe_index_points_parse(cases[i].text, strlen(cases[i].text), "p.csv", &p, &error);
    if (result != cases[i].code) fail_msg("%s: %d %s", cases[i].text, result, error.text);
    assert_contains(error.text, cases[i].part);
    assert_null(p.lambda_nm);
  }
}

TEST(files_are_read_or_named) {
  char path[] = "/tmp/abbe-test-points-XXXXXX";
  int fd = mkstemp(path);
  assert_true(fd >= 0);
  close(fd);
  OK(abbe_file_write(path, "500,1.5\n", 8, &error));
  abbe_index_points p;
  OK(abbe_index_points_load(path, &p, &error));
  assert_int_equal(p.count, 1);
  abbe_index_points_free(&p);
  unlink(path);
  REFUSED(ABBE_IO, path, abbe_index_points_load(path, &p, &error));
  assert_null(p.n);
}

TEST(many_points_are_read_at_once) {
  enum { COUNT = 5000 };
  static char text[COUNT * 24];
  size_t used = 0;
  for (int i = COUNT; i > 0; i--)
    used += (size_t)snprintf(text + used, sizeof text - used, "%d.5 %.6f\n", 400 + i, 1 + 1.0 / i);
  OWNED(abbe_index_points, p) = parse(text);
  assert_int_equal(p.count, COUNT);
  for (size_t i = 1; i < COUNT; i++) assert_true(p.lambda_nm[i] > p.lambda_nm[i - 1]);
  assert_near(p.n[0], 2, 0);
}

TEST(formulas_are_sampled_to_both_ends) {
  const abbe_dispersion d = {.model = ABBE_DISPERSION_CAUCHY, .count = 2, .c = {1.5, 0.004}};
  const struct {
    double min_nm, max_nm;
    size_t least, most, count;
  } cases[] = {{380, 780, 2, 1000, 401},   {380, 780, 500, 1000, 500}, {380, 780, 2, 100, 100},
               {380.5, 382.25, 2, 100, 3}, {380, 381, 7, 9, 7},        {1, 1e6, 2, 50, 50}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    MADE(abbe_index_points, p,
         abbe_index_points_sample(&d, cases[i].min_nm, cases[i].max_nm, cases[i].least,
                                  cases[i].most, &p, &error));
    assert_int_equal(p.count, cases[i].count);
    assert_near(p.lambda_nm[0], cases[i].min_nm, 0);
    assert_near(p.lambda_nm[p.count - 1], cases[i].max_nm, 0);
    assert_true(p.exact);
    for (size_t k = 0; k < p.count; k++) {
      assert_near(p.n[k], 1.5 + 0.004e6 / (p.lambda_nm[k] * p.lambda_nm[k]), 1e-9);
      if (k > 0) assert_true(p.lambda_nm[k] > p.lambda_nm[k - 1]);
    }
  }
}

TEST(what_cannot_be_sampled_is_refused) {
  const abbe_dispersion d = {.model = ABBE_DISPERSION_SELLMEIER2, .count = 3, .c = {0, 1, 0.25}};
  const struct {
    double min_nm, max_nm;
    size_t least, most;
    const char *part;
  } cases[] = {{780, 380, 2, 9, "780:380"},
               {0, 780, 2, 9, "0:780"},
               {NAN, 780, 2, 9, "nan"},
               {380, INFINITY, 2, 9, "inf"},
               {600, 780, 1, 9, "1 to 9 points"},
               {600, 780, 9, 8, "9 to 8 points"},
               {600, 780, 2, 1 << 20, "possible"},
               {400, 780, 2, 9, "no real index at 400 nm"}};
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    abbe_index_points p;
    REFUSED(ABBE_INVALID_ARGUMENT, cases[i].part,
            abbe_index_points_sample(&d, cases[i].min_nm, cases[i].max_nm, cases[i].least,
                                     cases[i].most, &p, &error));
    assert_null(p.n);
  }
}
