#include "validation/measure/surrogate.h"

#include "tests/check.h"

#include <math.h>
#include <string.h>

/* A hill, known at 4 x 4 places: between them it is found nearly, where it is highest too, and
 * surer than beyond them. */
TEST(a_hill_is_found) {
  static abbe_surrogate s;
  double x[2], near, far;
  const double top[2] = {0.62, 0.37}, corner[2] = {0, 1};
  s.count = 0;
  for (size_t i = 0; i < 16; i++) {
    double *at = s.at[i], off[2];
    at[0] = 0.2 + 0.2 * (double)(i % 4);
    at[1] = 0.2 + 0.2 * (double)(i / 4);
    for (int k = 0; k < 2; k++) off[k] = at[k] - top[k];
    s.value[i] = 3 + exp(-4 * (off[0] * off[0] + off[1] * off[1]));
    for (int k = 0; k < 2; k++) s.by[i][k] = -8 * off[k] * (s.value[i] - 3);
    s.count++;
  }
  assert_true(abbe_surrogate_fit(&s));
  assert_near(abbe_surrogate_at(&s, top, &near), 4, 0.05);
  abbe_surrogate_at(&s, corner, &far);
  assert_true(near > 0 && near < far / 2);
  abbe_surrogate_best(&s, 0, x);
  assert_near(x[0], top[0], 0.08);
  assert_near(x[1], top[1], 0.08);
}
