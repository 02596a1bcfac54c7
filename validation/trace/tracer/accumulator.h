/* accumulator.h: sums over passes, and the standard error of their mean.
 *
 * Within a pass values are added as whole numbers, by each thread for itself; whole numbers have
 * the same sum in any order, so the result does not depend on how the work was shared out. So are
 * the sums over passes. Passes are independent of each other, so their spread gives the error of
 * the mean.
 *
 * A single unit would take all that is dim away beside what is bright. There are two, 2^32 apart: a
 * number goes by its own size to the one that keeps all its bits, or, below 2^24 of the finer ones,
 * to the nearest of these. Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRACER_ACCUMULATOR_H
#define ABBE_VALIDATION_TRACE_TRACER_ACCUMULATOR_H

#include "base/error.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Sums of whole numbers over passes: they have the same bits in whatever order, and on however
 * many machines, the passes were done. */

#define ABBE_WHOLE_SUM_MOST_PASSES (1u << 20) /* passes of one picture */
/* A sample is a whole number of no more bits than these, and a sign. A product of two has two
 * digits of as many bits, which are summed apart. So many samples and digits fit into 127 bits. */
#define ABBE_WHOLE_SUM_BITS 104

__extension__ typedef __int128 abbe_whole_sum;
__extension__ typedef unsigned __int128 abbe_whole_size;

/* Adds the product of two samples to a sum of two digits, with no bit dropped. */
static inline void abbe_whole_sum_add_product(abbe_whole_sum a, abbe_whole_sum b,
                                              abbe_whole_sum sum[2]) {
  enum { HALF = ABBE_WHOLE_SUM_BITS / 2 };
  const uint64_t mask = ((uint64_t)1 << HALF) - 1;
  const abbe_whole_size x = (abbe_whole_size)(a < 0 ? -a : a),
                        y = (abbe_whole_size)(b < 0 ? -b : b);
  const uint64_t x0 = (uint64_t)x & mask, x1 = (uint64_t)(x >> HALF);
  const uint64_t y0 = (uint64_t)y & mask, y1 = (uint64_t)(y >> HALF);
  const abbe_whole_size cross = (abbe_whole_size)x0 * y1 + (abbe_whole_size)x1 * y0;
  const abbe_whole_sum low = (abbe_whole_sum)((abbe_whole_size)x0 * y0 + ((cross & mask) << HALF));
  const abbe_whole_sum high = (abbe_whole_sum)((abbe_whole_size)x1 * y1 + (cross >> HALF));
  const bool negative = (a < 0) != (b < 0);
  sum[0] += negative ? -low : low;
  sum[1] += negative ? -high : high;
}

/* What a sum of products stands for, in the product of both factors' units. */
static inline double abbe_whole_sum_of_products(const abbe_whole_sum sum[2]) {
  return (double)sum[1] * 0x1p104 + (double)sum[0];
}

/* x in units of 1 / per_unit, towards 0; at most as large as `limit` times per_unit; 0 of what is
 * not a number. */
static inline int64_t abbe_whole_sum_quantise(double x, double per_unit, double limit) {
  if (x != x) return 0;
  const double y = x > limit ? limit : x < -limit ? -limit : x;
  return (int64_t)(y * per_unit);
}

typedef struct abbe_accumulator {
  size_t values; /* elements times channels */
  size_t threads;
  size_t passes; /* ended so far */
  double unit;   /* value of a whole number 1: 2^-93 of the power of two that is at least `most` */
  double per_unit[2];     /* for the finer and the coarser unit */
  double coarse;          /* smallest magnitude that the coarser one takes */
  double limit;           /* largest magnitude that one addition keeps */
  int64_t **adding[2];    /* [threads][values] the pass that is in progress, in each unit */
  uint64_t *cut;          /* [threads] additions beyond the limit, cut to it */
  abbe_whole_sum *sum;    /* [values] over passes */
  abbe_whole_sum *square; /* [values][2] by abbe_whole_sum_add_product */
} abbe_accumulator;

#define ABBE_ACCUMULATOR_APART 32 /* bits from one unit to the other */

/* Sums of a pass up to `most` in magnitude are held; ABBE_INVALID_ARGUMENT unless it is positive
 * and from 1e-100 to 1e100, ABBE_NO_MEMORY. */
abbe_result abbe_accumulator_make(size_t values, size_t threads, double most, abbe_accumulator *out,
                                  abbe_error *error);
void abbe_accumulator_free(abbe_accumulator *a);

/* x, cut to the limit and counted where it is beyond it, 0 of what is not a number; in units, which
 * *coarse tells. */
static inline int64_t abbe_accumulator_quantise(const abbe_accumulator *a, float x, uint64_t *cut,
                                                bool *coarse) {
  double y = (double)x;
  if (!(fabs(y) <= a->limit)) {
    ++*cut;
    y = y > 0 ? a->limit : y < 0 ? -a->limit : 0;
  }
  *coarse = fabs(y) >= a->coarse;
  return lrint(y * a->per_unit[*coarse]);
}

/* Where a sum and what comes to it are more than 63 bits hold: the finer one's carry is the
 * coarser's, which is cut. */
void abbe_accumulator_carry(abbe_accumulator *a, size_t thread, size_t value, bool coarse,
                            int64_t more);

/* What is not a number adds nothing; sums beyond what a pass holds are cut. */
static inline void abbe_accumulator_add(abbe_accumulator *a, size_t thread, size_t value, float x) {
  bool coarse;
  const int64_t whole = abbe_accumulator_quantise(a, x, &a->cut[thread], &coarse);
  int64_t *sum = &a->adding[coarse][thread][value], all;
  if (__builtin_add_overflow(*sum, whole, &all))
    abbe_accumulator_carry(a, thread, value, coarse, whole);
  else
    *sum = all;
}

/* Ends the pass: its sums become one sample of every value. */
void abbe_accumulator_end_pass(abbe_accumulator *a);
/* Sum of a value in the pass that is in progress, in units. */
abbe_whole_sum abbe_accumulator_adding(const abbe_accumulator *a, size_t value);
/* Forgets the pass that is in progress. */
void abbe_accumulator_drop_pass(abbe_accumulator *a);

/* Mean over the passes; 0 before the first. */
double abbe_accumulator_mean(const abbe_accumulator *a, size_t value);
/* Standard error of that mean; infinite with fewer than two passes. */
double abbe_accumulator_error(const abbe_accumulator *a, size_t value);
/* Additions that were cut. */
uint64_t abbe_accumulator_cuts(const abbe_accumulator *a);

#endif
