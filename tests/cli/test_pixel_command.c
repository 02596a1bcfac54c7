/* The subcommand pixel, as a person or a program runs it. */
#include "tests/cli/run_output.h"

#include "colorimetry/gamut.h"
#include "colorimetry/image/exr.h"

#include <cjson/cJSON.h>

#define PICTURE "pixel_command.exr"
#define PIXEL "pixel " PICTURE " "

/* 2 x 2 pixels of Rec.709's white, with the bands of an even spectrum of 1 in each. */
static void make_picture(void) {
  char name[46][32];
  const char *names[46] = {"R", "G", "B", "stderr.R", "S0.385nm", "stderr.S0.385nm"};
  for (int i = 1; i < 40; i++) {
    snprintf(name[i], sizeof name[i], "S0.%d,0nm", 385 + 10 * i);
    names[5 + i] = name[i];
  }
  MADE(abbe_image, image, abbe_image_make(2, 2, 45, names, &image, &error));
  for (size_t i = 0; i < 4 * 45; i++) image.data[i] = 1;
  OK(abbe_exr_write(PICTURE, &image, &error));
}

static void remove_picture(void) {
  remove(PICTURE);
}

static double number(const cJSON *root, const char *group, const char *key, int index) {
  const cJSON *item = cJSON_GetObjectItem(cJSON_GetObjectItem(root, group), key);
  return cJSON_GetNumberValue(index < 0 ? item : cJSON_GetArrayItem(item, index));
}

GROUP(make_picture, remove_picture);

/* Equal energy is at x = y = 1/3, of 5455 K [CIE15]; the channels' white is D65. */
TEST(equal_energy) {
  assert_int_equal(run(PIXEL "0,0:1,1 --json"), 0);
  cJSON *root = cJSON_Parse(strchr(output, '{'));
  assert_non_null(root);
  assert_near(number(root, "spectrum", "xy", 0), 1.0 / 3, 1e-4);
  assert_near(number(root, "spectrum", "xy", 1), 1.0 / 3, 1e-4);
  assert_near(number(root, "spectrum", "cct_k", -1), 5455, 2);
  assert_near(number(root, "picture", "cct_k", -1), 6504, 2);
  assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(root, "bands")), 40);
  cJSON_Delete(root);
  assert_int_equal(run(PIXEL "1,1 --observer 1964"), 0);
  assert_contains(output, "CIE 1964, 10 degrees");
  assert_contains(output, "S0.385nm");
}

/* Rec.2020's green in linear Rec.709 is (-0.5876, 1.1329, -0.1006) [BT2407]. */
TEST(which_gamuts_a_colour_is_outside_of) {
  const char *const rgb[3] = {"R", "G", "B"};
  MADE(abbe_image, image, abbe_image_make(1, 1, 3, rgb, &image, &error));
  abbe_gamut_chromaticities(ABBE_GAMUT_REC2020, image.xy);
  image.data[1] = 4;
  OK(abbe_exr_write("pixel_gamut.exr", &image, &error));
  assert_int_equal(run("pixel pixel_gamut.exr 0,0"), 0);
  assert_contains(output, "outside of              Rec.709 (red -0.5187, blue -0.0888), P3 (red "
                          "-0.2623, blue -0.0182)\n");
  assert_int_equal(run("pixel pixel_gamut.exr 0,0 --json"), 0);
  cJSON *root = cJSON_Parse(strchr(output, '{'));
  const cJSON *picture = cJSON_GetObjectItem(root, "picture");
  const cJSON *linear = cJSON_GetObjectItem(cJSON_GetObjectItem(picture, "linear_rgb"), "rec709");
  assert_near(cJSON_GetNumberValue(cJSON_GetArrayItem(linear, 0)), -0.5876 / 1.1329, 1e-4);
  assert_near(cJSON_GetNumberValue(cJSON_GetArrayItem(linear, 2)), -0.1006 / 1.1329, 1e-4);
  cJSON_Delete(root);
  remove("pixel_gamut.exr");
  assert_int_equal(run(PIXEL "0,0"), 0);
  assert_contains(output, "outside of              none of Rec.709, P3, Rec.2020\n");
}

TEST(refusals) {
  assert_int_equal(run(PIXEL "2,0"), 1);
  assert_contains(output, "(0, 0) to (1, 1)");
  assert_int_equal(run(PIXEL "nowhere"), 2);
  assert_int_equal(run(PIXEL "1,1:0,0"), 2);
  assert_int_equal(run(PIXEL ""), 2);
  assert_int_equal(run(PIXEL "0,0 --observer 1930"), 2);
  assert_int_equal(run(PIXEL "0,0 --illuminant A"), 1);
  assert_contains(output, "which light it was made with");
}
