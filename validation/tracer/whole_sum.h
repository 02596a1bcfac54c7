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

/* Sums of a value and of its square, with no bit dropped: what the square's drops is summed in the
 * lowest bits of the value's, which need as many less. Both are added up as they are. */
#define ABBE_WHOLE_SUM_REST_BITS 40

static inline void abbe_whole_sum_add_sample(int64_t x, abbe_whole_sum *sum,
                                             abbe_whole_sum *square) {
  const abbe_whole_sum whole = (abbe_whole_sum)x * x;
  const int64_t rest = (int64_t)(whole & ((1 << ABBE_WHOLE_SUM_DROPPED_BITS) - 1));
  *sum += (abbe_whole_sum)x * ((int64_t)1 << ABBE_WHOLE_SUM_REST_BITS) + rest;
  *square += whole >> ABBE_WHOLE_SUM_DROPPED_BITS;
}

/* In the value's units, and in their square. */
static inline double abbe_whole_sum_of_values(abbe_whole_sum sum) {
  return (double)(sum >> ABBE_WHOLE_SUM_REST_BITS);
}
static inline double abbe_whole_sum_of_squares(abbe_whole_sum sum, abbe_whole_sum square) {
  const int64_t rest = (int64_t)(sum & (((int64_t)1 << ABBE_WHOLE_SUM_REST_BITS) - 1));
  return abbe_whole_sum_of_products(square) + (double)rest;
}

/* x in units of 1 / per_unit, towards 0; at most as large as `limit` times per_unit; 0 of what is
 * not a number. */
static inline int64_t abbe_whole_sum_quantise(double x, double per_unit, double limit) {
  if (x != x) return 0;
  const double y = x > limit ? limit : x < -limit ? -limit : x;
  return (int64_t)(y * per_unit);
}

#endif
