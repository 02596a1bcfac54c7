#include "tests/scenes/scene_text.h"

#include "tests/random.h"
#include "validation/walks/camera.h"

#define TILTED                                                                                     \
  "materials: glass.yaml\ncamera: {eye: [0.3, -1, 0.5], target: [0.1, 0, 0.05], up: [0.2, 0, 1], " \
  "fov: 70}\n"

static abbe_scene scene;
static abbe_geometry geometry;

static void setup(void) {
  load_text(TILTED POINT_LIGHT FLOOR BALL("flat"), &scene);
  OK(abbe_geometry_make(&scene, &geometry, &error));
}

static void teardown(void) {
  abbe_geometry_free(&geometry);
  abbe_scene_free(&scene);
}

static double dot(const float a[3], const float b[3]) {
  double sum = 0;
  for (int k = 0; k < 3; k++) sum += (double)a[k] * (double)b[k];
  return sum;
}

GROUP(setup, teardown);

TEST(the_frame_is_the_scenes) {
  abbe_trace_camera c;
  abbe_trace_camera_make(&geometry, 64, 48, &c);
  const float *axis[3] = {c.right, c.up, c.forward};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) assert_near(dot(axis[i], axis[j]), i == j, 1e-6);
  /* right-handed: right x up points back */
  float cross[3] = {c.right[1] * c.up[2] - c.right[2] * c.up[1],
                    c.right[2] * c.up[0] - c.right[0] * c.up[2],
                    c.right[0] * c.up[1] - c.right[1] * c.up[0]};
  assert_near(dot(cross, c.forward), -1, 1e-6);
  double way[3], length = 0;
  for (int k = 0; k < 3; k++) way[k] = scene.camera.target[k] - scene.camera.eye[k];
  for (int k = 0; k < 3; k++) length += way[k] * way[k];
  for (int k = 0; k < 3; k++) assert_near((double)c.forward[k], way[k] / sqrt(length), 1e-6);
  assert_near((double)c.half_height, tan(35 * 3.14159265358979 / 180), 1e-6);
  assert_near((double)(c.half_width / c.half_height), 64.0 / 48, 1e-6);
  assert_true(c.up[2] > 0);
}

/* Pixel 0 is at the top left. */
TEST(the_top_left_is_first) {
  abbe_trace_camera c;
  abbe_trace_camera_make(&geometry, 64, 48, &c);
  float d[3];
  abbe_trace_camera_ray(&c, 0.5f, 0.5f, d);
  assert_true(dot(d, c.right) < 0 && dot(d, c.up) > 0);
  abbe_trace_camera_ray(&c, 32, 24, d);
  assert_near(dot(d, c.forward), 1, 1e-6);
}

TEST(a_ray_comes_back_to_its_pixel) {
  static const size_t sizes[][2] = {{1, 1}, {64, 48}, {3, 1000}, {8192, 8192}};
  uint64_t random = 1;
  for (int s = 0; s < 4; s++) {
    abbe_trace_camera c;
    abbe_trace_camera_make(&geometry, sizes[s][0], sizes[s][1], &c);
    for (int i = 0; i < 2000; i++) {
      size_t column = (size_t)random_between(&random, 0, (double)sizes[s][0]);
      size_t row = (size_t)random_between(&random, 0, (double)sizes[s][1]);
      float x = (float)column + (float)random_between(&random, 0.05, 0.95), d[3], p[3], back[3];
      float y = (float)row + (float)random_between(&random, 0.05, 0.95), distance = 0, per_pixel;
      float far = (float)exp(random_between(&random, -3, 4));
      abbe_trace_camera_ray(&c, x, y, d);
      assert_near(dot(d, d), 1, 1e-6);
      for (int k = 0; k < 3; k++) p[k] = c.eye[k] + far * d[k];
      size_t pixel;
      assert_true(abbe_trace_camera_pixel(&c, p, &pixel, &distance, back, &per_pixel));
      assert_int_equal(pixel, row * sizes[s][0] + column);
      assert_near((double)(distance / far), 1, 1e-4);
      assert_near(dot(d, back), 1, 1e-5);
    }
  }
}

/* A pixel's mean of a radiance that reaches the eye from a small source is its intensity over the
 * square of the distance and over the pixel's solid angle; so 1 / per_pixel is that solid angle,
 * and over all pixels the film's: 4 atan(a b / sqrt(1 + a^2 + b^2)). */
TEST(solid_angles_of_pixels_add_up_to_the_films) {
  abbe_trace_camera c;
  abbe_trace_camera_make(&geometry, 200, 100, &c);
  double sum = 0;
  for (size_t row = 0; row < 100; row++)
    for (size_t column = 0; column < 200; column++) {
      float d[3], p[3], distance = 0, per_pixel = 0;
      size_t pixel;
      abbe_trace_camera_ray(&c, (float)column + 0.5f, (float)row + 0.5f, d);
      for (int k = 0; k < 3; k++) p[k] = c.eye[k] + 3 * d[k];
      assert_true(abbe_trace_camera_pixel(&c, p, &pixel, &distance, d, &per_pixel));
      sum += 1 / (double)per_pixel;
    }
  double a = (double)c.half_width, b = (double)c.half_height;
  double film = 4 * atan(a * b / sqrt(1 + a * a + b * b));
  assert_near(sum / film, 1, 1e-4);
}

TEST(what_is_not_in_the_picture_has_no_pixel) {
  abbe_trace_camera c;
  abbe_trace_camera_make(&geometry, 64, 48, &c);
  float d[3], distance, per_pixel, p[3];
  size_t pixel;
  /* behind, at the eye, beside the four edges, far away and no number */
  for (int k = 0; k < 3; k++) p[k] = c.eye[k] - c.forward[k];
  assert_false(abbe_trace_camera_pixel(&c, p, &pixel, &distance, d, &per_pixel));
  assert_false(abbe_trace_camera_pixel(&c, c.eye, &pixel, &distance, d, &per_pixel));
  const float beside[][2] = {{-0.1f, 10}, {64.1f, 10}, {10, -0.1f}, {10, 48.1f}};
  for (int i = 0; i < 4; i++) {
    abbe_trace_camera_ray(&c, beside[i][0], beside[i][1], d);
    for (int k = 0; k < 3; k++) p[k] = c.eye[k] + 2 * d[k];
    assert_false(abbe_trace_camera_pixel(&c, p, &pixel, &distance, d, &per_pixel));
  }
  for (int k = 0; k < 3; k++) p[k] = NAN;
  assert_false(abbe_trace_camera_pixel(&c, p, &pixel, &distance, d, &per_pixel));
}
