/* gem_number.h: a measured number and its standard error, from independent repeats.
 * Internal to validation/measure/gem/. */
#ifndef ABBE_VALIDATION_MEASURE_GEM_GEM_NUMBER_H
#define ABBE_VALIDATION_MEASURE_GEM_GEM_NUMBER_H

#include <stddef.h>

typedef struct abbe_gem_number {
  double value, error; /* error: one standard deviation; NaN for fewer than two repeats */
} abbe_gem_number;

/* The ratio of the totals of sum[i] and weight[i], i < count, and its error by the scatter of what
 * is left without each repeat in turn (the jackknife [Efron1982]). 0 where no weight is above 0. */
abbe_gem_number abbe_gem_number_ratio(const double *sum, const double *weight, size_t count);

/* whole: from all repeats; without[i]: the same measure without repeat i. */
abbe_gem_number abbe_gem_number_jackknife(double whole, const double *without, size_t count);

#endif
