/* AVIF files, decoded again by libavif: their pixels, and what they say of their colour. */
#include "tests/check.h"

#include "colorimetry/image/avif_file.h"
#include "colorimetry/image/rgb_encoding.h"

#include <unistd.h>

static char path[64];

static void setup(void) {
  snprintf(path, sizeof path, "/tmp/abbe-test-avif-%ld.avif", (long)getpid());
}

static void teardown(void) {
  unlink(path);
}

enum { W = 97, H = 61 };

/* Smooth hues with an edge. */
static void paint(abbe_image *image) {
  static const char *const names[] = {"R", "G", "B"};
  OK(abbe_image_make(W, H, 3, names, image, &error));
  for (size_t y = 0; y < H; y++)
    for (size_t x = 0; x < W; x++) {
      float *to = image->data + 3 * (y * W + x);
      to[0] = (float)(0.5 + 0.5 * sin(0.07 * (double)x));
      to[1] = (float)((double)y / (H - 1));
      to[2] = x > W / 2 ? 0.8f : 0.1f;
    }
}

GROUP(setup, teardown);

TEST(names_tell_what_is_meant) {
  assert_true(abbe_avif_is_meant("a.avif") && abbe_avif_is_meant("b.c/D.AVIF"));
  assert_false(abbe_avif_is_meant("a.avif.png") || abbe_avif_is_meant("avif") ||
               abbe_avif_is_meant(NULL));
}

#ifdef ABBE_HAS_AVIF
#include <avif/avif.h>

/* rgb[W * H * 3], of all the file's bits. */
static avifImage *decode(uint16_t *pixel) {
  avifDecoder *decoder = avifDecoderCreate();
  avifImage *image = avifImageCreateEmpty();
  avifRGBImage rgb;
  assert_int_equal(avifDecoderReadFile(decoder, image, path), AVIF_RESULT_OK);
  assert_int_equal(image->width, W);
  assert_int_equal(image->height, H);
  assert_int_equal(image->yuvFormat, AVIF_PIXEL_FORMAT_YUV444);
  assert_int_equal(image->yuvRange, AVIF_RANGE_FULL);
  avifRGBImageSetDefaults(&rgb, image);
  rgb.format = AVIF_RGB_FORMAT_RGB;
  rgb.pixels = (uint8_t *)pixel;
  rgb.rowBytes = 3 * W * sizeof *pixel;
  assert_int_equal(avifImageYUVToRGB(image, &rgb), AVIF_RESULT_OK);
  avifDecoderDestroy(decoder);
  return image;
}

/* Of the whole range, at the most and in the mean. */
static void check_pixels(const abbe_image *image, const uint16_t *pixel, int bits) {
  const double top = (1 << bits) - 1;
  double most = 0, sum = 0;
  for (size_t i = 0; i < W * H * 3; i++) {
    const double off = fabs((double)pixel[i] / top - (double)image->data[i]);
    most = fmax(most, off);
    sum += off;
  }
  print_message("%d bits: off by %.4f at the most, %.5f in the mean\n", bits, most,
                sum / (W * H * 3));
  assert_true(most < 0.012);
  assert_true(sum / (W * H * 3) < 0.0015);
}

typedef struct encoding {
  double xy[8], curve[5];
  int transfer, bits, code[3];
} encoding;

TEST(files_hold_pixels_and_their_colour) {
  static const encoding of[] = {
      {{0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290}, {0}, 16, 10, {9, 16, 9}},
      {{0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290}, {0}, 16, 12, {9, 16, 9}},
      {{0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290}, {0}, 18, 10, {9, 18, 9}},
      {{0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290}, {0}, 0, 10, {1, 13, 1}},
      {{0.68, 0.32, 0.265, 0.69, 0.15, 0.06, 0.3127, 0.3290}, {0}, 0, 12, {12, 13, 1}}};
  FREED uint16_t *pixel = malloc(W * H * 3 * sizeof *pixel);
  for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
    OWNED(abbe_image, image);
    double xy[8];
    paint(&image);
    memcpy(image.xy, of[i].xy, sizeof image.xy);
    image.transfer = of[i].transfer;
    if (of[i].transfer == 0) abbe_rgb_encoding_srgb(xy, image.curve);
    OK(abbe_avif_write(path, &image, of[i].bits, &error));
    avifImage *read = decode(pixel);
    assert_int_equal(read->depth, of[i].bits);
    assert_int_equal(read->colorPrimaries, of[i].code[0]);
    assert_int_equal(read->transferCharacteristics, of[i].code[1]);
    assert_int_equal(read->matrixCoefficients, of[i].code[2]);
    assert_int_equal(read->icc.size, 0);
    check_pixels(&image, pixel, of[i].bits);
    avifImageDestroy(read);
  }
}

/* A power of 2.4 has no code that decoders agree on: a profile says it. */
TEST(other_encodings_have_a_profile) {
  static const double power[5] = {2.4, 1, 0, 0, 0};
  FREED uint16_t *pixel = malloc(W * H * 3 * sizeof *pixel);
  OWNED(abbe_image, image);
  double curve[5];
  FREED void *icc = NULL;
  size_t size = 0;
  paint(&image);
  abbe_rgb_encoding_srgb(image.xy, curve);
  memcpy(image.curve, power, sizeof power);
  OK(abbe_avif_write(path, &image, 10, &error));
  OK(abbe_rgb_encoding_profile(image.xy, image.curve, &icc, &size, &error));
  avifImage *read = decode(pixel);
  assert_int_equal(read->icc.size, size);
  assert_memory_equal(read->icc.data, icc, size);
  check_pixels(&image, pixel, 10);
  avifImageDestroy(read);
}

TEST(what_cannot_be_written_is_said) {
  OWNED(abbe_image, image);
  assert_true(abbe_avif_is_there());
  paint(&image);
  REFUSED(ABBE_INVALID_ARGUMENT, "10 or 12", abbe_avif_write(path, &image, 8, &error));
  image.transfer = 16; /* of primaries that no code names */
  image.xy[0] = 0.6;
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_avif_write(path, &image, 10, &error));
  image.transfer = 0;
  image.data[0] = NAN; /* is dark */
  OK(abbe_avif_write(path, &image, 10, &error));
  REFUSED(ABBE_IO, "", abbe_avif_write("/nowhere/at/all.avif", &image, 10, &error));
}

#else
TEST(without_the_library_it_is_said) {
  OWNED(abbe_image, image);
  paint(&image);
  assert_false(abbe_avif_is_there());
  REFUSED(ABBE_UNSUPPORTED, "libavif", abbe_avif_write(path, &image, 10, &error));
}
#endif
