#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "colorimetry/png_file.h"
#include "spectral/file.h"

#include <math.h>
#include <png.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

static char path[128];
static const char *const names[] = {"R", "G", "B", "A"};

static abbe_image gradient(size_t width, size_t height, size_t channels) {
  abbe_image image = {0};
  assert_int_equal(abbe_image_make(width, height, channels, names, &image, NULL), ABBE_OK);
  size_t count = width * height * channels;
  for (size_t i = 0; i < count; i++) image.data[i] = (float)i / (float)(count - 1);
  return image;
}

static void test_round_trip(void **state) {
  (void)state;
  static const size_t channels[] = {1, 3, 4};
  for (int bits = 8; bits <= 16; bits += 8)
    for (int c = 0; c < 3; c++) {
      abbe_image image = gradient(13, 9, channels[c]), back = {0};
      abbe_error error = {0};
      assert_int_equal(abbe_png_write(path, &image, bits, &error), ABBE_OK);
      if (abbe_png_read(path, &back, &error) != ABBE_OK) fail_msg("%s", error.text);
      assert_true(back.width == 13 && back.height == 9 && back.channels == 3);
      double step = bits == 8 ? 0.5 / 255 : 0.5 / 65535;
      for (size_t p = 0; p < 13 * 9; p++)
        for (size_t k = 0; k < 3; k++) {
          float in = image.data[p * image.channels + (image.channels < 3 ? 0 : k)];
          assert_true(fabs((double)in - (double)back.data[3 * p + k]) <= step + 1e-7);
        }
      abbe_image_free(&image);
      abbe_image_free(&back);
    }
}

static void test_what_lies_outside_is_clamped(void **state) {
  (void)state;
  abbe_image image = gradient(2, 1, 3), back = {0};
  const float in[6] = {-1, NAN, INFINITY, 2, -INFINITY, 0.5f};
  const float out[6] = {0, 0, 1, 1, 0, 128.0f / 255};
  memcpy(image.data, in, sizeof in);
  assert_int_equal(abbe_png_write(path, &image, 8, NULL), ABBE_OK);
  assert_int_equal(abbe_png_read(path, &back, NULL), ABBE_OK);
  for (int i = 0; i < 6; i++) assert_true(back.data[i] == out[i]);
  abbe_image_free(&image);
  abbe_image_free(&back);
}

static void test_what_cannot_be_written(void **state) {
  (void)state;
  abbe_image image = gradient(2, 2, 3), empty = {0};
  abbe_error error = {0};
  assert_int_equal(abbe_png_write(path, &image, 12, &error), ABBE_INVALID_ARGUMENT);
  assert_non_null(strstr(error.text, "12"));
  assert_int_equal(abbe_png_write(path, &empty, 8, &error), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_png_write("/no/such/folder/a.png", &image, 8, &error), ABBE_IO);
  abbe_image_free(&image);
}

static void test_a_full_disk_leaves_the_old_file(void **state) {
  (void)state;
  assert_int_equal(abbe_file_write(path, "old", 3, NULL), ABBE_OK);
  abbe_image image = gradient(300, 300, 3);
  for (int i = 0; i < 270000; i++) image.data[i] = (float)rand() / (float)RAND_MAX;
  signal(SIGXFSZ, SIG_IGN);
  struct rlimit old, small;
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
  small = old;
  small.rlim_cur = 4096;
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
  abbe_error error = {0};
  abbe_result result = abbe_png_write(path, &image, 8, &error);
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
  assert_int_equal(result, ABBE_IO);
  assert_non_null(strstr(error.text, path));
  char *data = NULL;
  size_t size = 0;
  assert_int_equal(abbe_file_read(path, 100, &data, &size, NULL), ABBE_OK);
  assert_string_equal(data, "old");
  free(data);
  abbe_image_free(&image);
}

/* A palette, grey with alpha and interlaced rows, as other programs write them. */
static void write_foreign(int colour, int bits, int interlace) {
  FILE *file = fopen(path, "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
  png_infop info = png_create_info_struct(png);
  assert_true(file != NULL && png != NULL && info != NULL);
  if (setjmp(png_jmpbuf(png))) fail();
  png_init_io(png, file);
  png_set_IHDR(png, info, 8, 8, bits, colour, interlace, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  const png_color palette[2] = {{255, 0, 0}, {0, 0, 255}};
  if (colour == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, palette, 2);
  png_write_info(png, info);
  png_byte rows[8][64];
  png_bytep row[8];
  for (int y = 0; y < 8; y++) {
    memset(rows[y], colour == PNG_COLOR_TYPE_PALETTE ? 0x0f : 0x80, sizeof rows[y]);
    row[y] = rows[y];
  }
  png_write_image(png, row);
  png_write_end(png, NULL);
  png_destroy_write_struct(&png, &info);
  fclose(file);
}

static void test_foreign_files(void **state) {
  (void)state;
  static const struct {
    int colour, bits;
    float first[3];
  } cases[] = {
      {PNG_COLOR_TYPE_PALETTE, 1, {1, 0, 0}},
      {PNG_COLOR_TYPE_GRAY, 1, {1, 1, 1}},
      {PNG_COLOR_TYPE_GRAY, 4, {8 / 15.0f, 8 / 15.0f, 8 / 15.0f}},
      {PNG_COLOR_TYPE_GRAY_ALPHA, 8, {128 / 255.0f, 128 / 255.0f, 128 / 255.0f}},
      {PNG_COLOR_TYPE_RGB_ALPHA, 16, {32896 / 65535.0f, 32896 / 65535.0f, 32896 / 65535.0f}}};
  for (int i = 0; i < 10; i++) {
    write_foreign(cases[i / 2].colour, cases[i / 2].bits,
                  i % 2 ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE);
    abbe_image image = {0};
    abbe_error error = {0};
    if (abbe_png_read(path, &image, &error) != ABBE_OK) fail_msg("case %d: %s", i, error.text);
    assert_true(image.width == 8 && image.height == 8 && image.channels == 3);
    for (int k = 0; k < 3; k++) assert_true(fabsf(image.data[k] - cases[i / 2].first[k]) < 1e-6f);
    abbe_image_free(&image);
  }
}

static void read_must_fail(const char *data, size_t size, const char *what) {
  assert_int_equal(abbe_file_write(path, data, size, NULL), ABBE_OK);
  abbe_image image = {0};
  abbe_error error = {0};
  abbe_result result = abbe_png_read(path, &image, &error);
  if (result != ABBE_PARSE || image.data != NULL || strstr(error.text, path) == NULL)
    fail_msg("%s: %d %s", what, (int)result, error.text);
}

static char *written(size_t *size) {
  abbe_image image = gradient(20, 20, 3);
  assert_int_equal(abbe_png_write(path, &image, 8, NULL), ABBE_OK);
  abbe_image_free(&image);
  char *data = NULL;
  assert_int_equal(abbe_file_read(path, 1 << 20, &data, size, NULL), ABBE_OK);
  return data;
}

static void test_truncated_anywhere(void **state) {
  (void)state;
  size_t size = 0;
  char *data = written(&size);
  for (size_t cut = 0; cut < size; cut++) read_must_fail(data, cut, "truncated");
  free(data);
}

static void test_flipped_bits_anywhere(void **state) {
  (void)state;
  size_t size = 0;
  char *data = written(&size);
  for (size_t at = 0; at < size; at++) {
    data[at] ^= (char)(1 << at % 8);
    assert_int_equal(abbe_file_write(path, data, size, NULL), ABBE_OK);
    data[at] ^= (char)(1 << at % 8);
    abbe_image back = {0};
    abbe_error error = {0};
    if (abbe_png_read(path, &back, &error) != ABBE_OK) assert_true(error.text[0] != '\0');
    abbe_image_free(&back);
  }
  free(data);
}

/* A header that promises too much, with its checksum right. */
static void test_a_huge_header(void **state) {
  (void)state;
  static const unsigned sides[] = {15000, 16384, 16385, 0x7fffffff};
  for (int i = 0; i < 4; i++) {
    size_t size = 0;
    char *data = written(&size);
    for (int b = 0; b < 4; b++)
      data[16 + b] = data[20 + b] = (char)(sides[i] >> (24 - 8 * b) & 255);
    unsigned crc = 0xffffffff;
    for (int b = 12; b < 29; b++) {
      crc ^= (unsigned char)data[b];
      for (int k = 0; k < 8; k++) crc = crc & 1 ? 0xedb88320u ^ crc >> 1 : crc >> 1;
    }
    for (int b = 0; b < 4; b++) data[29 + b] = (char)(~crc >> (24 - 8 * b) & 255);
    read_must_fail(data, size, "huge header");
    free(data);
  }
}

static void test_not_pictures(void **state) {
  (void)state;
  abbe_image image = {0};
  abbe_error error = {0};
  assert_int_equal(abbe_png_read("/no/such.png", &image, &error), ABBE_IO);
  assert_int_equal(abbe_png_read("/tmp", &image, &error), ABBE_IO);
  assert_int_equal(abbe_png_read("/dev/zero", &image, &error), ABBE_IO);
  read_must_fail("", 0, "empty");
  read_must_fail("a text", 6, "text");
}

static int leave(void **state) {
  (void)state;
  unlink(path);
  return 0;
}

int main(void) {
  snprintf(path, sizeof path, "/tmp/abbe_test_png_%ld.png", (long)getpid());
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_round_trip),
                                     cmocka_unit_test(test_what_lies_outside_is_clamped),
                                     cmocka_unit_test(test_what_cannot_be_written),
                                     cmocka_unit_test(test_a_full_disk_leaves_the_old_file),
                                     cmocka_unit_test(test_foreign_files),
                                     cmocka_unit_test(test_truncated_anywhere),
                                     cmocka_unit_test(test_flipped_bits_anywhere),
                                     cmocka_unit_test(test_a_huge_header),
                                     cmocka_unit_test(test_not_pictures)};
  return cmocka_run_group_tests(tests, NULL, leave);
}
