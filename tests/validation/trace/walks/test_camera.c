#include "tests/scenes/scene_text.h"

#include "tests/random.h"
#include "validation/trace/walks/camera.h"

#define TILTED                                                                                     \
  "materials: glass.yaml\ncamera: {eye: [0.3, -1, 0.5], target: [0.1, 0, 0.05], up: [0.2, 0, 1], " \
  "fov: 70}\n"

static abbe_scene scene;
static abbe_geometry geometry;

static void setup(void) {
  scene = scene_of(TILTED POINT_LIGHT FLOOR BALL("flat"));
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

/* A point is seen as a disk whose radius on the film is the lens's times |1 / focus - 1 / z|, even
 * over its area; what is as far away as the focus stays a point, and rays lead to where it is. */
TEST(a_lens_blurs_by_disks) {
  enum { SIDE = 32, PIXELS = 4096 };
  static const float focus = 2, lens = 0.05f;
  for (int i = 0; i < 4; i++) {
    const float z = 1.0f + (float)i * 0.5f;
    abbe_trace_camera c;
    double square = 0, most = 0;
    abbe_trace_camera_make(&geometry, PIXELS, PIXELS, &c);
    c.lens = lens;
    c.focus = focus;
    float p[3], d[3], distance, per_pixel;
    for (int k = 0; k < 3; k++) p[k] = c.eye[k] + z * (c.forward[k] + 0.1f * c.right[k]);
    for (int n = 0; n < SIDE * SIDE; n++) {
      const abbe_trace_camera from = abbe_trace_camera_at(&c, ((float)(n % SIDE) + 0.5f) / SIDE,
                                                          ((float)(n / SIDE) + 0.5f) / SIDE);
      size_t pixel = 0;
      assert_true(abbe_trace_camera_pixel(&from, p, &pixel, &distance, d, &per_pixel));
      const float x = (float)(pixel % PIXELS) + 0.5f, y = (float)(pixel / PIXELS) + 0.5f;
      const double right = (2 * (double)x / PIXELS - 1) * (double)c.half_width - 0.1;
      const double up = (1 - 2 * (double)y / PIXELS) * (double)c.half_height;
      square += (right * right + up * up) / (SIDE * SIDE);
      most = fmax(most, hypot(right, up));
      float back[3];
      abbe_trace_camera_ray(&from, x, y, back);
      assert_near(dot(back, d), 1, 1e-6);
    }
    const double radius = (double)lens * fabs(1 / (double)focus - 1 / (double)z);
    const double side = 2 * (double)c.half_width / PIXELS;
    assert_near(most, radius, 0.02 * radius + side);
    assert_near(sqrt(2 * square), radius, 0.01 * radius + side);
  }
}
