#include "tests/check.h"

#include "base/maths.h"
#include "scenes/geometry/transform.h"

static void assert_point(const double m[16], double x, double y, double z, double ex, double ey,
                         double ez) {
  const double in[3] = {x, y, z};
  double out[3];
  abbe_transform_point(m, in, out);
  assert_true(fabs(out[0] - ex) < 1e-12 && fabs(out[1] - ey) < 1e-12 && fabs(out[2] - ez) < 1e-12);
}

TEST(rotation_is_right_handed) {
  const double axis[3] = {0, 0, 7};
  double m[16];
  abbe_transform_rotate(ABBE_PI / 2, axis, m);
  assert_point(m, 1, 0, 0, 0, 1, 0);
  assert_point(m, 0, 1, 0, -1, 0, 0);
}

TEST(product_applies_the_right_one_first_and_aliases) {
  const double offset[3] = {1, 2, 3}, factor[3] = {2, 2, 2};
  double move[16], scale[16];
  abbe_transform_translate(offset, move);
  abbe_transform_scale(factor, scale);
  abbe_transform_multiply(move, scale, scale);
  assert_point(scale, 1, 1, 1, 3, 4, 5);
  const double d[3] = {1, 0, 0};
  double out[3];
  abbe_transform_direction(scale, d, out);
  assert_true(out[0] == 2 && out[1] == 0 && out[2] == 0);
  assert_true(fabs(abbe_transform_determinant3(scale) - 8) < 1e-12);
}

TEST(look_at_puts_the_target_on_minus_z) {
  const double eye[3] = {3, -4, 5}, target[3] = {0, 1, 0}, up[3] = {0, 0, 1};
  double m[16];
  abbe_transform_look_at(eye, target, up, m);
  assert_point(m, 3, -4, 5, 0, 0, 0);
  assert_point(m, 0, 1, 0, 0, 0, -sqrt(9 + 25 + 25));
  const double parallel[3] = {3, -4, 0};
  abbe_transform_look_at(eye, parallel, up, m);
  assert_point(m, 3, -4, 0, 0, 0, -5);
  const double zero[3] = {0, 0, 0}, sideways[3] = {0, 5, 0}, y[3] = {0, 1, 0};
  abbe_transform_look_at(zero, sideways, y, m);
  assert_point(m, 0, 5, 0, 0, 0, -5);
}

TEST(perspective_maps_its_frustum_to_the_cube) {
  double m[16];
  abbe_transform_perspective(-0.5, 1.0, -0.25, 0.75, 0.1, 10, m);
  assert_point(m, -0.05, -0.025, -0.1, -1, -1, -1);
  assert_point(m, 10, 7.5, -10, 1, 1, 1);
}

TEST(orthographic_maps_its_box_to_the_cube) {
  double m[16];
  abbe_transform_orthographic(-2, 4, -1, 1, 1, 3, m);
  assert_point(m, -2, -1, -1, -1, -1, -1);
  assert_point(m, 4, 1, -3, 1, 1, 1);
}

TEST(inverse_undoes_and_refuses_singular) {
  const double offset[3] = {1, 2, 3}, axis[3] = {1, 1, 0}, flat[3] = {1, 0, 1};
  double move[16], turn[16], back[16];
  abbe_transform_translate(offset, move);
  abbe_transform_rotate(0.7, axis, turn);
  abbe_transform_multiply(move, turn, turn);
  assert_true(abbe_transform_inverse(turn, back));
  abbe_transform_multiply(back, turn, back);
  assert_point(back, 4, 5, 6, 4, 5, 6);
  abbe_transform_scale(flat, move);
  memcpy(back, turn, sizeof back);
  assert_false(abbe_transform_inverse(move, back));
  assert_memory_equal(back, turn, sizeof back);
  double normal[9];
  assert_false(abbe_transform_normal_matrix(move, normal));
}

TEST(normal_matrix_keeps_normals_perpendicular) {
  const double factor[3] = {1, 4, 1};
  double m[16], n[9];
  abbe_transform_scale(factor, m);
  assert_true(abbe_transform_normal_matrix(m, n));
  /* the plane x + y = 0 with normal (1, 1, 0) becomes x + y / 4 = 0 */
  assert_true(fabs(n[0] * 1 + n[3] * 1 - 1) < 1e-12 && fabs(n[1] * 1 + n[4] * 1 - 0.25) < 1e-12);
}

TEST(identity_changes_nothing) {
  double m[16];
  abbe_transform_identity(m);
  assert_point(m, 1, -2, 3, 1, -2, 3);
}
