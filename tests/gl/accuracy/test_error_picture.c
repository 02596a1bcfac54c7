/* Error bars in false colours: black where there is no error, white at the scale's end. */
#include "gl/accuracy/error_bars.h"

#include "colorimetry/image/picture_space.h"
#include "colorimetry/image/png_file.h"
#include "tests/check.h"
#include "tests/fontconfig.h"

#include <unistd.h>

static const char *const folder_name = "/tmp/abbe-test-errors-XXXXXX";

/* 64 x 64 pixels: the left half without error, the right half of `each`. */
static abbe_error_bars bars_of(double each) {
  static const char *const errors[] = {"stderr.X", "stderr.Y", "stderr.Z"};
  static const char *const names[] = {"X", "Y", "Z"};
  abbe_error_bars bars = {0};
  OK(abbe_image_make(64, 64, 3, errors, &bars.error, &error));
  OK(abbe_image_make(64, 64, 3, names, &bars.mean, &error));
  OK(abbe_image_set_attribute(&bars.mean, "abbe:space", "xyz", &error));
  for (size_t p = 0; p < 64 * 64; p++)
    if (p % 64 >= 32) bars.error.data[3 * p + 1] = (float)each;
  return bars;
}

/* Pixels of the colour of t in the picture of the errors. */
static size_t count(const abbe_error_bars *bars, double t) {
  char folder[64];
  double rgb[3];
  size_t found = 0;
  snprintf(folder, sizeof folder, "%s", folder_name);
  assert_non_null(mkdtemp(folder));
  const char *path = printed("%s/errors.png", folder);
  OK(abbe_error_picture_write(path, bars, &error));
  MADE(abbe_image, image, abbe_png_read(path, &image, &error));
  abbe_colour_map_at(ABBE_COLOUR_MAP_AMOUNT, t, rgb);
  for (size_t p = 0; p < image.width * image.height; p++) {
    bool same = true;
    for (size_t c = 0; c < 3; c++)
      same = same && fabs((double)image.data[p * image.channels + c] - rgb[c]) < 1.5 / 255;
    found += same;
  }
  unlink(path);
  rmdir(folder);
  return found;
}

TEST(colours) {
  /* A pixel is drawn as 8 x 8, and the frame lies on the rim. The scale runs from 0.0005 to 0.5;
   * 0.05 is two thirds of its decades up. */
  OWNED(abbe_error_bars, bars) = bars_of(0.05);
  for (size_t p = 32; p < 64; p++) bars.error.data[3 * p + 1] = 0.5f;
  assert_true(count(&bars, 0) >= 254 * 508);
  assert_true(count(&bars, 2.0 / 3.0) >= 254 * 500);
  assert_true(count(&bars, 1) >= 254 * 6);
}

/* Without any error all is black, and the scale still has a length. */
TEST(no_error_at_all) {
  OWNED(abbe_error_bars, bars) = bars_of(0);
  assert_true(count(&bars, 0) >= 508 * 508);
}

TEST(other_formats_are_refused) {
  OWNED(abbe_error_bars, bars) = bars_of(1);
  REFUSED(ABBE_INVALID_ARGUMENT, "errors.gif",
          abbe_error_picture_write("errors.gif", &bars, &error));
}
