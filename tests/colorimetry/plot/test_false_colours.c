#include "tests/check.h"
#include "tests/fontconfig.h"

#include "colorimetry/image/png_file.h"
#include "colorimetry/plot/false_colours.h"
#include "colorimetry/rgb_space.h"

static const char *const names[] = {"R",        "G",        "B",       "stderr.R", "stderr.G",
                                    "stderr.B", "S0.500nm", "depth.Z", "S0.600nm"};
enum { CHANNELS = 9 };

static void make(abbe_image *image) {
  OK(abbe_image_make(8, 4, CHANNELS, names, image, &error));
  for (size_t i = 0; i < 32 * CHANNELS; i++)
    image->data[i] = (float)(i % CHANNELS) + (float)(i / CHANNELS) / 32;
}

TEST(what_is_meant) {
  static const struct {
    const char *layer;
    bool meant;
  } of[] = {{"S0.500nm", true}, {"500nm", true},  {"549", true},    {"551nm", true},
            {"700nm", false},   {"stderr", true}, {"depth", false}, {"depth.Z", true},
            {"stderr.G", true}, {"R", true},      {"none", false},  {"500 nm", false}};
  FILLED(abbe_image, image, make(&image));
  for (size_t i = 0; i < sizeof of / sizeof *of; i++)
    assert_int_equal(abbe_false_colours_mean(&image, of[i].layer), of[i].meant);
  assert_false(abbe_false_colours_mean(&image, NULL));
}

TEST(values) {
  FREED float *value = NULL;
  char title[100];
  bool is_error;
  double to_xyz[9];
  FILLED(abbe_image, image, make(&image));
  OK(abbe_false_colours_values(&image, "551nm", "it", &value, title, sizeof title, &is_error,
                               &error));
  assert_string_equal(title, "S0.600nm");
  assert_false(is_error);
  for (int p = 0; p < 32; p++) assert_true(value[p] == (float)(8 + p / 32.0));
  free(value);
  /* Errors of Y: no chromaticities, so Rec.709. */
  OK(abbe_false_colours_values(&image, "stderr", "it", &value, title, sizeof title, &is_error,
                               &error));
  assert_true(is_error);
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_REC709, to_xyz);
  for (int p = 0; p < 32; p++)
    assert_near(
        (double)value[p],
        to_xyz[3] * (3 + p / 32.0) + to_xyz[4] * (4 + p / 32.0) + to_xyz[5] * (5 + p / 32.0), 1e-5);
}

TEST(pictures_and_refusals) {
  abbe_image png;
  FILLED(abbe_image, image, make(&image));
  image.data[6] = NAN;
  image.data[CHANNELS + 6] = -3;
  static const char *const layers[] = {"500nm", "stderr", "depth.Z", "600nm"};
  for (size_t i = 0; i < 4; i++) {
    OK(abbe_false_colours_write("false_colours.png", &image, layers[i], "it", &error));
    OK(abbe_png_read("false_colours.png", &png, &error));
    assert_true(png.width > 512 && png.height > 256);
    abbe_image_free(&png);
  }
  remove("false_colours.png");
  REFUSED(ABBE_NOT_FOUND, "it.exr: it has no channel or band '700nm'",
          abbe_false_colours_write("false_colours.png", &image, "700nm", "it.exr", &error));
  assert_contains(last_error.text, "S0.500nm");
  for (size_t i = 0; i < 32 * CHANNELS; i++) image.data[i] = NAN;
  OK(abbe_false_colours_write("false_colours.png", &image, "stderr", "it", &error));
  remove("false_colours.png");
}
