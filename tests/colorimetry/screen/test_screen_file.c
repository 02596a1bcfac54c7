/* Files for a display, decoded again by other programs (libavif, Pillow): their pixels, and what
 * they say of their colour and time. */
#include "tests/check.h"

#include "colorimetry/image/png_file.h"
#include "colorimetry/image/rgb_encoding.h"
#include "colorimetry/screen/screen_file.h"

#include <unistd.h>

static char folder[] = "/tmp/abbe-test-screen-XXXXXX", path[64];

static const char *name(const char *file) {
  snprintf(path, sizeof path, "%s/%s", folder, file);
  return path;
}

static void setup(void) {
  assert_non_null(mkdtemp(folder));
}

static void teardown(void) {
  assert_int_equal(system(printed("rm -r %s", folder)), 0);
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

/* What Pillow reads of the file; rgb[W * H * 3] of its picture `frame`. */
typedef struct decoded {
  int width, height, frames, profile; /* profile: bytes */
  double ms, alpha;                   /* of that picture; mean of alpha, 255 without */
} decoded;

static decoded decode(const char *file, int frame, unsigned char *rgb) {
  static const char script[] =
      "import sys\n"
      "from PIL import Image\n"
      "i = Image.open(sys.argv[1])\n"
      "f = getattr(i, 'n_frames', 1)\n"
      "if f > 1: i.seek(int(sys.argv[2]))\n"
      "i.load()\n"
      "c = i.convert('RGBA'); a = list(c.getdata(3))\n"
      "print(i.width, i.height, f, len(i.info.get('icc_profile') or b''),\n"
      "      i.info.get('duration', 0), sum(a) / len(a))\n"
      "open(sys.argv[1] + '.rgb', 'wb').write(c.convert('RGB').tobytes())\n";
  decoded d = {0};
  FILE *from = popen(printed("/usr/bin/python3 -c \"%s\" %s %d", script, file, frame), "r");
  assert_int_equal(fscanf(from, "%d %d %d %d %lf %lf", &d.width, &d.height, &d.frames, &d.profile,
                          &d.ms, &d.alpha),
                   6);
  assert_int_equal(pclose(from), 0);
  assert_true(d.width == W && d.height == H);
  from = fopen(printed("%s.rgb", file), "rb");
  assert_int_equal(fread(rgb, 3, W * H, from), W * H);
  fclose(from);
  return d;
}

/* Mean of |difference| and of the difference, of 255. */
static void compare(const abbe_image *image, const unsigned char *rgb, double *off, double *bias) {
  *off = *bias = 0;
  for (size_t i = 0; i < W * H * 3; i++) {
    const double d = rgb[i] - 255 * (double)image->data[i / 3 * image->channels + i % 3];
    *off += fabs(d) / (W * H * 3);
    *bias += d / (W * H * 3);
  }
}

TEST(kinds_hold_pixels_and_their_colour) {
  /* most: what 8 bits round by, JPEG's transform, and 256 colours with their errors spread */
  static const struct {
    const char *file;
    double most;
    bool profile[2]; /* of sRGB, of P3 */
  } of[] = {{"a.webp", 0.26, {false, true}},
            {"a.jpg", 1.5, {true, true}},
            {"A.JPEG", 1.5, {true, true}},
            {"a.gif", 4, {false, false}}};
  FREED unsigned char *rgb = malloc(W * H * 3);
  for (size_t i = 0; i < sizeof of / sizeof *of; i++)
    for (int p3 = 0; p3 < 2; p3++) {
      double off, bias;
      if (abbe_screen_kind_of(of[i].file)->library != NULL) continue;
      FILLED(abbe_image, image, paint(&image));
      (p3 ? abbe_rgb_encoding_display_p3 : abbe_rgb_encoding_srgb)(image.xy, image.curve);
      if (strcmp(of[i].file, "a.gif") == 0 && p3) {
        REFUSED(ABBE_INVALID_ARGUMENT, "a GIF is sRGB",
                abbe_screen_file_write(name(of[i].file), &image, 0, &error));
        continue;
      }
      OK(abbe_screen_file_write(name(of[i].file), &image, 0, &error));
      const decoded d = decode(path, 0, rgb);
      compare(&image, rgb, &off, &bias);
      print_message("%s: off by %.3f, bias %.3f\n", of[i].file, off, bias);
      assert_true(off < of[i].most && fabs(bias) < 0.15);
      assert_true(d.frames == 1 && (d.profile > 0) == of[i].profile[p3]);
    }
}

TEST(a_gif_of_few_colours_is_exact) {
  FREED unsigned char *rgb = malloc(W * H * 3);
  double off, bias;
  FILLED(abbe_image, image, paint(&image));
  for (size_t i = 0; i < W * H * 3; i++)
    image.data[i] = (float)((i / 3 % W / 7 * 16 + i % 3 * 5) % 256) / 255;
  OK(abbe_screen_file_write(name("few.gif"), &image, 0, &error));
  decode(path, 0, rgb);
  compare(&image, rgb, &off, &bias);
  assert_true(off < 1e-4);
}

TEST(alpha_stays) {
  static const char *const alpha[] = {"A"};
  FREED unsigned char *rgb = malloc(W * H * 3);
  if (abbe_screen_kind_of("a.webp")->library != NULL) return;
  FILLED(abbe_image, image, paint(&image));
  MADE(abbe_image, own, abbe_image_make(W, H, 1, alpha, &own, &error));
  for (size_t i = 0; i < W * H; i++) own.data[i] = i % 2 ? 0.2f : 1;
  OK(abbe_image_append(&image, &own, &error));
  OK(abbe_screen_file_write(name("alpha.webp"), &image, 0, &error));
  assert_near(decode(path, 0, rgb).alpha, 153, 0.1);
}

TEST(frames_move_at_their_pace) {
  static const struct {
    const char *file;
    double per_second, ms, most;
  } of[] = {{"turn.webp", 25, 40, 3}, {"turn.gif", 25, 40, 4}, {"turn.gif", 40, 30, 4}};
  FREED unsigned char *rgb = malloc(W * H * 3);
  char frame[3][64];
  const char *const frames[] = {frame[0], frame[1], frame[2]};
  FILLED(abbe_image, image, paint(&image));
  for (int i = 0; i < 3; i++) {
    snprintf(frame[i], sizeof frame[i], "%s/turn-%d.png", folder, i);
    for (size_t p = 0; p < W * H; p++) image.data[3 * p + 2] = 0.3f * (float)i;
    OK(abbe_png_write(frame[i], &image, 8, &error));
  }
  for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
    double off, bias;
    if (abbe_screen_kind_of(of[i].file)->library != NULL) continue;
    OK(abbe_screen_file_move(name(of[i].file), frames, 3, of[i].per_second, &error));
    const decoded d = decode(path, 2, rgb);
    compare(&image, rgb, &off, &bias);
    print_message("%s: the last frame is off by %.3f\n", of[i].file, off);
    assert_true(d.frames == 3 && off < of[i].most);
    assert_near(decode(path, 0, rgb).ms, of[i].ms, 0.5);
  }
  REFUSED(ABBE_INVALID_ARGUMENT, "to 50 frames",
          abbe_screen_file_move(name("a.gif"), frames, 3, 60, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_screen_file_move(name("a.avif"), frames, 3, 25, &error));
}

TEST(what_a_kind_does_not_hold_is_said) {
  static const struct {
    const char *file;
    abbe_screen_file_needs needs;
    const char *words;
  } of[] = {{"a.png", {.bits = 10}, "8 or 16"},
            {"a", {.bits = 12}, "8 or 16"},
            {"a.avif", {.bits = 8}, "10 or 12"},
            {"a.webp", {.bits = 16}, "8 bits"},
            {"a.gif", {.alpha = true}, ".webp"},
            {"a.jpg", {.alpha = true}, ".webp"},
            {"a.jpg", {.moves = true}, ".gif"},
            {"a.avif", {.moves = true}, ".gif"},
            {"a.gif", {.moves = true, .per_second = 60}, "to 50 frames"},
            {"a.png", {.moves = true, .per_second = 0.01}, "to 1000 frames"},
            {"a.webp", {.transfer = 16}, "PQ"},
            {"a.gif", {.transfer = 18}, "HLG"},
            {"a.png", {.transfer = 16, .bits = 8}, "16 bits"}};
  for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
    const abbe_screen_kind *kind = abbe_screen_kind_of(of[i].file);
    if (kind != NULL && kind->library != NULL)
      REFUSED(ABBE_UNSUPPORTED, kind->library,
              abbe_screen_file_check(of[i].file, &of[i].needs, &error));
    else
      REFUSED(ABBE_INVALID_ARGUMENT, of[i].words,
              abbe_screen_file_check(of[i].file, &of[i].needs, &error));
  }
  FILLED(abbe_image, image, paint(&image));
  image.transfer = 16;
  REFUSED(ABBE_INVALID_ARGUMENT, "PQ", abbe_screen_file_write(name("a.gif"), &image, 0, &error));
  assert_null(abbe_screen_kind_of("a.exr"));
  assert_null(abbe_screen_kind_of("gif"));
  assert_null(abbe_screen_kind_of(NULL));
  image.transfer = 0;
  REFUSED(ABBE_IO, "", abbe_screen_file_write("/nowhere/at/all.gif", &image, 0, &error));
}

#ifdef ABBE_HAS_AVIF
#include <avif/avif.h>

/* rgb[W * H * 3], of all the file's bits. */
static avifImage *decode_avif(uint16_t *pixel) {
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
    double xy[8];
    FILLED(abbe_image, image, paint(&image));
    memcpy(image.xy, of[i].xy, sizeof image.xy);
    image.transfer = of[i].transfer;
    if (of[i].transfer == 0) abbe_rgb_encoding_srgb(xy, image.curve);
    OK(abbe_screen_file_write(name("a.avif"), &image, of[i].bits, &error));
    avifImage *read = decode_avif(pixel);
    assert_int_equal(read->depth, of[i].bits);
    assert_int_equal(read->colorPrimaries, of[i].code[0]);
    assert_int_equal(read->transferCharacteristics, of[i].code[1]);
    assert_int_equal(read->matrixCoefficients, of[i].code[2]);
    assert_int_equal(read->icc.size, 0);
    check_pixels(&image, pixel, of[i].bits);
    avifImageDestroy(read);
    MADE(abbe_image, own, abbe_avif_read(path, &own, &error));
    assert_int_equal(own.transfer, of[i].transfer);
    for (int k = 0; k < 8; k++) assert_near(own.xy[k], of[i].xy[k], 1e-9);
    for (int k = 0; k < 5; k++) assert_near(own.curve[k], image.curve[k], 1e-9);
    /* Both are rounded: pixel to the file's bits, the reader's to 16. */
    const double top = (1 << of[i].bits) - 1, rounding = 0.5 / top + 0.5 / 65535 + 1e-7;
    for (size_t k = 0; k < W * H * 3; k++)
      assert_near(own.data[k], (double)pixel[k] / top, rounding);
  }
}

/* Bytes cut off, bytes that are none. */
TEST(broken_files_are_said) {
  FILLED(abbe_image, image, paint(&image));
  abbe_image none;
  abbe_rgb_encoding_srgb(image.xy, image.curve);
  OK(abbe_screen_file_write(name("a.avif"), &image, 10, &error));
  assert_int_equal(truncate(path, 200), 0);
  REFUSED(ABBE_PARSE, "a.avif: it cannot be read as AVIF", abbe_avif_read(path, &none, &error));
  OK(abbe_png_write(path, &image, 8, &error));
  REFUSED(ABBE_PARSE, "a.avif: it cannot be read as AVIF", abbe_avif_read(path, &none, &error));
  REFUSED(ABBE_IO, "", abbe_avif_read("/no/such.avif", &none, &error));
  assert_null(none.data);
  abbe_image large = image; /* one line beyond what is written; its pixels are not looked at */
  large.width = ABBE_IMAGE_MAX_SIDE, large.height = ABBE_IMAGE_MAX_SIDE / 8 + 1;
  REFUSED(ABBE_UNSUPPORTED, "up to 134217728 can be", abbe_avif_write(path, &large, 10, &error));
}

/* A power of 2.4 has no code that decoders agree on: a profile says it. */
TEST(other_encodings_have_a_profile) {
  static const double power[5] = {2.4, 1, 0, 0, 0};
  FREED uint16_t *pixel = malloc(W * H * 3 * sizeof *pixel);
  double curve[5];
  FREED void *icc = NULL;
  size_t size = 0;
  FILLED(abbe_image, image, paint(&image));
  abbe_rgb_encoding_srgb(image.xy, curve);
  memcpy(image.curve, power, sizeof power);
  OK(abbe_screen_file_write(name("a.avif"), &image, 10, &error));
  OK(abbe_rgb_encoding_profile(image.xy, image.curve, &icc, &size, &error));
  avifImage *read = decode_avif(pixel);
  assert_int_equal(read->icc.size, size);
  assert_memory_equal(read->icc.data, icc, size);
  check_pixels(&image, pixel, 10);
  avifImageDestroy(read);
  /* read, it is sRGB */
  MADE(abbe_image, own, abbe_avif_read(path, &own, &error));
  assert_true(abbe_rgb_encoding_is_srgb(own.xy, own.curve));
  const double light = pow((double)pixel[0] / 1023, 2.4);
  assert_near(own.data[0], abbe_srgb_encoded(light), 2e-3);
}

TEST(what_cannot_be_written_is_said) {
  FILLED(abbe_image, image, paint(&image));
  REFUSED(ABBE_INVALID_ARGUMENT, "10 or 12",
          abbe_screen_file_write(name("a.avif"), &image, 8, &error));
  image.transfer = 16; /* of primaries that no code names */
  image.xy[0] = 0.6;
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_screen_file_write(name("a.avif"), &image, 10, &error));
  image.transfer = 0;
  image.data[0] = NAN; /* is dark */
  OK(abbe_screen_file_write(name("a.avif"), &image, 10, &error));
  REFUSED(ABBE_IO, "", abbe_screen_file_write("/nowhere/at/all.avif", &image, 10, &error));
}

#endif
