#include "tests/check.h"

#include "base/maths.h"

TEST(products) {
  const double x[3] = {1, 0, 0}, y[3] = {0, 2, 0};
  double z[3];
  abbe_vector_cross(x, y, z);
  assert_true(z[0] == 0 && z[1] == 0 && z[2] == 2);
  assert_true(abbe_vector_dot(x, y) == 0);
  assert_true(abbe_vector_length(y) == 2);
  abbe_vector_subtract(z, y, z);
  assert_true(z[1] == -2 && z[2] == 2);
}

TEST(normalising_zero_or_infinity_is_refused) {
  double zero[3] = {0, 0, 0}, infinite[3] = {INFINITY, 0, 0}, good[3] = {0, 0, -4};
  assert_false(abbe_vector_normalise(zero));
  assert_true(zero[0] == 0 && zero[2] == 0);
  assert_false(abbe_vector_normalise(infinite));
  assert_false(abbe_vector_finite(infinite));
  assert_true(abbe_vector_normalise(good) && good[2] == -1);
}

/* Squares of these are subnormal numbers, of few digits. */
TEST(what_is_next_to_nothing_has_a_direction) {
  for (double size = 1e-120; size > 1e-161; size *= 0.1) {
    double a[3] = {3 * size, -4 * size, 12 * size};
    assert_true(abbe_vector_normalise(a));
    assert_true(fabs(a[0] - 3.0 / 13) < 1e-15 && fabs(a[1] + 4.0 / 13) < 1e-15 &&
                fabs(a[2] - 12.0 / 13) < 1e-15);
  }
}

TEST(triangle_points_along_its_normal) {
  const double a[3] = {1, 1, 5}, b[3] = {3, 1, 5}, c[3] = {1, 2, 5};
  double n[3];
  abbe_vector_triangle(a, b, c, n);
  assert_true(n[0] == 0 && n[1] == 0 && n[2] == 2);
}

/* A frame and its mirror image: columns of length 1, square to each other, to one hand each. */
TEST(frames_are_square) {
  const double a[3] = {0, 3, 0}, b[3] = {-2, 5, 0};
  double frame[9], image[9];
  abbe_vector_frame(a, b, 1, frame);
  abbe_vector_frame(a, b, -1, image);
  const double known[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  for (int k = 0; k < 9; k++) {
    assert_true(fabs(frame[k] - known[k]) < 1e-15);
    assert_true(fabs(image[k] - (k == 8 ? -1 : known[k])) < 1e-15);
  }
}
