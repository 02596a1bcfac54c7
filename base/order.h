/* order.h: comparisons for qsort. No number may be a NaN. */
#ifndef ABBE_BASE_ORDER_H
#define ABBE_BASE_ORDER_H

/* Compares two doubles. */
static inline int abbe_order_ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static inline int abbe_order_descending(const void *a, const void *b) {
  return abbe_order_ascending(b, a);
}

/* Compares two floats. */
static inline int abbe_order_ascending_floats(const void *a, const void *b) {
  const float x = *(const float *)a, y = *(const float *)b;
  return (x > y) - (x < y);
}

static inline int abbe_order_descending_floats(const void *a, const void *b) {
  return abbe_order_ascending_floats(b, a);
}

#endif
