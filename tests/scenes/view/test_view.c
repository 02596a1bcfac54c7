/* Views: known windows, the way there and back, and their matrices. */
#include "tests/check.h"

#include "base/maths.h"
#include "scenes/geometry/transform.h"
#include "scenes/view/view.h"
#include "tests/scenes/scene_text.h"

/* Doubles of order one, a dozen operations: 1e-12 leaves four digits for rounding. */
static const double tolerance = 1e-12;

static const double eye[3] = {1, 2, 3}, along_y[3] = {0, 2, 0}, up_z[3] = {0, 0, 1};

static void assert_vector(const double v[3], double x, double y, double z) {
  assert_near(v[0], x, tolerance);
  assert_near(v[1], y, tolerance);
  assert_near(v[2], z, tolerance);
}

TEST(look_makes_a_right_handed_frame) {
  abbe_view v;
  abbe_view_look(eye, along_y, up_z, false, &v);
  assert_vector(v.origin, 1, 2, 3);
  assert_vector(v.forward, 0, 1, 0);
  assert_vector(v.right, 1, 0, 0);
  assert_vector(v.up, 0, 0, 1);
}

TEST(up_along_the_view_is_replaced) {
  static const double axes[3][3] = {{1, 0, 0}, {0, -3, 0}, {0, 0, 1e-3}};
  for (int i = 0; i < 3; i++) {
    abbe_view v;
    abbe_view_look(eye, axes[i], axes[i], false, &v);
    assert_near(abbe_vector_dot(v.right, v.right), 1, tolerance);
    assert_near(abbe_vector_dot(v.up, v.up), 1, tolerance);
    assert_near(abbe_vector_dot(v.right, v.forward), 0, tolerance);
    assert_near(abbe_vector_dot(v.up, v.forward), 0, tolerance);
    assert_near(abbe_vector_dot(v.right, v.up), 0, tolerance);
  }
}

TEST(fit_finds_known_windows) {
  static const double points[3][3] = {{2, 4, 2}, {0, 4, 4}, {1, 6, 3}};
  abbe_view v;
  abbe_view_look(eye, along_y, up_z, false, &v);
  assert_true(abbe_view_fit(&v, points, 3));
  assert_near(v.window[0], -0.5, tolerance); /* 1 m left at 2 m */
  assert_near(v.window[1], 0.5, tolerance);
  assert_near(v.window[2], -0.5, tolerance);
  assert_near(v.window[3], 0.5, tolerance);
  assert_near(v.near, 2, tolerance);
  assert_near(v.far, 4, tolerance);
  assert_near(abbe_view_area(&v), 1, tolerance);
  abbe_view_look(eye, along_y, up_z, true, &v);
  assert_true(abbe_view_fit(&v, points, 3));
  assert_near(v.window[0], -1, tolerance); /* metres */
  assert_near(v.window[3], 1, tolerance);
  assert_near(abbe_view_area(&v), 4, tolerance);
}

TEST(fit_says_what_does_not_fit) {
  static const double ahead[1][3] = {{1, 4, 3}}, behind[1][3] = {{2, 1, 3}};
  static const double aside[1][3] = {{1 + 2 * (ABBE_VIEW_MAX_TANGENT + 1), 4, 3}};
  abbe_view v;
  abbe_view_look(eye, along_y, up_z, false, &v);
  assert_true(abbe_view_fit(&v, ahead, 1));
  assert_false(abbe_view_fit(&v, behind, 1));
  assert_near(v.window[1], ABBE_VIEW_MAX_TANGENT, tolerance);
  assert_near(v.window[0], 0, tolerance);
  assert_true(v.near > 0);
  abbe_view_look(eye, along_y, up_z, false, &v);
  assert_false(abbe_view_fit(&v, aside, 1));
  assert_near(v.window[1], ABBE_VIEW_MAX_TANGENT, tolerance);
  /* Parallel light has no such limit. */
  abbe_view_look(eye, along_y, up_z, true, &v);
  assert_true(abbe_view_fit(&v, behind, 1));
  assert_true(abbe_view_fit(&v, aside, 1));
}

TEST(pad_widens_and_never_leaves_nothing) {
  static const double points[2][3] = {{0, 4, 2}, {2, 8, 4}}, one[1][3] = {{1, 4, 3}};
  abbe_view v;
  abbe_view_look(eye, along_y, up_z, true, &v);
  abbe_view_fit(&v, points, 2);
  abbe_view_pad(&v, 0.1);
  assert_near(v.window[0], -1.2, tolerance); /* 10 % of 2 m on each side */
  assert_near(v.window[1], 1.2, tolerance);
  assert_near(v.near, 1.6, tolerance);
  assert_near(v.far, 6.4, tolerance);
  for (int orthographic = 0; orthographic < 2; orthographic++) {
    abbe_view_look(eye, along_y, up_z, orthographic, &v);
    abbe_view_fit(&v, one, 1);
    abbe_view_pad(&v, 0.02);
    assert_true(abbe_view_area(&v) > 0);
    assert_true(v.near > 0);
    assert_true(v.far > v.near);
  }
}

static abbe_view slanted(bool orthographic) {
  static const double forward[3] = {0.3, -0.5, -0.8}, up[3] = {0.1, 0.2, 1};
  static const double window[4] = {-0.7, 0.4, -0.2, 0.9};
  abbe_view v;
  abbe_view_look(eye, forward, up, orthographic, &v);
  memcpy(v.window, window, sizeof window);
  v.near = 0.5;
  v.far = 9;
  return v;
}

TEST(rays_project_back_to_where_they_start) {
  for (int i = 0; i < 2 * 7 * 7; i++) {
    abbe_view v = slanted(i % 2);
    double uv[2] = {(i / 2 % 7) / 6.0, (i / 14) / 6.0}, o[3], d[3], p[3], uvz[3], t = 0.6 + i;
    abbe_view_ray(&v, uv, o, d);
    assert_near(abbe_vector_dot(d, d), 1, tolerance);
    for (int k = 0; k < 3; k++) p[k] = o[k] + t * d[k];
    assert_true(abbe_view_project(&v, p, uvz));
    /* p lies up to 100 m away: its rounding, 1e-14 m, is seen over a window of 1. */
    assert_near(uvz[0], uv[0], tolerance);
    assert_near(uvz[1], uv[1], tolerance);
    assert_near(uvz[2], t, 100 * tolerance);
  }
}

TEST(projection_fails_behind_the_origin_only) {
  double behind[3], uvz[3];
  for (int orthographic = 0; orthographic < 2; orthographic++) {
    abbe_view v = slanted(orthographic);
    for (int k = 0; k < 3; k++) behind[k] = v.origin[k] - v.forward[k];
    assert_int_equal(abbe_view_project(&v, behind, uvz), orthographic);
  }
}

/* Clip space is the window, from -1 to 1, and near to far. */
TEST(the_matrix_agrees_with_the_projection) {
  for (int orthographic = 0; orthographic < 2; orthographic++) {
    abbe_view v = slanted(orthographic);
    double matrix[16], uv[2] = {0.2, 0.7}, o[3], d[3], p[3], clip[3];
    abbe_view_matrix(&v, matrix);
    abbe_view_ray(&v, uv, o, d);
    double depth[3] = {v.near, 2, v.far}, z[3];
    for (int i = 0; i < 3; i++) {
      double t = depth[i] / abbe_vector_dot(d, v.forward);
      for (int k = 0; k < 3; k++) p[k] = o[k] + t * d[k];
      abbe_transform_point(matrix, p, clip);
      assert_near(clip[0], 2 * uv[0] - 1, tolerance);
      assert_near(clip[1], 2 * uv[1] - 1, tolerance);
      z[i] = clip[2];
    }
    assert_near(z[0], -1, tolerance);
    assert_near(z[2], 1, tolerance);
    assert_true(z[1] > -1 && z[1] < 1);
  }
}

TEST(pack_is_the_float_copy) {
  abbe_view v = slanted(false);
  float packed[24];
  abbe_view_pack(&v, packed);
  const double *rows[4] = {v.origin, v.right, v.up, v.forward};
  for (int i = 0; i < 12; i++)
    assert_true(packed[4 * (i / 3) + i % 3] == (float)rows[i / 3][i % 3]);
  for (int k = 0; k < 4; k++) assert_true(packed[16 + k] == (float)v.window[k]);
  assert_true(packed[20] == 0.5f && packed[21] == 9.0f);
  assert_true(packed[3] == 1.0f); /* perspective */
  v = slanted(true);
  abbe_view_pack(&v, packed);
  assert_true(packed[3] == 0.0f);
}

static double sum_of(const abbe_image *alpha) {
  double sum = 0;
  for (size_t i = 0; i < alpha->width * alpha->height; i++) sum += (double)alpha->data[i];
  return sum;
}

static void make(const char *text, size_t width, size_t height, size_t samples, abbe_image *out) {
  OWNED(abbe_scene, scene) = scene_of(text);
  OK(abbe_coverage_make(&scene, width, height, samples, out, &error));
}

/* A ball of radius r at distance d in the middle of the view is a disk of r / sqrt(d^2 - r^2). */
TEST(a_ball_covers_its_disk) {
  OWNED(abbe_image, alpha);
  make("materials: glass.yaml\ncamera: {eye: [0, -1, 0], target: [0, 0, 0], fov: 40}\n"
       "environment: {uniform: 1}\nobjects:\n"
       "- {name: ball, shape: sphere, radius: 0.2, levels: 6, material: flat}\n",
       80, 40, 8, &alpha);
  const double tangent = tan(20 * 3.14159265358979 / 180), r = 0.2 / sqrt(1 - 0.04) / tangent * 20;
  assert_near(sum_of(&alpha), 3.14159265358979 * r * r, 1e-3 * 3.14159265358979 * r * r);
  assert_near((double)alpha.data[20 * 80 + 40], 1, 1e-6);
  assert_near((double)alpha.data[0], 0, 0);
}

/* Rows go downwards, columns to the right; a quarter of the picture is covered to its edges. */
TEST(a_wall_covers_its_side) {
  OWNED(abbe_image, alpha);
  make("materials: glass.yaml\ncamera: {eye: [0, -1, 0], target: [0, 0, 0], fov: 90}\n"
       "environment: {uniform: 1}\nobjects:\n"
       "- {name: wall, shape: rectangle, width: 1, height: 1, reflectance: 1,\n"
       "   transform: [{rotate: {axis: [1, 0, 0], angle: 90}}, {translate: [0.5, 0, 0.5]}]}\n",
       16, 16, 2, &alpha);
  for (size_t y = 0; y < 16; y++)
    for (size_t x = 0; x < 16; x++)
      assert_near((double)alpha.data[y * 16 + x], y < 8 && x >= 8 ? 1 : 0, 0);
}

TEST(nothing_covers_nothing) {
  OWNED(abbe_image, alpha);
  make("camera: {eye: [0, -1, 0], target: [0, 0, 0]}\nenvironment: {uniform: 1}\n", 8, 8, 1,
       &alpha);
  assert_string_equal(alpha.channel[0], "A");
  assert_near(sum_of(&alpha), 0, 0);
}
