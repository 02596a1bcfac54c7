#include "validation/measure/gem/gem_maps.h"

#include "tests/validation/measure/gem/gem_stones.h"

static const abbe_gem_view_desc small = {.head_rad = 15 * DEG, .side = 24, .repeats = 3};

/* Of the middle pixel, which the stone fills. */
static void middle(const abbe_gem_view *view, abbe_gem_map map, float rgb[3]) {
  MADE(abbe_image, image, abbe_gem_map_paint(view, map, &image, &error));
  for (size_t c = 0; c < 3; c++) {
    rgb[c] = image.data[3 * (view->side * view->side / 2 + view->side / 2) + c];
    assert_near(image.data[c], 1, 0); /* white where no stone is */
  }
}

/* A roof shows the head alone; a plate shows what is behind it, and the head by its faces. */
TEST(colours_are_those_of_the_scopes) {
  char text[256];
  float rgb[3];
  roof_text(45, text);
  OWNED(judged, j) = judged_plain(text, 1.6);
  OWNED(abbe_gem_view, v) = judged_view(&j, &small);
  middle(&v, ABBE_GEM_MAP_ASET, rgb);
  assert_true(rgb[2] > 2 * rgb[0] && rgb[2] > 2 * rgb[1]);
  middle(&v, ABBE_GEM_MAP_IDEAL, rgb);
  assert_near(rgb[0], 0, 0.01);
  middle(&v, ABBE_GEM_MAP_ISO, rgb);
  assert_near(rgb[1], 1, 0.01);
  middle(&v, ABBE_GEM_MAP_COLOUR, rgb);
  assert_near(rgb[1], 0, 0.01); /* of one wavelength, and dark */
  abbe_gem_view_free(&v);
  judged_free(&j);
  j = judged_plain(slab, 1.5);
  v = judged_view(&j, &small);
  /* 0.923 of the light: sRGB's 0.965 */
  middle(&v, ABBE_GEM_MAP_LEAKAGE, rgb);
  assert_near(rgb[0], 0.9654, 1e-3);
  middle(&v, ABBE_GEM_MAP_IDEAL, rgb);
  assert_near(rgb[1], 0.9654, 1e-3);
  middle(&v, ABBE_GEM_MAP_ASET, rgb);
  assert_true(rgb[0] < 0.1f);
}

/* The means of its channels over the silhouette are the measures. */
TEST(channels_have_the_measures) {
  OWNED(judged, j) = judged_plain(design_b, 2.417);
  OWNED(abbe_gem_view, v) = judged_view(&j, &small);
  MADE(abbe_image, image, abbe_gem_map_image(&v, &image, &error));
  const size_t cover = abbe_image_find_channel(&image, "cover");
  const size_t y = abbe_image_find_channel(&image, "Y");
  assert_true(cover < image.channels && y < image.channels);
  for (int a = 0; a < ABBE_GEM_AMOUNT_COUNT; a++) {
    const size_t c = abbe_image_find_channel(&image, abbe_gem_amount_name((abbe_gem_amount)a));
    double sum = 0, met = 0;
    assert_true(c < image.channels);
    for (size_t i = 0; i < v.side * v.side; i++) {
      const float *p = image.data + i * image.channels;
      sum += (double)p[c] * (double)p[cover];
      met += (double)p[cover];
      if (a == ABBE_GEM_RETURN) assert_near(p[c], p[y], 1e-4);
    }
    assert_near(sum / met, abbe_gem_view_amount(&v, (abbe_gem_amount)a).value, 1e-5);
  }
}
