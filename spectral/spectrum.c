#include "spectral/spectrum.h"

#include "base/gsl_guard.h"

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
  gsl_interp *interp; /* NULL for a single point */
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

static const gsl_interp_type *method(abbe_interpolation interpolation, size_t count) {
  if (count < 3 || interpolation == ABBE_INTERPOLATION_LINEAR) return gsl_interp_linear;
  return interpolation == ABBE_INTERPOLATION_MONOTONE ? gsl_interp_steffen : gsl_interp_cspline;
}

static bool allocate(abbe_spectrum *spectrum, abbe_interpolation interpolation) {
  size_t count = spectrum->count;
  spectrum->lambda_nm = malloc(count * sizeof(double));
  spectrum->value = malloc(count * sizeof(double));
  if (count > 1) {
    abbe_gsl_guard_enter();
    spectrum->interp = gsl_interp_alloc(method(interpolation, count), count);
    abbe_gsl_guard_leave();
  }
  return spectrum->lambda_nm != NULL && spectrum->value != NULL &&
         (count == 1 || spectrum->interp != NULL);
}

/* Finite points can still make slopes that overflow. */
static bool usable(const abbe_spectrum *spectrum) {
  if (spectrum->interp == NULL) return true;
  abbe_gsl_guard_enter();
  int status =
      gsl_interp_init(spectrum->interp, spectrum->lambda_nm, spectrum->value, spectrum->count);
  abbe_gsl_guard_leave();
  if (status != GSL_SUCCESS) return false;
  const double *l = spectrum->lambda_nm;
  for (size_t i = 1; i < spectrum->count; i++)
    if (!isfinite(abbe_spectrum_at(spectrum, l[i - 1] + (l[i] - l[i - 1]) / 2))) return false;
  return true;
}

abbe_result abbe_spectrum_make(const double *lambda_nm, const double *value, size_t count,
                               abbe_interpolation interpolation, abbe_spectrum **out,
                               abbe_error *error) {
  ABBE_REQUIRE(lambda_nm && value && out, error);
  *out = NULL;
  abbe_result result = check(lambda_nm, value, count, error);
  if (result != ABBE_OK) return result;
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
  if (spectrum->interp != NULL) gsl_interp_free(spectrum->interp);
  free(spectrum);
}

/* No lookup accelerator is passed: it would be shared state between threads. */
double abbe_spectrum_at(const abbe_spectrum *spectrum, double lambda_nm) {
  const double *l = spectrum->lambda_nm, *v = spectrum->value;
  size_t last = spectrum->count - 1;
  if (isnan(lambda_nm)) return NAN;
  if (lambda_nm <= l[0]) return v[0];
  if (lambda_nm >= l[last]) return v[last];
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
