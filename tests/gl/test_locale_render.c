/* A frame in a program that sets its user's locale: shaders are put together and compiled as ever.
 */
#include "tests/decimal_comma.h"
#include "tests/gl/frame.h"

static void draw(const char *locale, abbe_image *picture, abbe_image *map) {
  const abbe_render_desc desc = {
      .width = 24, .height = 18, .photons = 48, .map_size = 64, .min_nm = 390.5, .max_nm = 720.25};
  assert_non_null(setlocale(LC_ALL, locale));
  abbe_scene scene = scene_of(CAMERA POINT_LIGHT FLOOR BALL("murk"));
  abbe_renderer *renderer = drawn_renderer(&scene, &desc);
  *picture = picture_of(renderer);
  *map = map_of(renderer, 0);
  abbe_renderer_free(renderer);
  abbe_scene_free(&scene);
  setlocale(LC_ALL, "C");
}

TEST(a_frame_is_the_same) {
  abbe_image picture[2] = {{0}}, map[2] = {{0}};
  draw("C", &picture[0], &map[0]);
  draw(COMMA, &picture[1], &map[1]);
  assert_true(image_max(&picture[0], 1) > 0 && image_sum(&map[0], 1) > 0);
  assert_same_pixels(&picture[0], &picture[1]);
  assert_same_pixels(&map[0], &map[1]);
  for (size_t i = 0; i < map[0].attribute_count; i++)
    assert_string_equal(map[0].attribute[i].text, map[1].attribute[i].text);
  for (int i = 0; i < 2; i++) {
    abbe_image_free(&picture[i]);
    abbe_image_free(&map[i]);
  }
}

static void begin(void) {
  comma_setup();
  make_context();
}

static void end(void) {
  free_context();
  comma_teardown();
}

GROUP(begin, end);
