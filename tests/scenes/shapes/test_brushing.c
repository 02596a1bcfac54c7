#include "tests/check.h"

#include "scenes/geometry/transform.h"
#include "scenes/shapes/brushing.h"

TEST(grooves_run_along_or_around) {
  static const struct {
    bool around;
    double axis[3], centre[3], p[3], n[3], along[3];
  } rows[] = {
      {false, {0, 0, 1}, {0, 0, 0}, {3, 0, 5}, {1, 0, 0}, {0, 0, 1}},
      {false, {0, 0, 1}, {0, 0, 0}, {3, 0, 5}, {0.6, 0, 0.8}, {-0.8, 0, 0.6}},
      {true, {0, 0, 1}, {0, 0, 0}, {3, 0, 5}, {1, 0, 0}, {0, 1, 0}},
      {true, {0, 0, 1}, {1, 2, 0}, {1, 7, 5}, {0, 0, 1}, {-1, 0, 0}}, /* the top of a ring */
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    abbe_brushing b = {.around = rows[i].around};
    double along[3];
    memcpy(b.axis, rows[i].axis, sizeof b.axis);
    memcpy(b.centre, rows[i].centre, sizeof b.centre);
    abbe_brushing_grain(&b, rows[i].p, rows[i].n, along);
    for (int k = 0; k < 3; k++) assert_near(along[k], rows[i].along[k], 1e-12);
  }
}

/* At a pole, on the axis, without one: any way, but along the surface and of length 1. */
TEST(there_is_always_a_way) {
  static const double n[][3] = {{0, 0, 1}, {0, -1, 0}, {1, 0, 0}, {0.6, 0, 0.8}, {1, 1e-12, 0}};
  for (size_t i = 0; i < sizeof n / sizeof *n; i++)
    for (int around = 0; around < 2; around++)
      for (int axis = 0; axis < 2; axis++) {
        abbe_brushing b = {.around = around != 0};
        double along[3];
        for (int k = 0; k < 3; k++) b.axis[k] = axis * n[i][k];
        abbe_brushing_grain(&b, b.axis, n[i], along);
        double square = 0, off = 0;
        for (int k = 0; k < 3; k++) {
          square += along[k] * along[k];
          off += along[k] * n[i][k];
        }
        assert_near(square, 1, 1e-12);
        assert_near(off, 0, 1e-12);
      }
}

TEST(it_moves_with_its_object) {
  static const double x[3] = {0, 0, 3}, turn[3] = {1, 0, 0};
  abbe_brushing b = {.facets = {0.1, 0.3}, .around = true, .axis = {0, 0, 1}, .centre = {0, 0, 1}};
  double m[16], step[16];
  abbe_transform_rotate(3.14159265358979323846 / 2, turn, m);
  abbe_transform_translate(x, step);
  abbe_transform_multiply(step, m, m);
  abbe_brushing_move(&b, m);
  assert_near(b.axis[1], -1, 1e-12);
  assert_near(b.centre[1], -1, 1e-12);
  assert_near(b.centre[2], 3, 1e-12);
  assert_true(abbe_brushing_is_rough(&b) && !abbe_brushing_is_rough(&(abbe_brushing){0}));
}
