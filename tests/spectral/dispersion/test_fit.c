#include "tests/check.h"
#include "tests/random.h"

#include "spectral/dispersion/fit.h"

#include <gsl/gsl_errno.h>

static const abbe_dispersion bk7 = {
    .model = ABBE_DISPERSION_SELLMEIER2,
    .count = 7,
    .c = {0, 1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653}};

static abbe_index_points sampled(const abbe_dispersion *d, double min_nm, double max_nm) {
  abbe_index_points points;
  OK(abbe_index_points_sample(d, min_nm, max_nm, 64, 4001, &points, &error));
  return points;
}

static abbe_fit made(const abbe_index_points *points, abbe_fit_request request) {
  abbe_fit fit;
  OK(abbe_fit_make(points, &request, &fit, &error));
  return fit;
}

/* ---- Cauchy ---- */

TEST(cauchy_coefficients_are_found_again) {
  const abbe_dispersion exact = {
      .model = ABBE_DISPERSION_CAUCHY, .count = 5, .c = {1.5, 4e-3, 1e-4, -2e-5, 3e-6}};
  for (size_t terms = 1; terms <= 5; terms++) {
    abbe_dispersion cut = exact;
    cut.count = terms;
    OWNED(abbe_index_points, points) = sampled(&cut, 380, 780);
    abbe_fit fit = made(&points, (abbe_fit_request){.terms = terms});
    assert_int_equal(fit.dispersion.model, ABBE_DISPERSION_CAUCHY);
    assert_int_equal(fit.dispersion.count, terms);
    assert_int_equal(fit.free, terms);
    for (size_t k = 0; k < terms; k++) assert_near(fit.dispersion.c[k], exact.c[k], 1e-11);
    assert_true(fit.max_error < 1e-13);
  }
}

/* A straight line in x = L^-2 with weights, by its textbook formulas: an independent answer. */
TEST(weights_and_covariance_are_the_straight_lines) {
  double lambda_nm[] = {400, 450, 500, 600, 700};
  double n[] = {1.5251, 1.5199, 1.5161, 1.5112, 1.5080};
  double sigma[] = {5e-5, 2e-5, 1e-5, 2e-5, 4e-5};
  double S = 0, Sx = 0, Sxx = 0, Sy = 0, Sxy = 0, chi = 0;
  for (int i = 0; i < 5; i++) {
    double x = 1e6 / (lambda_nm[i] * lambda_nm[i]), w = 1 / (sigma[i] * sigma[i]);
    S += w, Sx += w * x, Sxx += w * x * x, Sy += w * n[i], Sxy += w * x * n[i];
  }
  double determinant = S * Sxx - Sx * Sx;
  double slope = (S * Sxy - Sx * Sy) / determinant, offset = (Sy - slope * Sx) / S;
  for (int i = 0; i < 5; i++) {
    double x = 1e6 / (lambda_nm[i] * lambda_nm[i]);
    chi += pow((n[i] - offset - slope * x) / sigma[i], 2);
  }
  const abbe_index_points points = {5, lambda_nm, n, sigma, false};
  abbe_fit fit = made(&points, (abbe_fit_request){.terms = 2});
  assert_near(fit.dispersion.c[0], offset, 1e-12);
  assert_near(fit.dispersion.c[1], slope, 1e-12);
  assert_near(fit.covariance[0][0], Sxx / determinant, 1e-10 * Sxx / determinant);
  assert_near(fit.covariance[1][1], S / determinant, 1e-10 * S / determinant);
  assert_near(fit.covariance[0][1], -Sx / determinant, 1e-10 * Sx / determinant);
  assert_near(fit.covariance[1][0], fit.covariance[0][1], 0);
  assert_near(fit.reduced_chi_squared, chi / 3, 1e-9 * chi);
  assert_true(fit.weighted);
  assert_near(abbe_fit_standard_error(&fit, 1), sqrt(S / determinant), 1e-12);

  /* without uncertainties, the residuals give the scale */
  const abbe_index_points plain = {5, lambda_nm, n, NULL, false};
  fit = made(&plain, (abbe_fit_request){.terms = 2});
  double sum = 0, x_mean = 0, xx = 0;
  for (int i = 0; i < 5; i++) {
    sum += pow(n[i] - abbe_dispersion_n(&fit.dispersion, lambda_nm[i]), 2);
    x_mean += 1e6 / (lambda_nm[i] * lambda_nm[i]) / 5;
  }
  for (int i = 0; i < 5; i++) xx += pow(1e6 / (lambda_nm[i] * lambda_nm[i]) - x_mean, 2);
  assert_near(fit.covariance[1][1], sum / 3 / xx, 1e-9 * sum / 3 / xx);
  assert_near(fit.rms, sqrt(sum / 5), 1e-15);
  assert_false(fit.weighted);
}

/* A point with a large uncertainty hardly counts; one with a small one is met. */
TEST(uncertain_points_count_less) {
  double lambda_nm[] = {400, 500, 600, 700}, n[] = {1.525, 1.516, 1.60, 1.508162};
  double sigma[] = {1e-5, 1e-5, 1, 1e-5};
  const abbe_index_points points = {4, lambda_nm, n, sigma, false};
  abbe_fit fit = made(&points, (abbe_fit_request){.terms = 2});
  assert_near(fit.dispersion.c[0], 1.5, 5e-5);
  assert_near(fit.dispersion.c[1], 0.004, 1e-5);
  assert_near(fit.max_nm_of_error, 600, 0);
  assert_near(fit.max_error, 1.60 - (1.5 + 0.004 / 0.36), 1e-4);
}

/* Over many repeated measurements the coefficients scatter as the covariance says. */
TEST(standard_errors_are_the_scatter) {
  enum { RUNS = 2000, COUNT = 12 };
  uint64_t random = 7;
  double lambda_nm[COUNT], n[COUNT], sigma[COUNT], sum[2] = {0}, squares[2] = {0}, cross = 0;
  abbe_fit fit = {0};
  for (int run = 0; run < RUNS; run++) {
    for (int i = 0; i < COUNT; i++) {
      lambda_nm[i] = 400 + 30 * i;
      sigma[i] = 1e-5 * (1 + i % 3);
      n[i] = 1.5 + 4e3 / (lambda_nm[i] * lambda_nm[i]) + sigma[i] * random_normal(&random);
    }
    const abbe_index_points points = {COUNT, lambda_nm, n, sigma, false};
    fit = made(&points, (abbe_fit_request){.terms = 2});
    double off[2] = {fit.dispersion.c[0] - 1.5, fit.dispersion.c[1] - 0.004};
    for (int k = 0; k < 2; k++) sum[k] += off[k], squares[k] += off[k] * off[k];
    cross += off[0] * off[1];
  }
  for (int k = 0; k < 2; k++) {
    double error = abbe_fit_standard_error(&fit, (size_t)k);
    assert_near(sum[k] / RUNS, 0, 4 * error / sqrt(RUNS));
    /* the variance of a variance of normal numbers is 2 / RUNS of its square */
    assert_near(squares[k] / RUNS / (error * error), 1, 4 * sqrt(2.0 / RUNS));
  }
  assert_near(cross / RUNS / fit.covariance[0][1], 1, 0.15);
}

TEST(only_points_of_the_range_are_used) {
  double lambda_nm[] = {300, 400, 500, 600, 900};
  double n[] = {3, 1.525, 1.516, 1.5 + 0.004 / 0.36, 3};
  const abbe_index_points points = {5, lambda_nm, n, NULL, false};
  abbe_fit fit = made(&points, (abbe_fit_request){.terms = 2, .min_nm = 380, .max_nm = 780});
  assert_int_equal(fit.points, 3);
  assert_near(fit.min_nm, 400, 0);
  assert_near(fit.max_nm, 600, 0);
  assert_near(fit.dispersion.c[1], 0.004, 1e-12);
}

TEST(as_many_points_as_coefficients_leave_no_error_bar) {
  double lambda_nm[] = {400, 600}, n[] = {1.525, 1.511}, sigma[] = {1e-5, 1e-5};
  abbe_index_points points = {2, lambda_nm, n, NULL, false};
  abbe_fit fit = made(&points, (abbe_fit_request){.terms = 2});
  assert_true(fit.max_error < 1e-15);
  assert_true(isnan(fit.reduced_chi_squared));
  assert_true(isnan(abbe_fit_standard_error(&fit, 0)));
  points.uncertainty = sigma;
  fit = made(&points, (abbe_fit_request){.terms = 2});
  double x = 1 / 0.16 - 1 / 0.36;
  assert_near(abbe_fit_standard_error(&fit, 1), sqrt(2) * 1e-5 / x, 1e-12);
}

TEST(many_terms_are_fitted_until_doubles_end) {
  OWNED(abbe_index_points, points) = sampled(&bk7, 380, 780);
  double before = INFINITY;
  for (size_t terms = 1; terms <= 16; terms++) {
    abbe_fit fit = made(&points, (abbe_fit_request){.terms = terms});
    assert_true(fit.max_error < before);
    before = fit.max_error;
  }
  assert_true(before < 1e-9);
  abbe_fit fit;
  REFUSED(ABBE_INVALID_ARGUMENT, "cancel beyond double precision",
          abbe_fit_make(&points, &(abbe_fit_request){.terms = 32}, &fit, &error));
}

/* ---- Sellmeier ---- */

/* The published coefficients of glasses come back from the indices that they give. */
TEST(published_sellmeier_coefficients_are_found_again) {
  const struct {
    abbe_dispersion glass;
    double min_nm, max_nm;
  } cases[] = {
      {bk7, 300, 2500},
      {{.model = ABBE_DISPERSION_SELLMEIER2,
        .count = 7,
        .c = {0, 1.61625977, 0.0127534559, 0.259229334, 0.0581983954, 1.07762317, 116.60768}},
       380,
       2500},
      /* fused silica [Malitson1965], its poles squared */
      {FIELDS(.model = ABBE_DISPERSION_SELLMEIER2, .count = 7,
              .c = {0, 0.6961663, 0.0684043 * 0.0684043, 0.4079426, 0.1162414 * 0.1162414,
                    0.8974794, 9.896161 * 9.896161}),
       210, 6700},
      /* diamond [Peter1923]: two poles, none beyond the red */
      {{.model = ABBE_DISPERSION_SELLMEIER2,
        .count = 5,
        .c = {0, 4.3356, 0.106 * 0.106, 0.3306, 0.175 * 0.175}},
       226,
       760},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    MADE(abbe_index_points, points,
         abbe_index_points_sample(&cases[i].glass, cases[i].min_nm, cases[i].max_nm, 2, 200,
                                  &points, &error));
    abbe_fit fit = made(
        &points, (abbe_fit_request){.form = ABBE_FIT_SELLMEIER, .terms = cases[i].glass.count / 2});
    assert_int_equal(fit.dispersion.model, ABBE_DISPERSION_SELLMEIER2);
    assert_int_equal(fit.dispersion.count, cases[i].glass.count);
    for (size_t k = 0; k < fit.dispersion.count; k++)
      assert_near(fit.dispersion.c[k], cases[i].glass.c[k], 1e-6 * fabs(cases[i].glass.c[k]));
    assert_true(fit.max_error < 1e-10);
  }
}

/* Any glass of two terms, one on either side of the light: the curve is met. */
TEST(random_sellmeier_curves_are_met) {
  uint64_t random = 3;
  for (int i = 0; i < 12; i++) {
    abbe_dispersion d =
        FIELDS(.model = ABBE_DISPERSION_SELLMEIER2, .count = 5,
               .c = {0, random_between(&random, 0.8, 3.5), random_between(&random, 0.004, 0.04),
                     random_between(&random, 0.2, 3), random_between(&random, 50, 300)});
    MADE(abbe_index_points, points,
         abbe_index_points_sample(&d, 350, 2000, 2, 120, &points, &error));
    abbe_fit fit = made(&points, (abbe_fit_request){.form = ABBE_FIT_SELLMEIER, .terms = 2});
    if (!(fit.max_error < 1e-9))
      fail_msg("%d: B %g C %g, B %g C %g is missed by %g", i, d.c[1], d.c[2], d.c[3], d.c[4],
               fit.max_error);
  }
}

TEST(sellmeier_errors_cover_the_truth) {
  enum { COUNT = 40, RUNS = 40 };
  uint64_t random = 11;
  double lambda_nm[COUNT], n[COUNT], sigma[COUNT];
  const abbe_dispersion truth = {
      .model = ABBE_DISPERSION_SELLMEIER2, .count = 5, .c = {0, 1.3, 0.011, 1.0, 110}};
  double squares[5] = {0};
  for (int run = 0; run < RUNS; run++) {
    for (int i = 0; i < COUNT; i++) {
      lambda_nm[i] = 350 + 50 * i;
      sigma[i] = 1e-6;
      n[i] = abbe_dispersion_n(&truth, lambda_nm[i]) + sigma[i] * random_normal(&random);
    }
    const abbe_index_points points = {COUNT, lambda_nm, n, sigma, false};
    abbe_fit fit = made(&points, (abbe_fit_request){.form = ABBE_FIT_SELLMEIER, .terms = 2});
    for (size_t k = 1; k < 5; k++)
      squares[k] +=
          pow((fit.dispersion.c[k] - truth.c[k]) / abbe_fit_standard_error(&fit, k), 2) / RUNS;
    assert_near(fit.covariance[0][0], 0, 0);
    assert_near(fit.reduced_chi_squared, 1, 5 * sqrt(2.0 / (COUNT - 4)));
  }
  for (size_t k = 1; k < 5; k++) assert_near(squares[k], 1, 5 * sqrt(2.0 / RUNS));
}

/* ---- refusals ---- */

static int handled;
static void hosts_handler(const char *reason, const char *file, int line, int number) {
  (void)reason, (void)file, (void)line, (void)number;
  handled++;
}

TEST(what_cannot_be_is_refused) {
  double lambda_nm[] = {486.1, 486.1, 587.6, 656.3}, n[] = {1.5224, 1.5223, 1.5168, 1.5143};
  const abbe_index_points points = {4, lambda_nm, n, NULL, false};
  const struct {
    abbe_fit_request request;
    const char *part;
  } cases[] = {
      {{.terms = 33}, "33 terms is asked for; 1 to 32"},
      {{.form = ABBE_FIT_SELLMEIER, .terms = 5}, "1 to 4 are possible"},
      {{.form = (abbe_fit_form)7}, "no form 7"},
      {{.terms = 4}, "4 coefficients, and there are points at only 3 wavelengths"},
      {{.form = ABBE_FIT_SELLMEIER, .terms = 2}, "4 coefficients"},
      {{.terms = 2, .min_nm = 600, .max_nm = 700}, "only 1 wavelength (656.3 to 656.3 nm)"},
      {{.terms = 1, .min_nm = 700, .max_nm = 800}, "no point lies in the range"},
      {{.terms = 1, .min_nm = 800, .max_nm = 700}, "800:700"},
      {{.terms = 1, .min_nm = NAN, .max_nm = 700}, "nan"},
      {{.terms = 1, .min_nm = -5, .max_nm = 700}, "-5:700"},
      {{.terms = 1, .min_nm = 5, .max_nm = INFINITY}, "inf"},
  };
  handled = 0;
  gsl_error_handler_t *before = gsl_set_error_handler(hosts_handler);
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    abbe_fit fit;
    REFUSED(ABBE_INVALID_ARGUMENT, cases[i].part,
            abbe_fit_make(&points, &cases[i].request, &fit, &error));
    assert_int_equal(fit.points, 0);
  }
  assert_int_equal(handled, 0);
  assert_ptr_equal(gsl_set_error_handler(before), hosts_handler);
}

/* Over 10 nm, and known to 1e-4 only, B cannot be told from zero; over 300 nm it can. */
TEST(a_range_too_small_for_the_data_is_refused) {
  enum { COUNT = 11 };
  double lambda_nm[COUNT], n[COUNT], sigma[COUNT];
  const double from[] = {580, 400}, step[] = {1, 30};
  uint64_t random = 5;
  for (int wide = 0; wide < 2; wide++) {
    for (int i = 0; i < COUNT; i++) {
      lambda_nm[i] = from[wide] + step[wide] * i;
      sigma[i] = 1e-3;
      n[i] = abbe_dispersion_n(&bk7, lambda_nm[i]) + 1e-4 * random_normal(&random);
    }
    const abbe_index_points points = {COUNT, lambda_nm, n, sigma, false};
    abbe_fit fit;
    abbe_error why = {0};
    abbe_result result = abbe_fit_make(&points, &(abbe_fit_request){.terms = 2}, &fit, &why);
    assert_int_equal(result, wide ? ABBE_OK : ABBE_INVALID_ARGUMENT);
    if (!wide) {
      assert_contains(why.text, "do not support a Cauchy fit of 2 terms over 580 to 590 nm");
      assert_contains(why.text, "standard error");
    }
  }
  OWNED(abbe_index_points, points) = sampled(&bk7, 500, 500.0000001);
  abbe_fit fit;
  REFUSED(ABBE_INVALID_ARGUMENT, "too narrow",
          abbe_fit_make(&points, &(abbe_fit_request){.terms = 2}, &fit, &error));
}

/* Indices printed to five digits over the visible do not carry three Sellmeier terms. */
TEST(sellmeier_terms_that_the_points_do_not_carry_are_refused) {
  const double lines_nm[] = {404.66, 435.83, 479.99, 486.13, 546.07, 587.56, 589.29, 632.8, 656.27};
  double lambda_nm[9], n[9];
  for (int i = 0; i < 9; i++) {
    lambda_nm[i] = lines_nm[i];
    n[i] = round(abbe_dispersion_n(&bk7, lines_nm[i]) * 1e5) / 1e5;
  }
  const abbe_index_points points = {9, lambda_nm, n, NULL, false};
  abbe_fit fit;
  abbe_fit_request request = {.form = ABBE_FIT_SELLMEIER, .terms = 3};
  REFUSED(ABBE_INVALID_ARGUMENT, "fewer terms", abbe_fit_make(&points, &request, &fit, &error));
  request.terms = 1;
  OK(abbe_fit_make(&points, &request, &fit, &error));
  assert_true(fit.max_error < 2e-4);
  n[3] = 0.99;
  REFUSED(ABBE_INVALID_ARGUMENT, "n is 0.99 at 486.13 nm",
          abbe_fit_make(&points, &request, &fit, &error));
}

/* ---- of another curve ---- */

TEST(a_cauchy_curve_is_found_again) {
  const abbe_dispersion exact = {.model = ABBE_DISPERSION_CAUCHY,
                                 .count = 8,
                                 .c = {1.5, 4e-3, 1e-4, -2e-5, 3e-6, -1e-6, 2e-7, -1e-8}};
  for (size_t terms = 1; terms <= 8; terms++) {
    abbe_dispersion cut = exact, found;
    double worst = NAN;
    cut.count = terms;
    OK(abbe_fit_dispersion(&cut, terms, 380, 780, &found, &worst, &error));
    assert_int_equal(found.model, ABBE_DISPERSION_CAUCHY);
    assert_int_equal(found.count, terms);
    assert_true(worst < 1e-11);
    for (size_t k = 0; k < terms && terms <= 4; k++) assert_near(found.c[k], exact.c[k], 1e-10);
  }
}

/* The two-term form by the normal equations, written out: an independent answer. */
TEST(two_terms_agree_with_the_normal_equations) {
  double n = 0, sx = 0, sxx = 0, sy = 0, sxy = 0, worst = 0, told = 0;
  for (int l = 380; l <= 780; l++) {
    double x = 1e6 / (double)(l * l), y = abbe_dispersion_n(&bk7, l);
    n++, sx += x, sxx += x * x, sy += y, sxy += x * y;
  }
  double b = (n * sxy - sx * sy) / (n * sxx - sx * sx), a = (sy - b * sx) / n;
  for (int l = 380; l <= 780; l++)
    worst = fmax(worst, fabs(a + b * 1e6 / (double)(l * l) - abbe_dispersion_n(&bk7, l)));
  abbe_dispersion found;
  OK(abbe_fit_dispersion(&bk7, 2, 380, 780, &found, &told, &error));
  assert_near(found.c[0], a, 1e-11);
  assert_near(found.c[1], b, 1e-11);
  assert_near(told, worst, 1e-11);
}

TEST(more_terms_fit_better) {
  double before = INFINITY;
  for (size_t terms = 1; terms <= 6; terms++) {
    abbe_dispersion found;
    double worst = NAN;
    OK(abbe_fit_dispersion(&bk7, terms, 380, 780, &found, &worst, &error));
    assert_true(worst < before);
    before = worst;
  }
  assert_true(before < 1e-5);
}

TEST(odd_ranges_of_a_curve_are_fitted) {
  abbe_dispersion found;
  double worst = NAN;
  OK(abbe_fit_dispersion(&bk7, 3, 550, 550.5, &found, &worst, &error));
  assert_true(worst < 1e-9);
  OK(abbe_fit_dispersion(&bk7, 2, 380.25, 779.5, &found, &worst, &error));
  assert_true(worst < 3e-4);
  const abbe_dispersion flat = {.model = ABBE_DISPERSION_CONSTANT, .count = 1, .c = {1.5}};
  OK(abbe_fit_dispersion(&flat, 3, 1, 1e6, &found, &worst, &error));
  assert_true(worst < 1e-6); /* nearly all points are at one end of 1 / L^2 */
}

TEST(a_curve_that_cannot_be_fitted_is_refused) {
  const struct {
    size_t terms;
    double min_nm, max_nm;
    const char *part;
  } cases[] = {
      {0, 380, 780, "0 terms"},      {9, 380, 780, "9 terms"},
      {2, 780, 380, "780:380"},      {2, 500, 500, "500:500"},
      {2, NAN, 780, "nan"},          {2, 380, INFINITY, "inf"},
      {2, -1, 780, "-1:780"},        {2, 0, 780, "0:780"},
      {2, 1e-200, 780, "too wide"},  {2, 500, 500.00000000001, "too narrow"},
      {2, 50, 780, "no real index"},
  };
  handled = 0;
  gsl_error_handler_t *before = gsl_set_error_handler(hosts_handler);
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    abbe_dispersion found;
    REFUSED(ABBE_INVALID_ARGUMENT, cases[i].part,
            abbe_fit_dispersion(&bk7, cases[i].terms, cases[i].min_nm, cases[i].max_nm, &found,
                                NULL, &error));
  }
  assert_int_equal(handled, 0);
  assert_ptr_equal(gsl_set_error_handler(before), hosts_handler);
}
