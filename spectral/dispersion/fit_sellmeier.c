/* The Sellmeier form is not linear in its poles. Starts are taken from a grid of poles, at each of
 * which the strengths B follow linearly; the best few are followed down by Levenberg-Marquardt in
 * ln B and in a coordinate that keeps each pole on its side of the points. */
#include "spectral/dispersion/fit.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <math.h>
#include <string.h>

enum {
  MAX_TERMS = ABBE_FIT_MAX_SELLMEIER_TERMS,
  MAX_FREE = 2 * MAX_TERMS,
  STARTS = 6,
  MAX_FAR = 2
};

typedef struct problem {
  const abbe_fit_data *data;
  size_t terms, far; /* the last `far` poles lie beyond the points' red end, the others below */
  double low, high;  /* ends of the points, um */
} problem;

typedef struct start {
  double cost;
  size_t far;
  double p[MAX_FREE]; /* ln B, then the pole's coordinate, term by term */
} start;

static bool is_far(const problem *f, size_t term) {
  return term + f->far >= f->terms;
}

/* The pole C in um^2 at coordinate u: low^2 s below the points, high^2 / s beyond them, where
 * s = 1 / (1 + exp(-u)) runs from 0 to 1. */
static double pole(const problem *f, size_t term, double u) {
  double grow = 1 + exp(-u);
  return is_far(f, term) ? f->high * f->high * grow : f->low * f->low / grow;
}

static double pole_slope(const problem *f, size_t term, double u) {
  double rest = 1 / (1 + exp(u)); /* 1 - s */
  return (is_far(f, term) ? -1 : 1) * pole(f, term, u) * rest;
}

static double unit(const problem *f, size_t i) {
  return f->data->uncertainty != NULL ? f->data->uncertainty[i] : 1;
}

static double square_at(const problem *f, size_t i) {
  double L = f->data->lambda_nm[i] / 1000;
  return L * L;
}

/* ---- the descent ---- */

static double n_squared(const problem *f, const gsl_vector *p, double L2) {
  double sum = 1;
  for (size_t k = 0; k < f->terms; k++)
    sum += exp(gsl_vector_get(p, 2 * k)) * L2 / (L2 - pole(f, k, gsl_vector_get(p, 2 * k + 1)));
  return sum;
}

static int residuals(const gsl_vector *p, void *user, gsl_vector *out) {
  const problem *f = user;
  for (size_t i = 0; i < f->data->count; i++) {
    double n2 = n_squared(f, p, square_at(f, i));
    if (!(n2 > 0) || !isfinite(n2)) return GSL_EDOM;
    gsl_vector_set(out, i, (sqrt(n2) - f->data->n[i]) / unit(f, i));
  }
  return GSL_SUCCESS;
}

static int jacobian(const gsl_vector *p, void *user, gsl_matrix *out) {
  const problem *f = user;
  for (size_t i = 0; i < f->data->count; i++) {
    double L2 = square_at(f, i), scale = 0.5 / (sqrt(n_squared(f, p, L2)) * unit(f, i));
    for (size_t k = 0; k < f->terms; k++) {
      double u = gsl_vector_get(p, 2 * k + 1), gap = L2 - pole(f, k, u);
      double term = exp(gsl_vector_get(p, 2 * k)) * L2 / gap;
      gsl_matrix_set(out, i, 2 * k, scale * term);
      gsl_matrix_set(out, i, 2 * k + 1, scale * term / gap * pole_slope(f, k, u));
    }
  }
  return GSL_SUCCESS;
}

static gsl_multifit_nlinear_workspace *open_descent(const problem *f) {
  gsl_multifit_nlinear_parameters parameters = gsl_multifit_nlinear_default_parameters();
  parameters.solver = gsl_multifit_nlinear_solver_qr;
  return gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &parameters, f->data->count,
                                    2 * f->terms);
}

/* Follows s down in place; what it reached is kept even where the last steps gained nothing. */
static void descend(problem *f, gsl_multifit_nlinear_workspace *work, start *s, size_t steps) {
  size_t count = 2 * f->terms;
  gsl_vector_view p = gsl_vector_view_array(s->p, count);
  gsl_multifit_nlinear_fdf system = {
      .f = residuals, .df = jacobian, .n = f->data->count, .p = count, .params = f};
  int info = 0;
  f->far = s->far;
  if (gsl_multifit_nlinear_init(&p.vector, &system, work) != GSL_SUCCESS) return;
  gsl_multifit_nlinear_driver(steps, 1e-12, 1e-14, 0, NULL, NULL, &info, work);
  double cost = 0;
  gsl_blas_ddot(gsl_multifit_nlinear_residual(work), gsl_multifit_nlinear_residual(work), &cost);
  if (!(cost <= s->cost)) return;
  s->cost = cost;
  gsl_vector_memcpy(&p.vector, gsl_multifit_nlinear_position(work));
}

/* ---- the starts ---- */

/* The strengths B that suit the poles best, by the normal equations in n^2; they are few, and only
 * a start. */
static bool strengths(const problem *f, const double *c, double *B) {
  double matrix[MAX_TERMS * MAX_TERMS] = {0}, right[MAX_TERMS] = {0}, term[MAX_TERMS];
  for (size_t i = 0; i < f->data->count; i++) {
    double L2 = square_at(f, i), n = f->data->n[i], weight = 1 / (2 * n * unit(f, i));
    for (size_t k = 0; k < f->terms; k++) term[k] = weight * L2 / (L2 - c[k]);
    for (size_t k = 0; k < f->terms; k++) {
      right[k] += term[k] * weight * (n * n - 1);
      for (size_t j = 0; j < f->terms; j++) matrix[k * f->terms + j] += term[k] * term[j];
    }
  }
  gsl_matrix_view m = gsl_matrix_view_array(matrix, f->terms, f->terms);
  gsl_vector_view r = gsl_vector_view_array(right, f->terms);
  gsl_vector_view b = gsl_vector_view_array(B, f->terms);
  return gsl_linalg_cholesky_decomp1(&m.matrix) == GSL_SUCCESS &&
         gsl_linalg_cholesky_solve(&m.matrix, &r.vector, &b.vector) == GSL_SUCCESS;
}

static void offer(problem *f, const double *u, start *best) {
  double c[MAX_TERMS], B[MAX_TERMS] = {0};
  start s = {.far = f->far};
  for (size_t k = 0; k < f->terms; k++) c[k] = pole(f, k, u[k]);
  if (!strengths(f, c, B)) return;
  for (size_t k = 0; k < f->terms; k++) {
    s.p[2 * k] = log(B[k] > 1e-6 ? B[k] : 1e-6);
    s.p[2 * k + 1] = u[k];
  }
  gsl_vector_view p = gsl_vector_view_array(s.p, 2 * f->terms);
  for (size_t i = 0; i < f->data->count; i++) {
    double off = (sqrt(n_squared(f, &p.vector, square_at(f, i))) - f->data->n[i]) / unit(f, i);
    s.cost += off * off;
  }
  if (!isfinite(s.cost)) return;
  for (size_t i = 0; i < STARTS; i++)
    if (s.cost < best[i].cost) {
      memmove(best + i + 1, best + i, (STARTS - 1 - i) * sizeof *best);
      best[i] = s;
      return;
    }
}

/* Every ascending choice of poles from the grid, near ones first. */
static void walk(problem *f, double *u, size_t term, size_t from, start *best) {
  static const double below[] = {-4.5, -3, -2, -1.2, -0.4, 0.5, 1.6}; /* s: 0.01 to 0.83 */
  static const double beyond[] = {0.5, -1.5, -3.5, -5.5};             /* 1.3 to 16 times high */
  if (term >= f->terms || term >= MAX_TERMS) {
    offer(f, u, best);
    return;
  }
  bool first_far = is_far(f, term) && (term == 0 || !is_far(f, term - 1));
  const double *grid = is_far(f, term) ? beyond : below;
  size_t count = is_far(f, term) ? sizeof beyond / sizeof *beyond : sizeof below / sizeof *below;
  for (size_t i = first_far ? 0 : from; i < count; i++) {
    u[term] = grid[i];
    walk(f, u, term + 1, i + 1, best);
  }
}

/* ---- the answer ---- */

static int by_pole(const double *c, size_t a, size_t b) {
  return c[2 * a + 2] > c[2 * b + 2];
}

static void write_dispersion(const problem *f, const start *s, size_t *order, abbe_fit *fit) {
  double c[2 * MAX_TERMS + 1] = {0};
  for (size_t k = 0; k < f->terms; k++) {
    c[2 * k + 1] = exp(s->p[2 * k]);
    c[2 * k + 2] = pole(f, k, s->p[2 * k + 1]);
    order[k] = k;
  }
  for (size_t k = 1; k < f->terms; k++)
    for (size_t j = k; j > 0 && by_pole(c, order[j - 1], order[j]); j--) {
      size_t other = order[j];
      order[j] = order[j - 1];
      order[j - 1] = other;
    }
  fit->dispersion =
      (abbe_dispersion){.model = ABBE_DISPERSION_SELLMEIER2, .count = 2 * f->terms + 1};
  for (size_t k = 0; k < f->terms; k++) {
    fit->dispersion.c[2 * k + 1] = c[2 * order[k] + 1];
    fit->dispersion.c[2 * k + 2] = c[2 * order[k] + 2];
  }
}

/* From (ln B, u) to (B, C), and to the order of the coefficients. */
static abbe_result write_covariance(const problem *f, const start *s, const size_t *order,
                                    gsl_multifit_nlinear_workspace *work, abbe_fit *fit,
                                    abbe_fit_weakest *weakest, abbe_error *error) {
  size_t count = 2 * f->terms;
  double cells[MAX_FREE * MAX_FREE] = {0}, slope[MAX_FREE];
  gsl_matrix_view covariance = gsl_matrix_view_array(cells, count, count);
  int status = gsl_multifit_nlinear_covar(gsl_multifit_nlinear_jac(work), 0, &covariance.matrix);
  for (size_t k = 0; k < f->terms; k++) {
    slope[2 * k] = exp(s->p[2 * k]);
    slope[2 * k + 1] = pole_slope(f, k, s->p[2 * k + 1]);
  }
  for (size_t i = 0; i < count; i++)
    for (size_t j = 0; j < count; j++) {
      size_t a = 2 * order[i / 2] + i % 2, b = 2 * order[j / 2] + j % 2;
      fit->covariance[i + 1][j + 1] = cells[a * count + b] * slope[a] * slope[b];
    }
  double worst = 0;
  for (size_t k = 0; k < f->terms; k++) worst = fmax(worst, cells[2 * k * count + 2 * k]);
  for (size_t k = 0; k < count; k++)
    if (status != GSL_SUCCESS || !(cells[k * count + k] > 0) || !isfinite(cells[k * count + k]))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "the points from %g to %g nm do not determine %zu Sellmeier terms: "
                            "another set of coefficients fits them as well; ask for fewer terms",
                            1000 * f->low, 1000 * f->high, f->terms);
  /* as a share of the strength itself */
  *weakest = (abbe_fit_weakest){"the least known of its strengths, as a share of itself,", 1,
                                sqrt(worst), 1};
  return ABBE_OK;
}

/* The best starts of each kind, with no pole beyond the points, one or two: those of one kind
 * may all lead to the same shallow minimum. */
static abbe_result search(problem *f, start *winner, gsl_multifit_nlinear_workspace *work,
                          abbe_error *error) {
  double u[MAX_TERMS] = {0};
  *winner = (start){.cost = INFINITY};
  for (size_t far = 0; far <= f->terms && far <= MAX_FAR; far++) {
    start best[STARTS];
    for (size_t i = 0; i < STARTS; i++) best[i] = (start){.cost = INFINITY};
    f->far = far;
    walk(f, u, 0, 0, best);
    for (size_t i = 0; i < STARTS && isfinite(best[i].cost); i++) {
      descend(f, work, &best[i], 60);
      if (best[i].cost < winner->cost) *winner = best[i];
    }
  }
  if (!isfinite(winner->cost))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "no Sellmeier form of %zu terms comes near the points", f->terms);
  descend(f, work, winner, 2000);
  f->far = winner->far;
  return ABBE_OK;
}

static abbe_result check_indices(const abbe_fit_data *data, abbe_error *error) {
  for (size_t i = 0; i < data->count; i++)
    if (!(data->n[i] > 1))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "n is %g at %g nm; a Sellmeier form is fitted to indices above 1",
                            data->n[i], data->lambda_nm[i]);
  return ABBE_OK;
}

abbe_result abbe_fit_sellmeier(const abbe_fit_data *data, abbe_fit *fit, abbe_fit_weakest *weakest,
                               abbe_error *error) {
  problem f = {.data = data,
               .terms = data->terms,
               .low = data->lambda_nm[0] / 1000,
               .high = data->lambda_nm[data->count - 1] / 1000};
  start best;
  size_t order[MAX_TERMS];
  ABBE_TRY(check_indices(data, error));
  gsl_multifit_nlinear_workspace *work = open_descent(&f);
  if (work == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a Sellmeier fit");
  abbe_result result = search(&f, &best, work, error);
  if (result == ABBE_OK) {
    write_dispersion(&f, &best, order, fit);
    result = write_covariance(&f, &best, order, work, fit, weakest, error);
  }
  gsl_multifit_nlinear_free(work);
  return result;
}
