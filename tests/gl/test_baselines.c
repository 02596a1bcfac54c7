/* The thesis's passes in physical units: what arrives, what is white, and what lies in the open. */
#include "tests/gl/frame.h"

#define PANE(material)                                                                             \
  "- {name: pane, shape: box, size: [0.3, 0.3, 0.001], transform: [{translate: [0.05, 0.03, "      \
  "0.3]}], material: " material "}\n"

static void draw(const abbe_scene *scene, abbe_profile profile, abbe_image *picture,
                 abbe_image *map) {
  const abbe_render_desc desc = {.profile = profile,
                                 .width = 64,
                                 .height = 64,
                                 .photons = 217, /* so that splats lie anywhere in a texel */
                                 .map_size = 512,
                                 .supersample = 1,
                                 .exits = 1,
                                 .space = ABBE_RGB_SPACE_XYZ,
                                 .fill = ABBE_FILL_NONE};
  HELD(abbe_renderer, renderer) = drawn_renderer(scene, &desc);
  *picture = picture_of(renderer);
  *map = map_of(renderer, 0);
}

GROUP(make_context, free_context);

/* A pane turns no light: both profiles hold the lamp's power through it, less two reflections. */
TEST(what_arrives_is_what_was_sent) {
  OWNED(abbe_image, own_picture) = {0}, own_map = {0}, picture = {0}, map = {0};
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR PANE("flat"));
  draw(&scene, ABBE_PROFILE_DEFAULT, &own_picture, &own_map);
  draw(&scene, ABBE_PROFILE_THESIS_CIE, &picture, &map);
  /* Power in the solid angle of a square of half side a at distance h, less two reflections of 4 %
   * (5 % at its corners). */
  double h = 0.2995, a = 0.15, angle = 4 * asin(a * a / (a * a + h * h));
  double sum = image_sum(&map, 1), own = image_sum(&own_map, 1);
  assert_near(own, angle * 0.9216, 0.02 * angle);
  /* Cells at the rim are whole ones, and a splat's sum depends on where in a texel it lies. */
  assert_near(sum / own, 1, 0.02);
  /* White light stays white. */
  for (size_t c = 0; c < 3; c += 2)
    assert_near(image_sum(&map, c) / sum, image_sum(&own_map, c) / own, 1e-4);
}

/* A floor in the open has the same radiance, pixel by pixel, in the default profile's own units. */
TEST(light_in_the_open_is_the_same) {
  OWNED(abbe_image, own_picture) = {0}, own_map = {0}, picture = {0}, map = {0};
  OWNED(abbe_scene, scene) = scene_of(CAMERA "ambient: 0.3\n" POINT_LIGHT FLOOR PANE("flat"));
  draw(&scene, ABBE_PROFILE_DEFAULT, &own_picture, &own_map);
  draw(&scene, ABBE_PROFILE_THESIS_CIE, &picture, &map);
  assert_string_equal(picture.channel[0], "X");
  size_t same = 0, lit = 0;
  for (size_t i = 0; i < 64 * 64; i++) {
    double y = (double)picture.data[3 * i + 1], right = (double)own_picture.data[3 * i + 1];
    lit += right > 0;
    same += right > 0 && fabs(y / right - 1) < 1e-3;
  }
  /* The rest is the pane and its shadow; what it mirrors goes up and away. */
  assert_true(lit > 1000);
  assert_true(same > 3 * lit / 5);
}
