#include "tests/check.h"

#include "base/file.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/image/rgb_encoding.h"

#include <png.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

static char path[128];
static const char *const names[] = {"R", "G", "B", "A"};

static abbe_image gradient(size_t width, size_t height, size_t channels) {
  abbe_image image = {0};
  OK(abbe_image_make(width, height, channels, names, &image, &error));
  size_t count = width * height * channels;
  for (size_t i = 0; i < count; i++) image.data[i] = (float)i / (float)(count - 1);
  return image;
}

TEST(round_trip) {
  static const size_t channels[] = {1, 3, 4};
  for (int bits = 8; bits <= 16; bits += 8)
    for (int c = 0; c < 3; c++) {
      OWNED(abbe_image, image) = gradient(13, 9, channels[c]);
      OK(abbe_png_write(path, &image, bits, &error));
      MADE(abbe_image, back, abbe_png_read(path, &back, &error));
      assert_true(back.width == 13 && back.height == 9 && back.channels == 3);
      double step = bits == 8 ? 0.5 / 255 : 0.5 / 65535;
      for (size_t p = 0; p < 13 * 9; p++)
        for (size_t k = 0; k < 3; k++) {
          float in = image.data[p * image.channels + (image.channels < 3 ? 0 : k)];
          assert_true(fabs((double)in - (double)back.data[3 * p + k]) <= step + 1e-7);
        }
    }
}

TEST(what_lies_outside_is_clamped) {
  OWNED(abbe_image, image) = gradient(2, 1, 3);
  const float in[6] = {-1, NAN, INFINITY, 2, -INFINITY, 0.5f};
  const float out[6] = {0, 0, 1, 1, 0, 128.0f / 255};
  memcpy(image.data, in, sizeof in);
  OK(abbe_png_write(path, &image, 8, &error));
  MADE(abbe_image, back, abbe_png_read(path, &back, &error));
  for (int i = 0; i < 6; i++) assert_true(back.data[i] == out[i]);
}

TEST(what_cannot_be_written) {
  OWNED(abbe_image, image) = gradient(2, 2, 3);
  abbe_image empty = {0};
  REFUSED(ABBE_INVALID_ARGUMENT, "12", abbe_png_write(path, &image, 12, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_png_write(path, &empty, 8, &error));
  REFUSED(ABBE_IO, "", abbe_png_write("/no/such/folder/a.png", &image, 8, &error));
  image.channels = 0;
  REFUSED(ABBE_INVALID_ARGUMENT, "is empty", abbe_png_write(path, &image, 8, &error));
  image.channels = 2;
  image.transfer = 16;
  REFUSED(ABBE_INVALID_ARGUMENT, "PQ and HLG", abbe_png_write(path, &image, 16, &error));
  image.channels = 3;
}

/* A fourth channel that is no alpha is left out. */
TEST(other_channels_are_left_out) {
  static const char *const depth[] = {"R", "G", "B", "Z"};
  MADE(abbe_image, image, abbe_image_make(1, 1, 4, depth, &image, &error));
  FREED char *data = NULL;
  size_t size = 0;
  image.data[0] = 1;
  OK(abbe_png_write(path, &image, 8, &error));
  OK(abbe_file_read(path, 1 << 20, &data, &size, &error));
  assert_int_equal(data[25], PNG_COLOR_TYPE_RGB); /* IHDR's kind of colour */
  MADE(abbe_image, back, abbe_png_read(path, &back, &error));
  assert_true(back.data[0] == 1 && back.data[1] == 0);
}

TEST(a_full_disk_leaves_the_old_file) {
  OK(abbe_file_write(path, "old", 3, &error));
  OWNED(abbe_image, image) = gradient(300, 300, 3);
  for (int i = 0; i < 270000; i++) image.data[i] = (float)rand() / (float)RAND_MAX;
  signal(SIGXFSZ, SIG_IGN);
  struct rlimit old, small;
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
  small = old;
  small.rlim_cur = 4096;
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
  abbe_error why = {0};
  abbe_result result = abbe_png_write(path, &image, 8, &why);
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &old), 0);
  assert_int_equal(result, ABBE_IO);
  assert_non_null(strstr(why.text, path));
  FREED char *data = NULL;
  size_t size = 0;
  OK(abbe_file_read(path, 100, &data, &size, &error));
  assert_string_equal(data, "old");
}

/* A file as libpng writes it for other programs: begun, its header not yet written, and ended. */
typedef struct foreign {
  FILE *file;
  png_structp png;
  png_infop info;
} foreign;

static void fail_writing(png_structp png, png_const_charp message) {
  (void)png;
  fail_msg("%s", message);
  abort();
}

static foreign begin_foreign(png_uint_32 side, int bits, int colour, int interlace) {
  foreign f = {.file = fopen(path, "wb"),
               .png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, fail_writing, NULL)};
  f.info = png_create_info_struct(f.png);
  assert_true(f.file != NULL && f.png != NULL && f.info != NULL);
  png_init_io(f.png, f.file);
  png_set_IHDR(f.png, f.info, side, side, bits, colour, interlace, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  return f;
}

static void foreign_free(foreign *f) {
  png_write_end(f->png, NULL);
  png_destroy_write_struct(&f->png, &f->info);
  fclose(f->file);
}

/* A palette, grey with alpha and interlaced rows, as other programs write them. */
static void write_foreign(int colour, int bits, int interlace) {
  OWNED(foreign, f) = begin_foreign(8, bits, colour, interlace);
  const png_color palette[2] = {{255, 0, 0}, {0, 0, 255}};
  if (colour == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(f.png, f.info, palette, 2);
  png_write_info(f.png, f.info);
  png_byte rows[8][64];
  png_bytep row[8];
  for (int y = 0; y < 8; y++) {
    memset(rows[y], colour == PNG_COLOR_TYPE_PALETTE ? 0x0f : 0x80, sizeof rows[y]);
    row[y] = rows[y];
  }
  png_write_image(f.png, row);
}

TEST(foreign_files) {
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
    OWNED(abbe_image, image) = {0};
    abbe_error error = {0};
    if (abbe_png_read(path, &image, &error) != ABBE_OK) fail_msg("case %d: %s", i, error.text);
    assert_true(image.width == 8 && image.height == 8 && image.channels == 3);
    for (int k = 0; k < 3; k++) assert_true(fabsf(image.data[k] - cases[i / 2].first[k]) < 1e-6f);
  }
}

static void read_must_fail(const char *data, size_t size, const char *what) {
  OK(abbe_file_write(path, data, size, &error));
  abbe_image image = {0};
  abbe_error error = {0};
  abbe_result result = abbe_png_read(path, &image, &error);
  if (result != ABBE_PARSE || image.data != NULL || strstr(error.text, path) == NULL)
    fail_msg("%s: %d %s", what, (int)result, error.text);
}

static char *written(size_t *size) {
  OWNED(abbe_image, image) = gradient(20, 20, 3);
  OK(abbe_png_write(path, &image, 8, &error));
  char *data = NULL;
  OK(abbe_file_read(path, 1 << 20, &data, size, &error));
  return data;
}

TEST(truncated_anywhere) {
  size_t size = 0;
  FREED char *data = written(&size);
  for (size_t cut = 0; cut < size; cut++) read_must_fail(data, cut, "truncated");
}

TEST(flipped_bits_anywhere) {
  size_t size = 0;
  FREED char *data = written(&size);
  for (size_t at = 0; at < size; at++) {
    data[at] ^= (char)(1 << at % 8);
    OK(abbe_file_write(path, data, size, &error));
    data[at] ^= (char)(1 << at % 8);
    OWNED(abbe_image, back) = {0};
    abbe_error why = {0};
    if (abbe_png_read(path, &back, &why) != ABBE_OK) assert_true(why.text[0] != '\0');
  }
}

/* A header that promises too much, with its checksum right. */
TEST(a_huge_header) {
  static const unsigned sides[][2] = {{2000, 2000}, {16385, 1}, {1, 16385}};
  for (int i = 0; i < 3; i++) {
    size_t size = 0;
    FREED char *data = written(&size);
    for (int b = 0; b < 4; b++)
      for (int k = 0; k < 2; k++) data[16 + 4 * k + b] = (char)(sides[i][k] >> (24 - 8 * b) & 255);
    unsigned crc = 0xffffffff;
    for (int b = 12; b < 29; b++) {
      crc ^= (unsigned char)data[b];
      for (int k = 0; k < 8; k++) crc = crc & 1 ? 0xedb88320u ^ crc >> 1 : crc >> 1;
    }
    for (int b = 0; b < 4; b++) data[29 + b] = (char)(~crc >> (24 - 8 * b) & 255);
    read_must_fail(data, size, "huge header");
  }
}

TEST(not_pictures) {
  abbe_image image = {0};
  REFUSED(ABBE_IO, "", abbe_png_read("/no/such.png", &image, &error));
  REFUSED(ABBE_IO, "", abbe_png_read("/tmp", &image, &error));
  REFUSED(ABBE_IO, "", abbe_png_read("/dev/zero", &image, &error));
  read_must_fail("", 0, "empty");
  read_must_fail("a text", 6, "text");
}

/* Which of the chunks that say a colour the file has: sRGB, gAMA, cHRM, iCCP. */
static void chunks_are(const char *expected) {
  static const char *const known[] = {"sRGB", "gAMA", "cHRM", "iCCP"};
  FREED char *data = NULL;
  char found[40] = "";
  size_t size = 0;
  OK(abbe_file_read(path, 1 << 20, &data, &size, &error));
  for (int k = 0; k < 4; k++)
    for (size_t i = 0; i + 4 <= size; i++)
      if (memcmp(data + i, known[k], 4) == 0) strcat(strcat(found, " "), known[k]);
  assert_string_equal(found, expected);
}

TEST(the_colour_is_said) {
  for (size_t channels = 1; channels <= 3; channels += 2) {
    OWNED(abbe_image, image) = gradient(4, 4, channels);
    OK(abbe_png_write(path, &image, 8, &error));
    chunks_are("");
    abbe_rgb_encoding_srgb(image.xy, image.curve);
    OK(abbe_png_write(path, &image, 8, &error));
    chunks_are(" sRGB gAMA cHRM");
    abbe_rgb_encoding_display_p3(image.xy, image.curve);
    OK(abbe_png_write(path, &image, 16, &error));
    chunks_are(channels == 3 ? " iCCP" : "");
    MADE(abbe_image, back, abbe_png_read(path, &back, &error));
  }
}

static const char *find(const char *data, size_t size, const char *bytes, size_t length) {
  for (size_t i = 0; i + length <= size; i++)
    if (memcmp(data + i, bytes, length) == 0) return data + i;
  return NULL;
}

/* PQ and HLG by cICP [H273], before the pixels, in 16 bits alone; libpng reads the chunk back. */
TEST(hdr_is_said) {
  static const double rec2020[8] = {0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290};
  static const char *const said[] = {"cICP\x09\x10\x00\x01", "cICP\x09\x12\x00\x01"};
  OWNED(abbe_image, image) = gradient(4, 4, 3);
  abbe_image back = {0};
  for (int k = 0; k < 2; k++) {
    FREED char *data = NULL;
    size_t size = 0;
    memcpy(image.xy, rec2020, sizeof image.xy);
    image.transfer = k == 0 ? 16 : 18;
    REFUSED(ABBE_INVALID_ARGUMENT, "16 bits", abbe_png_write(path, &image, 8, &error));
    OK(abbe_png_write(path, &image, 16, &error));
    chunks_are("");
    OK(abbe_file_read(path, 1 << 20, &data, &size, &error));
    const char *chunk = find(data, size, said[k], 8), *pixels = find(data, size, "IDAT", 4);
    assert_true(chunk != NULL && chunk < pixels);
    REFUSED(ABBE_UNSUPPORTED, "cICP", abbe_png_read(path, &back, &error));
    image.xy[0] = 0.5;
    REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_png_write(path, &image, 16, &error));
  }
}

/* A file of one colour that says what `say` adds to it. */
static void write_stating(const double rgb[3], void (*say)(png_structp png, png_infop info)) {
  OWNED(foreign, f) = begin_foreign(1, 16, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE);
  say(f.png, f.info);
  png_write_info(f.png, f.info);
  png_byte row[6];
  for (int c = 0; c < 3; c++) {
    const unsigned v = (unsigned)lround(65535 * rgb[c]);
    row[2 * c] = (png_byte)(v >> 8);
    row[2 * c + 1] = (png_byte)(v & 255);
  }
  png_write_row(f.png, row);
}

static void say_nothing(png_structp png, png_infop info) {
  (void)png, (void)info;
}
static void say_green_is_clear(png_structp png, png_infop info) {
  png_set_tRNS(png, info, NULL, 0, &(png_color_16){.green = 65535});
}
static void say_srgb(png_structp png, png_infop info) {
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
}
static void say_old_srgb(png_structp png, png_infop info) {
  png_set_gAMA_fixed(png, info, 45455);
  png_set_cHRM(png, info, 0.3127, 0.329, 0.64, 0.33, 0.3, 0.6, 0.15, 0.06);
}
static void say_linear(png_structp png, png_infop info) {
  png_set_gAMA_fixed(png, info, 100000);
}
static void say_p3_by_chunks(png_structp png, png_infop info) {
  png_set_cHRM(png, info, 0.3127, 0.329, 0.68, 0.32, 0.265, 0.69, 0.15, 0.06);
}
static void say_p3_and_gamma(png_structp png, png_infop info) {
  png_set_gAMA_fixed(png, info, 45455);
  say_p3_by_chunks(png, info);
}
static void say_p3_by_profile(png_structp png, png_infop info) {
  double xy[8], curve[5];
  FREED void *icc = NULL;
  size_t size = 0;
  abbe_rgb_encoding_display_p3(xy, curve);
  OK(abbe_rgb_encoding_profile(xy, curve, &icc, &size, &error));
  png_set_iCCP(png, info, "p3", 0, icc, (png_uint_32)size);
}
static png_byte matrix = 0, full = 1, cicp_size = 4;
static void say_cicp(png_structp png, png_infop info, int primaries, int transfer) {
  png_unknown_chunk chunk = {.name = "cICP", .size = cicp_size, .location = PNG_HAVE_IHDR};
  png_byte code[4] = {(png_byte)primaries, (png_byte)transfer, matrix, full};
  chunk.data = code;
  png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_ALWAYS, NULL, 0);
  png_set_unknown_chunks(png, info, &chunk, 1);
}
static void say_p3_by_cicp(png_structp png, png_infop info) {
  say_srgb(png, info); /* is outranked */
  say_cicp(png, info, 12, 13);
}
static void say_rec709_by_cicp(png_structp png, png_infop info) {
  say_cicp(png, info, 1, 1);
}
static void say_nobody_knows(png_structp png, png_infop info) {
  say_cicp(png, info, 2, 13);
}
static void say_pq(png_structp png, png_infop info) {
  say_cicp(png, info, 9, 16);
}

/* Half of black lets half of white through, in light; of what is clear the colour does not matter,
 * whether alpha or a key says so. */
TEST(what_is_transparent_lies_on_white_paper) {
  static const float in[] = {0, 0, 0, 0.5f, 1, 0, 0, 0, 0.2f, 1, 0.5f, 1};
  static const double out[] = {0.7354, 0.7354, 0.7354, 1, 1, 1, 0.2, 1, 0.5};
  OWNED(abbe_image, image) = gradient(3, 1, 4);
  memcpy(image.data, in, sizeof in);
  for (int bits = 8; bits <= 16; bits += 8) {
    OK(abbe_png_write(path, &image, bits, &error));
    MADE(abbe_image, back, abbe_png_read_over_white(path, &back, &error));
    assert_int_equal(back.channels, 3);
    for (size_t i = 0; i < 9; i++) assert_near((double)back.data[i], out[i], 4e-3);
  }
  write_stating((const double[3]){0, 1, 0}, say_green_is_clear);
  MADE(abbe_image, keyed, abbe_png_read_over_white(path, &keyed, &error));
  for (size_t i = 0; i < 3; i++) assert_true(keyed.data[i] == 1);
}

TEST(the_colour_is_heeded) {
  /* Rec.709's red on a Display P3 screen, as published for CSS colours; (V + 0.099) / 1.099 of 0.5
   * to the power 1/0.45 is 0.2597 */
  static const struct {
    void (*say)(png_structp png, png_infop info);
    double in[3], out[3];
  } cases[] = {{say_nothing, {0.2, 0.5, 0.7}, {0.2, 0.5, 0.7}},
               {say_srgb, {0.2, 0.5, 0.7}, {0.2, 0.5, 0.7}},
               {say_old_srgb, {0.2, 0.5, 0.7}, {0.2, 0.5, 0.7}},
               {say_linear, {0.21404, 0.5, 1}, {0.5, 0.73536, 1}},
               {say_p3_by_chunks, {0.91749, 0.20029, 0.13856}, {1, 0, 0}},
               /* sqrt-like curves part there: 0.2159 is 0.5^2.2, of grey nothing but the curve */
               {say_p3_and_gamma, {0.5, 0.5, 0.5}, {0.5028, 0.5028, 0.5028}},
               {say_p3_by_profile, {0.91749, 0.20029, 0.13856}, {1, 0, 0}},
               {say_p3_by_cicp, {0.91749, 0.20029, 0.13856}, {1, 0, 0}},
               {say_rec709_by_cicp, {0.5, 0.5, 0.5}, {0.54681, 0.54681, 0.54681}}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    OWNED(abbe_image, image) = {0};
    abbe_error why = {0};
    write_stating(cases[i].in, cases[i].say);
    if (abbe_png_read(path, &image, &why) != ABBE_OK) fail_msg("case %zu: %s", i, why.text);
    for (int c = 0; c < 3; c++)
      if (!(fabs((double)image.data[c] - cases[i].out[c]) < 4e-3))
        fail_msg("case %zu: component %d is %g, not %g", i, c, (double)image.data[c],
                 cases[i].out[c]);
    assert_true(abbe_rgb_encoding_is_srgb(image.xy, image.curve));
  }
  abbe_image image = {0};
  static const png_byte odd[][3] = {{0, 1, 4}, {1, 1, 4}, {0, 0, 4}, {0, 1, 3}};
  for (size_t i = 0; i < 5; i++) {
    matrix = i < 4 ? odd[i][0] : 0;
    full = i < 4 ? odd[i][1] : 1;
    cicp_size = i < 4 ? odd[i][2] : 4;
    write_stating(cases[0].in, i == 0 ? say_pq : i < 4 ? say_p3_by_cicp : say_nobody_knows);
    REFUSED(ABBE_UNSUPPORTED, "cICP", abbe_png_read(path, &image, &error));
    assert_null(image.data);
  }
}

/* ---- the text that Abbe adds ---- */

static const unsigned char signature[] = "\x89PNG\r\n\x1a\n";

/* A file of so many chunks of a kind and length, each of zeros, then one with a text of the key. */
static void write_chunks(size_t chunks, const char *kind, unsigned length, const char *key) {
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  fwrite(signature, 8, 1, file);
  for (size_t i = 0; i < chunks; i++) {
    fprintf(file, "%c%c%c%c%s", length >> 24, length >> 16 & 255, length >> 8 & 255, length & 255,
            kind);
    for (size_t k = 0; k < (length & 0xffff) + 4; k++) fputc(0, file);
  }
  if (key != NULL)
    fprintf(file, "%c%c%c%ctEXt%s%cwords....", 0, 0, 0, (int)strlen(key) + 6, key, 0);
  fclose(file);
}

TEST(the_text_is_found) {
  static const struct {
    size_t chunks;
    const char *kind;
    unsigned length;
    const char *key, *text;
  } rows[] = {
      {0, "", 0, ABBE_PNG_TEXT, "words"},        {1, "pHYs", 9, ABBE_PNG_TEXT, "words"},
      {255, "pHYs", 0, ABBE_PNG_TEXT, "words"},  {256, "pHYs", 0, ABBE_PNG_TEXT, NULL},
      {1, "tEXt", 2, ABBE_PNG_TEXT, "words"},    {1, "tEXt", 60, ABBE_PNG_TEXT, "words"},
      {1, "IDAT", 9, ABBE_PNG_TEXT, NULL},       {1, "pHYs", 0x80000009, ABBE_PNG_TEXT, NULL},
      {1, "tEXt", 0x10001, ABBE_PNG_TEXT, NULL}, {2, "pHYs", 3, NULL, NULL}};
  FREED char *text = NULL;
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    write_chunks(rows[i].chunks, rows[i].kind, rows[i].length, rows[i].key);
    OK(abbe_png_read_text(path, &text, &error));
    if ((text == NULL) != (rows[i].text == NULL)) fail_msg("row %zu: %s", i, text);
    if (text != NULL) assert_string_equal(text, rows[i].text);
    free(text);
    text = NULL;
  }
  write_chunks(1, "tEXt", 60, NULL);
  assert_int_equal(truncate(path, 40), 0); /* within it */
  OK(abbe_png_read_text(path, &text, &error));
  assert_null(text);
  OWNED(abbe_image, image) = gradient(2, 2, 3);
  OK(abbe_image_set_attribute(&image, ABBE_PNG_TEXT, "scene: 3", &error));
  OK(abbe_png_write(path, &image, 8, &error));
  OK(abbe_png_read_text(path, &text, &error));
  assert_string_equal(text, "scene: 3");
  free(text);
  REFUSED(ABBE_IO, "/no/such.png", abbe_png_read_text("/no/such.png", &text, &error));
  static const char *const none[] = {"", "a text that is long enough"};
  for (int i = 0; i < 2; i++) {
    OK(abbe_file_write(path, none[i], strlen(none[i]), &error));
    FREED char *nothing = NULL;
    REFUSED(ABBE_PARSE, "it is no PNG", abbe_png_read_text(path, &nothing, &error));
  }
}

static long peak_kilobytes(void) {
  struct rusage usage;
  assert_int_equal(getrusage(RUSAGE_SELF, &usage), 0);
  return usage.ru_maxrss;
}

/* Pixels of one bit, and a text, that are a little beyond what is unpacked: refused before memory
 * is taken. */
TEST(what_unfolds_is_refused) {
  static const unsigned char text_bomb[] =
      "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\10\2\0\0\0\x90wS\xde\0\x40\0\1zTXtk";
  abbe_image image = {0};
  const long before = peak_kilobytes();
  read_must_fail((const char *)text_bomb, sizeof text_bomb, "text bomb");
  foreign f = begin_foreign(5000, 1, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE);
  png_write_info(f.png, f.info);
  const png_byte row[625] = {0};
  for (int y = 0; y < 5000; y++) png_write_row(f.png, row);
  foreign_free(&f);
  REFUSED(ABBE_UNSUPPORTED, "5000 x 5000", abbe_png_read(path, &image, &error));
  assert_null(image.data);
  assert_true(peak_kilobytes() - before < 100000);
}

static void leave(void) {
  unlink(path);
}

static void begin(void) {
  snprintf(path, sizeof path, "/tmp/abbe_test_png_%ld.png", (long)getpid());
}

GROUP(begin, leave);
