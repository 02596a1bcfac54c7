/* fit_forms.h: what spectral/dispersion/fit.c asks of its two forms. Internal to spectral/. */
#ifndef ABBE_SPECTRAL_DISPERSION_FIT_FORMS_H
#define ABBE_SPECTRAL_DISPERSION_FIT_FORMS_H

#include "spectral/dispersion/fit.h"

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

abbe_result abbe_fit_cauchy(const abbe_fit_data *data, abbe_fit *fit, abbe_fit_weakest *weakest,
                            abbe_error *error);
abbe_result abbe_fit_sellmeier(const abbe_fit_data *data, abbe_fit *fit, abbe_fit_weakest *weakest,
                               abbe_error *error);

#endif
