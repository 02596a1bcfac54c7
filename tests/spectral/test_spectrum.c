#include "tests/check.h"

#include "spectral/spectrum.h"

#include <gsl/gsl_errno.h>
#include <pthread.h>

HOLDS(abbe_spectrum);

static const abbe_interpolation methods[] = {ABBE_INTERPOLATION_LINEAR, ABBE_INTERPOLATION_MONOTONE,
                                             ABBE_INTERPOLATION_SPLINE};

static abbe_spectrum *make(const double *l, const double *v, size_t count,
                           abbe_interpolation interpolation) {
  abbe_spectrum *spectrum = NULL;
  OK(abbe_spectrum_make(l, v, count, interpolation, &spectrum, &error));
  return spectrum;
}

static double bk7(double nm) {
  const double l = nm * nm / 1e6;
  return sqrt(1 + 1.03961212 * l / (l - 0.00600069867) + 0.231792344 * l / (l - 0.0200179144) +
              1.01046945 * l / (l - 103.560653));
}

TEST(every_method_passes_through_its_points) {
  const double l[] = {400, 450, 470, 600, 700}, v[] = {1, 5, -2, 0, 3};
  for (int m = 0; m < 3; m++) {
    HELD(abbe_spectrum, s) = make(l, v, 5, methods[m]);
    for (int i = 0; i < 5; i++) assert_near(abbe_spectrum_at(s, l[i]), v[i], 1e-12);
    assert_near(abbe_spectrum_at(s, 100), 1, 0);
    assert_near(abbe_spectrum_at(s, 1e300), 3, 0);
    assert_true(isnan(abbe_spectrum_at(s, NAN)));
    assert_int_equal(abbe_spectrum_count(s), 5);
    assert_near(abbe_spectrum_lambda_nm(s)[2], 470, 0);
    assert_near(abbe_spectrum_value(s)[2], -2, 0);
  }
}

TEST(methods_differ_as_they_should) {
  const double l[] = {400, 500, 600, 700}, v[] = {0, 0, 1, 1};
  HELD(abbe_spectrum, linear) = make(l, v, 4, ABBE_INTERPOLATION_LINEAR);
  HELD(abbe_spectrum, monotone) = make(l, v, 4, ABBE_INTERPOLATION_MONOTONE);
  HELD(abbe_spectrum, spline) = make(l, v, 4, ABBE_INTERPOLATION_SPLINE);
  assert_near(abbe_spectrum_at(linear, 525), 0.25, 1e-14);
  /* between flat neighbours Steffen's piece is the smoothstep 3t^2 - 2t^3 */
  assert_near(abbe_spectrum_at(monotone, 525), 3 * 0.0625 - 2 * 0.015625, 1e-14);
  /* natural spline through 0 0 1 1: M1 = 2, M2 = -2 on unit spacing, so s(1/4) by hand */
  double m1 = 2, t = 0.25, u = 0.75;
  double by_hand = (m1 * u * u * u - m1 * t * t * t) / 6 - m1 / 6 * u + (1 + m1 / 6) * t;
  assert_near(abbe_spectrum_at(spline, 525), by_hand, 1e-12);
  double least = 0;
  for (double x = 400; x < 700; x++) {
    double y = abbe_spectrum_at(monotone, x);
    assert_true(y >= 0 && y <= 1);
    least = fmin(least, abbe_spectrum_at(spline, x));
  }
  assert_true(least < -0.01); /* the spline does overshoot */
}

/* The curve of a parabola that rises in every interval is that parabola, to both ends. */
TEST(monotone_is_exact_for_a_parabola) {
  const double l[] = {400, 450, 520, 600, 710};
  double v[5], reversed[5];
  for (int i = 0; i < 5; i++) v[i] = (l[i] - 200) * (l[i] - 200) / 1e4;
  for (int i = 0; i < 5; i++) reversed[i] = (l[i] - 900) * (l[i] - 900) / 1e4;
  HELD(abbe_spectrum, rising) = make(l, v, 5, ABBE_INTERPOLATION_MONOTONE);
  HELD(abbe_spectrum, falling) = make(l, reversed, 5, ABBE_INTERPOLATION_MONOTONE);
  for (double x = 400; x <= 710; x += 2.5) {
    assert_near(abbe_spectrum_at(rising, x), (x - 200) * (x - 200) / 1e4, 1e-13);
    assert_near(abbe_spectrum_at(falling, x), (x - 900) * (x - 900) / 1e4, 1e-13);
  }
  assert_near(abbe_spectrum_integral(rising, 410, 700), (125e6 - 9261e3) / 3e4, 1e-9);
}

/* At an end the parabola's slope is held between 0 and twice the outer secant [Steffen1990]. */
TEST(slopes_at_the_ends_of_a_monotone_curve_are_limited) {
  const double l[] = {400, 500, 600};
  HELD(abbe_spectrum, flat) = make(l, (double[]){0, 1, 10}, 3, ABBE_INTERPOLATION_MONOTONE);
  HELD(abbe_spectrum, steep) = make(l, (double[]){0, 1, -9}, 3, ABBE_INTERPOLATION_MONOTONE);
  assert_near(abbe_spectrum_at(flat, 450), 0.25, 1e-14);  /* slopes 0 and 2 a step */
  assert_near(abbe_spectrum_at(steep, 450), 0.75, 1e-14); /* slopes 2 and 0 a step */
}

/* N-BK7 by Schott's formula [Schott2014] at 400 to 700 nm in steps of 30. */
TEST(monotone_follows_a_glass_in_its_first_interval) {
  double l[11], v[11], worst = 0;
  for (int i = 0; i < 11; i++) l[i] = 400 + 30 * i;
  for (int i = 0; i < 11; i++) v[i] = bk7(l[i]);
  HELD(abbe_spectrum, s) = make(l, v, 11, ABBE_INTERPOLATION_MONOTONE);
  for (double x = 400; x < 430; x++) worst = fmax(worst, fabs(abbe_spectrum_at(s, x) - bk7(x)));
  assert_true(worst < 1.6e-5);
}

TEST(one_and_two_points_work_with_every_method) {
  const double l[] = {500, 600}, v[] = {2, 4};
  for (int m = 0; m < 3; m++) {
    HELD(abbe_spectrum, one) = make(l, v, 1, methods[m]), *two = make(l, v, 2, methods[m]);
    assert_near(abbe_spectrum_at(one, 1), 2, 0);
    assert_near(abbe_spectrum_integral(one, 400, 700), 600, 1e-12);
    assert_near(abbe_spectrum_integral(one, 510, 520), 20, 1e-12);
    assert_near(abbe_spectrum_at(two, 525), 2.5, 1e-14);
  }
}

TEST(integrals_are_exact) {
  const double l[] = {400, 500, 700}, v[] = {1, 3, 1};
  HELD(abbe_spectrum, s) = make(l, v, 3, ABBE_INTERPOLATION_LINEAR);
  assert_near(abbe_spectrum_integral(s, 400, 700), 200 + 400, 1e-11);
  assert_near(abbe_spectrum_integral(s, 450, 600), 125 + 250, 1e-11);
  assert_near(abbe_spectrum_integral(s, 300, 800), 100 + 600 + 100, 1e-11);
  assert_near(abbe_spectrum_integral(s, 100, 200), 100, 1e-11);
  assert_near(abbe_spectrum_integral(s, 900, 1000), 100, 1e-11);
  assert_near(abbe_spectrum_integral(s, 480, 480), 0, 0);
}

TEST(integrals_agree_with_sums_and_add_up) {
  const double l[] = {400, 450, 470, 600, 700}, v[] = {1, 5, -2, 0, 3};
  for (int m = 0; m < 3; m++) {
    HELD(abbe_spectrum, s) = make(l, v, 5, methods[m]);
    double sum = 0, parts = 0;
    enum { STEPS = 200000 };
    for (int i = 0; i < STEPS; i++)
      sum += abbe_spectrum_at(s, 390 + 320 * (i + 0.5) / STEPS) * 320 / STEPS;
    for (int i = 0; i < 64; i++) parts += abbe_spectrum_integral(s, 390 + 5 * i, 395 + 5 * i);
    assert_near(abbe_spectrum_integral(s, 390, 710), sum, 1e-5);
    assert_near(abbe_spectrum_integral(s, 390, 710), parts, 1e-9);
  }
}

static void refuses(const double *l, const double *v, size_t count, const char *part) {
  for (int m = 0; m < 3; m++) {
    abbe_spectrum *s = NULL;
    REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_spectrum_make(l, v, count, methods[m], &s, &error));
    assert_null(s);
    assert_contains(last_error.text, part);
  }
}

TEST(what_is_no_spectrum_is_refused) {
  const double v[] = {1, 2, 3};
  refuses(v, v, 0, "0 points");
  refuses(v, v, ABBE_SPECTRUM_MAX_COUNT + 1, "65537");
  refuses((double[]){400, 400, 500}, v, 3, "ascend");
  refuses((double[]){400, 390, 500}, v, 3, "390");
  refuses((double[]){0, 390, 500}, v, 3, "above 0");
  refuses((double[]){400, NAN, 500}, v, 3, "point 2");
  refuses((double[]){400, 450, INFINITY}, v, 3, "point 3");
  refuses((double[]){400, 450, 500}, (double[]){1, NAN, 1}, 3, "not finite");
}

static int handled;
static void hosts_handler(const char *reason, const char *file, int line, int number) {
  (void)reason, (void)file, (void)line, (void)number;
  handled++;
}

TEST(overflow_is_refused_and_the_hosts_handler_kept) {
  gsl_error_handler_t *before = gsl_set_error_handler(hosts_handler);
  const double l[] = {400, 400.0000001, 500, 600}, v[] = {1e308, -1e308, 1e308, -1e308};
  abbe_spectrum *s = NULL;
  assert_int_equal(abbe_spectrum_make(l, v, 4, ABBE_INTERPOLATION_SPLINE, &s, NULL),
                   ABBE_INVALID_ARGUMENT);
  assert_int_equal(handled, 0);
  assert_ptr_equal(gsl_set_error_handler(before), hosts_handler);
}

static void *read_many(void *data) {
  double sum = 0;
  for (int i = 0; i < 100000; i++) sum += abbe_spectrum_at(data, 380 + i % 400);
  double *out = malloc(sizeof *out);
  if (out != NULL) *out = sum;
  return out;
}

TEST(threads_read_the_same) {
  const double l[] = {400, 450, 470, 600, 700}, v[] = {1, 5, -2, 0, 3};
  HELD(abbe_spectrum, s) = make(l, v, 5, ABBE_INTERPOLATION_SPLINE);
  pthread_t threads[4];
  FREED double *alone = read_many(s);
  for (int i = 0; i < 4; i++) assert_int_equal(pthread_create(&threads[i], NULL, read_many, s), 0);
  for (int i = 0; i < 4; i++) {
    FREED void *sum = NULL;
    pthread_join(threads[i], &sum);
    assert_near(*(double *)sum, *alone, 0);
  }
}
