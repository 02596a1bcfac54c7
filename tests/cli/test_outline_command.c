/* `abbe outline` as people and programs meet it: one picture, two, a dark one, refusals. */
#include "tests/cli/run_json.h"

#include "colorimetry/image/exr.h"

enum { WIDE = 64, HIGH = 48 };

/* A blue square of 8 x 8 pixels with its left upper corner at (x, y) over grey; its light is also
 * in the layer caustic where that is asked for. */
static void write_square(const char *name, int x, int y, float grey, bool apart) {
  static const char *const names[] = {"R", "G", "B", "caustic.R", "caustic.G", "caustic.B"};
  MADE(abbe_image, image, abbe_image_make(WIDE, HIGH, apart ? 6 : 3, names, &image, &error));
  for (int i = 0; i < WIDE * HIGH; i++) {
    float *p = image.data + (size_t)i * image.channels;
    p[0] = p[1] = p[2] = grey;
    if (i % WIDE < x || i % WIDE >= x + 8 || i / WIDE < y || i / WIDE >= y + 8) continue;
    p[2] += 1;
    if (apart) p[5] = 1;
  }
  OK(abbe_exr_write(run_path(name), &image, &error));
}

GROUP(run_setup, run_teardown);

TEST(two_pictures_as_json) {
  write_square("a.exr", 10, 20, 0.25f, true);
  write_square("b.exr", 14, 20, 0.5f, false);
  write_square("dark.exr", WIDE, HIGH, 0.5f, false);
  HELD(cJSON, json) = run_json("\"$abbe\" outline a.exr b.exr --minus dark.exr --blur 0 --share 1 "
                               "--json && rm b.exr dark.exr",
                               0);
  const cJSON *pictures = cJSON_GetObjectItemCaseSensitive(json, "pictures");
  for (int i = 0; i < 2; i++) {
    const cJSON *picture = cJSON_GetArrayItem(pictures, i);
    assert_near(json_number(picture, "inside"), 64, 0);
    assert_near(json_number(picture, "light"), 64 * 0.0722, 0.01);
    const cJSON *blue = cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(picture, "hues"), 4);
    assert_string_equal(cJSON_GetObjectItemCaseSensitive(blue, "name")->valuestring, "blue");
    assert_near(json_number(blue, "share"), 1, 1e-6);
    assert_near(json_number(blue, "x"), 14 + 4 * i, 1e-6);
    assert_near(json_number(blue, "y"), 24, 1e-6);
  }
  const cJSON *both = cJSON_GetObjectItemCaseSensitive(json, "agreement");
  assert_near(json_number(both, "light_ratio"), 1, 1e-6);
  assert_near(json_number(both, "overlap"), 32.0 / 96, 1e-9);
  const cJSON *blue = cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(both, "hues"), 4);
  assert_near(json_number(blue, "apart"), 4, 1e-6);
  assert_near(json_number(blue, "overlap"), 0.5, 1e-6);
  run_says("\"$abbe\" outline a.exr && rm a.exr", "inside the outline, pixels");
  assert_contains(run_output, "blue");
  assert_int_equal(run_left(), 0);
}

TEST(refusals) {
  write_square("black.exr", WIDE, HIGH, 0, false);
  run_must("\"$abbe\" outline black.exr; rm black.exr");
  assert_contains(run_errors, "dark");
  static const struct {
    const char *line;
    int code;
    const char *part;
  } rows[] = {
      {"\"$abbe\" outline", 2, "which picture?"},
      {"\"$abbe\" outline a b c", 2, "one too many"},
      {"\"$abbe\" outline a.exr --share 0", 2, "--share"},
      {"\"$abbe\" outline missing.exr", 1, "missing.exr"},
  };
  int wrong = 0;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
    wrong += !run_refuses(rows[i].line, rows[i].code, rows[i].part);
  assert_int_equal(wrong, 0);
}
