#include "spectral/dispersion/fit.h"

#include "base/maths.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit.h>
#include <math.h>

/* The Cauchy form is linear: it is solved in Chebyshev polynomials of t, which runs from -1 to 1
 * as x = L^-2 runs over the points, and then written out in powers of x. */

enum { MAX_TERMS = ABBE_FIT_MAX_CAUCHY_TERMS };

typedef struct basis {
  double middle, half; /* the range of x, um^-2 */
  size_t terms;
  double power[MAX_TERMS][MAX_TERMS]; /* T_k = sum_j power[k][j] x^j */
} basis;

static double x_of(double lambda_nm) {
  return 1e6 / (lambda_nm * lambda_nm);
}

static void chebyshev(const basis *b, double lambda_nm, double *value) {
  double t = (x_of(lambda_nm) - b->middle) / b->half;
  value[0] = 1;
  if (b->terms > 1) value[1] = t;
  for (size_t k = 2; k < b->terms; k++) value[k] = 2 * t * value[k - 1] - value[k - 2];
}

/* T_k+1 = 2 t T_k - T_k-1 on the coefficients of powers of x. */
static void plan(const abbe_fit_data *data, basis *b) {
  double low = x_of(data->lambda_nm[data->count - 1]), high = x_of(data->lambda_nm[0]);
  *b = (basis){.middle = (high + low) / 2, .half = (high - low) / 2, .terms = data->terms};
  if (b->half == 0) b->half = 1; /* one term: t is not used */
  b->power[0][0] = 1;
  for (size_t k = 1; k < b->terms; k++) {
    double twice = k == 1 ? 1 : 2;
    for (size_t j = 0; j <= k; j++) {
      double up = j > 0 ? b->power[k - 1][j - 1] : 0;
      double before = k > 1 ? b->power[k - 2][j] : 0;
      b->power[k][j] = twice * (up - b->middle * b->power[k - 1][j]) / b->half - before;
    }
  }
}

typedef struct workspace {
  gsl_multifit_linear_workspace *work;
  gsl_matrix *basis, *covariance;
  gsl_vector *n, *weight, *a;
} workspace;

static abbe_result open_workspace(size_t points, size_t terms, workspace *w, abbe_error *error) {
  *w = (workspace){gsl_multifit_linear_alloc(points, terms),
                   gsl_matrix_alloc(points, terms),
                   gsl_matrix_alloc(terms, terms),
                   gsl_vector_alloc(points),
                   gsl_vector_alloc(points),
                   gsl_vector_alloc(terms)};
  if (w->work != NULL && w->basis != NULL && w->covariance != NULL && w->n != NULL &&
      w->weight != NULL && w->a != NULL)
    return ABBE_OK;
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a Cauchy fit");
}

static void close_workspace(workspace *w) {
  if (w->work != NULL) gsl_multifit_linear_free(w->work);
  gsl_matrix_free(w->basis);
  gsl_matrix_free(w->covariance);
  gsl_vector_free(w->n);
  gsl_vector_free(w->weight);
  gsl_vector_free(w->a);
}

static abbe_result solve(const abbe_fit_data *data, const basis *b, workspace *w,
                         abbe_error *error) {
  double value[MAX_TERMS], chi_squared = 0;
  for (size_t i = 0; i < data->count; i++) {
    double unit = data->uncertainty != NULL ? data->uncertainty[i] : 1;
    gsl_vector_set(w->n, i, data->n[i]);
    gsl_vector_set(w->weight, i, 1 / (unit * unit));
    chebyshev(b, data->lambda_nm[i], value);
    for (size_t k = 0; k < b->terms; k++) gsl_matrix_set(w->basis, i, k, value[k]);
  }
  int status =
      gsl_multifit_wlinear(w->basis, w->weight, w->n, w->a, w->covariance, &chi_squared, w->work);
  if (status == GSL_SUCCESS) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the Cauchy fit failed: %s",
                        gsl_strerror(status));
}

static void write_out(const basis *b, const workspace *w, abbe_fit *fit) {
  size_t terms = b->terms;
  fit->dispersion = (abbe_dispersion){.model = ABBE_DISPERSION_CAUCHY, .count = terms};
  for (size_t k = 0; k < terms; k++)
    for (size_t j = 0; j <= k; j++)
      fit->dispersion.c[j] += gsl_vector_get(w->a, k) * b->power[k][j];
  double half[MAX_TERMS][MAX_TERMS] = {{0}}; /* power^T covariance */
  for (size_t i = 0; i < terms; i++)
    for (size_t l = 0; l < terms; l++)
      for (size_t k = 0; k < terms; k++)
        half[i][l] += b->power[k][i] * gsl_matrix_get(w->covariance, k, l);
  for (size_t i = 0; i < terms; i++)
    for (size_t j = 0; j < terms; j++)
      for (size_t l = 0; l < terms; l++) fit->covariance[i][j] += half[i][l] * b->power[l][j];
}

/* Many powers of x nearly cancel each other; what is left must still be the fit. */
static abbe_result check_cancelling(const abbe_fit_data *data, const basis *b, const workspace *w,
                                    const abbe_fit *fit, abbe_error *error) {
  double worst = 0, value[MAX_TERMS];
  for (size_t i = 0; i < data->count; i++) {
    double sum = 0;
    chebyshev(b, data->lambda_nm[i], value);
    for (size_t k = 0; k < b->terms; k++) sum += gsl_vector_get(w->a, k) * value[k];
    double off = fabs(sum - abbe_dispersion_n(&fit->dispersion, data->lambda_nm[i]));
    if (!(off <= worst)) worst = off;
  }
  if (worst <= 1e-8) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "the coefficients of %zu Cauchy terms over %g to %g nm are so large that "
                        "they cancel beyond double precision (n is off by up to %.2g); ask for "
                        "fewer terms",
                        b->terms, data->lambda_nm[0], data->lambda_nm[data->count - 1], worst);
}

static abbe_result fit_cauchy(const abbe_fit_data *data, abbe_fit *fit, abbe_fit_weakest *weakest,
                              abbe_error *error) {
  basis b;
  workspace w;
  plan(data, &b);
  abbe_result result = open_workspace(data->count, data->terms, &w, error);
  if (result == ABBE_OK) result = solve(data, &b, &w, error);
  if (result == ABBE_OK) {
    size_t top = b.terms - 1;
    write_out(&b, &w, fit);
    *weakest = (abbe_fit_weakest){"what its highest term adds", gsl_vector_get(w.a, top),
                                  sqrt(gsl_matrix_get(w.covariance, top, top)), 2};
    result = check_cancelling(data, &b, &w, fit, error);
  }
  close_workspace(&w);
  return result;
}

const char *abbe_fit_form_name(abbe_fit_form form) {
  return form == ABBE_FIT_CAUCHY ? "cauchy" : form == ABBE_FIT_SELLMEIER ? "sellmeier" : "unknown";
}

double abbe_fit_standard_error(const abbe_fit *fit, size_t i) {
  return i < ABBE_DISPERSION_MAX_COEFFICIENTS ? sqrt(fit->covariance[i][i]) : NAN;
}

/* The number of wavelengths that are different from each other: the points hold no more. */
static size_t different(const abbe_fit_data *data) {
  size_t count = data->count > 0;
  for (size_t i = 1; i < data->count; i++) count += data->lambda_nm[i] > data->lambda_nm[i - 1];
  return count;
}

static abbe_result check_terms(const abbe_fit_request *request, size_t terms, abbe_error *error) {
  bool cauchy = request->form == ABBE_FIT_CAUCHY;
  size_t most = cauchy ? ABBE_FIT_MAX_CAUCHY_TERMS : ABBE_FIT_MAX_SELLMEIER_TERMS;
  if ((int)request->form < 0 || request->form >= ABBE_FIT_FORM_COUNT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there is no form %d to fit",
                          (int)request->form);
  if (terms <= most) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "a %s fit of %zu terms is asked for; 1 to %zu are possible",
                        abbe_fit_form_name(request->form), terms, most);
}

/* The points of the range, which is everything where it is not given. */
static abbe_result choose(const abbe_index_points *points, const abbe_fit_request *request,
                          abbe_fit_data *out, abbe_error *error) {
  double low = request->min_nm, high = request->max_nm;
  bool all = low == 0 && high == 0;
  if (!all && !(low > 0 && low < high && isfinite(high)))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the range %g:%g nm of a fit is not one, such as 380:780", low, high);
  size_t from = 0, to = points->count;
  while (!all && from < to && points->lambda_nm[from] < low) from++;
  while (!all && to > from && points->lambda_nm[to - 1] > high) to--;
  *out = (abbe_fit_data){.count = to - from,
                         .terms = request->terms > 0 ? request->terms : 2,
                         .lambda_nm = points->lambda_nm + from,
                         .n = points->n + from,
                         .uncertainty = points->uncertainty ? points->uncertainty + from : NULL,
                         .exact = points->exact};
  return check_terms(request, out->terms, error);
}

static abbe_result check_data(const abbe_fit_data *data, size_t free_count, const char *form,
                              abbe_error *error) {
  size_t wavelengths = different(data);
  if (data->count == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "no point lies in the range of the fit");
  double low = data->lambda_nm[0], high = data->lambda_nm[data->count - 1];
  if (wavelengths < free_count)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a %s fit of %zu term%s has %zu coefficients, and there are points at "
                          "only %zu wavelength%s (%g to %g nm); ask for fewer terms or measure at "
                          "more wavelengths",
                          form, data->terms, data->terms == 1 ? "" : "s", free_count, wavelengths,
                          wavelengths == 1 ? "" : "s", low, high);
  double x_low = 1 / (high * high), x_high = 1 / (low * low);
  if (free_count == 1 || (isfinite(x_high) && x_high - x_low > 2e-9 * x_high && x_low > 0))
    return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "the range %.17g:%.17g nm is too narrow or too wide for a %s fit of %zu "
                        "terms",
                        low, high, form, data->terms);
}

static void measure(const abbe_fit_data *data, abbe_fit *fit) {
  double sum = 0, weighted = 0;
  fit->max_error = -1;
  for (size_t i = 0; i < data->count; i++) {
    double off = data->n[i] - abbe_dispersion_n(&fit->dispersion, data->lambda_nm[i]);
    double unit = data->uncertainty != NULL ? data->uncertainty[i] : 1;
    sum += off * off;
    weighted += (off / unit) * (off / unit);
    if (!(fabs(off) <= fit->max_error)) {
      fit->max_error = fabs(off);
      fit->max_nm_of_error = data->lambda_nm[i];
    }
  }
  fit->points = data->count;
  fit->weighted = data->uncertainty != NULL;
  fit->min_nm = data->lambda_nm[0];
  fit->max_nm = data->lambda_nm[data->count - 1];
  fit->rms = sqrt(sum / (double)data->count);
  fit->reduced_chi_squared =
      data->count > fit->free ? weighted / (double)(data->count - fit->free) : NAN;
}

/* Without uncertainties the residuals show how large they are. */
static double scale_covariance(abbe_fit *fit) {
  double scale = fit->weighted ? 1 : fit->reduced_chi_squared;
  size_t count = fit->dispersion.count;
  for (size_t i = 0; i < count; i++)
    for (size_t j = 0; j < count; j++)
      if (j < i)
        fit->covariance[i][j] = fit->covariance[j][i]; /* to the last bit */
      else if (fit->covariance[i][j] != 0)
        fit->covariance[i][j] *= scale;
  return sqrt(scale);
}

static abbe_result check_support(const abbe_fit_data *data, const abbe_fit_weakest *weakest,
                                 double scale, const char *form, abbe_error *error) {
  double standard_error = weakest->standard_error * scale;
  if (data->exact || !(fabs(weakest->value) < weakest->least_ratio * standard_error))
    return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "the points do not support a %s fit of %zu term%s over %g to %g nm: %s is "
                        "%.3g with a standard error of %.2g; ask for fewer terms, or measure over "
                        "a wider range or more exactly",
                        form, data->terms, data->terms == 1 ? "" : "s", data->lambda_nm[0],
                        data->lambda_nm[data->count - 1], weakest->what, weakest->value,
                        standard_error);
}

abbe_result abbe_fit_make(const abbe_index_points *points, const abbe_fit_request *request,
                          abbe_fit *out, abbe_error *error) {
  *out = (abbe_fit){0};
  abbe_fit_data data;
  abbe_fit_weakest weakest = {0};
  ABBE_TRY(choose(points, request, &data, error));
  bool cauchy = request->form == ABBE_FIT_CAUCHY;
  const char *form = cauchy ? "Cauchy" : "Sellmeier";
  abbe_fit fit = {.free = cauchy ? data.terms : 2 * data.terms};
  ABBE_TRY(check_data(&data, fit.free, form, error));
  abbe_gsl_guard_enter();
  abbe_result result = cauchy ? fit_cauchy(&data, &fit, &weakest, error)
                              : abbe_fit_sellmeier(&data, &fit, &weakest, error);
  abbe_gsl_guard_leave();
  if (result != ABBE_OK) return result;
  measure(&data, &fit);
  result = check_support(&data, &weakest, scale_covariance(&fit), form, error);
  if (result == ABBE_OK) *out = fit;
  return result;
}

/* ---- of another curve ---- */

enum { MAX_CURVE_TERMS = 8, MAX_CURVE_POINTS = 100001 }; /* 1 nm steps up to 100 um */

abbe_result abbe_fit_dispersion(const abbe_dispersion *source, size_t terms, double min_nm,
                                double max_nm, abbe_dispersion *out, double *max_error,
                                abbe_error *error) {
  *out = (abbe_dispersion){0};
  if (terms < 1 || terms > MAX_CURVE_TERMS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a Cauchy fit of %zu terms is asked for; 1 to %d are possible", terms,
                          MAX_CURVE_TERMS);
  if (min_nm > 0 && !isfinite(1e6 / (min_nm * min_nm)))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the range %g:%g nm is too wide for a Cauchy fit", min_nm, max_nm);
  abbe_index_points points;
  abbe_fit fit;
  abbe_result result =
      abbe_index_points_sample(source, min_nm, max_nm, 8 * terms, MAX_CURVE_POINTS, &points, error);
  if (result == ABBE_OK)
    result = abbe_fit_make(&points, &(abbe_fit_request){.terms = terms}, &fit, error);
  abbe_index_points_free(&points);
  if (result != ABBE_OK) return result;
  if (max_error != NULL) *max_error = fit.max_error;
  *out = fit.dispersion;
  return ABBE_OK;
}
