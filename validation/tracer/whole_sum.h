/* whole_sum.h: sums of whole numbers over passes: they have the same bits in whatever order, and on
 * however many machines, the passes were done.
 *
 * Internal to validation/: it is not installed.
 */
#ifndef ABBE_VALIDATION_TRACER_WHOLE_SUM_H
#define ABBE_VALIDATION_TRACER_WHOLE_SUM_H

#include <stdint.h>

/* Passes of one picture: so many products of 63 bits each way, less the bits that are dropped, fit
 * into 127. */
#define ABBE_WHOLE_SUM_MOST_PASSES (1u << 20)
#define ABBE_WHOLE_SUM_DROPPED_BITS 20

__extension__ typedef __int128 abbe_whole_sum;

/* a times b, in units of 2^ABBE_WHOLE_SUM_DROPPED_BITS, rounded downwards. */
static inline abbe_whole_sum abbe_whole_sum_product(int64_t a, int64_t b) {
  return ((abbe_whole_sum)a * b) >> ABBE_WHOLE_SUM_DROPPED_BITS;
}

/* What a sum of such products stands for, in the product of both factors' units. */
static inline double abbe_whole_sum_of_products(abbe_whole_sum sum) {
  return (double)sum * (double)(1 << ABBE_WHOLE_SUM_DROPPED_BITS);
}

/* x in units of 1 / per_unit, towards 0; at most as large as `limit` times per_unit. */
static inline int64_t abbe_whole_sum_quantise(double x, double per_unit, double limit) {
  const double y = x > limit ? limit : x < -limit ? -limit : x;
  return (int64_t)(y * per_unit);
}

#endif
