/* A picture of four pixels whose places in each gamut are known, and pictures of nothing. */
#include "tests/check.h"
#include "tests/fontconfig.h"

#include "base/file.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/picture_gamut/gamut_check.h"

#include <unistd.h>

/* Rec.709 white; half as bright, outside by a quarter; Rec.2020's green; dark. */
static abbe_image picture(void) {
  static const char *const names[] = {"R", "G", "B"};
  abbe_image image = {0};
  double to[9], from[9], green[3] = {0, 1, 0};
  abbe_gamut_to_xyz(ABBE_GAMUT_REC2020, to);
  abbe_gamut_from_xyz(ABBE_GAMUT_REC709, from);
  abbe_rgb_space_apply(to, green, green);
  abbe_rgb_space_apply(from, green, green);
  const double pixel[4][3] = {
      {1, 1, 1}, {0.8, 0.4, -0.2}, {green[0], green[1], green[2]}, {0, 0, 0}};
  OK(abbe_image_make(2, 2, 3, names, &image, &error));
  OK(abbe_image_set_attribute(&image, "abbe:space", "rec709", &error));
  for (int i = 0; i < 12; i++) image.data[i] = (float)pixel[i / 3][i % 3];
  return image;
}

TEST(known_pixels) {
  OWNED(abbe_image, image) = picture();
  MADE(abbe_gamut_check, c, abbe_gamut_check_make(&image, "it", ABBE_GAMUT_REC709, &c, &error));
  assert_int_equal(c.lit, 3);
  assert_int_equal(c.outside, 2);
  assert_int_equal(c.x, 0);
  assert_int_equal(c.y, 1);
  /* Rec.2020's green in Rec.709 is (-0.5876, 1.1329, -0.1006) [BT2087] */
  assert_near(c.excess_greatest, 0.5876 / 1.1329, 2e-4);
  assert_near(c.excess_mean, (0.25 + 0.5876 / 1.1329) / 2, 2e-4);
  const double y = 0.8 * 0.2126 + 0.4 * 0.7152 - 0.2 * 0.0722;
  assert_near(c.light_outside, (y + 0.678) / (1 + y + 0.678), 2e-4);
  assert_near(c.white_y, 1, 1e-4);
  assert_near(c.cost[ABBE_GAMUT_MAP_NONE].greatest, 0, 0);
  for (int k = ABBE_GAMUT_MAP_CLIP; k < ABBE_GAMUT_MAP_COUNT; k++)
    assert_true(c.cost[k].mean > 1 && c.cost[k].greatest >= c.cost[k].mean);
  assert_near(c.cost[ABBE_GAMUT_MAP_WHITE].hue_greatest, 0, 0.01);
  assert_true(c.cost[ABBE_GAMUT_MAP_CLIP].hue_greatest > 1);
  abbe_gamut_check_free(&c);
  OK(abbe_gamut_check_make(&image, "it", ABBE_GAMUT_REC2020, &c, &error));
  assert_int_equal(c.outside, 1);
  abbe_gamut_check_free(&c);
}

TEST(what_is_not_finite_is_counted) {
  OWNED(abbe_image, image) = picture();
  image.data[0] = INFINITY;
  image.data[4] = NAN;
  MADE(abbe_gamut_check, c, abbe_gamut_check_make(&image, "it", ABBE_GAMUT_REC709, &c, &error));
  assert_true(c.odd.infinite == 1 && c.odd.nan == 1);
  assert_int_equal(c.lit, 1);
}

TEST(pictures_of_it) {
  static const char png[] = "/tmp/abbe_test_overlay.png", svg[] = "/tmp/abbe_test_diagram.svg";
  OWNED(abbe_image, image) = picture();
  MADE(abbe_gamut_check, c, abbe_gamut_check_make(&image, "it", ABBE_GAMUT_REC709, &c, &error));
  OK(abbe_gamut_check_overlay(&c, png, &error));
  OK(abbe_gamut_check_diagram(&c, svg, "it", &error));
  assert_int_equal(abbe_gamut_check_diagram(&c, "it.jpg", "it", NULL), ABBE_INVALID_ARGUMENT);
  MADE(abbe_image, read, abbe_png_read(png, &read, &error));
  const float *p = read.data;
  assert_true(p[0] == p[1] && p[1] == p[2] && p[0] > 0.5f); /* inside: grey */
  assert_true(p[6] > p[7] + 0.3f);                          /* outside: red */
  assert_true(p[9] == 0 && p[10] == 0);
  FILE *file = fopen(svg, "r");
  assert_non_null(file);
  fclose(file);
  unlink(png);
  unlink(svg);
}

TEST(nothing) {
  static const char *const names[] = {"A", "Z", "S0.5"};
  OWNED(abbe_image, image) = picture();
  abbe_gamut_check c;
  memset(image.data, 0, 12 * sizeof *image.data);
  image.data[3] = NAN;
  REFUSED(ABBE_INVALID_ARGUMENT, "it: none of its 2 x 2 pixels is lit",
          abbe_gamut_check_make(&image, "it", ABBE_GAMUT_P3, &c, &error));
  assert_null(c.xyz);
  MADE(abbe_image, other, abbe_image_make(2, 2, 3, names, &other, &error));
  REFUSED(ABBE_NOT_FOUND, "", abbe_gamut_check_make(&other, "it", ABBE_GAMUT_P3, &c, &error));
}
