/* `abbe compare` as people and programs meet it: numbers, sentences, exit codes, files. */
#include "tests/cli/run_json.h"

#include "colorimetry/image/exr.h"
#include "colorimetry/image/png_file.h"
#include "scenes/view/map_layout.h"

#define COMPARE "\"$abbe\" compare "

static void path_of(const char *name, char path[128]) {
  snprintf(path, 128, "%s/%s", run_folder, name);
}

/* X, Y, Z and perhaps standard errors, 8 x 8: Y = 1 but `bright` in the first eight pixels. */
static abbe_image picture(double bright, double each) {
  static const char *const names[] = {"X", "Y", "Z", "stderr.X", "stderr.Y", "stderr.Z"};
  size_t channels = each > 0 ? 6 : 3;
  abbe_image image = {0};
  OK(abbe_image_make(8, 8, channels, names, &image, &error));
  for (size_t i = 0; i < 64; i++)
    for (size_t c = 0; c < channels; c++)
      image.data[i * channels + c] = c < 3 ? (i < 8 ? (float)bright : 1) : (float)each;
  return image;
}

static void leave(const char *name, abbe_image image) {
  char path[128];
  path_of(name, path);
  OK(abbe_exr_write(path, &image, &error));
  abbe_image_free(&image);
}

/* The same as a map of 8 x 8 texels, or of 16 x 16 that hold a quarter each. */
static abbe_image map(bool fine, double left) {
  static const char *const names[] = {"X", "Y", "Z"};
  static const double origin[3] = {0, 0, 2}, forward[3] = {0, 0, -1}, up[3] = {0, 1, 0};
  size_t side = fine ? 16 : 8;
  abbe_image image = {0};
  OK(abbe_image_make(side, side, 3, names, &image, &error));
  for (size_t i = 0; i < side * side * 3; i++)
    image.data[i] = (float)((fine ? 0.25 : 1) * (i / 3 / side < side / 8 ? 19 : 0.01));
  abbe_view view;
  abbe_map_layout layout;
  abbe_view_look(origin, forward, up, false, &view);
  view.window[0] = left;
  view.window[2] = -1;
  view.window[1] = view.window[3] = 1;
  view.near = 1;
  view.far = 3;
  abbe_map_layout_make(&view, &layout);
  OK(abbe_map_layout_write(&layout, "lamp", &image, &error));
  return image;
}

static double number(const cJSON *json, const char *region, const char *metric, const char *key) {
  const cJSON *o = cJSON_GetObjectItemCaseSensitive(json, "regions");
  o = cJSON_GetObjectItemCaseSensitive(o, region);
  o = cJSON_GetObjectItemCaseSensitive(o, "metrics");
  o = cJSON_GetObjectItemCaseSensitive(o, metric);
  return cJSON_GetNumberValue(cJSON_GetObjectItemCaseSensitive(o, key));
}

EACH(run_setup, run_teardown);

TEST(numbers) {
  leave("ref.exr", picture(1, 0));
  leave("test.exr", picture(3, 0));
  HELD(cJSON, json) = run_json(COMPARE "ref.exr test.exr --json", 0);
  assert_near(number(json, "whole", "relative_rmse", "value"), sqrt(4.0 / 8), 1e-7);
  assert_near(number(json, "whole", "energy_ratio", "value"), 1.25, 1e-7);
  assert_near(number(json, "whole", "squared_relative", "value"), 0.5 / (1.01 * 1.01), 1e-6);
  assert_near(number(json, "whole", "uv_mean", "value"), 0, 1e-7);
  assert_true(isnan(number(json, "whole", "relative_rmse", "noise")));
  assert_null(
      cJSON_GetObjectItemCaseSensitive(cJSON_GetObjectItemCaseSensitive(json, "regions"), "mask"));
  rerun_json(&json, COMPARE "ref.exr test.exr --json --scale best", 0);
  /* sum of ab over sum of a^2: (8 x 3 + 56) / (8 x 9 + 56) */
  assert_near(cJSON_GetNumberValue(cJSON_GetObjectItem(json, "scale")), 80.0 / 128, 1e-7);
  run_must(COMPARE "ref.exr test.exr");
  assert_string_equal(run_errors, "");
  assert_contains(run_output, "relative RMSE");
  assert_contains(run_output, "0.7071");
  assert_contains(run_output, "no standard errors");
}

TEST(maps_of_two_sizes) {
  leave("coarse.exr", map(false, -1));
  leave("fine.exr", map(true, -1));
  leave("moved.exr", map(true, -0.9));
  static const char *const lines[] = {
      COMPARE "coarse.exr fine.exr --mask caustic --json --tolerance mask.relative_rmse=1e-6",
      COMPARE "fine.exr coarse.exr --mask caustic --json --tolerance energy_ratio=1e-6"};
  for (int i = 0; i < 2; i++) {
    HELD(cJSON, json) = run_json(lines[i], 0);
    assert_near(number(json, "whole", "relative_rmse", "value"), 0, 1e-6);
    const cJSON *mask = cJSON_GetObjectItem(json, "mask");
    assert_near(cJSON_GetNumberValue(cJSON_GetObjectItem(mask, "pixels")), 8, 0);
    assert_contains(run_output, "summed down from 16 x 16");
  }
  leave("ref.exr", picture(1, 0));
  run_fails(COMPARE "coarse.exr moved.exr", 1, "--map-like");
  run_fails(COMPARE "coarse.exr ref.exr", 1, "receiver map");
}

/* The way from a reference to a comparison: trace a map, render one like it, compare them. */
TEST(a_traced_map_and_a_rendered_one) {
  assert_int_equal(
      run_line("\"$abbe\" trace \"$house\"/scenes/sphere.yaml -q -o t.exr --save-map ref.exr "
               "--size 16x16 --map 32 --spp 8 --photons 20000 --physics matched && \"$abbe\" "
               "render \"$house\"/scenes/sphere.yaml -q -o r.exr --size 16x16 --aovs --photons 64 "
               "--save-map test.exr --map-like ref.exr"),
      0);
  HELD(cJSON, json) = run_json(COMPARE "ref.exr test.exr --json --mask caustic", 0);
  assert_near(number(json, "whole", "energy_ratio", "value"), 1, 0.05);
  assert_true(number(json, "mask", "relative_rmse", "noise") > 0);
  rerun_json(&json, COMPARE "t.exr r.exr --json --mask caustic", 0);
  assert_near(number(json, "whole", "energy_ratio", "value"), 1, 0.05);
  assert_true(number(json, "whole", "z_mean_square", "value") > 0);
}

TEST(tolerances) {
  leave("ref.exr", picture(1, 0));
  leave("test.exr", picture(3, 0));
  run_must(COMPARE "ref.exr test.exr --tolerance relative_rmse=0.71");
  run_must(COMPARE "ref.exr test.exr --tolerance energy_ratio=0.26");
  run_fails(COMPARE "ref.exr test.exr --tolerance relative_rmse=0.70 --tolerance "
                    "whole.energy_ratio=0.24 --tolerance uv_mean=1",
            3, "test.exr: relative_rmse of the whole field is 0.7071");
  assert_contains(run_errors, "1 more");
  assert_contains(run_output, "relative RMSE"); /* the numbers are told all the same */
  HELD(cJSON, json) = run_json(COMPARE "ref.exr test.exr --json --tolerance relative_rmse=0.1", 3);
  assert_true(cJSON_IsFalse(cJSON_GetObjectItem(json, "within_tolerance")));
}

TEST(a_pixel_that_is_no_number_keeps_no_tolerance) {
  abbe_image bad = picture(1, 0);
  bad.data[30] = NAN;
  leave("ref.exr", picture(1, 0));
  leave("test.exr", bad);
  run_says(COMPARE "ref.exr test.exr", "1 in the test");
  run_fails(COMPARE "ref.exr test.exr --tolerance relative_rmse=1", 3, "not finite");
}

TEST(noise_is_told) {
  leave("ref.exr", picture(1, 0.1));
  leave("near.exr", picture(1.05, 0));
  leave("far.exr", picture(3, 0));
  run_says(COMPARE "ref.exr near.exr --tolerance z_excess=1",
           "below the reference's own noise in relative RMSE");
  assert_contains(run_output, "agree within their errors");
  assert_int_equal(run_line(COMPARE "ref.exr far.exr --tolerance z_excess=1"), 3);
  assert_contains(run_output, "differ by more than noise");
  run_fails(COMPARE "near.exr far.exr --tolerance z_excess=1", 1, "z_excess");
  assert_string_equal(run_output, "");
}

TEST(masks_from_files) {
  abbe_image drawn = picture(1, 0), small = {0}, dark = picture(0, 0);
  static const char *const names[] = {"R"};
  for (size_t i = 24; i < 192; i++) drawn.data[i] = 0;
  for (size_t i = 0; i < 192; i++) dark.data[i] = 0.5f;
  OK(abbe_image_make(4, 4, 1, names, &small, &error));
  char path[128];
  path_of("mask.png", path);
  OK(abbe_png_write(path, &drawn, 8, &error));
  leave("mask.exr", drawn);
  leave("small.exr", small);
  leave("dark.exr", dark);
  leave("ref.exr", picture(1, 0));
  leave("test.exr", picture(3, 0));
  static const char *const lines[] = {COMPARE "ref.exr test.exr --json --mask mask.png",
                                      COMPARE "ref.exr test.exr --json --mask mask.exr"};
  for (int i = 0; i < 2; i++) {
    HELD(cJSON, json) = run_json(lines[i], 0);
    assert_near(number(json, "mask", "relative_rmse", "value"), 2, 1e-6);
    assert_near(number(json, "mask", "energy_ratio", "value"), 3, 1e-6);
    assert_near(number(json, "whole", "energy_ratio", "value"), 1.25, 1e-6);
  }
  static const char *const bad[][2] = {{"small.exr", "4 x 4"},
                                       {"dark.exr", "nowhere above 0.5"},
                                       {"missing.png", "missing.png"},
                                       {"caustic", "caustic.*"}};
  for (int i = 0; i < 4; i++) {
    run_fails(printed(COMPARE "ref.exr test.exr --mask %s", bad[i][0]), 1, bad[i][1]);
    assert_string_equal(run_output, "");
  }
}

TEST(the_difference_picture) {
  leave("ref.exr", picture(1, 0));
  leave("test.exr", picture(3, 0));
  char path[128];
  run_must(COMPARE "ref.exr test.exr --difference d.png --json");
  assert_string_equal(run_errors, "");
  path_of("d.png", path);
  MADE(abbe_image, image, abbe_png_read(path, &image, &error));
  size_t red = 0, all = image.width * image.height;
  for (size_t i = 0; i < all; i++) red += image.data[3 * i] > 2 * image.data[3 * i + 2];
  /* The first row of eight, 64 pixels high, and the bar. */
  assert_true(red >= 512 * 64 && red < 512 * 80);
  run_must(COMPARE "ref.exr ref.exr --difference d.png --range 0.5");
  run_fails(COMPARE "ref.exr test.exr --difference no/d.png", 1, "no/d.png");
  run_must(COMPARE "ref.exr test.exr --difference d.svg");
  run_fails(COMPARE "ref.exr test.exr --difference d.gif", 1, "d.gif");
}

TEST(bad_files) {
  abbe_image half = {0};
  static const char *const names[] = {"depth"};
  OK(abbe_image_make(8, 8, 1, names, &half, &error));
  leave("depth.exr", half);
  abbe_image dark = picture(0, 0);
  memset(dark.data, 0, 192 * sizeof *dark.data);
  leave("dark.exr", dark);
  leave("ref.exr", picture(1, 0));
  static const char *const small_names[] = {"R", "G", "B"};
  abbe_image small = {0};
  OK(abbe_image_make(4, 8, 3, small_names, &small, &error));
  leave("small.exr", small);
  static const struct {
    const char *line, *says;
  } rows[] = {
      {"head -c 300 ref.exr >cut.exr; " COMPARE "ref.exr cut.exr", "cut.exr"},
      {COMPARE "cut.exr ref.exr", "cut.exr"},
      {COMPARE "missing.exr ref.exr", "missing.exr"},
      {COMPARE ". ref.exr", "is a directory; name a file"},
      {COMPARE "ref.exr small.exr", "8 x 8 pixels and small.exr has 4 x 8"},
      {COMPARE "ref.exr depth.exr", "depth.exr: it has no channels R, G, B"},
      {COMPARE "dark.exr ref.exr", "the reference is black"},
      {COMPARE "ref.exr dark.exr --scale best", "no scale"},
      {COMPARE "ref.exr ref.exr --tolerance bands_relative_rmse=1", "bands_relative_rmse"},
      {COMPARE "ref.exr ref.exr >/dev/full", "could not be written to the output"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    int code = run_line(rows[i].line);
    if (code != 1 || strstr(run_errors, rows[i].says) == NULL || run_output[0] != '\0')
      fail_msg("%s ends with %d: %s%s", rows[i].line, code, run_errors, run_output);
  }
}

TEST(used_wrongly) {
  static const struct {
    const char *line, *says;
  } rows[] = {
      {COMPARE, "which two files"},
      {COMPARE "a.exr", "which two files"},
      {COMPARE "a.exr b.exr c.exr", "too many"},
      {COMPARE "a b --tolerance relative_rmsee=1", "did you mean 'relative_rmse'"},
      {COMPARE "a b --tolerance relative_rmse", "is not METRIC=X"},
      {COMPARE "a b --tolerance =1", "is not METRIC=X"},
      {COMPARE "a b --tolerance relative_rmse=-1", "'-1'"},
      {COMPARE "a b --tolerance relative_rmse=nan", "'nan'"},
      {COMPARE "a b --tolerance mask.relative_rmse=1", "needs a --mask"},
      {COMPARE "a b --scale worst", "'worst'"},
      {COMPARE "a b --white 0", "--white '0'"},
      {COMPARE "a b --white 1,2", "--white '1,2'"},
      {COMPARE "a b --white 1,2,x", "--white '1,2,x'"},
      {COMPARE "a b --range 1", "--difference"},
      {COMPARE "a b --mask-share 2", "--mask-share '2'"},
      {COMPARE "a b --seed x", "--seed 'x'"},
  };
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    int code = run_line(rows[i].line);
    if (code != 2 || strstr(run_errors, rows[i].says) == NULL || run_output[0] != '\0')
      fail_msg("%s ends with %d: %s%s", rows[i].line, code, run_errors, run_output);
  }
}
