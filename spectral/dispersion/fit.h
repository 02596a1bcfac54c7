/* fit.h: Cauchy and Sellmeier forms fitted to refractive indices by weighted least squares.
 *
 * The points are measured ones or those of a formula. A fit comes with its residuals, and with
 * the covariance of its coefficients; what the points cannot support is refused with the reason.
 * GSL does the linear algebra and the descent. It neither reads files nor judges materials.
 */
#ifndef ABBE_SPECTRAL_DISPERSION_FIT_H
#define ABBE_SPECTRAL_DISPERSION_FIT_H

#include "base/error.h"
#include "spectral/dispersion/dispersion.h"
#include "spectral/dispersion/index_points.h"

#include <stdbool.h>
#include <stddef.h>

typedef enum abbe_fit_form {
  ABBE_FIT_CAUCHY,    /* n = c0 + c1 L^-2 + …: a coefficient a term */
  ABBE_FIT_SELLMEIER, /* n^2 - 1 = sum of B L^2 / (L^2 - C): two coefficients a term */
  ABBE_FIT_FORM_COUNT
} abbe_fit_form;

#define ABBE_FIT_MAX_CAUCHY_TERMS ABBE_DISPERSION_MAX_COEFFICIENTS
#define ABBE_FIT_MAX_SELLMEIER_TERMS 4

/* Zero asks for a Cauchy form of two terms through all points. */
typedef struct abbe_fit_request {
  abbe_fit_form form;
  size_t terms;          /* 0: two; Cauchy up to 32, Sellmeier up to 4 */
  double min_nm, max_nm; /* only the points within are used; both 0: all */
} abbe_fit_request;

typedef struct abbe_fit {
  abbe_dispersion dispersion; /* cauchy, or sellmeier2 with c0 = 0 */
  double min_nm, max_nm;      /* first and last wavelength of the points used */
  size_t points, free;        /* points used, coefficients that were fitted */
  bool weighted;              /* by the points' uncertainties */
  double rms, max_error;      /* residuals n - fit at the points used, unweighted */
  double max_nm_of_error;     /* where the largest is */
  /* sum of squared residuals over (points - free): in units of the uncertainties where weighted
   * (about 1 where they and the form are right), else of n^2; NaN where no point is left over */
  double reduced_chi_squared;
  /* covariance[i][j] of c[i] and c[j]; 0 for a coefficient that was not free. From the points'
   * uncertainties where they have them, else from the residuals (NaN where no point is left) */
  double covariance[ABBE_DISPERSION_MAX_COEFFICIENTS][ABBE_DISPERSION_MAX_COEFFICIENTS];
} abbe_fit;

/* Fits points, weighted by 1
 * uncertainty^2 where they have them. The poles of a Sellmeier form stay outside the points'
 * wavelengths, and its B above 0. ABBE_INVALID_ARGUMENT, with the numbers that show it, for terms
 * that are not possible, fewer wavelengths than coefficients, a range too narrow for the terms,
 * coefficients so large that they cancel beyond double precision, and, unless the points are a
 * formula's, a highest term that the points do not separate from zero (below twice its standard
 * error). */
abbe_result abbe_fit_make(const abbe_index_points *points, const abbe_fit_request *request,
                          abbe_fit *out, abbe_error *error);

/* Least-squares Cauchy form with `terms` coefficients over [min_nm, max_nm], fitted to n of
 * `source` at 1 nm steps (or at least 8 points a term on narrower ranges); largest absolute
 * residual over those points in *max_error (may be NULL). ABBE_INVALID_ARGUMENT for terms outside
 * [1, 8] or an empty range. */
abbe_result abbe_fit_dispersion(const abbe_dispersion *source, size_t terms, double min_nm,
                                double max_nm, abbe_dispersion *out, double *max_error,
                                abbe_error *error);

/* Standard error of coefficient i: the root of its variance. */
double abbe_fit_standard_error(const abbe_fit *fit, size_t i);

const char *abbe_fit_form_name(abbe_fit_form form);

/* What spectral/dispersion/fit.c needs of its two forms. */

/* The points of one fit: those within its range. uncertainty is NULL where all weigh the same. */
typedef struct abbe_fit_data {
  size_t count, terms;
  const double *lambda_nm, *n, *uncertainty;
  bool exact;
} abbe_fit_data;

/* Both fill dispersion and covariance of *fit, the latter as if every uncertainty were 1 where
 * there are none, and *weakest with the parameter that the points support least, its value and
 * its standard error in the same unit. */
typedef struct abbe_fit_weakest {
  const char *what;                          /* such as "its highest term"; a literal */
  double value, standard_error, least_ratio; /* refused where value < least_ratio x error */
} abbe_fit_weakest;

abbe_result abbe_fit_sellmeier(const abbe_fit_data *data, abbe_fit *fit, abbe_fit_weakest *weakest,
                               abbe_error *error);

#endif
