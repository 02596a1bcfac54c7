#include "tests/check.h"

#include "base/file.h"
#include "spectral/dispersion/index_points.h"

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

static const abbe_dispersion a = {.model = ABBE_DISPERSION_CAUCHY, .count = 2, .c = {1.51, 0.0040}};
static const abbe_dispersion b = {.model = ABBE_DISPERSION_CAUCHY, .count = 2, .c = {1.50, 0.0040}};
static const abbe_dispersion steeper = {
    .model = ABBE_DISPERSION_CAUCHY, .count = 2, .c = {1.50, 0.0050}};

TEST(a_shift_is_its_own_size_everywhere) {
  abbe_index_difference d;
  OK(abbe_index_difference_of_curves(&a, &b, 380, 780, &d, &error));
  assert_near(d.rms, 0.01, 1e-14);
  assert_near(d.max, 0.01, 1e-14);
  assert_near(d.mean, 0.01, 1e-14);
  OK(abbe_index_difference_of_curves(&b, &a, 380, 780, &d, &error));
  assert_near(d.mean, -0.01, 1e-14);
  assert_near(d.max, 0.01, 1e-14);
  OK(abbe_index_difference_of_curves(&a, &a, 380, 780, &d, &error));
  assert_near(d.rms, 0, 0);
  assert_near(d.max, 0, 0);
}

/* 0.001 / L^2: its mean square over L by hand is 1e-6 times (1/3) (a^-3 - b^-3) / (b - a). */
TEST(a_steeper_curve_differs_most_in_the_violet) {
  abbe_index_difference d;
  OK(abbe_index_difference_of_curves(&steeper, &b, 380, 780, &d, &error));
  assert_near(d.max_nm, 380, 0);
  assert_near(d.max, 0.001 / (0.38 * 0.38), 1e-14);
  double mean_square = (pow(0.38, -3) - pow(0.78, -3)) / 3 / 0.4;
  assert_near(d.rms, 0.001 * sqrt(mean_square), 2e-6 * 3);
  assert_near(d.mean, 0.001 * (1 / 0.38 - 1 / 0.78) / 0.4, 2e-6 * 3);
}

TEST(points_outside_the_range_are_left_out) {
  double lambda_nm[] = {300, 500, 600, 900}, n[] = {9, 1.5, 1.5, 9};
  const abbe_dispersion flat = {.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {1.51}};
  const abbe_index_points points = {.count = 4, .lambda_nm = lambda_nm, .n = n};
  abbe_index_difference d;
  OK(abbe_index_difference_of_points(&flat, &points, 380, 780, &d, &error));
  assert_near(d.max, 0.01, 1e-14);
  assert_near(d.max_nm, 500, 0);
  OK(abbe_index_difference_of_points(&flat, &points, -INFINITY, INFINITY, &d, &error));
  assert_near(d.max, 7.49, 1e-12);
}

TEST(no_common_ground_is_refused) {
  double lambda_nm[] = {500}, n[] = {1.5};
  const abbe_index_points points = {.count = 1, .lambda_nm = lambda_nm, .n = n};
  const abbe_dispersion pole = {.model = ABBE_DISPERSION_SELLMEIER2, .count = 3, .c = {0, 1, 0.3}};
  abbe_index_difference d;
  REFUSED(ABBE_INVALID_ARGUMENT, "600:700",
          abbe_index_difference_of_points(&a, &points, 600, 700, &d, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "no real index at 500 nm",
          abbe_index_difference_of_points(&pole, &points, 0, INFINITY, &d, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_index_difference_of_curves(&a, &pole, 380, 780, &d, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_index_difference_of_curves(&a, &b, 780, 380, &d, &error));
}

enum { COUNT = 36 };
static double lambda_nm[COUNT], n[COUNT];

static void set_up_law(double ior, double dispersion) {
  for (int i = 0; i < COUNT; i++) {
    lambda_nm[i] = 380 + 10 * i;
    n[i] = ior * pow(dispersion, (555 - lambda_nm[i]) / 350);
  }
}

/* As the manual states it: ior in the middle, the ratio of the ends. */
TEST(the_law_is_that_of_the_manual) {
  const abbe_povray_index index = {1.6, 1.04};
  assert_near(abbe_povray_index_at(&index, 555), 1.6, 1e-15);
  assert_near(abbe_povray_index_at(&index, 380) / abbe_povray_index_at(&index, 730), 1.04, 1e-15);
  assert_near(abbe_povray_index_at(&index, 380), 1.6 * sqrt(1.04), 1e-15);
}

TEST(what_follows_the_law_is_found_whatever_the_weights) {
  const double ratios[] = {0.97, 1.01, 1.2};
  for (int k = 0; k < 3; k++) {
    double weight[COUNT];
    set_up_law(1.7, ratios[k]);
    for (int i = 0; i < COUNT; i++) weight[i] = 1e6 * (i % 3);
    abbe_povray_index alike = abbe_povray_index_fit(lambda_nm, n, NULL, COUNT);
    abbe_povray_index weighted = abbe_povray_index_fit(lambda_nm, n, weight, COUNT);
    assert_near(alike.ior, 1.7, 1e-12);
    assert_near(alike.dispersion, ratios[k], 1e-12);
    assert_near(weighted.ior, 1.7, 1e-12);
    assert_near(weighted.dispersion, ratios[k], 1e-12);
  }
}

/* Of two lines that disagree the fit goes with the one that weighs. */
TEST(weights_decide) {
  double weight[COUNT];
  set_up_law(1.5, 1.02);
  for (int i = 0; i < COUNT; i++) weight[i] = i % 2 == 0;
  for (int i = 1; i < COUNT; i += 2) n[i] += 0.01;
  abbe_povray_index index = abbe_povray_index_fit(lambda_nm, n, weight, COUNT);
  assert_near(index.ior, 1.5, 1e-12);
  index = abbe_povray_index_fit(lambda_nm, n, NULL, COUNT);
  assert_near(index.ior, 1.505, 1e-4);
}

TEST(a_constant_index_has_no_dispersion) {
  set_up_law(1.33, 1);
  abbe_povray_index index = abbe_povray_index_fit(lambda_nm, n, NULL, COUNT);
  assert_near(index.dispersion, 1, 0);
  assert_near(index.ior, 1.33, 1e-14);
  index = abbe_povray_index_fit(lambda_nm, n, NULL, 1);
  assert_near(index.dispersion, 1, 0);
  assert_near(index.ior, 1.33, 1e-14);
}
