/* surrogate.h: a smooth function of two variables that is known at some places with its gradient,
 * as a random process has it [Rasmussen2006]: what it probably is elsewhere, and how surely.
 *
 * Variables are 0 to 1. A tenth of the values' scatter is taken for steps that are finer than the
 * process, and half of what gradients scatter by. Internal to validation/measure/. */
#ifndef ABBE_VALIDATION_MEASURE_SURROGATE_H
#define ABBE_VALIDATION_MEASURE_SURROGATE_H

#include <stdbool.h>
#include <stddef.h>

enum { ABBE_SURROGATE_MOST = 48 };

/* count, at, value and by are given; fit fills the rest. */
typedef struct abbe_surrogate {
  size_t count;
  double at[ABBE_SURROGATE_MOST][2], value[ABBE_SURROGATE_MOST], by[ABBE_SURROGATE_MOST][2];
  double mean, scale;                                         /* of the values */
  double root[9 * ABBE_SURROGATE_MOST * ABBE_SURROGATE_MOST]; /* the covariance's, lower triangle */
  double weight[3 * ABBE_SURROGATE_MOST];
} abbe_surrogate;

/* false for places that are no positive definite set: two of them one. */
bool abbe_surrogate_fit(abbe_surrogate *s);
/* The mean there, and its standard deviation. */
double abbe_surrogate_at(const abbe_surrogate *s, const double x[2], double *deviation);
/* Where mean + trust * deviation is greatest, among 41 x 41 places. */
void abbe_surrogate_best(const abbe_surrogate *s, double trust, double x[2]);

#endif
