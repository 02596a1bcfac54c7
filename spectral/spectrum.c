#include "spectral/spectrum.h"

#include "base/maths.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_interp.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

struct abbe_spectrum {
  size_t count;
  double *lambda_nm, *value;
  abbe_interpolation interpolation;
  double *slope;      /* [count] of a monotone curve of three points or more; else NULL */
  gsl_interp *interp; /* NULL for a single point and where there are slopes */
};

const char *abbe_interpolation_name(abbe_interpolation interpolation) {
  switch (interpolation) {
  case ABBE_INTERPOLATION_LINEAR:
    return "linear";
  case ABBE_INTERPOLATION_MONOTONE:
    return "monotone";
  case ABBE_INTERPOLATION_SPLINE:
    return "spline";
  }
  return "unknown";
}

static abbe_result check(const double *lambda_nm, const double *value, size_t count,
                         abbe_error *error) {
  if (count < 1 || count > ABBE_SPECTRUM_MAX_COUNT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a spectrum of %zu points is asked for; 1 to %d are possible", count,
                          ABBE_SPECTRUM_MAX_COUNT);
  for (size_t i = 0; i < count; i++) {
    if (!isfinite(lambda_nm[i]) || lambda_nm[i] <= 0)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "wavelength %g nm (point %zu) is not a finite number above 0",
                            lambda_nm[i], i + 1);
    if (i > 0 && lambda_nm[i] <= lambda_nm[i - 1])
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "wavelength %g nm (point %zu) follows %g nm; wavelengths must ascend",
                            lambda_nm[i], i + 1, lambda_nm[i - 1]);
    if (!isfinite(value[i]))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "the value %g at %g nm (point %zu) is not finite", value[i],
                            lambda_nm[i], i + 1);
  }
  return ABBE_OK;
}

/* GSL's own Steffen curve ends with the slopes of its outer intervals, which the paper does not. */
static bool is_steffen(abbe_interpolation interpolation, size_t count) {
  return interpolation == ABBE_INTERPOLATION_MONOTONE && count >= 3;
}

static const gsl_interp_type *method(abbe_interpolation interpolation, size_t count) {
  return count < 3 || interpolation == ABBE_INTERPOLATION_LINEAR ? gsl_interp_linear
                                                                 : gsl_interp_cspline;
}

static bool allocate(abbe_spectrum *spectrum, abbe_interpolation interpolation) {
  size_t count = spectrum->count;
  const bool steffen = is_steffen(interpolation, count);
  spectrum->lambda_nm = malloc(count * sizeof(double));
  spectrum->value = malloc(count * sizeof(double));
  if (steffen) spectrum->slope = malloc(count * sizeof(double));
  if (count > 1 && !steffen) {
    abbe_gsl_guard_enter();
    spectrum->interp = gsl_interp_alloc(method(interpolation, count), count);
    abbe_gsl_guard_leave();
  }
  return spectrum->lambda_nm != NULL && spectrum->value != NULL &&
         (count == 1 || spectrum->interp != NULL || spectrum->slope != NULL);
}

static double secant(const abbe_spectrum *s, size_t interval) {
  return (s->value[interval + 1] - s->value[interval]) /
         (s->lambda_nm[interval + 1] - s->lambda_nm[interval]);
}

/* [Steffen1990]: the slope of the parabola through three points, at the middle one, held to twice
 * the flatter secant, and flat at an extremum. */
static double inner_slope(const abbe_spectrum *s, size_t i) {
  const double left = secant(s, i - 1), right = secant(s, i);
  const double before = s->lambda_nm[i] - s->lambda_nm[i - 1];
  const double after = s->lambda_nm[i + 1] - s->lambda_nm[i];
  if (!(left * right > 0)) return left * right <= 0 ? 0 : NAN;
  const double parabola = left * (after / (before + after)) + right * (before / (before + after));
  return copysign(fmin(fabs(parabola), 2 * fmin(fabs(left), fabs(right))), left);
}

/* [Steffen1990]: the slope of the parabola through the last three points, at the outer one, held
 * between flat and twice the outer secant. */
static double end_slope(double outer, double inner, double outer_nm, double inner_nm) {
  const double parabola = outer + (outer - inner) * (outer_nm / (outer_nm + inner_nm));
  if (!(parabola * outer > 0)) return parabola * outer <= 0 ? 0 : NAN;
  return copysign(fmin(fabs(parabola), 2 * fabs(outer)), outer);
}

static void find_slopes(abbe_spectrum *s) {
  const double *l = s->lambda_nm;
  const size_t last = s->count - 1;
  for (size_t i = 1; i < last; i++) s->slope[i] = inner_slope(s, i);
  s->slope[0] = end_slope(secant(s, 0), secant(s, 1), l[1] - l[0], l[2] - l[1]);
  s->slope[last] = end_slope(secant(s, last - 1), secant(s, last - 2), l[last] - l[last - 1],
                             l[last - 1] - l[last - 2]);
}

/* Evaluates the cubic in one interval, at a share t of it: its value, or its integral from the
 * interval's beginning, over the width. */
static double cubic(const abbe_spectrum *s, size_t i, double t, bool integral) {
  const double width = s->lambda_nm[i + 1] - s->lambda_nm[i], y = s->value[i];
  const double rise = s->value[i + 1] - y, from = width * s->slope[i], to = width * s->slope[i + 1];
  const double square = 3 * rise - 2 * from - to, cube = from + to - 2 * rise;
  if (integral) return t * (y + t * (from / 2 + t * (square / 3 + t * cube / 4)));
  return y + t * (from + t * (square + t * cube));
}

/* Finite points can still make slopes that overflow. */
static bool usable(abbe_spectrum *spectrum) {
  if (spectrum->count == 1) return true;
  if (spectrum->slope != NULL) {
    find_slopes(spectrum);
  } else {
    abbe_gsl_guard_enter();
    int status =
        gsl_interp_init(spectrum->interp, spectrum->lambda_nm, spectrum->value, spectrum->count);
    abbe_gsl_guard_leave();
    if (status != GSL_SUCCESS) return false;
  }
  const double *l = spectrum->lambda_nm;
  for (size_t i = 1; i < spectrum->count; i++) {
    const double middle = spectrum->slope != NULL
                              ? cubic(spectrum, i - 1, 0.5, false)
                              : abbe_spectrum_at(spectrum, l[i - 1] + (l[i] - l[i - 1]) / 2);
    if (!isfinite(middle)) return false;
  }
  return true;
}

abbe_result abbe_spectrum_make(const double *lambda_nm, const double *value, size_t count,
                               abbe_interpolation interpolation, abbe_spectrum **out,
                               abbe_error *error) {
  *out = NULL;
  ABBE_TRY(check(lambda_nm, value, count, error));
  abbe_spectrum *made = calloc(1, sizeof *made);
  if (made != NULL) *made = (struct abbe_spectrum){.count = count, .interpolation = interpolation};
  if (made == NULL || !allocate(made, interpolation)) {
    abbe_spectrum_free(made);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a spectrum of %zu points", count);
  }
  memcpy(made->lambda_nm, lambda_nm, count * sizeof(double));
  memcpy(made->value, value, count * sizeof(double));
  if (!usable(made)) {
    abbe_spectrum_free(made);
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the values of the spectrum are too large or too close together to be "
                          "interpolated");
  }
  *out = made;
  return ABBE_OK;
}

void abbe_spectrum_free(abbe_spectrum *spectrum) {
  if (spectrum == NULL) return;
  free(spectrum->lambda_nm);
  free(spectrum->value);
  free(spectrum->slope);
  if (spectrum->interp != NULL) gsl_interp_free(spectrum->interp);
  free(spectrum);
}

static double share_of(const abbe_spectrum *s, size_t i, double lambda_nm) {
  return (lambda_nm - s->lambda_nm[i]) / (s->lambda_nm[i + 1] - s->lambda_nm[i]);
}

static double cubic_integral(const abbe_spectrum *s, double from_nm, double to_nm) {
  const double *l = s->lambda_nm;
  const size_t first = gsl_interp_bsearch(l, from_nm, 0, s->count - 1);
  const size_t last = gsl_interp_bsearch(l, to_nm, 0, s->count - 1);
  double sum = 0;
  for (size_t i = first; i <= last; i++) {
    const double end = i == last ? share_of(s, i, to_nm) : 1;
    const double start = i == first ? share_of(s, i, from_nm) : 0;
    sum += (l[i + 1] - l[i]) * (cubic(s, i, end, true) - cubic(s, i, start, true));
  }
  return sum;
}

/* No lookup accelerator is passed: it would be shared state between threads. */
double abbe_spectrum_at(const abbe_spectrum *spectrum, double lambda_nm) {
  const double *l = spectrum->lambda_nm, *v = spectrum->value;
  size_t last = spectrum->count - 1;
  if (isnan(lambda_nm)) return NAN;
  if (lambda_nm <= l[0]) return v[0];
  if (lambda_nm >= l[last]) return v[last];
  if (spectrum->slope != NULL) {
    const size_t i = gsl_interp_bsearch(l, lambda_nm, 0, last);
    return cubic(spectrum, i, share_of(spectrum, i, lambda_nm), false);
  }
  double y = NAN;
  gsl_interp_eval_e(spectrum->interp, l, v, lambda_nm, NULL, &y);
  return y;
}

double abbe_spectrum_integral(const abbe_spectrum *spectrum, double from_nm, double to_nm) {
  const double *l = spectrum->lambda_nm, *v = spectrum->value;
  size_t last = spectrum->count - 1;
  if (!(from_nm <= to_nm)) return NAN;
  double below = fmin(to_nm, l[0]) - fmin(from_nm, l[0]);
  double above = fmax(to_nm, l[last]) - fmax(from_nm, l[last]);
  double sum = v[0] * below + v[last] * above;
  double a = fmax(from_nm, l[0]), b = fmin(to_nm, l[last]);
  if (a >= b) return sum;
  if (spectrum->slope != NULL) return sum + cubic_integral(spectrum, a, b);
  double inner = NAN;
  gsl_interp_eval_integ_e(spectrum->interp, l, v, a, b, NULL, &inner);
  return sum + inner;
}

size_t abbe_spectrum_count(const abbe_spectrum *spectrum) {
  return spectrum->count;
}
const double *abbe_spectrum_lambda_nm(const abbe_spectrum *spectrum) {
  return spectrum->lambda_nm;
}
const double *abbe_spectrum_value(const abbe_spectrum *spectrum) {
  return spectrum->value;
}

abbe_interpolation abbe_spectrum_interpolation(const abbe_spectrum *spectrum) {
  return spectrum->interpolation;
}
