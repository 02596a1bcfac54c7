/* The subcommand derive: what it says of a mirror ball in a room, whose light is known. */
#include "tests/cli/run_json.h"

#include "base/maths.h"
#include "colorimetry/difference.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/rgb_space.h"

#include <math.h>

#define BALL_M 0.05
#define LAMP_M 0.3
#define DERIVE "$abbe derive ball.yaml --points 8 "

static void begin(void) {
  run_setup();
  run_must(
      "cat >ball.yaml <<'Y'\n"
      "camera: {eye: [0, -0.9, 0], target: [0, 0, 0]}\n"
      "lights: [{name: lamp, kind: point, position: [0, 0, 0.3], intensity: 1, illuminant: E}]\n"
      "objects:\n"
      "- {name: ball, shape: sphere, radius: 0.05, mirror: 1}\n"
      "- {name: room, shape: box, size: [2, 2, 2], reflectance: 0.5}\n"
      "Y");
  run_must("cat >glass.yaml <<'Y'\n"
           "materials: [{name: glass, model: constant, coefficients: [1.6], source: here,\n"
           "  absorption: {attenuation_per_m: [[400, 25], [700, 25]]}}]\n"
           "Y");
  run_must("cat >pane.yaml <<'Y'\n"
           "materials: glass.yaml\n"
           "camera: {eye: [0, -0.9, 0], target: [0, 0, 0]}\n"
           "environment: {uniform: 1}\n"
           "objects:\n"
           "- {name: pane, shape: box, size: [0.02, 0.02, 0.004], material: glass}\n"
           "Y");
}

GROUP(begin, run_teardown);

static double value(const cJSON *row, const char *name, int error) {
  return cJSON_GetNumberValue(cJSON_GetArrayItem(json_item(row, name), error));
}

/* All that the ball catches lands in the room: its solid angle 2 pi (1 - cos) from the lamp, which
 * grows with its silhouette alone. */
TEST(a_balls_light_by_its_radius) {
  HELD(cJSON, json) =
      run_json(DERIVE "--by objects.ball.radius --by camera.eye.1 --lines 512 --json", 0);
  assert_contains(run_errors, "nothing that lands depends on 'camera.eye.1'");
  const cJSON *rows = json_item(json, "rows");
  const double cosine = sqrt(1 - BALL_M * BALL_M / (LAMP_M * LAMP_M));
  const double exact[2] = {2 * ABBE_PI * (1 - cosine),
                           2 * ABBE_PI * BALL_M / (LAMP_M * LAMP_M * cosine)};
  for (int i = 0; i < 2; i++) {
    const cJSON *row = cJSON_GetArrayItem(rows, i);
    const double error = value(row, "flux", 1);
    assert_true(error > 0 && error < 0.04 * exact[i]);
    assert_near(value(row, "flux", 0), exact[i], 4 * error);
  }
  assert_true(value(cJSON_GetArrayItem(rows, 2), "flux", 0) == 0);
}

TEST(a_map_has_layers_of_each_key) {
  run_must(DERIVE "--by objects.ball.radius --lines 64 --map 8x8 -q -o map.exr");
  MADE(abbe_image, image, abbe_exr_read(run_path("map.exr"), &image, &error));
  assert_int_equal(image.width, 8);
  static const char *const layers[] = {"Y", "stderr.Y", "objects.ball.radius.Y",
                                       "stderr.objects.ball.radius.Y"};
  for (size_t i = 0; i < sizeof layers / sizeof *layers; i++)
    assert_true(abbe_image_find_channel(&image, layers[i]) < image.channels);
}

/* All light is the lamp's, of 1 W/sr: by its power the picture is its own derivative. */
TEST(a_picture_by_its_lamps_power) {
  HELD(cJSON, json) = run_json(DERIVE "--by lights.lamp.intensity "
                                      "--lines 64 --size 8x8 --spp 4 -o picture.exr --json",
                               0);
  const cJSON *rows = json_item(json, "rows"), *as_it_is = cJSON_GetArrayItem(rows, 0);
  const double mean = value(as_it_is, "mean.G", 0);
  assert_true(mean > 0);
  assert_near(value(cJSON_GetArrayItem(rows, 1), "mean.G", 0), mean, 1e-6 * mean);
  MADE(abbe_image, image, abbe_exr_read(run_path("picture.exr"), &image, &error));
  assert_int_equal(image.width, 8);
  static const char *const layers[] = {"G", "stderr.G", "lights.lamp.intensity.G",
                                       "stderr.lights.lamp.intensity.G"};
  size_t channel[4];
  for (size_t i = 0; i < 4; i++) {
    channel[i] = abbe_image_find_channel(&image, layers[i]);
    assert_true(channel[i] < image.channels);
  }
  for (size_t i = 0; i < 64; i++) {
    const float *pixel = image.data + i * image.channels;
    assert_near((double)pixel[channel[2]], (double)pixel[channel[0]],
                1e-5 * fabs((double)pixel[channel[0]]));
  }
}

static double ciede2000(const double rgb[3], double by, const double white[3],
                        const double lab[3]) {
  double to_xyz[9], xyz[3], own[3];
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_ACESCG, to_xyz);
  abbe_rgb_space_apply(to_xyz, rgb, xyz);
  for (int c = 0; c < 3; c++) xyz[c] *= by;
  abbe_difference_lab(xyz, white, own);
  return abbe_difference_ciede2000(own, lab);
}

/* The target is the picture of a lamp of 0.8 W/sr, so that the region's mean is 1.25 times its own,
 * and grows with the lamp's power. White is the target's brightest pixel, of 64. */
TEST(a_regions_difference_by_its_lamps_power) {
#define REGION                                                                                     \
  DERIVE "--by lights.lamp.intensity --by objects.ball.radius --lines 64 --size 8x8 --spp 4 "
  run_must(REGION "--set lights.lamp.intensity=0.8 -o wanted.exr -q");
  HELD(cJSON, json) = run_json(REGION "--region 2,3,4,2 --target wanted.exr --json -q", 0);
  MADE(abbe_image, image, abbe_exr_read(run_path("wanted.exr"), &image, &error));
  double rgb[3], target[3], to_xyz[9], xyz[3], white[3] = {0}, lab[3], most = 0;
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_ACESCG, to_xyz);
  for (size_t i = 0; i < 64; i++) {
    for (int c = 0; c < 3; c++)
      rgb[c] =
          (double)image.data[i * image.channels +
                             abbe_image_find_channel(&image, (const char *[]){"R", "G", "B"}[c])];
    abbe_rgb_space_apply(to_xyz, rgb, xyz);
    most = fmax(most, xyz[1]);
  }
  white[0] = most * 0.3127 / 0.3290;
  white[1] = most;
  white[2] = most * (1 - 0.3127 - 0.3290) / 0.3290;
  const cJSON *rows = json_item(json, "rows"), *is = cJSON_GetArrayItem(rows, 0);
  for (int c = 0; c < 3; c++) {
    rgb[c] = value(is, (const char *[]){"mean.R", "mean.G", "mean.B"}[c], 0);
    target[c] = 0.8 * rgb[c];
  }
  abbe_rgb_space_apply(to_xyz, target, xyz);
  abbe_difference_lab(xyz, white, lab);
  const double h = 1e-4, exact = ciede2000(rgb, 1, white, lab);
  const double slope =
      (ciede2000(rgb, 1 + h, white, lab) - ciede2000(rgb, 1 - h, white, lab)) / (2 * h);
  assert_true(exact > 1 && slope > 1);
  assert_near(value(is, "ciede2000", 0), exact, 1e-4 * exact);
  assert_near(value(cJSON_GetArrayItem(rows, 1), "ciede2000", 0), slope, 1e-4 * slope);
  assert_true(value(is, "ciede2000", 1) > 0);
  assert_true(value(cJSON_GetArrayItem(rows, 2), "ciede2000", 0) != 0);
  run_fails(REGION "--region 6,3,4,2 --target wanted.exr", 1, "the picture has 8 x 8 pixels");
  run_fails(REGION "--region 2,3,4 --target wanted.exr", 2, "X,Y,W,H is wanted");
  run_fails(REGION "--region 2,3,0,2", 2, "X,Y,W,H is wanted");
  run_fails(REGION "--size 9x8 --target wanted.exr", 1, "give --size 8x8");
  run_fails(REGION "--map 8x8 -o map.exr --target wanted.exr", 2, "are of a picture");
  run_fails(REGION "--target nowhere.exr", 1, "nowhere.exr");
}

/* A pane seen from straight above returns R + (1 - R)^2 R T^2 / (1 - R^2 T^2) of the light, and so
 * do all measures of a pane but the leakage, for all exits go straight up; the head's shadow takes
 * what returns. */
static double pane_returns(double n, double absorption, double thick) {
  const double r = pow((n - 1) / (n + 1), 2), t = exp(-2 * absorption * thick);
  return r + (1 - r) * (1 - r) * r * t / (1 - r * r * t);
}

TEST(a_panes_measures_by_its_numbers) {
  HELD(cJSON, json) = run_json("$abbe derive pane.yaml --stone pane --by materials.glass.n --by "
                               "materials.glass.absorption --by objects.pane.size.2 --by "
                               "materials.glass.B --by camera.eye.1 --json",
                               0);
  assert_contains(run_errors, "does not change with 'camera.eye.1'");
  assert_false(strstr(run_errors, "materials.glass.B'"));
  const cJSON *rows = json_item(json, "rows");
  const double h = 1e-6;
  const double exact[] = {
      pane_returns(1.6, 25, 0.004),
      (pane_returns(1.6 + h, 25, 0.004) - pane_returns(1.6 - h, 25, 0.004)) / (2 * h),
      (pane_returns(1.6, 25 + h, 0.004) - pane_returns(1.6, 25 - h, 0.004)) / (2 * h),
      (pane_returns(1.6, 25, 0.004 + h) - pane_returns(1.6, 25, 0.004 - h)) / (2 * h)};
  for (int i = 0; i < 4; i++) {
    const cJSON *row = cJSON_GetArrayItem(rows, i);
    /* paths end below 1e-4 of the light */
    assert_near(value(row, "iso", 0), exact[i], 5e-4 * fabs(exact[i]));
    assert_near(value(row, "cos", 0), exact[i], 5e-4 * fabs(exact[i]));
    assert_true(value(row, "iso", 1) < 1e-6 * fabs(exact[i]));
    assert_true(value(row, "return", 0) == 0 && value(row, "fire", 0) == 0);
  }
  assert_true(value(cJSON_GetArrayItem(rows, 5), "iso", 0) == 0);
}

/* By differences of the same lines, in the design's own angle, which the file does not name; the
 * measures of a stone are those of its index. */
TEST(a_cuts_measures_by_its_angle) {
  static const char *const names[] = {"return", "iso", "cos", "leakage", "fire"};
  double at[2][5], slope[5];
  for (int i = 0; i < 3; i++) {
    static const char *const sets[] = {"--set objects.stone.pavilion=42.9995",
                                       "--set objects.stone.pavilion=43.0005", ""};
    HELD(cJSON, json) =
        run_json(printed("$abbe derive \"$house\"/scenes/stone.yaml --stone stone --by "
                         "objects.stone.pavilion --lines 64 -q --json %s",
                         sets[i]),
                 0);
    const cJSON *row = cJSON_GetArrayItem(json_item(json, "rows"), i == 2);
    for (int k = 0; k < 5; k++) *(i < 2 ? &at[i][k] : &slope[k]) = value(row, names[k], 0);
  }
  for (int k = 0; k < 5; k++) {
    const double exact = (at[1][k] - at[0][k]) / 0.001;
    assert_near(slope[k], exact, 1e-3 * fabs(exact) + 1e-4);
  }
}

TEST(refusals) {
  run_fails(DERIVE "--by objects.ball.radios", 1, "did you mean 'radius'?");
  run_fails(DERIVE "--by objects.ball.shape", 1, "is no number");
  run_fails(DERIVE "--by lights.lamp.illuminant", 1, "is no number");
  run_fails(DERIVE "--by materials.glas.n", 1, "no refractor is made of 'glas'");
  run_fails(DERIVE "--by objects.ball.radius --map 4096x4096 -o map.exr", 1, "16 million");
  run_fails(DERIVE "--by objects.ball.radius --size 4096x4096 -o picture.exr", 1, "16 million");
  run_must("sed 's/^camera: {/camera: {polariser: {kind: linear, angle: 30}, /' ball.yaml "
           ">polarised.yaml");
  run_fails("$abbe derive polarised.yaml --by objects.ball.radius -o picture.exr", 1,
            "there is a polariser");
  run_fails(DERIVE, 2, "Give --by KEY");
  run_fails(DERIVE "--by objects.ball.radius --stone bal", 1, "has no object 'bal'");
  run_fails(DERIVE "--by objects.ball.radius --stone ball", 1, "'ball' is no stone");
  run_fails("$abbe derive pane.yaml --stone pan --by materials.glass.n", 1, "did you mean 'pane'?");
  run_fails("$abbe derive pane.yaml --stone pane --by objects.pane.material", 1, "is no number");
  run_fails("$abbe derive pane.yaml --stone pane --by materials.glass.n -o map.exr", 2,
            "-o and --map are of pictures");
  run_fails(DERIVE "--by objects.ball.radius --lines 64 -q -o gone/map.exr", 1,
            "its folder is not there");
  run_fails("$abbe derive nowhere.yaml --by objects.ball.radius", 1,
            "nowhere.yaml: cannot be opened");
}
