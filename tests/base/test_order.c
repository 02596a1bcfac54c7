/* Numbers in order, and in reverse. */
#include "tests/check.h"

#include "base/order.h"

TEST(numbers_come_in_order) {
  double a[] = {2, -INFINITY, 0.5, 1e300, 0.5, -3};
  float b[] = {2, -INFINITY, 0.5f, 1e30f, 0.5f, -3};
  qsort(a, 6, sizeof *a, abbe_order_ascending);
  qsort(b, 6, sizeof *b, abbe_order_ascending_floats);
  for (int i = 0; i < 5; i++) assert_true(a[i] <= a[i + 1] && b[i] <= b[i + 1]);
  qsort(a, 6, sizeof *a, abbe_order_descending);
  qsort(b, 6, sizeof *b, abbe_order_descending_floats);
  for (int i = 0; i < 5; i++) assert_true(a[i] >= a[i + 1] && b[i] >= b[i + 1]);
  assert_true(a[0] == 1e300 && b[0] == 1e30f && a[5] == -INFINITY && b[5] == -INFINITY);
  assert_int_equal(abbe_order_ascending(&a[2], &a[2]), 0);
}
