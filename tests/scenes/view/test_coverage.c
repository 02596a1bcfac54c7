#include "tests/scenes/scene_text.h"

#include "scenes/view/coverage.h"

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
