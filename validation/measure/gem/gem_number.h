/* gem_number.h: a measured number and its standard error, from independent rays or repeats.
 * Internal to validation/measure/gem/. */
#ifndef ABBE_VALIDATION_MEASURE_GEM_GEM_NUMBER_H
#define ABBE_VALIDATION_MEASURE_GEM_GEM_NUMBER_H

#include <stddef.h>

typedef struct abbe_gem_number {
  double value, error; /* error: one standard deviation; NaN for fewer than two repeats */
} abbe_gem_number;

/* What rays by chance in a grid's pixels add up to. Errors come from the scatter in each pixel, for
 * few repeats tell the scatter of their totals poorly. Zeroed before the first pixel. */
typedef struct abbe_gem_sums {
  double value, weight;                        /* totals */
  double value_square, product, weight_square; /* their variances and covariance */
} abbe_gem_sums;

/* One pixel's rays, count >= 2. */
void abbe_gem_sums_add(abbe_gem_sums *sums, const double *value, const float *weight, size_t count);
void abbe_gem_sums_join(abbe_gem_sums *to, const abbe_gem_sums *other);
/* Value over weight; 0 where no weight is above 0. */
abbe_gem_number abbe_gem_sums_ratio(const abbe_gem_sums *sums);

/* The ratio of the totals of sum[i] and weight[i], i < count, and its error by the scatter of what
 * is left without each repeat in turn (the jackknife [Efron1982]). 0 where no weight is above 0. */
abbe_gem_number abbe_gem_number_ratio(const double *sum, const double *weight, size_t count);

/* whole: from all repeats; without[i]: the same measure without repeat i. */
abbe_gem_number abbe_gem_number_jackknife(double whole, const double *without, size_t count);

#endif
