/* What every verb that reads a picture makes of its windows: the picture is the display window. */
#include "tests/cli/run_program.h"
#include "tests/colorimetry/image/exr_library.h"

#include "colorimetry/image/png_file.h"

/* A picture in the program's folder; all have the same values from their data window's corner on.
 */
static void write_picture(const char *name, const int display[4], const int data[4]) {
  exr_library_file f = {.channels = 3, .name = {"B", "G", "R"}, .type = {2, 2, 2}};
  char why[300];
  const char *path = printed("%s/%s", run_folder, name);
  memcpy(f.display_window, display, sizeof f.display_window);
  memcpy(f.data_window, data, sizeof f.data_window);
  if (!exr_library_write(path, &f, why, sizeof why)) fail_msg("%s: %s", name, why);
}

static void ends_with(int code, const char *line) {
  const int actual = run_line(line);
  if (actual != code) fail_msg("%s ends with %d:\n%s%s", line, actual, run_output, run_errors);
}

static void write_pictures(void) {
  write_picture("plain.exr", (const int[]){0, 0, 31, 23}, (const int[]){0, 0, 31, 23});
  write_picture("apart.exr", (const int[]){100, 50, 131, 73}, (const int[]){100, 50, 131, 73});
  write_picture("left.exr", (const int[]){0, 0, 31, 23}, (const int[]){2, 3, 9, 8});
  write_picture("right.exr", (const int[]){0, 0, 31, 23}, (const int[]){22, 3, 29, 8});
  write_picture("over.exr", (const int[]){0, 0, 31, 23}, (const int[]){-8, -6, 39, 29});
  write_picture("nothing.exr", (const int[]){0, 0, 31, 23}, (const int[]){40, 3, 49, 8});
}

GROUP(run_setup, run_teardown);

TEST(info) {
  write_pictures();
  ends_with(0, "$abbe info plain.exr");
  assert_contains(run_output, "32 x 24 pixels");
  assert_null(strstr(run_output, "window"));
  ends_with(0, "$abbe info apart.exr");
  assert_contains(run_output, "display window  (100, 50) to (131, 73)");
  assert_null(strstr(run_output, "data window"));
  ends_with(0, "$abbe info left.exr");
  assert_contains(run_output, "32 x 24 pixels");
  assert_contains(run_output, "data window     (2, 3) to (9, 8): elsewhere the picture is 0\n");
  assert_contains(run_output, "\nB                               0 ");
  ends_with(0, "$abbe info over.exr");
  assert_contains(run_output, "(-8, -6) to (39, 29): what lies outside the display window is left");
  ends_with(0, "$abbe info nothing.exr");
  assert_contains(run_output, "elsewhere the picture is 0; nothing of it is shown");
  ends_with(0, "$abbe info --json left.exr | tr -d ' \\n\\t'");
  assert_contains(run_output, "\"display_window\":[0,0,31,23],\"data_window\":[2,3,9,8]");
}

/* One block of light in two places is not one picture. */
TEST(compare) {
  write_pictures();
  ends_with(0, "$abbe compare left.exr left.exr --tolerance relative_rmse=0");
  ends_with(3, "$abbe compare left.exr right.exr --tolerance relative_rmse=0.5");
  ends_with(0, "$abbe compare left.exr left.exr --tolerance flip_mean=0 --tolerance ssim=0 "
               "--tolerance itp_mean=0 --tolerance cie94_mean=0");
  ends_with(3, "$abbe compare left.exr right.exr --tolerance ssim=0.001");
  ends_with(3, "$abbe compare left.exr right.exr --tolerance flip_mean=0.001");
  /* what lies outside the display window is not compared */
  write_picture("wide.exr", (const int[]){0, 0, 31, 23}, (const int[]){0, 0, 63, 47});
  write_picture("cut.exr", (const int[]){0, 0, 15, 11}, (const int[]){0, 0, 63, 47});
  ends_with(0, "$abbe compare wide.exr wide.exr --tolerance hdr_flip_mean=0");
  ends_with(1, "$abbe compare wide.exr cut.exr");
  ends_with(0, "$abbe compare apart.exr apart.exr --tolerance relative_rmse=0");
  ends_with(1, "$abbe compare plain.exr apart.exr");
  assert_contains(run_errors,
                  "plain.exr shows (0, 0) to (31, 23) and apart.exr (100, 50) to (131, 73)");
  ends_with(1, "$abbe compare plain.exr plain.exr --mask apart.exr");
  assert_contains(run_errors, "apart.exr shows (100, 50)");
}

TEST(display) {
  write_pictures();
  ends_with(0, "$abbe display left.exr -o left.png --view Raw");
  MADE(abbe_image, image, abbe_png_read(run_path("left.png"), &image, &error));
  assert_int_equal(image.width, 32);
  assert_int_equal(image.height, 24);
  for (size_t y = 0; y < 24; y++)
    for (size_t x = 0; x < 32; x++) {
      const bool inside = x >= 2 && x <= 9 && y >= 3 && y <= 8;
      assert_int_equal(image.data[3 * (y * 32 + x)] > 0, inside);
    }
}

/* A depth and the colours, 32 x 16, as parts of one file. */
static void write_parts(const char *name) {
  exr_library_file f[2] = {
      {.part = "depth", .channels = 1, .name = {"Z"}, .type = {2}},
      {.part = "rgba", .channels = 3, .name = {"B", "G", "R"}, .type = {2, 2, 2}}};
  char why[300];
  for (int i = 0; i < 2; i++) {
    memcpy(f[i].data_window, (const int[]){0, 0, 7, 15}, sizeof f[i].data_window);
    memcpy(f[i].display_window, (const int[]){0, 0, 31, 15}, sizeof f[i].display_window);
  }
  const char *path = printed("%s/%s", run_folder, name);
  if (!exr_library_write_parts(path, f, 2, why, sizeof why)) fail_msg("%s: %s", name, why);
}

/* Whoever reads a picture says which part of its file that is, and writes over no part of it. */
TEST(parts) {
  static const char *const lines[] = {"$abbe compare plain.exr plain.exr --mask parts.exr",
                                      "$abbe plan scene.yaml", "$abbe plan second.yaml"};
  static const char *const over[] = {
      "$abbe display 'parts.exr#2' -o parts.exr",
      "$abbe compare plain.exr 'parts.exr#rgba' --difference parts.exr"};
  write_parts("parts.exr");
  write_picture("plain.exr", (const int[]){0, 0, 31, 15}, (const int[]){0, 0, 31, 15});
  run_must("for i in '' '#rgba' '#1'; do printf 'camera: {eye: [0, -1, 0], target: [0, 0, "
           "0]}\\nobjects:\\n- "
           "{shape: rectangle, width: 1, height: 1, reflectance: 0.5}\\nenvironment: {file: "
           "\"parts.exr%s\"}\\n' \"$i\" >scene$i.yaml; done; mv 'scene#rgba.yaml' second.yaml; cp "
           "parts.exr parts-0000.exr; cp plain.exr parts-0001.exr");
  for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
    ends_with(0, lines[i]);
    assert_contains(run_errors, "its part 2 'rgba' of 2 is read");
  }
  ends_with(1, "$abbe plan 'scene#1.yaml'");
  assert_contains(run_errors, "no channels R, G and B");
  for (size_t i = 0; i < sizeof over / sizeof *over; i++) {
    ends_with(2, over[i]);
    assert_contains(run_errors, "would be written over");
  }
  run_must("cmp parts.exr parts-0000.exr");
}
