/* The Cauchy form is linear: it is solved in Chebyshev polynomials of t, which runs from -1 to 1
 * as x = L^-2 runs over the points, and then written out in powers of x. */
#include "spectral/dispersion/fit.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit.h>
#include <math.h>
#include <string.h>

enum { MAX_TERMS = ABBE_FIT_MAX_CAUCHY_TERMS };

typedef struct basis {
  double middle, half; /* of x, um^-2 */
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

abbe_result abbe_fit_cauchy(const abbe_fit_data *data, abbe_fit *fit, abbe_fit_weakest *weakest,
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
