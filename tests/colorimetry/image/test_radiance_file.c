#include "tests/check.h"

#include "base/file.h"
#include "colorimetry/image/picture_file.h"
#include "colorimetry/rgb_space.h"

#include <sys/stat.h>
#include <unistd.h>

#define HEAD "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n"

static char path[128];

static abbe_result read_bytes(const void *data, size_t size, abbe_image *out, abbe_error *error) {
  assert_int_equal(abbe_file_write(path, data, size, NULL), ABBE_OK);
  return abbe_radiance_read(path, out, error);
}

/* A header, then pixels of four bytes each. */
static abbe_image read_pixels(const char *head, const void *pixels, size_t size) {
  char data[8192];
  const size_t length = strlen(head);
  abbe_image image;
  memcpy(data, head, length);
  memcpy(data + length, pixels, size);
  OK(read_bytes(data, length + size, &image, &error));
  return image;
}

static void check_pixel(const abbe_image *image, size_t x, size_t y, double r, double g, double b) {
  const float *pixel = image->data + 3 * (y * image->width + x);
  assert_true(pixel[0] == (float)r && pixel[1] == (float)g && pixel[2] == (float)b);
}

static const uint8_t six[6][4] = {{128, 0, 0, 129},    {0, 255, 1, 128},  {9, 9, 9, 0},
                                  {128, 64, 192, 137}, {200, 100, 50, 1}, {128, 128, 128, 130}};

static void begin(void) {
  snprintf(path, sizeof path, "/tmp/abbe-test-radiance-%d.hdr", (int)getpid());
}

static void finish(void) {
  unlink(path);
}

GROUP(begin, finish);

TEST(exponents_and_mantissas) {
  OWNED(abbe_image, image) = read_pixels(HEAD "\n-Y 2 +X 3\n", six, sizeof six);
  assert_true(image.width == 3 && image.height == 2 && image.channels == 3);
  check_pixel(&image, 0, 0, 1, 0, 0);
  check_pixel(&image, 1, 0, 0, 255.0 / 256, 1.0 / 256);
  check_pixel(&image, 2, 0, 0, 0, 0);
  check_pixel(&image, 0, 1, 256, 128, 384);
  check_pixel(&image, 1, 1, ldexp(200, -135), ldexp(100, -135), ldexp(50, -135));
  check_pixel(&image, 2, 1, 2, 2, 2);
  for (int i = 0; i < 8; i++) assert_true(image.xy[i] == 0);
}

/* The same six pixels in each of the eight directions: where the first and the second come to lie.
 */
TEST(directions) {
  static const struct {
    const char *size;
    size_t first[2], second[2];
  } cases[] = {{"-Y 2 +X 3", {0, 0}, {1, 0}}, {"-Y 2 -X 3", {2, 0}, {1, 0}},
               {"+Y 2 +X 3", {0, 1}, {1, 1}}, {"+Y 2 -X 3", {2, 1}, {1, 1}},
               {"+X 3 -Y 2", {0, 0}, {0, 1}}, {"-X 3 -Y 2", {2, 0}, {2, 1}},
               {"+X 3 +Y 2", {0, 1}, {0, 0}}, {"-X 3 +Y 2", {2, 1}, {2, 0}}};
  for (size_t i = 0; i < 8; i++) {
    OWNED(abbe_image, image) = read_pixels(printed(HEAD "\n%s\n", cases[i].size), six, sizeof six);
    assert_true(image.width == 3 && image.height == 2);
    check_pixel(&image, cases[i].first[0], cases[i].first[1], 1, 0, 0);
    check_pixel(&image, cases[i].second[0], cases[i].second[1], 0, 255.0 / 256, 1.0 / 256);
  }
}

TEST(header_variables) {
  static const char head[] =
      "#?RGBE\n# EXPOSURE=7\nEXPOSURE= 4\nEXPOSURE=0.5\nCOLORCORR=1 2 0.5\nVIEW=-vtv\n"
      "FORMAT=32-bit_rle_rgbe\nPRIMARIES=0.7 0.3 0.2 0.7 0.1 0.1 0.33 0.33\n\n-Y 2 +X 3\n";
  OWNED(abbe_image, image) = read_pixels(head, six, sizeof six);
  check_pixel(&image, 2, 1, 1, 0.5, 2);
  assert_true(image.xy[0] == 0.7 && image.xy[7] == 0.33);
  abbe_image_free(&image);
  image = read_pixels("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 2 +X 3\n", six, sizeof six);
  assert_int_equal(abbe_rgb_space_of_chromaticities(image.xy), ABBE_RGB_SPACE_XYZ);
  abbe_image_free(&image);
  image = read_pixels("#?RADIANCE\r\n\r\n-Y 2 +X 3\r\n", six, sizeof six);
  check_pixel(&image, 0, 0, 1, 0, 0);
}

/* Runs may be continued, by eight bits more each; the new coding is of each byte by itself. */
TEST(runs) {
  static const uint8_t old[] = {128, 128, 128, 129, 1, 1,   1, 3, 1, 1,
                                1,   1,   128, 0,   0, 130, 1, 1, 1, 0};
  OWNED(abbe_image, image) = read_pixels(HEAD "\n-Y 1 +X 261\n", old, sizeof old);
  for (size_t x = 0; x < 260; x++) check_pixel(&image, x, 0, 1, 1, 1);
  check_pixel(&image, 260, 0, 2, 0, 0);
  abbe_image_free(&image);
  static const uint8_t coded[] = {2,        2,   0, 10,                               /* */
                                  128 + 10, 128,                                      /* R */
                                  4,        0,   0, 0,  0, 128 + 6, 7,                /* G */
                                  9,        1,   2, 3,  4, 5,       6, 7, 8, 9, 1, 5, /* B */
                                  128 + 9,  129, 1, 133}; /* exponents */
  image = read_pixels(HEAD "\n-Y 1 +X 10\n", coded, sizeof coded);
  for (size_t x = 0; x < 10; x++) {
    const double unit = x < 9 ? 1.0 / 128 : 1.0 / 8;
    check_pixel(&image, x, 0, 128 * unit, (x < 4 ? 0 : 7) * unit,
                (x < 9 ? (double)x + 1 : 5) * unit);
  }
}

/* Pixels one by one, of which the second line begins as one in runs does. */
TEST(flat_pixels) {
  uint8_t flat[2][8][4];
  memset(flat, 128, sizeof flat);
  memcpy(flat[1][0], (const uint8_t[4]){2, 2, 0, 8}, 4);
  OWNED(abbe_image, image) = read_pixels(HEAD "\n-Y 2 +X 8\n", flat, sizeof flat);
  check_pixel(&image, 7, 1, 0.5, 0.5, 0.5);
  check_pixel(&image, 0, 1, ldexp(2, 8 - 136), ldexp(2, 8 - 136), 0);
}

TEST(what_is_refused) {
  static const struct {
    const char *data;
    size_t size; /* 0: of the text */
    abbe_result code;
    const char *part;
  } cases[] = {
      {"", 0, ABBE_PARSE, "does not begin"},
      {"\x89PNG\r\n", 0, ABBE_PARSE, "does not begin"},
      {"#?RADIANCE\n", 0, ABBE_PARSE, "cut off"},
      {HEAD, 0, ABBE_PARSE, "cut off"},
      {HEAD "\n", 0, ABBE_PARSE, "size"},
      {HEAD "\n-Y 2 +Y 3\n", 0, ABBE_PARSE, "twice"},
      {HEAD "\n-Y 0 +X 3\n", 0, ABBE_PARSE, "size"},
      {HEAD "\n-Y 99999 +X 3\n", 0, ABBE_PARSE, "size"},
      {HEAD "\nwidth 3\n", 0, ABBE_PARSE, "size"},
      {HEAD "\n-Y 32768 +X 32768\n", 0, ABBE_UNSUPPORTED, ""},
      {HEAD "\n-Y 2 +X 3\nabcd", 0, ABBE_PARSE, "cut off (line 1 of 2)"},
      {HEAD "\n-Y 1 +X 8\n\x02\x02\x03\x04", 0, ABBE_PARSE, "another length"},
      {HEAD "\n-Y 1 +X 8\n\x02\x02\0\x08\x89\x01", sizeof HEAD + 16, ABBE_PARSE, "longer"},
      {HEAD "\n-Y 1 +X 8\n\x02\x02\0\x08\0\0", sizeof HEAD + 16, ABBE_PARSE, "longer"},
      {HEAD "\n-Y 1 +X 3\n\x01\x01\x01\x02", 0, ABBE_PARSE, "begins"},
      {HEAD "\n-Y 1 +X 3\nabcd\x01\x01\x01\x09", 0, ABBE_PARSE, "longer"},
      {HEAD "EXPOSURE=-1\n\n-Y 1 +X 1\nabcd", 0, ABBE_PARSE, "EXPOSURE"},
      {HEAD "EXPOSURE=nan\n\n-Y 1 +X 1\nabcd", 0, ABBE_PARSE, "EXPOSURE"},
      {HEAD "COLORCORR=1 2\n\n-Y 1 +X 1\nabcd", 0, ABBE_PARSE, "COLORCORR"},
      {HEAD "PRIMARIES=1 2\n\n-Y 1 +X 1\nabcd", 0, ABBE_PARSE, "PRIMARIES"},
      {"#?RADIANCE\nFORMAT=float\n\n-Y 1 +X 1\nabcd", 0, ABBE_UNSUPPORTED, "FORMAT"},
      {HEAD "EXPOSURE=1e999\n\n-Y 1 +X 1\nabcd", 0, ABBE_PARSE, "EXPOSURE is no number"},
      {HEAD "EXPOSURE=1e-31\n\n-Y 1 +X 1\nabcd", 0, ABBE_PARSE, "not above 0, or too large"},
      {HEAD "EXPOSURE=1e31\n\n-Y 1 +X 1\nabcd", 0, ABBE_PARSE, "not above 0, or too large"},
      {HEAD "COLORCORR=1 0 1\n\n-Y 1 +X 1\nabcd", 0, ABBE_PARSE, "COLORCORR"},
      {HEAD "\n-Z 1 +X 1\nabcd", 0, ABBE_PARSE, "size"},
      {HEAD "\n-Y : +X 1\nabcd", 0, ABBE_PARSE, "size"},
      {HEAD "\n-Y 00000001 +X 1\nabcd", 0, ABBE_PARSE, "size"},
      {HEAD "\n-Y 1 +X 4\nabcd\x01\x01\x01\0\x01\x01\x01\0\x01\x01\x01\0\x01\x01\x01\0"
            "\x01\x01\x01\0",
       sizeof HEAD - 1 + 11 + 24, ABBE_PARSE, "a run is too long"},
      {HEAD "\n-Y 1 +X 8\n\x02\x02", 0, ABBE_PARSE, "cut off"},
      {HEAD "\n-Y 1 +X 8\n\x02\x02\0\x08\x88", sizeof HEAD - 1 + 11 + 5, ABBE_PARSE, "cut off"},
      {HEAD "\n-Y 1 +X 8\n\x02\x02\0\x08\x08\x01", sizeof HEAD - 1 + 11 + 6, ABBE_PARSE, "cut off"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    abbe_image image;
    abbe_error error = {0};
    const size_t size = cases[i].size ? cases[i].size : strlen(cases[i].data);
    const abbe_result result = read_bytes(cases[i].data, size, &image, &error);
    if (result != cases[i].code) print_error("case %zu: %s\n", i, error.text);
    assert_int_equal(result, cases[i].code);
    assert_contains(error.text, cases[i].part);
    assert_contains(error.text, path);
    assert_null(image.data);
  }
}

/* What looks like a repetition, or like a line in runs, and is neither. */
TEST(pixels_that_look_like_codes) {
  static const uint8_t three[3][4] = {{1, 2, 1, 136}, {1, 1, 2, 136}, {1, 3, 3, 136}};
  OWNED(abbe_image, image) = read_pixels(HEAD "\n-Y 1 +X 3\n", three, sizeof three);
  check_pixel(&image, 0, 0, 1, 2, 1);
  check_pixel(&image, 1, 0, 1, 1, 2);
  for (int k = 1; k < 3; k++) {
    uint8_t line[8][4] = {{2, 2, 2, 136}};
    line[0][k] = k == 1 ? 3 : 128;
    abbe_image_free(&image);
    image = read_pixels(HEAD "\n-Y 1 +X 8\n", line, sizeof line);
    check_pixel(&image, 0, 0, 2, k == 1 ? 3 : 2, k == 2 ? 128 : 2);
  }
  static uint8_t wide[4 * 32768 + sizeof HEAD + 20];
  const int length = snprintf((char *)wide, sizeof wide, HEAD "\n-Y 1 +X 32768\n");
  memset(wide + length, 128, 4 * 32768); /* is beyond what lines in runs can be */
  abbe_image_free(&image);
  OK(read_bytes(wide, (size_t)length + 4 * 32768, &image, &error));
  check_pixel(&image, 32767, 0, 0.5, 0.5, 0.5);
}

TEST(other_kinds_of_file) {
  abbe_image image;
  char line[2200];
  memset(line, 'a', sizeof line);
  memcpy(line, "#?RADIANCE\n", 11);
  line[sizeof line - 1] = '\n';
  REFUSED(ABBE_PARSE, "its header is cut off", read_bytes(line, sizeof line, &image, &error));
  unlink(path);
  REFUSED(ABBE_IO, "", abbe_radiance_read(path, &image, &error));
  assert_int_equal(mkfifo(path, 0600), 0);
  REFUSED(ABBE_IO, "", abbe_radiance_read(path, &image, &error));
  unlink(path);
  REFUSED(ABBE_IO, "", abbe_radiance_read("/dev", &image, &error));
}
