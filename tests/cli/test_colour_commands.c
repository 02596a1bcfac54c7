/* The subcommands weights, display and info, as a person or a program runs them. */
#include "tests/cli/run_output.h"
#include "tests/colorimetry/image/exr_library.h"

#include "base/file.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/rgb_space.h"
#include "colorimetry/weights.h"

#include <cjson/cJSON.h>
#include <unistd.h>

static char exr[64], png[64], other[64];

static void must(int code, const char *says, const char *arguments) {
  int got = run(arguments);
  if (got != code || strstr(output, says) == NULL)
    fail_msg("abbe %s: %d, not %d, with '%s': %s", arguments, got, code, says, output);
}

static cJSON *run_json(const char *arguments) {
  if (run(arguments) != 0) fail_msg("abbe %s: %s", arguments, output);
  cJSON *json = cJSON_Parse(output);
  if (json == NULL) fail_msg("abbe %s: no JSON: %s", arguments, output);
  return json;
}

static double number(const cJSON *object, const char *key, int index) {
  const cJSON *item = cJSON_GetObjectItem(object, key);
  return cJSON_GetNumberValue(index < 0 ? item : cJSON_GetArrayItem(item, index));
}

/* Which part of a file is read is said, and each can be named. */
TEST(parts) {
  const exr_library_file file[] = {
      {{0, 0, 3, 3}, {0, 0, 3, 3}, 1, {"Z"}, {2}, .part = "depth"},
      {{0, 0, 3, 3}, {0, 0, 3, 3}, 3, {"B", "G", "R"}, {2, 2, 2}, .part = "colours"}};
  char why[200];
  const char *parts = printed("%s.parts.exr", exr);
  if (!exr_library_write_parts(parts, file, 2, why, sizeof why)) fail_msg("%s", why);
  must(0, "note:", printed("info %s", parts));
  assert_contains(output, "its part 2");
  assert_contains(output, "3 channels");
  must(0, "of 2 is read", printed("compare %s '%s#2'", parts, parts));
  must(0, "1 channels", printed("info '%s#1'", parts));
  must(1, "it has no part '3'; there are 1 ", printed("display '%s#3' -o %s", parts, png));
  unlink(parts);
}

TEST(weights_json) {
  cJSON *json = run_json("weights --count 7 --range 380:780 --illuminant D65 --space xyz --json");
  const cJSON *samples = cJSON_GetObjectItem(json, "samples");
  assert_int_equal(cJSON_GetArraySize(samples), 7);
  const abbe_illuminant light = {0};
  MADE(abbe_wavelengths, nodes, abbe_wavelengths_make(7, 380, 780, &nodes, &error));
  MADE(abbe_weights, weights,
       abbe_weights_make(&nodes, &light, ABBE_RGB_SPACE_XYZ, &weights, &error));
  for (int i = 0; i < 7; i++) {
    const cJSON *sample = cJSON_GetArrayItem(samples, i);
    assert_true(number(sample, "lambda_nm", -1) == nodes.lambda_nm[i]);
    /* cJSON leaves out a seventeenth digit worth less than an epsilon */
    for (int k = 0; k < 3; k++) {
      double w = weights.weight[i][k];
      assert_true(fabs(number(sample, "weight", k) - w) <= 3e-16 * w);
    }
  }
  assert_true(fabs(number(json, "sum", 1) - 1) < 1e-15);
  cJSON_Delete(json);
}

TEST(weights_of_every_kind) {
  static const char *const spaces[] = {"xyz", "rec709", "acescg"};
  static const char *const lights[] = {"D65", "D50", "a", "E"};
  for (int s = 0; s < 3; s++)
    for (int l = 0; l < 4; l++) {
      cJSON *json = run_json(
          printed("weights --count 333 --space %s --illuminant %s --json", spaces[s], lights[l]));
      double sum[3] = {0}, matrix[9];
      const cJSON *sample = NULL;
      cJSON_ArrayForEach(sample, cJSON_GetObjectItem(json, "samples")) for (int k = 0; k < 3; k++)
          sum[k] += number(sample, "weight", k);
      abbe_rgb_space_to_xyz(s == 0   ? ABBE_RGB_SPACE_XYZ
                            : s == 1 ? ABBE_RGB_SPACE_REC709
                                     : ABBE_RGB_SPACE_ACESCG,
                            matrix);
      abbe_rgb_space_apply(matrix, sum, sum);
      assert_true(fabs(sum[1] - 1) < 1e-13);
      cJSON_Delete(json);
    }
}

TEST(weights_thesis) {
  cJSON *json = run_json("weights --set thesis --json");
  for (int k = 0; k < 3; k++) assert_true(fabs(number(json, "sum", k) - 3.5) < 1e-12);
  cJSON_Delete(json);
  must(0, "680", "weights --set thesis");
}

TEST(weights_used_wrongly) {
  must(2, "--count '0'", "weights --count 0");
  must(2, "--count '4097'", "weights --count 4097");
  must(2, "--range '780:380'", "weights --range 780:380");
  must(2, "--range '-5:380'", "weights --range=-5:380");
  must(2, "did you mean 'acescg'", "weights --space acecsg");
  must(2, "did you mean 'thesis'", "weights --set theses");
  must(2, "--set thesis fixes", "weights --set thesis --count 3");
  must(2, "too many", "weights more");
  must(2, "--unknown", "weights --unknown");
  must(1, "did you mean 'LED-B1'", "weights --illuminant LED-C1");
  must(1, "/no/such.csv", "weights --illuminant /no/such.csv");
  must(1, "900", "weights --range 900:1000");
  must(0, "abbe weights --set thesis", "weights --help");
  must(1, "", "weights > /dev/full");
}

static void make_picture(const double *xy, const char *space, const char *const names[4]) {
  MADE(abbe_image, image, abbe_image_make(4, 3, 4, names, &image, &error));
  for (int i = 0; i < 48; i++) image.data[i] = i % 4 == 3 ? (float)i : 0.18f;
  if (xy != NULL) memcpy(image.xy, xy, sizeof image.xy);
  if (space != NULL) OK(abbe_image_set_attribute(&image, "abbe:space", space, &error));
  image.data[3] = NAN;
  image.data[7] = -INFINITY;
  OK(abbe_exr_write(exr, &image, &error));
}

static const char *const rgbz[4] = {"R", "G", "B", "Z"};

static void show(const char *options, double rgb[3]) {
  const char *arguments = printed("display %s -o %s --bits 16 %s", exr, png, options);
  if (run(arguments) != 0) fail_msg("abbe %s: %s", arguments, output);
  MADE(abbe_image, image, abbe_png_read(png, &image, &error));
  for (int k = 0; k < 3; k++) rgb[k] = (double)image.data[k];
}

TEST(display) {
  double xy[8], rgb[3];
  abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_REC709, xy);
  make_picture(xy, NULL, rgbz);
  show("--view Plain", rgb);
  for (int k = 0; k < 3; k++) assert_true(fabs(rgb[k] - 0.46135) < 1e-4);
  show("--view Plain --exposure 1", rgb);
  for (int k = 0; k < 3; k++) assert_true(fabs(rgb[k] - 0.63424) < 2e-4);
  show("", rgb);
  for (int k = 0; k < 3; k++) assert_true(fabs(rgb[k] - 0.4614) < 2e-3);
}

/* Equal numbers mean another colour in another space; who says so is ranked. */
TEST(display_source) {
  double rgb[3], xy[8];
  make_picture(NULL, "xyz", rgbz);
  show("--view Plain", rgb);
  assert_true(rgb[0] > rgb[1] + 0.01);
  show("--view Plain --source ACEScg", rgb);
  assert_true(fabs(rgb[0] - rgb[1]) < 1e-3);
  static const char *const xyz[4] = {"X", "Y", "Z", "W"};
  make_picture(NULL, NULL, xyz);
  show("--view Plain", rgb);
  assert_true(rgb[0] > rgb[1] + 0.01);
  static const char *const layer[4] = {"caustic.R", "caustic.G", "caustic.B", "Z"};
  make_picture(NULL, NULL, layer);
  show("--view Plain --layer caustic", rgb);
  assert_true(fabs(rgb[0] - rgb[1]) < 1e-3);
  const char *arguments = printed("display %s -o %s", exr, png);
  must(1, "caustic.G", arguments);
  make_picture(NULL, "rgb", rgbz);
  must(1, "'rgb'", arguments);
  abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_REC709, xy);
  xy[0] = 0.7; /* of no space that has a name: grey stays grey */
  make_picture(xy, NULL, rgbz);
  show("--view Plain", rgb);
  assert_true(fabs(rgb[0] - rgb[1]) < 1e-3);
  for (int i = 0; i < 4; i++) xy[2 * i] = xy[2 * i + 1] = 0.1 + 0.1 * i;
  make_picture(xy, NULL, rgbz);
  must(1, exr, arguments);
}

/* A file that does not say its space is Rec.709 to every command, and each says so; and says how
 * many pixels are not finite. */
TEST(one_meaning_of_the_numbers) {
  static const char *const commands[] = {"display %s -o %s", "pixel %s 2,1"};
  double silent[3], said[3], xy[8];
  char line[300];
  abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_REC709, xy);
  make_picture(xy, NULL, rgbz);
  show("--view Plain --exposure 1", said);
  for (int c = 0; c < 2; c++) {
    snprintf(line, sizeof line, commands[c], exr, png);
    assert_int_equal(run(line), 0);
    assert_null(strstr(output, "note"));
  }
  make_picture(NULL, NULL, rgbz);
  show("--view Plain --exposure 1", silent);
  for (int k = 0; k < 3; k++) assert_near(silent[k], said[k], 1e-4);
  for (int c = 0; c < 2; c++) {
    snprintf(line, sizeof line, commands[c], exr, png);
    must(0, "does not say its colour space; linear Rec.709 is taken", line);
  }
  MADE(abbe_image, image, abbe_image_make(8, 4, 3, rgbz, &image, &error));
  for (int i = 0; i < 96; i++) image.data[i] = i < 9 ? INFINITY : i < 12 ? NAN : 1;
  memcpy(image.xy, xy, sizeof xy);
  OK(abbe_exr_write(exr, &image, &error));
  snprintf(line, sizeof line, commands[0], exr, png);
  must(0, ": 3 pixels are infinite, ", line);
  must(0, ": 1 pixels are not a number (NaN)", line);
  snprintf(line, sizeof line, "display %s -o %s --layer G", exr, png);
  must(0, ": 3 pixels are infinite, drawn as the scale's end", line);
  show("--view Looking --exposure -20", said);
  for (int k = 0; k < 3; k++) assert_true(said[k] > 0.99);
}

static bool holds(const char *word) {
  char data[4096];
  FILE *file = fopen(png, "rb");
  assert_non_null(file);
  const size_t size = fread(data, 1, sizeof data, file), length = strlen(word);
  fclose(file);
  for (size_t i = 0; i + length <= size; i++)
    if (memcmp(data + i, word, length) == 0) return true;
  return false;
}

/* By the display that was asked for. */
TEST(display_says_its_colour) {
  double rgb[3];
  make_picture(NULL, NULL, rgbz);
  show("", rgb);
  assert_true(holds("sRGB") && !holds("iCCP"));
  show("--display 'Display P3' --view Plain", rgb);
  assert_true(holds("iCCP") && !holds("sRGB"));
  show("--view Raw", rgb);
  assert_true(!holds("iCCP") && !holds("sRGB"));
}

TEST(gamut) {
  make_picture(NULL, "rec709", rgbz);
  char a[512];
  snprintf(a, sizeof a, "display %s -o %s --gamut squeeze", exr, png);
  must(2, "--gamut 'squeeze'", a);
  snprintf(a, sizeof a, "display %s -o %s --white warm", exr, png);
  must(2, "--white 'warm'", a);
  snprintf(a, sizeof a, "display %s -o %s --display 'Rec.2100 PQ' --bits 8", exr, png);
  must(1, "16 bits", a);
  snprintf(a, sizeof a, "display %s -o %s --ocio ocio://default", exr, png);
  if (run(a) != 0) must(1, "built into OpenColorIO 2.2 and later", a);
  snprintf(a, sizeof a, "display %s -o %s --display 'Rec.2100 PQ'", exr, png);
  assert_int_equal(run(a), 0);
  assert_true(holds("cICP") && !holds("sRGB") && !holds("iCCP"));
  double rgb[3];
  show("--gamut white --white 2856 --view Plain", rgb);
  assert_true(holds("sRGB"));
}

TEST(display_fails) {
  make_picture(NULL, NULL, rgbz);
  unlink(png);
  must(2, "which file", "display -o a.png");
  must(2, "8 or 16 bits, not 12", "display a.exr -o a.png --bits 12");
  must(2, "--exposure 'bright'", "display a.exr -o a.png --exposure bright");
  must(2, "-o names", printed("display %s", exr));
  must(1, "/no/such.exr", "display /no/such.exr -o a.png");
  must(1, "Looking, Plain, Raw", printed("display %s -o %s --view Plane", exr, png));
  must(1, "/no/such.ocio", printed("display %s -o %s --ocio /no/such.ocio", exr, png));
  OK(abbe_file_write(other, "broken: [", 9, &error));
  must(1, other, printed("display %s -o %s --ocio %s", exr, png, other));
  assert_int_not_equal(access(png, F_OK), 0);
  must(1, "/no/such/folder/a.png", printed("display %s -o /no/such/folder/a.png", exr));
  must(1, other, printed("display %s -o %s", other, png));
  must(0, "Display P3 / Plain", "display --list");
}

TEST(info) {
  double xy[8];
  abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_ACESCG, xy);
  make_picture(xy, "acescg", rgbz);
  cJSON *json = run_json(printed("info %s --json", exr));
  assert_true(number(json, "width", -1) == 4 && number(json, "height", -1) == 3);
  assert_true(fabs(number(json, "chromaticities", 0) - 0.713) < 1e-6);
  assert_string_equal(cJSON_GetStringValue(cJSON_GetObjectItem(
                          cJSON_GetObjectItem(json, "attributes"), "abbe:space")),
                      "acescg");
  const cJSON *z = cJSON_GetArrayItem(cJSON_GetObjectItem(json, "channels"), 3);
  assert_string_equal(cJSON_GetStringValue(cJSON_GetObjectItem(z, "name")), "Z");
  assert_true(number(z, "nan", -1) == 1 && number(z, "inf", -1) == 1);
  assert_true(number(z, "min", -1) == 11 && number(z, "max", -1) == 47);
  assert_true(number(z, "mean", -1) == 29);
  cJSON_Delete(json);
  must(0, "4 x 3 pixels, 4 channels", printed("info %s", exr));
  MADE(abbe_image, image, abbe_exr_read(exr, &image, &error));
  char table[2000] = {0};
  memset(table, '7', sizeof table - 1);
  OK(abbe_image_set_attribute(&image, "table", table, &error));
  OK(abbe_exr_write(exr, &image, &error));
  must(0, "777… (--json has all)", printed("info %s", exr));
  must(2, "which file", "info");
  must(1, "/no/such.exr", "info /no/such.exr");
  OK(abbe_file_write(other, "broken", 6, &error));
  must(1, other, printed("info %s", other));
}

/* A full disk, by a limit on the size of files: the sentence, the code, the old file. */
TEST(a_full_disk) {
  make_picture(NULL, NULL, rgbz);
  OK(abbe_file_write(png, "old", 3, &error));
  int status = system(printed("sh -c 'ulimit -f 0; %s display %s -o %s' > %s 2>/dev/null",
                              ABBE_PROGRAM, exr, png, "/dev/null"));
  assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 1);
  FREED char *data = NULL;
  size_t size = 0;
  OK(abbe_file_read(png, 100, &data, &size, &error));
  assert_string_equal(data, "old");
}

static void leave(void) {
  unlink(exr);
  unlink(png);
  unlink(other);
}

static void begin(void) {
  /* As of tests/fontconfig.h, for the program that is run. */
  setenv("LSAN_OPTIONS", "suppressions=" ABBE_SOURCE_DIR "/tests/fontconfig.supp", 1);
  long id = (long)getpid();
  snprintf(exr, sizeof exr, "/tmp/abbe_test_command_%ld.exr", id);
  snprintf(png, sizeof png, "/tmp/abbe_test_command_%ld.png", id);
  snprintf(other, sizeof other, "/tmp/abbe_test_command_%ld.txt", id);
  unsetenv("OCIO");
}

GROUP(begin, leave);
