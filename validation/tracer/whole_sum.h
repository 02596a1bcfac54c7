/* whole_sum.h: sums of whole numbers over passes: they have the same bits in whatever order, and on
 * however many machines, the passes were done.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACER_WHOLE_SUM_H
#define ABBE_VALIDATION_TRACER_WHOLE_SUM_H

#include <stdbool.h>
#include <stdint.h>

#define ABBE_WHOLE_SUM_MOST_PASSES (1u << 20) /* of one picture */
/* A sample is a whole number of no more bits than these, and a sign. A product of two has two digits
 * of as many bits, which are summed apart. So many samples and digits fit into 127 bits. */
#define ABBE_WHOLE_SUM_BITS 104

__extension__ typedef __int128 abbe_whole_sum;
__extension__ typedef unsigned __int128 abbe_whole_size;

/* Adds the product of two samples to a sum of two digits, with no bit dropped. */
static inline void abbe_whole_sum_add_product(abbe_whole_sum a, abbe_whole_sum b,
                                              abbe_whole_sum sum[2]) {
  enum { HALF = ABBE_WHOLE_SUM_BITS / 2 };
  const uint64_t mask = ((uint64_t)1 << HALF) - 1;
  const abbe_whole_size x = (abbe_whole_size)(a < 0 ? -a : a), y = (abbe_whole_size)(b < 0 ? -b : b);
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

#endif
