#include "tests/gl/frame.h"

#include "colorimetry/weights.h"

enum { BANDS = 96 };

/* The map of one frame, with so many bands. */
static void make_bands(const abbe_scene *scene, size_t bands, abbe_image *map) {
  HELD(abbe_renderer, renderer) = drawn_renderer(scene, &small_frame);
  OK(abbe_renderer_read_map_bands(renderer, 0, bands, map, &error));
}

GROUP(make_context, free_context);

TEST(bands_add_up_to_the_colour) {
  OWNED(abbe_scene, scene) = shipped_scene("gem");
  FILLED(abbe_image, map, make_bands(&scene, BANDS, &map));
  assert_int_equal(map.channels, 3 + BANDS);
  assert_string_equal(map.channel[3], "S0.382,083333nm");
  assert_string_equal(map.channel[3 + BANDS - 1], "S0.777,916667nm");
  const abbe_illuminant *light = &scene.light[0].illuminant;
  const double width = 400.0 / BANDS;
  double sum[3] = {0};
  for (size_t i = 0; i < BANDS; i++) {
    const double from = 380 + width * (double)i, to = from + width;
    double xyz[3], power = abbe_weights_band_power(light, 380, 780, from, to);
    abbe_weights_band_xyz(light, 380, 780, from, to, xyz);
    const double flux = width * image_sum(&map, 3 + i);
    for (int c = 0; c < 3; c++) sum[c] += flux / power * xyz[c];
  }
  for (size_t c = 0; c < 3; c++) {
    /* What a wall lets through is told at the mean wavelength of a piece's X, Y or Z, or of its
     * part of a band: of a piece as wide as an interval the first lacks what bends, 3e-4 at the
     * most. A band's light is taken to be even in it, which at the violet end of a dense flint is
     * told by narrow bands alone. */
    assert_true(fabs(sum[c] / image_sum(&map, c) - 1) < 5e-4);
  }
}

/* Where the light of a channel lies on the map, along its column (axis 0) or row (1). */
static double middle_of(const abbe_image *map, size_t channel, int axis) {
  double sum = 0, weighted = 0;
  for (size_t y = 0; y < map->height; y++)
    for (size_t x = 0; x < map->width; x++) {
      const double v = (double)map->data[(y * map->width + x) * map->channels + channel];
      sum += v;
      weighted += v * (double)(axis == 0 ? x : y);
    }
  return weighted / sum;
}

TEST(a_prism_sorts_the_bands) {
  OWNED(abbe_scene, scene) = shipped_scene("prism");
  FILLED(abbe_image, map, make_bands(&scene, 8, &map));
  const double across = middle_of(&map, 10, 0) - middle_of(&map, 3, 0);
  const double along = middle_of(&map, 10, 1) - middle_of(&map, 3, 1);
  const int axis = fabs(along) > fabs(across);
  const double way = axis ? along : across;
  assert_true(fabs(way) > 10);
  for (size_t i = 4; i < 11; i++)
    assert_true((middle_of(&map, i, axis) - middle_of(&map, i - 1, axis)) * way > 0);
}

TEST(the_renderer_is_as_it_was) {
  OWNED(abbe_scene, scene) = shipped_scene("gem");
  HELD(abbe_renderer, renderer) = drawn_renderer(&scene, &small_frame);
  OWNED(abbe_image, before) = map_of(renderer, 0);
  MADE(abbe_image, bands, abbe_renderer_read_map_bands(renderer, 0, 5, &bands, &error));
  OWNED(abbe_image, after) = map_of(renderer, 0);
  assert_same_pixels(&before, &after);
  for (size_t i = 0; i < before.width * before.height; i++)
    assert_memory_equal(before.data + 3 * i, bands.data + 8 * i, 3 * sizeof(float));
  abbe_image_free(&after);
  draw_frame(renderer);
  after = map_of(renderer, 0);
  assert_true(image_sum(&after, 1) > 0);
}

TEST(refuses_what_has_no_bands) {
  abbe_image map;
  OWNED(abbe_scene, scene) = shipped_scene("gem");
  HELD(abbe_renderer, renderer) = make_renderer(&scene, &small_frame);
  const size_t bad[] = {0, ABBE_RENDER_MAX_BANDS + 1};
  for (size_t i = 0; i < 2; i++)
    REFUSED(ABBE_INVALID_ARGUMENT, "",
            abbe_renderer_read_map_bands(renderer, 0, bad[i], &map, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_renderer_read_map_bands(renderer, 7, 3, &map, &error));
  abbe_renderer_free(renderer);
  abbe_render_desc desc = small_frame;
  desc.profile = ABBE_PROFILE_THESIS;
  renderer = make_renderer(&scene, &desc);
  REFUSED(ABBE_INVALID_ARGUMENT, "thesis",
          abbe_renderer_read_map_bands(renderer, 0, 3, &map, &error));
}
