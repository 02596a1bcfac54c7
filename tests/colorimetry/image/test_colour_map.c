#include "tests/check.h"

#include "colorimetry/image/colour_map.h"

static void check_colour(abbe_colour_map map, double t, double r, double g, double b,
                         double tolerance) {
  double rgb[3];
  abbe_colour_map_at(map, t, rgb);
  assert_near(rgb[0], r, tolerance);
  assert_near(rgb[1], g, tolerance);
  assert_near(rgb[2], b, tolerance);
}

/* The colours that the paper prints, in 8 bits. */
TEST(differences_have_the_published_ends) {
  check_colour(ABBE_COLOUR_MAP_DIFFERENCE, 0, 59 / 255.0, 76 / 255.0, 192 / 255.0, 1.5 / 255);
  check_colour(ABBE_COLOUR_MAP_DIFFERENCE, 0.5, 221 / 255.0, 221 / 255.0, 221 / 255.0, 1.0 / 255);
  check_colour(ABBE_COLOUR_MAP_DIFFERENCE, 1, 180 / 255.0, 4 / 255.0, 38 / 255.0, 1.5 / 255);
}

TEST(amounts_grow_lighter) {
  check_colour(ABBE_COLOUR_MAP_AMOUNT, 0, 0, 0, 0, 0);
  check_colour(ABBE_COLOUR_MAP_AMOUNT, 1, 1, 1, 1, 0);
  double before = -1;
  for (int i = 0; i <= 1000; i++) {
    double rgb[3];
    abbe_colour_map_at(ABBE_COLOUR_MAP_AMOUNT, i / 1000.0, rgb);
    /* the weights that the map is built about: perceived brightness of encoded components */
    double lightness = 0.30 * rgb[0] + 0.59 * rgb[1] + 0.11 * rgb[2];
    assert_true(lightness > before);
    assert_near(lightness, i / 1000.0, 0.003);
    before = lightness;
  }
}

TEST(what_is_outside_is_held) {
  for (int map = 0; map < 2; map++) {
    double in[3], out[3];
    abbe_colour_map_at((abbe_colour_map)map, 0, in);
    abbe_colour_map_at((abbe_colour_map)map, -INFINITY, out);
    assert_memory_equal(in, out, sizeof in);
    abbe_colour_map_at((abbe_colour_map)map, 1, in);
    abbe_colour_map_at((abbe_colour_map)map, 7, out);
    assert_memory_equal(in, out, sizeof in);
    check_colour((abbe_colour_map)map, NAN, 0, 0.8, 0, 0);
  }
}
