#define _GNU_SOURCE /* memmem */
#include "tests/check.h"

#include "base/file.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/picture_space.h"
#include "colorimetry/rgb_space.h"

#include <openexr.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static char path[128];

static abbe_image gradient(size_t width, size_t height) {
  static const char *const names[] = {"R", "G", "B", "caustic.R", "caustic.G", "caustic.B"};
  abbe_image image = {0};
  OK(abbe_image_make(width, height, 6, names, &image, &error));
  for (size_t i = 0; i < width * height * 6; i++) image.data[i] = (float)i * 0.37f - 3;
  abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_ACESCG, image.xy);
  return image;
}

static void write_image(const abbe_image *image) {
  OK(abbe_exr_write(path, image, &error));
}

TEST(round_trip_is_exact) {
  static const size_t sizes[][2] = {{1, 1}, {7, 5}, {33, 16}, {16, 33}, {200, 100}};
  for (int s = 0; s < 5; s++) {
    OWNED(abbe_image, image) = gradient(sizes[s][0], sizes[s][1]);
    OK(abbe_image_set_attribute(&image, "abbe:space", "acescg", &error));
    OK(abbe_image_set_attribute(&image, "a name of more than thirty-one letters", "several\nlines",
                                &error));
    image.data[0] = INFINITY;
    write_image(&image);
    MADE(abbe_image, back, abbe_exr_read(path, &back, &error));
    assert_int_equal(back.width, image.width);
    assert_int_equal(back.height, image.height);
    assert_int_equal(back.channels, 6);
    for (size_t c = 0; c < 6; c++) {
      size_t there = abbe_image_find_channel(&back, image.channel[c]);
      assert_true(there != (size_t)-1);
      for (size_t i = 0; i < image.width * image.height; i++)
        assert_true(back.data[6 * i + there] == image.data[6 * i + c]);
    }
    for (int i = 0; i < 8; i++) assert_true(fabs(back.xy[i] - image.xy[i]) < 1e-7);
    assert_string_equal(abbe_image_attribute_text(&back, "abbe:space"), "acescg");
    assert_int_equal(back.attribute_count, 3); /* and the ID */
    assert_string_equal(abbe_image_attribute_text(&back, "a name of more than thirty-one letters"),
                        "several\nlines");
  }
}

/* A row of values, written in half precision and read again. */
static void through_half(const float *value, size_t count, float *back) {
  static const char *const names[] = {"Y"};
  MADE(abbe_image, image, abbe_image_make(count, 1, 1, names, &image, &error));
  memcpy(image.data, value, count * sizeof *value);
  OK(abbe_exr_write_half(path, &image, &error));
  MADE(abbe_image, read, abbe_exr_read(path, &read, &error));
  assert_int_equal(read.attribute_count, 0);
  memcpy(back, read.data, count * sizeof *back);
}

/* IEEE 754's binary16: 11 bits, ties to even, steps of 2^-24 at the lower end. */
TEST(half_precision_rounds_as_it_should) {
  const float value[] = {1,          1.0f / 3,     -0.1f,    65504,     65503,
                         0x1.002p0f, 0x1.006p0f,   0x1p-24f, 0x1p-25f,  0x1.8p-25f,
                         0,          0x1.ff8p-15f, INFINITY, -INFINITY, 2049};
  const float expected[] = {1, 0x1.554p-2f,  -0x1.998p-4f, 65504,     65504,
                            1, 0x1.008p0f,   0x1p-24f,     0,         0x1p-24f,
                            0, 0x1.ff8p-15f, INFINITY,     -INFINITY, 2048};
  float back[15];
  through_half(value, 15, back);
  for (int i = 0; i < 15; i++)
    if (back[i] != expected[i])
      fail_msg("%a becomes %a, not %a", (double)value[i], (double)back[i], (double)expected[i]);
  const float broken[] = {NAN, 1};
  through_half(broken, 2, back);
  assert_true(isnan(back[0]) && back[1] == 1);
}

/* What is too great for half precision, or all too small, comes back all the same. */
TEST(half_precision_never_overflows) {
  static const float scale[] = {65505, 1e6f, 1e38f, 0.99f, 1e-6f, 1e-12f, 1e-38f};
  for (int s = 0; s < 7; s++) {
    float value[5] = {scale[s], -scale[s] / 3, scale[s] / 1e4f, 0, INFINITY}, back[5];
    through_half(value, 5, back);
    for (int i = 0; i < 3; i++)
      if (!(fabs(back[i] / (double)value[i] - 1) <= 0x1p-11))
        fail_msg("%g becomes %g", (double)value[i], (double)back[i]);
    assert_true(back[3] == 0 && back[4] == INFINITY);
  }
}

TEST(units_that_are_none) {
  static const char *const names[] = {"Y"};
  abbe_image back = {0};
  MADE(abbe_image, image, abbe_image_make(1, 1, 1, names, &image, &error));
  image.data[0] = 0x1p-3f; /* unit 2^-17 */
  OK(abbe_exr_write_half(path, &image, &error));
  OK(abbe_image_set_attribute(&image, "abbe:stored_unit", "2", &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "'abbe:stored_unit'",
          abbe_exr_write_half("/tmp/no.exr", &image, &error));
  FREED char *data = NULL;
  size_t size = 0;
  OK(abbe_file_read(path, 1 << 20, &data, &size, &error));
  char *unit = NULL;
  for (size_t i = 0; i + 17 <= size && unit == NULL; i++)
    if (memcmp(data + i, "7.62939453125e-06", 17) == 0) unit = data + i;
  assert_non_null(unit);
  static const char *const wrong[] = {"7.62939453125e-05", "inf              ", "-7.6293945313e-06",
                                      "0.000000000000000", "something-or-othe", "0.25 and the rest",
                                      "1e999            ", "1e99999999999999"};
  for (int i = 0; i < 8; i++) {
    memcpy(unit, wrong[i], 17);
    OK(abbe_file_write(path, data, size, &error));
    REFUSED(ABBE_PARSE, "abbe:stored_unit", abbe_exr_read(path, &back, &error));
    assert_null(back.data);
  }
}

/* Black needs no unit. */
TEST(black_halves) {
  static const char *const names[] = {"Y"};
  MADE(abbe_image, image, abbe_image_make(1, 1, 1, names, &image, &error));
  OK(abbe_exr_write_half(path, &image, &error));
  MADE(abbe_image, back, abbe_exr_read(path, &back, &error));
  assert_true(back.data[0] == 0);
  image.channels = 0;
  REFUSED(ABBE_INVALID_ARGUMENT, "is empty", abbe_exr_write(path, &image, &error));
  image.channels = 1;
}

TEST(what_cannot_be_written) {
  static const char *const twice[] = {"R", "R"};
  abbe_image empty = {0};
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_exr_write(path, &empty, &error));
  MADE(abbe_image, image, abbe_image_make(1, 1, 2, twice, &image, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "'R'", abbe_exr_write(path, &image, &error));
  abbe_image_free(&image);
  image = gradient(2, 2);
  REFUSED(ABBE_IO, "/no/such/folder/a.exr",
          abbe_exr_write("/no/such/folder/a.exr", &image, &error));
  OK(abbe_image_set_attribute(&image, "channels", "mine", &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_exr_write(path, &image, &error));
  abbe_image_free(&image);
  image = gradient(2, 2);
  OK(abbe_image_set_attribute(&image, "type", "tiledimage", &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "'type'", abbe_exr_write(path, &image, &error));
}

TEST(a_full_disk_leaves_the_old_file) {
  OK(abbe_file_write(path, "old", 3, &error));
  OWNED(abbe_image, image) = gradient(512, 512);
  for (size_t i = 0; i < 512 * 512 * 6; i++) image.data[i] = (float)rand();
  signal(SIGXFSZ, SIG_IGN);
  struct rlimit old, small;
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
  small = old;
  small.rlim_cur = 4096;
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
  abbe_error why = {0};
  abbe_result result = abbe_exr_write(path, &image, &why);
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
  assert_int_equal(result, ABBE_IO);
  assert_non_null(strstr(why.text, path));
  FREED char *data = NULL;
  size_t size = 0;
  OK(abbe_file_read(path, 100, &data, &size, &error));
  assert_string_equal(data, "old");
}

/* A file of the given storage and type as another program might write it: ramps in three types. */
static void write_foreign(exr_storage_t storage, exr_compression_t compression, int width,
                          int height) {
  exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
  exr_context_t f = NULL;
  int part = 0;
  const exr_attr_box2i_t window = {.min = {.x = -3, .y = 5},
                                   .max = {.x = width - 4, .y = height + 4}};
  const exr_attr_v2f_t center = {.x = 0, .y = 0};
  assert_int_equal(exr_start_write(&f, path, EXR_WRITE_FILE_DIRECTLY, &setup), 0);
  assert_int_equal(exr_add_part(f, "", storage, &part), 0);
  assert_int_equal(exr_initialize_required_attr(f, 0, &window, &window, 1, &center, 1,
                                                EXR_LINEORDER_INCREASING_Y, compression),
                   0);
  assert_int_equal(exr_add_channel(f, 0, "f", EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LINEAR, 1, 1), 0);
  assert_int_equal(exr_add_channel(f, 0, "h", EXR_PIXEL_HALF, EXR_PERCEPTUALLY_LINEAR, 1, 1), 0);
  assert_int_equal(exr_add_channel(f, 0, "u", EXR_PIXEL_UINT, EXR_PERCEPTUALLY_LINEAR, 1, 1), 0);
  bool tiled = storage == EXR_STORAGE_TILED;
  if (tiled)
    assert_int_equal(exr_set_tile_descriptor(f, 0, 16, 8, EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN),
                     0);
  assert_int_equal(exr_write_header(f), 0);
  int32_t lines = 8;
  if (!tiled) assert_int_equal(exr_get_scanlines_per_chunk(f, 0, &lines), 0);
  exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
  FREED float *ramp = malloc((size_t)(width * height) * sizeof *ramp);
  FREED uint16_t *half = malloc((size_t)(width * height) * sizeof *half);
  FREED uint32_t *whole = malloc((size_t)(width * height) * sizeof *whole);
  assert_true(ramp != NULL && half != NULL && whole != NULL);
  for (int i = 0; i < width * height; i++) {
    ramp[i] = (float)i * 0.25f;
    half[i] = i % 2 ? 0x3c00 : 0x4000; /* 1 and 2 */
    whole[i] = (uint32_t)i;
  }
  const uint8_t *data[3] = {(uint8_t *)ramp, (uint8_t *)half, (uint8_t *)whole};
  bool first = true;
  for (int y = 0; y < height; y += lines)
    for (int x = 0; x < width; x += tiled ? 16 : width) {
      exr_chunk_info_t chunk = {0};
      assert_int_equal(tiled ? exr_write_tile_chunk_info(f, 0, x / 16, y / 8, 0, 0, &chunk)
                             : exr_write_scanline_chunk_info(f, 0, y + 5, &chunk),
                       0);
      assert_int_equal(first ? exr_encoding_initialize(f, 0, &chunk, &pipe)
                             : exr_encoding_update(f, 0, &chunk, &pipe),
                       0);
      for (int c = 0; c < 3; c++) {
        int bytes = pipe.channels[c].bytes_per_element;
        pipe.channels[c].encode_from_ptr = data[c] + (y * width + x) * bytes;
        pipe.channels[c].user_pixel_stride = bytes;
        pipe.channels[c].user_line_stride = bytes * width;
      }
      if (first) assert_int_equal(exr_encoding_choose_default_routines(f, 0, &pipe), 0);
      assert_int_equal(exr_encoding_run(f, 0, &pipe), 0);
      first = false;
    }
  exr_encoding_destroy(f, &pipe);
  assert_int_equal(exr_finish(&f), 0);
}

TEST(foreign_files) {
  static const exr_compression_t codecs[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE,
                                             EXR_COMPRESSION_ZIPS, EXR_COMPRESSION_ZIP,
                                             EXR_COMPRESSION_PIZ};
  for (int i = 0; i < 10; i++) {
    write_foreign(i < 5 ? EXR_STORAGE_SCANLINE : EXR_STORAGE_TILED, codecs[i % 5], 37, 41);
    OWNED(abbe_image, image) = {0};
    abbe_error error = {0};
    if (abbe_exr_read(path, &image, &error) != ABBE_OK) fail_msg("case %d: %s", i, error.text);
    assert_true(image.width == 37 && image.height == 41 && image.channels == 3);
    for (int p = 0; p < 37 * 41; p++) {
      const float *v = image.data + 3 * p;
      if (v[0] != (float)p * 0.25f || v[1] != (p % 2 ? 1 : 2) || v[2] != (float)p)
        fail_msg("case %d, pixel %d: %g %g %g", i, p, (double)v[0], (double)v[1], (double)v[2]);
    }
  }
}

static void read_must_fail(const char *data, size_t size, const char *what) {
  OK(abbe_file_write(path, data, size, &error));
  abbe_image image = {0};
  abbe_error error = {0};
  abbe_result result = abbe_exr_read(path, &image, &error);
  if (result != ABBE_PARSE || image.data != NULL || strstr(error.text, path) == NULL)
    fail_msg("%s: %d %s", what, (int)result, error.text);
}

static char *load(size_t *size) {
  char *data = NULL;
  OK(abbe_file_read(path, 1 << 24, &data, size, &error));
  return data;
}

TEST(truncated_anywhere) {
  OWNED(abbe_image, image) = gradient(20, 40);
  write_image(&image);
  size_t size = 0;
  FREED char *data = load(&size);
  for (size_t cut = 0; cut < size; cut += cut < 400 ? 1 : 97)
    read_must_fail(data, cut, "truncated");
  read_must_fail(data, size - 1, "truncated by a byte");
}

/* Any outcome but a crash, a leak or a hang: the sanitizers judge. */
TEST(flipped_bits_anywhere) {
  OWNED(abbe_image, image) = gradient(20, 40);
  write_image(&image);
  size_t size = 0;
  FREED char *data = load(&size);
  for (size_t at = 0; at < size; at += at < 500 ? 1 : 31) {
    const char flipped = (char)(1 << at * 5 % 8);
    data[at] ^= flipped;
    OK(abbe_file_write(path, data, size, &error));
    data[at] ^= flipped;
    OWNED(abbe_image, back) = {0};
    abbe_error why = {0};
    if (abbe_exr_read(path, &back, &why) != ABBE_OK) assert_true(why.text[0] != '\0');
  }
}

TEST(a_huge_data_window) {
  OWNED(abbe_image, image) = gradient(20, 40);
  write_image(&image);
  size_t size = 0;
  FREED char *data = load(&size);
  char *window = NULL;
  for (size_t i = 0; i + 40 < size && window == NULL; i++)
    if (memcmp(data + i, "dataWindow", 11) == 0) window = data + i + 11 + 6 + 4;
  assert_non_null(window);
  static const int32_t last[][2] = {
      {1999, 1999}, {ABBE_IMAGE_MAX_SIDE, 39}, {19, ABBE_IMAGE_MAX_SIDE}};
  for (int i = 0; i < 3; i++) {
    memcpy(window + 8, last[i], sizeof last[i]);
    read_must_fail(data, size, "huge window");
  }
}

TEST(not_pictures) {
  abbe_image image = {0};
  REFUSED(ABBE_IO, "/no/such.exr", abbe_exr_read("/no/such.exr", &image, &error));
  REFUSED(ABBE_IO, "", abbe_exr_read("/tmp", &image, &error));
  REFUSED(ABBE_IO, "", abbe_exr_read("/dev/null", &image, &error));
  read_must_fail("not an OpenEXR file at all, but long enough to be one", 53, "text");
  static const char *const others[][2] = {{"PF\n1 1\n-1.0\n0123456789ab", "a PFM"},
                                          {"\x89PNG\r\n\x1a\n", "a PNG"},
                                          {"MM\\0*12345678", "a TIFF"}};
  for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
    OK(abbe_file_write(path, others[i][0], strlen(others[i][0]), &error));
    REFUSED(ABBE_PARSE, printed("it is %s file and not OpenEXR", others[i][1]),
            abbe_exr_read(path, &image, &error));
  }
}

/* A file of the C core's making, of one pixel of one channel; its header is not yet written. */
static exr_context_t begin_pixel(exr_storage_t storage, const char *channel) {
  exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
  exr_context_t f = NULL;
  int part = 0;
  assert_int_equal(exr_start_write(&f, path, EXR_WRITE_FILE_DIRECTLY, &setup), 0);
  assert_int_equal(exr_add_part(f, "pixel", storage, &part), 0);
  assert_int_equal(exr_initialize_required_attr_simple(f, 0, 1, 1, EXR_COMPRESSION_NONE), 0);
  assert_int_equal(exr_add_channel(f, 0, channel, EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LINEAR, 1, 1),
                   0);
  return f;
}

/* Whatever the file says beside. Y of red is AP0's in the published matrix to XYZ of D65. */
TEST(an_aces_container_is_of_ap0) {
  const exr_attr_chromaticities_t rec709 = {0.64F, 0.33F, 0.3F,    0.6F,
                                            0.15F, 0.06F, 0.3127F, 0.329F};
  for (int i = 0; i < 8; i++) {
    exr_context_t f = begin_pixel(EXR_STORAGE_SCANLINE, "R");
    const bool flag = (i & 1) != 0, primaries = (i & 2) != 0, id = (i & 4) != 0;
    if (primaries)
      assert_int_equal(exr_attr_set_chromaticities(f, 0, "chromaticities", &rec709), 0);
    if (id) assert_int_equal(exr_attr_set_string(f, 0, "colorInteropID", "lin_rec709_scene"), 0);
    assert_int_equal(exr_attr_set_int(f, 0, "acesImageContainerFlag", flag), 0);
    assert_int_equal(exr_write_header(f), 0);
    const float red = 1;
    assert_int_equal(exr_write_scanline_chunk(f, 0, 0, &red, 4), 0);
    assert_int_equal(exr_finish(&f), 0);
    MADE(abbe_image, image, abbe_exr_read(path, &image, &error));
    abbe_picture_space space;
    OK(abbe_picture_space_find(&image, false, path, &space, &error));
    assert_int_equal(space.assumed, !flag && !primaries && !id);
    assert_near(space.to_xyz[3], flag ? 0.337369 : 0.212639, 1e-6);
  }
}

/* One more than can be read. */
TEST(too_many_attributes) {
  exr_context_t f = begin_pixel(EXR_STORAGE_SCANLINE, "Y");
  for (int i = 0; i <= ABBE_IMAGE_MAX_ATTRIBUTES; i++)
    assert_int_equal(exr_attr_set_string(f, 0, printed("a%05d", i), "x"), 0);
  assert_int_equal(exr_write_header(f), 0);
  const float y = 1;
  assert_int_equal(exr_write_scanline_chunk(f, 0, 0, &y, 4), 0);
  assert_int_equal(exr_finish(&f), 0);
  abbe_image image = {0};
  REFUSED(ABBE_UNSUPPORTED, "attributes", abbe_exr_read(path, &image, &error));
  assert_null(image.data);
}

TEST(too_many_channels) {
  enum { CHANNELS = 20000 };
  exr_context_t f = begin_pixel(EXR_STORAGE_SCANLINE, "Y");
  for (int i = 1; i < CHANNELS; i++)
    assert_int_equal(
        exr_add_channel(f, 0, printed("c%05d", i), EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LINEAR, 1, 1),
        0);
  assert_int_equal(exr_write_header(f), 0);
  static const float values[CHANNELS];
  assert_int_equal(exr_write_scanline_chunk(f, 0, 0, values, sizeof values), 0);
  assert_int_equal(exr_finish(&f), 0);
  abbe_image image = {0};
  REFUSED(ABBE_PARSE, "it has 20000 channels; 1 to 1024 can be read",
          abbe_exr_read(path, &image, &error));
}

TEST(deep_is_unsupported) {
  exr_context_t f = begin_pixel(EXR_STORAGE_DEEP_SCANLINE, "Z");
  assert_int_equal(exr_set_version(f, 0, 1), 0);
  assert_int_equal(exr_set_chunk_count(f, 0, 1), 0);
  assert_int_equal(exr_write_header(f), 0);
  const float z = 1;
  const int32_t samples = 1;
  assert_int_equal(exr_write_deep_scanline_chunk(f, 0, 0, &z, 4, 4, &samples, 4), 0);
  assert_int_equal(exr_finish(&f), 0);
  abbe_image image = {0};
  REFUSED(ABBE_UNSUPPORTED, "deep", abbe_exr_read(path, &image, &error));
}

/* Codecs that are younger than the library are refused by their names. */
TEST(younger_codecs) {
  static const char key[] = "compression\0compression\0\1\0\0"; /* and the size's last byte */
  static const struct {
    char number;
    const char *says;
  } codecs[] = {{10, "HTJ2K compression is read with OpenEXR 3.4.0 or later"},
                {11, "HTJ2K compression is read with OpenEXR 3.4.0 or later"},
                {12, "an unknown compression (number 12)"}};
  static const char *const names[] = {"R", "G", "B"};
  abbe_image image = {0};
  FREED char *data = NULL;
  size_t size = 0;
  OK(abbe_image_make(4, 4, 3, names, &image, &error));
  write_image(&image);
  abbe_image_free(&image);
  OK(abbe_file_read(path, 1 << 20, &data, &size, &error));
  char *at = memmem(data, size, key, sizeof key);
  assert_non_null(at);
  int major, minor, patch;
  const char *extra = NULL;
  exr_get_library_version(&major, &minor, &patch, &extra);
  const bool knows = major > 3 || (major == 3 && minor >= 4); /* HTJ2K */
  for (size_t i = knows ? 2 : 0; i < sizeof codecs / sizeof *codecs; i++) {
    at[sizeof key] = codecs[i].number;
    OK(abbe_file_write(path, data, size, &error));
    REFUSED(ABBE_UNSUPPORTED, codecs[i].says, abbe_exr_read(path, &image, &error));
  }
  unlink(path);
}

/* The reference implementation's own tool accepts the file and sees what was written. */
TEST(exrheader_agrees) {
  if (system("command -v exrheader > /dev/null") != 0)
    fail_msg("exrheader is missing; script/bootstrap installs it (openexr)");
  OWNED(abbe_image, image) = gradient(31, 17);
  OK(abbe_image_set_attribute(&image, "abbe:seed", "42", &error));
  write_image(&image);
  char text[4096] = "";
  FILE *pipe = popen(printed("exrheader %s", path), "r");
  assert_non_null(pipe);
  size_t n = fread(text, 1, sizeof text - 1, pipe);
  text[n] = '\0';
  assert_int_equal(pclose(pipe), 0);
  static const char *const says[] = {"caustic.R, 32-bit floating-point", "chromaticities",
                                     "(0.713 0.293)", "\"42\"", "(0 0) - (30 16)"};
  for (int i = 0; i < 5; i++)
    if (strstr(text, says[i]) == NULL) fail_msg("no '%s' in %s", says[i], text);
}

static void leave(void) {
  unlink(path);
}

static void begin(void) {
  snprintf(path, sizeof path, "/tmp/abbe_test_exr_%ld.exr", (long)getpid());
}

GROUP(begin, leave);
