/* accumulator.h: sums over passes, and the standard error of their mean.
 *
 * Within a pass values are added as whole numbers of a small unit, by each thread for itself;
 * whole numbers have the same sum in any order, so the result does not depend on how the work was
 * shared out. So are the sums over passes (whole_sum.h). Passes are independent of each other, so
 * their spread tells the error of the mean.
 */
#ifndef ABBE_VALIDATION_TRACER_ACCUMULATOR_H
#define ABBE_VALIDATION_TRACER_ACCUMULATOR_H

#include "base/error.h"
#include "validation/tracer/whole_sum.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct abbe_accumulator {
  size_t values; /* elements times channels */
  size_t threads;
  size_t passes; /* ended so far */
  double unit;   /* value of a whole number 1 */
  double per_unit;
  double limit;           /* largest magnitude that one addition keeps */
  int64_t **adding;       /* [threads][values] the pass that is under way */
  uint64_t *cut;          /* [threads] additions beyond the limit, cut to it */
  abbe_whole_sum *sum;    /* [values] over passes, by abbe_whole_sum_add_sample */
  abbe_whole_sum *square; /* [values] likewise */
} abbe_accumulator;

/* Sums of a pass up to `most` in magnitude are held; ABBE_INVALID_ARGUMENT unless it is positive
 * and finite, ABBE_NO_MEMORY. */
abbe_result abbe_accumulator_make(size_t values, size_t threads, double most, abbe_accumulator *out,
                                  abbe_error *error);
void abbe_accumulator_free(abbe_accumulator *a);

/* What is not a number adds nothing; sums beyond what a pass holds are cut. */
static inline void abbe_accumulator_add(abbe_accumulator *a, size_t thread, size_t value, float x) {
  double y = (double)x;
  if (!(y <= a->limit && y >= -a->limit)) {
    a->cut[thread]++;
    y = y > 0 ? a->limit : y < 0 ? -a->limit : 0;
  }
  int64_t whole = (int64_t)(y * a->per_unit), *sum = &a->adding[thread][value];
  if (!__builtin_add_overflow(*sum, whole, sum)) return;
  a->cut[thread]++;
  *sum = whole > 0 ? INT64_MAX : INT64_MIN;
}

/* Ends the pass: its sums become one sample of every value. */
void abbe_accumulator_end_pass(abbe_accumulator *a);
/* Sum of a value in the pass that is under way, in units. */
int64_t abbe_accumulator_adding(const abbe_accumulator *a, size_t value);
/* Forgets the pass that is under way. */
void abbe_accumulator_drop_pass(abbe_accumulator *a);

/* Mean over the passes; 0 before the first. */
double abbe_accumulator_mean(const abbe_accumulator *a, size_t value);
/* Standard error of that mean; infinite with fewer than two passes. */
double abbe_accumulator_error(const abbe_accumulator *a, size_t value);
/* Additions that were cut. */
uint64_t abbe_accumulator_cuts(const abbe_accumulator *a);

#ifdef __cplusplus
}
#endif
#endif
