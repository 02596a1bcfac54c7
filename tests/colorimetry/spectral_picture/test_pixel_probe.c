#include "tests/check.h"

#include "colorimetry/spectral_picture/pixel_probe.h"

static const char *const names[] = {
    "R", "G", "B", "stderr.R", "S0.500nm", "S0.600nm", "stderr.S0.500nm"};
enum { CHANNELS = 7 };

/* 3 x 2 pixels from (10, 20) on, channel c of pixel i being 100 i + c. */
static void make(abbe_image *image) {
  OK(abbe_image_make(3, 2, CHANNELS, names, image, &error));
  for (size_t i = 0; i < 6 * CHANNELS; i++)
    image->data[i] = (float)(100 * (i / CHANNELS) + i % CHANNELS);
  image->display_window = (abbe_image_window){10, 20, 12, 21};
}

TEST(a_pixel_and_a_region) {
  const abbe_spectral_view view = {0};
  FILLED(abbe_image, image, make(&image));
  MADE(abbe_pixel_probe, p,
       abbe_pixel_probe_make(&image, NULL, "it", (abbe_image_window){11, 21, 11, 21}, &view, &p,
                             &error));
  assert_int_equal(p.pixels, 1);
  for (size_t c = 0; c < CHANNELS; c++) assert_near(p.mean[c], 400 + (double)c, 1e-12);
  assert_near(p.error[0], 403, 1e-12);
  assert_near(p.error[4], 406, 1e-12);
  assert_true(isnan(p.error[1]));
  assert_true(p.has_colour && p.space.assumed && p.has_spectral_xyz && !p.is_relative);
  abbe_pixel_probe_free(&p);

  OK(abbe_pixel_probe_make(&image, NULL, "it", (abbe_image_window){10, 20, 11, 21}, &view, &p,
                           &error));
  assert_int_equal(p.pixels, 4);
  assert_near(p.mean[1], (1 + 101 + 301 + 401) / 4.0, 1e-12);
  assert_near(p.error[0], sqrt(3 * 3 + 103 * 103 + 303 * 303 + 403 * 403) / 4, 1e-9);
}

TEST(colour_is_xyz) {
  const abbe_spectral_view view = {0};
  FILLED(abbe_image, image, make(&image));
  for (size_t c = 0; c < 3; c++) image.data[c] = 1;
  MADE(abbe_pixel_probe, p,
       abbe_pixel_probe_make(&image, NULL, "it", (abbe_image_window){10, 20, 10, 20}, &view, &p,
                             &error));
  assert_near(p.xyz[0], 0.3127 / 0.3290, 1e-9);
  assert_near(p.xyz[1], 1, 1e-9);
}

TEST(refusals) {
  const abbe_spectral_view view = {0};
  static const abbe_image_window outside[] = {
      {9, 20, 10, 20}, {10, 20, 13, 20}, {10, 22, 10, 22}, {11, 20, 10, 20}};
  abbe_pixel_probe p;
  FILLED(abbe_image, image, make(&image));
  for (int i = 0; i < 4; i++) {
    REFUSED(ABBE_INVALID_ARGUMENT, "(10, 20) to (12, 21)",
            abbe_pixel_probe_make(&image, NULL, "it.exr", outside[i], &view, &p, &error));
  }
  REFUSED(ABBE_NOT_FOUND, "layer 'none'",
          abbe_pixel_probe_make(&image, "none", "it.exr", (abbe_image_window){10, 20, 10, 20},
                                &view, &p, &error));
}
