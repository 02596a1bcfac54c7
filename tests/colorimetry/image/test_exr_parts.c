#define _GNU_SOURCE /* memmem */
/* What of an OpenEXR file belongs together: levels, parts, sums of channels, and what a header says
 * wrongly of them. */
#include "tests/check.h"
#include "tests/colorimetry/image/exr_library.h"
#include "tests/colorimetry/image/exr_parts_file.h"

#include "base/file.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/rgb_space.h"

#include <openexr.h>
#include <unistd.h>

static char path[128];

static exr_library_file coloured(int codec, int side) {
  exr_library_file f = {.channels = 3, .type = {1, 1, 1}, .name = {"B", "G", "R"}, .codec = codec};
  f.data_window[2] = f.display_window[2] = f.data_window[3] = f.display_window[3] = side - 1;
  return f;
}

/* A level's pixels, all or those of a window: here lesser levels show the corner of the full one.
 */
TEST(levels_of_tiles) {
  static const int sides[][2] = {{37, 20}, {20, 37}};
  for (int i = 0; i < 4; i++) {
    const int *side = sides[i / 2], ripmap = i % 2;
    exr_library_file f = coloured(EXR_COMPRESSION_ZIP, 0);
    f.tile[0] = f.tile[1] = 16;
    f.levels = 1 + ripmap;
    f.data_window[2] = f.display_window[2] = side[0] - 1;
    f.data_window[3] = f.display_window[3] = side[1] - 1;
    char why[300];
    if (!exr_library_write(path, &f, why, sizeof why)) fail_msg("%s", why);
    abbe_exr_reader *reader = NULL;
    abbe_exr_levels levels;
    abbe_image none;
    OK(abbe_exr_open(path, &reader, &error));
    abbe_exr_find_levels(reader, &levels);
    assert_int_equal(levels.count, ripmap ? 1 : 6); /* 1 + floor(log2) */
    MADE(abbe_image, whole, abbe_exr_read_level(reader, 0, NULL, &whole, &error));
    MADE(abbe_image, all, abbe_exr_read(path, &all, &error));
    const size_t row = whole.width * 3;
    assert_memory_equal(whole.data, all.data, row * whole.height * sizeof(float));
    for (size_t level = 1; level < levels.count; level++) {
      MADE(abbe_image, less, abbe_exr_read_level(reader, level, NULL, &less, &error));
      assert_int_equal(less.width, side[0] >> level > 1 ? side[0] >> level : 1);
      assert_int_equal(less.height, side[1] >> level > 1 ? side[1] >> level : 1);
      for (size_t y = 0; y < less.height; y++)
        assert_memory_equal(less.data + y * less.width * 3, whole.data + y * row,
                            less.width * 3 * sizeof(float));
    }
    if (ripmap) abbe_exr_close(reader);
    if (ripmap) continue;
    MADE(abbe_image, part,
         abbe_exr_read_level(reader, 1, (const size_t[]){3, 5, 8, 9}, &part, &error));
    assert_true(part.width == 6 && part.height == 5);
    assert_memory_equal(part.data, whole.data + 5 * row + 9, 18 * sizeof(float));
    REFUSED(ABBE_INVALID_ARGUMENT, "it has no level",
            abbe_exr_read_level(reader, levels.count, NULL, &none, &error));
    static const size_t wrong[][4] = {{4, 0, 3, 0}, {0, 4, 0, 3}, {0, 0, 99, 0}, {0, 0, 0, 99}};
    for (int k = 0; k < 4; k++)
      REFUSED(ABBE_INVALID_ARGUMENT, "are not in its level 1",
              abbe_exr_read_level(reader, 1, wrong[k], &none, &error));
    abbe_exr_close(reader);
    f.display_window[2]++; /* then levels are of something else than what is shown */
    if (!exr_library_write(path, &f, why, sizeof why)) fail_msg("%s", why);
    OK(abbe_exr_open(path, &reader, &error));
    abbe_exr_find_levels(reader, &levels);
    assert_int_equal(levels.count, 1);
    abbe_exr_close(reader);
  }
  write_parts(path, 2);
  abbe_exr_reader *reader = NULL;
  abbe_image none;
  abbe_exr_levels levels;
  OK(abbe_exr_open(path, &reader, &error));
  abbe_exr_find_levels(reader, &levels);
  assert_int_equal(levels.count, 1);
  REFUSED(ABBE_INVALID_ARGUMENT, "it has no levels",
          abbe_exr_read_level(reader, 0, NULL, &none, &error));
  abbe_exr_close(reader);
  abbe_exr_close(NULL);
}

/* A part belongs to the picture where it is marked as data, is packed and placed alike, and has
 * channels of its own. */
TEST(data_that_is_not_the_pictures) {
  const exr_library_file rgb = {.part = "p",
                                .channels = 3,
                                .name = {"B", "G", "R"},
                                .type = {1, 1, 1},
                                .codec = EXR_COMPRESSION_ZIP,
                                .data_window = {0, 0, 9, 9},
                                .display_window = {0, 0, 9, 9}};
  for (int odd = 0; odd < 7; odd++) {
    exr_library_file f[2] = {rgb, rgb};
    char why[300];
    f[1].part = "d";
    f[1].channels = 1;
    f[1].name[0] = odd == 1 ? "G" : "X";
    f[1].id = odd == 2 ? NULL : odd == 3 ? "lin_ap1_scene" : "data";
    if (odd == 4) f[1].codec = EXR_COMPRESSION_ZIPS;
    if (odd == 5) f[1].data_window[3] = 8;
    if (odd == 6) f[1].tile[0] = f[1].tile[1] = 4;
    if (!exr_library_write_parts(path, f, 2, why, sizeof why)) fail_msg("%s", why);
    MADE(abbe_image, image, abbe_exr_read(path, &image, &error));
    assert_int_equal(image.channels, odd == 0 ? 4 : 3);
    assert_string_equal(image.part, odd == 0 ? "" : "1 'p' of 2");
  }
}

/* Sums of the channels that are asked for alone; a sum that is no number is counted. */
TEST(sums_of_channels) {
  static const char *const four[] = {"R", "G", "B", "normal.X"};
  static const double weight[2][3] = {{1, 2, 4}, {0.5, 0, 1}}, factor[2] = {1, 1};
  static const size_t channel[2] = {1, 0};
  MADE(abbe_image, image, abbe_image_make(3, 2, 4, four, &image, &error));
  abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_ACESCG, image.xy);
  for (size_t i = 0; i < 24; i++) image.data[i] = (float)i;
  image.data[4 * 1 + 0] = INFINITY;
  image.data[4 * 2 + 1] = NAN;
  image.data[4 * 3 + 2] = NAN; /* of a channel that is not asked for */
  image.data[4 * 4 + 3] = INFINITY;
  OK(abbe_exr_write(path, &image, &error));
  abbe_exr_reader *reader = NULL;
  OK(abbe_exr_open(path, &reader, &error));
  MADE(abbe_image, head, abbe_exr_read_header(reader, &head, &error));
  assert_null(head.data);
  size_t place[2];
  for (int k = 0; k < 2; k++) place[k] = abbe_image_find_channel(&head, four[channel[k]]);
  MADE(abbe_image, out, abbe_image_make(3, 2, 3, four, &out, &error));
  abbe_image_odd odd;
  OK(abbe_exr_read_sums(reader, 2, place, weight, factor, &out, &odd, &error));
  abbe_exr_close(reader);
  for (size_t p = 0; p < 6; p++)
    for (int k = 0; k < 3; k++) {
      const double g = (double)image.data[4 * p + 1], r = (double)image.data[4 * p];
      if (p != 1 && p != 2)
        assert_near((double)out.data[3 * p + k], weight[0][k] * g + weight[1][k] * r, 1e-6);
    }
  assert_int_equal(odd.infinite, 1);
  assert_int_equal(odd.nan, 1);
}

/* The names of a file of many parts are as many as a sentence can hold. */
TEST(many_parts) {
  exr_library_file f[9];
  char why[300], name[9][80];
  abbe_image image;
  for (int i = 0; i < 9; i++) {
    f[i] = parts[0];
    memset(name[i], 'a' + i, 70);
    name[i][70] = '\0';
    f[i].part = name[i];
  }
  if (!exr_library_write_parts(path, f, 9, why, sizeof why)) fail_msg("%s", why);
  REFUSED(ABBE_NOT_FOUND, "'bbb", abbe_exr_read(printed("%s#z", path), &image, &error));
}

/* Bytes of a written file changed: find's first place, and what stands so far behind it. */
static void patch(const char *find, size_t length, size_t behind, char with) {
  FREED char *data = NULL;
  size_t size = 0;
  OK(abbe_file_read(path, 1 << 20, &data, &size, &error));
  char *at = memmem(data, size, find, length);
  assert_non_null(at);
  at[behind] = with;
  OK(abbe_file_write(path, data, size, &error));
}

TEST(what_a_file_says_wrongly) {
  abbe_image image;
  exr_library_file f = coloured(EXR_COMPRESSION_NONE, 4);
  char why[300];
  if (!exr_library_write(path, &f, why, sizeof why)) fail_msg("%s", why);
  patch("R\0\1\0\0\0", 6, 14, 2); /* every second line of R alone */
  REFUSED(ABBE_UNSUPPORTED, "subsampled", abbe_exr_read(path, &image, &error));
  if (!exr_library_write(path, &f, why, sizeof why)) fail_msg("%s", why);
  patch("\2\0\0\0\x18\0\0\0", 8, 4, 0x10); /* the third line's bytes, less than they are */
  REFUSED(ABBE_PARSE, "", abbe_exr_read(path, &image, &error));
  patch("compression\0compression\0\1\0\0", 27, 28, 99); /* and what keeps it from being opened */
  patch("screenWindowWidth", 17, 0, 'x');
  REFUSED(ABBE_UNSUPPORTED, "an unknown compression (number 99)",
          abbe_exr_read(path, &image, &error));
  write_parts(path, 2);
  patch("name\0string", 11, 1, 'o'); /* parts without a name */
  REFUSED(ABBE_PARSE, "name", abbe_exr_read(path, &image, &error));
}

/* Each part has a codec of its own. */
TEST(a_codec_of_one_part) {
  static const char key[] = "compression\0compression\0\1\0\0"; /* and the size's last byte */
  FREED char *data = NULL;
  size_t size = 0;
  abbe_image image = {0};
  write_parts(path, PARTS);
  OK(abbe_file_read(path, 1 << 20, &data, &size, &error));
  char *at = data;
  for (int i = 0; i < 3; i++) {
    at = memmem(at, size - (size_t)(at - data), key, sizeof key);
    assert_non_null(at);
    at += sizeof key;
  }
  *at = 99;
  OK(abbe_file_write(path, data, size, &error));
  REFUSED(ABBE_UNSUPPORTED, "an unknown compression (number 99)",
          abbe_exr_read(path, &image, &error));
}

static void leave(void) {
  unlink(path);
}

static void begin(void) {
  snprintf(path, sizeof path, "/tmp/abbe_test_exr_parts_%ld.exr", (long)getpid());
}

GROUP(begin, leave);
