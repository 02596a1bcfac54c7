/* OpenEXR files of every make, read by Abbe and by OpenEXR's own C++ library, and the other way. */
#include "tests/check.h"
#include "tests/colorimetry/image/exr_library.h"
#include "tests/colorimetry/image/exr_parts_file.h"
#include "tests/random.h"

#include "base/file.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/rgb_space.h"

#include <openexr.h>
#include <unistd.h>
#include <zlib.h>

static char path[128];

static const char *const names[] = {"A", "B", "G", "R", "Z", "caustic.R"};
static const int sizes[][2] = {{37, 41}, {3, 2}, {1, 1}, {1, 70}, {129, 1}};
enum { SIZES = sizeof sizes / sizeof *sizes, TILED_SIZES = 2 };

static void say(char *text, size_t size, const exr_library_file *f) {
  snprintf(text, size, "%d channels of types %d %d, codec %d, %d x %d, tiles of %d, order %d",
           f->channels, f->type[0], f->type[1], f->codec, f->data_window[2] - f->data_window[0] + 1,
           f->data_window[3] - f->data_window[1] + 1, f->tile[0], f->line_order);
}

static bool same(float a, float b) {
  return (isnan(a) && isnan(b)) || memcmp(&a, &b, sizeof a) == 0;
}

/* Every pixel of the picture, by place: what the file's data hold there, else 0. */
static void compare_part(const abbe_image *image, int part, const char *const *name, int count,
                         const char *what) {
  int data[4], shown[4];
  FREED float *value = NULL;
  char why[300];
  if (!exr_library_read(path, part, name, count, data, shown, &value, why, sizeof why))
    fail_msg("%s: %s", what, why);
  const int width = shown[2] - shown[0] + 1, height = shown[3] - shown[1] + 1;
  const int line = data[2] - data[0] + 1, lines = data[3] - data[1] + 1;
  if (image->width != (size_t)width || image->height != (size_t)height)
    fail_msg("%s: %zu x %zu pixels, not %d x %d", what, image->width, image->height, width, height);
  for (int k = 0; k < count; k++) {
    const size_t c = abbe_image_find_channel(image, name[k]);
    assert_true(c != (size_t)-1);
    for (int i = 0; i < width * height; i++) {
      const int x = i % width + shown[0] - data[0], y = i / width + shown[1] - data[1];
      const bool inside = x >= 0 && x < line && y >= 0 && y < lines;
      const float right = inside ? value[(k * lines + y) * line + x] : 0;
      const float is = image->data[(size_t)i * image->channels + c];
      if (!same(right, is))
        fail_msg("%s: %s of pixel %d is %g, not %g", what, name[k], i, (double)is, (double)right);
    }
  }
}

static void compare(const abbe_image *image, const char *const *name, int count, const char *what) {
  compare_part(image, 0, name, count, what);
}

static void read_and_compare(const exr_library_file *f) {
  char what[200], why[300];
  say(what, sizeof what, f);
  if (!exr_library_write(path, f, why, sizeof why)) fail_msg("%s: %s", what, why);
  OWNED(abbe_image, image) = {0};
  abbe_error error = {0};
  if (abbe_exr_read(path, &image, &error) != ABBE_OK) fail_msg("%s: %s", what, error.text);
  assert_int_equal(image.channels, f->channels);
  compare(&image, f->name, f->channels, what);
}

/* All counts of channels to six, of one type or of two, at all sizes. */
static void read_all(exr_library_file f) {
  static const int types[][2] = {{1, 1}, {2, 2}, {0, 0}, {1, 2}};
  for (f.channels = 1; f.channels <= 6; f.channels++)
    for (int t = 0; t < 4; t++)
      for (int s = 0; s < (f.tile[0] > 0 ? TILED_SIZES : SIZES); s++) {
        for (int c = 0; c < f.channels; c++) {
          f.name[c] = names[c];
          f.type[c] = types[t][c % 2];
        }
        f.data_window[2] = f.display_window[2] = sizes[s][0] - 1;
        f.data_window[3] = f.display_window[3] = sizes[s][1] - 1;
        read_and_compare(&f);
      }
}

TEST(scan_lines) {
  for (int codec = EXR_COMPRESSION_NONE; codec <= EXR_COMPRESSION_B44A; codec++)
    read_all((exr_library_file){.codec = codec, .line_order = codec % 2});
}

/* The picture is the display window, wherever the data lie. */
TEST(windows) {
  static const int display[][4] = {
      {0, 0, 29, 19}, {-7, 11, 22, 30}, {-1000000000, 3, -999999973, 9}};
  static const int data[][4] = {{3, 4, 12, 9},  {-5, -6, 40, 33}, {20, -9, 44, 7}, {-4, 15, 3, 40},
                                {60, 0, 70, 9}, {-9, -9, -1, -1}, {-9, 2, -1, 9}};
  for (int d = 0; d < 3; d++)
    for (int w = 0; w < 7; w++)
      for (int i = 0; i < 6; i++) {
        exr_library_file f = {.channels = 3, .name = {"B", "G", "R"}, .type = {1, 2, 0}};
        f.codec = i % 3 == 0   ? EXR_COMPRESSION_ZIP
                  : i % 3 == 1 ? EXR_COMPRESSION_NONE
                               : EXR_COMPRESSION_B44A;
        f.tile[0] = f.tile[1] = i < 3 ? 0 : 7;
        memcpy(f.display_window, display[d], sizeof f.display_window);
        for (int k = 0; k < 4; k++) f.data_window[k] = display[d][k % 2] + data[w][k];
        read_and_compare(&f);
      }
}

TEST(tiles) {
  for (int codec = EXR_COMPRESSION_NONE; codec <= EXR_COMPRESSION_B44A; codec++)
    read_all((exr_library_file){.codec = codec, .tile = {16, 10}, .levels = codec % 2 == 0});
}

static bool library_is(int major, int minor, int patch) {
  int here[3];
  const char *extra = NULL;
  exr_get_library_version(&here[0], &here[1], &here[2], &extra);
  return (here[0] * 100 + here[1]) * 100 + here[2] >= (major * 100 + minor) * 100 + patch;
}

static void refused(const exr_library_file *f, const char *word) {
  char why[300];
  if (!exr_library_write(path, f, why, sizeof why)) fail_msg("%s", why);
  abbe_image image = {0};
  REFUSED(ABBE_UNSUPPORTED, word, abbe_exr_read(path, &image, &error));
  assert_null(image.data);
}

static exr_library_file coloured(int codec, int side) {
  exr_library_file f = {.channels = 3, .type = {1, 1, 1}, .name = {"B", "G", "R"}, .codec = codec};
  f.data_window[2] = f.display_window[2] = f.data_window[3] = f.display_window[3] = side - 1;
  return f;
}

TEST(what_is_refused) {
  exr_library_file f = coloured(EXR_COMPRESSION_ZIP, 64);
  f.sampling = 2;
  refused(&f, "subsampled");
  f = coloured(EXR_COMPRESSION_PIZ, 1);
  f.tile[0] = 16385;
  f.tile[1] = 1;
  refused(&f, "16385 x 1 pixels; up to 16384 a side");
  f.tile[0] = 1;
  f.tile[1] = 16385;
  refused(&f, "1 x 16385 pixels; up to 16384 a side");
}

/* What the OpenEXR that is here decodes is read, however small the file of a flat picture; else the
 * version is named that does. */
TEST(younger_codecs) {
  enum { HTJ2K = 10, HTJ2K_32 = 11 };
  for (int codec = EXR_COMPRESSION_DWAA; codec <= HTJ2K_32; codec++) {
    exr_library_file f = coloured(codec, 64), flat = coloured(codec, 3000);
    flat.flat = true;
    const bool dwa = codec < HTJ2K;
    if (dwa ? library_is(3, 1, 8) : library_is(3, 4, 0)) {
      read_and_compare(&f);
      read_and_compare(&flat);
    } else if (dwa) {
      refused(&f, codec == EXR_COMPRESSION_DWAA ? "DWAA compression is read with OpenEXR 3.1.8"
                                                : "DWAB compression is read with OpenEXR 3.1.8");
    }
  }
}

/* mark: "" or "#PART". */
static void reads_part(const char *mark, int part, const char *says) {
  const char *name = printed("%s%s", path, mark);
  MADE(abbe_image, image, abbe_exr_read(name, &image, &error));
  assert_string_equal(image.part, says);
  assert_int_equal(image.channels, parts[part].channels);
  compare_part(&image, part, parts[part].name, parts[part].channels, name);
}

TEST(parts) {
  write_parts(path, PARTS);
  reads_part("", 2, "3 'rgb left' of 4"); /* the first with colours */
  reads_part("#depth", 0, "1 'depth' of 4");
  reads_part("#2", 1, "2 'grey' of 4");
  reads_part("#rgb right", 3, "4 'rgb right' of 4");
  write_parts(path, 2);
  reads_part("", 1, "2 'grey' of 2");
  OWNED(abbe_image, image) = {0};
  char name[200];
  static const char *const none[] = {"#rgb left", "#3", "#0", "#"};
  for (int i = 0; i < 4; i++) {
    snprintf(name, sizeof name, "%s%s", path, none[i]);
    REFUSED(ABBE_NOT_FOUND, "there are 1 'depth', 2 'grey'", abbe_exr_read(name, &image, &error));
  }
  read_and_compare(&(exr_library_file){.channels = 1, .name = {"Y"}, .type = {2}});
  snprintf(name, sizeof name, "%s#2", path);
  REFUSED(ABBE_NOT_FOUND, "no part '2'; there is 1", abbe_exr_read(name, &image, &error));
  snprintf(name, sizeof name, "%s#1", path);
  OK(abbe_exr_read(name, &image, &error));
  assert_string_equal(image.part, "");
  abbe_image_free(&image);
  /* a file of that very name is itself */
  assert_int_equal(rename(path, name), 0);
  OK(abbe_exr_read(name, &image, &error));
  unlink(name);
}

/* The layout of Ocean: channels of any name, whose light an attribute says in metres. */
TEST(wavelengths_as_attributes) {
  exr_library_file f = {.channels = 3,
                        .type = {1, 2, 2},
                        .name = {"Y", "wl0", "wl1"},
                        .metres = {0, 5.5e-7F, 4.005e-7F}}; /* a double, a float */
  char why[300];
  if (!exr_library_write(path, &f, why, sizeof why)) fail_msg("%s", why);
  MADE(abbe_image, image, abbe_exr_read(path, &image, &error));
  assert_string_equal(image.channel[0], "Y");
  assert_string_equal(image.channel[1], "S0.550,000000nm");
  assert_string_equal(image.channel[2], "S0.400,500000nm");
  static const float none[] = {NAN, -5.5e-7F, 550, INFINITY};
  for (size_t i = 0; i < sizeof none / sizeof *none; i++) {
    abbe_image broken;
    f.metres[2] = none[i];
    if (!exr_library_write(path, &f, why, sizeof why)) fail_msg("%s", why);
    REFUSED(ABBE_PARSE, "its attribute wl1.wavelength is no wavelength",
            abbe_exr_read(path, &broken, &error));
  }
}

/* In metres or with a unit; what is no number leaves the channel's name, and stays a text. */
TEST(wavelengths_as_texts) {
  static const char *const name[] = {"wl0", "wl1", "wl2", "wl3"};
  static const char *const text[] = {"4.005e-7", "550 nm", "6e-7m", "550 green"};
  static const char *const other[] = {"wl3.width", "wlx.wavelength", "waves.wavelength",
                                      "wl3.green"};
  static const char *const read[] = {"S0.400,500000nm", "S0.550,000000nm", "S0.600,000000nm",
                                     "wl3"};
  MADE(abbe_image, image, abbe_image_make(2, 1, 4, name, &image, &error));
  for (size_t i = 0; i < 4; i++)
    OK(abbe_image_set_attribute(&image, printed("%s.wavelength", name[i]), text[i], &error));
  for (size_t i = 0; i < 4; i++) OK(abbe_image_set_attribute(&image, other[i], "1 nm", &error));
  OK(abbe_image_set_attribute(&image, "wl3.wavelength", "green", &error));
  OK(abbe_exr_write(path, &image, &error));
  MADE(abbe_image, green, abbe_exr_read(path, &green, &error));
  assert_true(abbe_image_find_channel(&green, "wl3") < 4);
  OK(abbe_image_set_attribute(&image, "wl3.wavelength", text[3], &error));
  OK(abbe_exr_write(path, &image, &error));
  MADE(abbe_image, back, abbe_exr_read(path, &back, &error));
  for (size_t i = 0; i < 4; i++) assert_true(abbe_image_find_channel(&back, read[i]) < 4);
  assert_string_equal(abbe_image_attribute_text(&back, "wl3.wavelength"), "550 green");
  for (size_t i = 0; i < 4; i++)
    assert_string_equal(abbe_image_attribute_text(&back, other[i]), "1 nm");
  OK(abbe_image_set_attribute(&image, "wl3.wavelength", "550", &error));
  OK(abbe_exr_write(path, &image, &error));
  abbe_image none;
  REFUSED(ABBE_PARSE, "wl3.wavelength is no wavelength", abbe_exr_read(path, &none, &error));
}

/* Every fourth chunk first, then those between; until then lines are as those above. Chunks above
 * and below what is shown are not counted. */
TEST(lines_in_passes) {
  static const int shown[][4] = {{0, 0, 36, 69}, {0, 41, 36, 61}, {0, -8, 36, 11}};
  for (int i = 0; i < 3; i++) {
    exr_library_file f = {.channels = 1, .type = {2}, .name = {"Y"}, .data_window = {0, 0, 36, 69}};
    char why[300];
    memcpy(f.display_window, shown[i], sizeof shown[i]);
    if (!exr_library_write(path, &f, why, sizeof why)) fail_msg("%s", why);
    MADE(abbe_image, whole, abbe_exr_read(path, &whole, &error));
    const size_t row = 37 * sizeof(float), blank = i == 2 ? 8 : 0, chunks = whole.height - blank;
    abbe_exr_reader *reader = NULL;
    OK(abbe_exr_open(path, &reader, &error));
    MADE(abbe_image, image,
         abbe_exr_read_first(reader, whole.width * whole.height / 4, &image, &error));
    double share = 0;
    OK(abbe_exr_read_on(reader, 0, &image, &share, &error));
    assert_near(share, (double)((chunks + 3) / 4) / (double)chunks, 1e-9);
    for (size_t y = blank; y < image.height; y++)
      assert_memory_equal(image.data + y * image.width,
                          whole.data + ((y - blank) / 4 * 4 + blank) * image.width, row);
    OK(abbe_exr_read_on(reader, 60, &image, &share, &error));
    assert_near(share, 1, 0);
    assert_memory_equal(image.data, whole.data, row * image.height);
    abbe_exr_close(reader);
  }
}

/* What a small file may unfold into is bounded, whichever window says it. */
TEST(what_unfolds_is_refused) {
  static const int wide[4] = {0, 0, 32767, 32767};
  exr_library_file f = {.channels = 1, .type = {1}, .name = {"Y"}, .codec = EXR_COMPRESSION_ZIP};
  char why[300];
  memcpy(f.display_window, wide, sizeof wide);
  if (!exr_library_write(path, &f, why, sizeof why)) fail_msg("%s", why);
  abbe_image image = {0};
  REFUSED(ABBE_UNSUPPORTED, "32768 x 32768", abbe_exr_read(path, &image, &error));
  assert_null(image.data);
  f.display_window[3] = 0; /* one line of it, for which there is one pixel of data */
  read_and_compare(&f);
}

/* Every half there is, by OpenEXR's own conversion. */
TEST(every_half) {
  exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
  exr_context_t f = NULL;
  int part = 0;
  static uint16_t row[65536];
  enum { WIDE = 32768 };
  for (int i = 0; i < 65536; i++) row[i] = (uint16_t)i;
  assert_int_equal(exr_start_write(&f, path, EXR_WRITE_FILE_DIRECTLY, &setup), 0);
  assert_int_equal(exr_add_part(f, "", EXR_STORAGE_SCANLINE, &part), 0);
  assert_int_equal(
      exr_initialize_required_attr_simple(f, 0, WIDE, 65536 / WIDE, EXR_COMPRESSION_NONE), 0);
  assert_int_equal(exr_add_channel(f, 0, "Y", EXR_PIXEL_HALF, EXR_PERCEPTUALLY_LINEAR, 1, 1), 0);
  assert_int_equal(exr_write_header(f), 0);
  for (int y = 0; y < 65536 / WIDE; y++)
    assert_int_equal(exr_write_scanline_chunk(f, 0, y, row + WIDE * y, WIDE * sizeof *row), 0);
  assert_int_equal(exr_finish(&f), 0);
  MADE(abbe_image, image, abbe_exr_read(path, &image, &error));
  compare(&image, (const char *const[]){"Y"}, 1, "every half");
}

TEST(what_abbe_writes) {
  for (size_t channels = 1; channels <= 6; channels++)
    for (int s = 0; s < SIZES; s++)
      for (int half = 0; half < 2; half++) {
        MADE(abbe_image, image,
             abbe_image_make((size_t)sizes[s][0], (size_t)sizes[s][1], channels, names, &image,
                             &error));
        for (size_t i = 0; i < image.width * image.height * channels; i++)
          image.data[i] = (float)(i % 1000) * 0.25f + 1; /* a half can hold it */
        OK((half ? abbe_exr_write_half : abbe_exr_write)(path, &image, &error));
        compare(&image, names, (int)channels, "written by Abbe");
      }
}

/* What is no colour is in a part of its own where R, G and B have an ID; both are read as one
 * picture, in a unit of each part. */
TEST(data_beside_colours) {
  static const char *const mixed[] = {"stderr.R", "R", "normal.X", "G", "S0.550,000000nm", "B"};
  static const char *const colours[] = {"B", "G", "R", "S0.550,000000nm"};
  static const char *const data[] = {"normal.X", "stderr.R"};
  for (int s = 0; s < SIZES; s++)
    for (int half = 0; half < 2; half++) {
      MADE(abbe_image, image,
           abbe_image_make((size_t)sizes[s][0], (size_t)sizes[s][1], 6, mixed, &image, &error));
      abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_ACESCG, image.xy);
      for (size_t i = 0; i < image.width * image.height * 6; i++)
        image.data[i] = (float)(i % 1000) * 0.25f + 1;
      OK((half ? abbe_exr_write_half : abbe_exr_write)(path, &image, &error));
      compare_part(&image, 0, colours, 4, "colours");
      compare_part(&image, 1, data, 2, "data");
      MADE(abbe_image, back, abbe_exr_read(path, &back, &error));
      compare_part(&back, 0, colours, 4, "colours that are read");
      compare_part(&back, 1, data, 2, "data that are read");
      assert_int_equal(back.channels, 6);
      assert_string_equal(back.part, "");
      assert_string_equal(abbe_image_attribute_text(&back, "colorInteropID"), "lin_ap1_scene");
      MADE(abbe_image, alone, abbe_exr_read(printed("%s#data", path), &alone, &error));
      assert_int_equal(alone.channels, 2);
      assert_string_equal(abbe_image_attribute_text(&alone, "colorInteropID"), "data");
      for (size_t i = 0; i < image.width * image.height * 6; i++) image.data[i] *= 0x1p-30f;
      OK(abbe_exr_write_half(path, &image, &error));
      MADE(abbe_image, small, abbe_exr_read(path, &small, &error));
      for (size_t i = 0; i < image.width * image.height * 6; i++)
        assert_true(small.data[i] == 0x1p-30f * back.data[i]);
    }
}

/* An ID is of R, G, B by the standard observer, in a space that has one; nothing else gets one, and
 * none that was read is handed on. */
TEST(what_gets_an_id) {
  static const double p3[8] = {0.68, 0.32, 0.265, 0.69, 0.15, 0.06, 0.3127, 0.329};
  static const double none[8] = {0}, other[8] = {0.7, 0.3, 0.2, 0.7, 0.1, 0.1, 0.3127, 0.329};
  static const struct {
    const char *channel[3], *observer, *id;
    const double *xy;
  } rows[] = {{{"R", "G", "B"}, NULL, "lin_p3d65_scene", p3},
              {{"R", "G", "B"}, "CIE 1931, 2 degrees", "lin_p3d65_scene", p3},
              {{"R", "G", "B"}, "CIE 1964, 10 degrees", NULL, p3},
              {{"R", "G", "B"}, NULL, NULL, none},
              {{"R", "G", "B"}, NULL, NULL, other},
              {{"X", "Y", "Z"}, NULL, NULL, p3},
              {{"S0.500,000000nm", "S0.550,000000nm", "stderr.R"}, NULL, NULL, p3}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    MADE(abbe_image, image, abbe_image_make(2, 1, 3, rows[i].channel, &image, &error));
    memcpy(image.xy, rows[i].xy, sizeof image.xy);
    OK(abbe_image_set_attribute(&image, "colorInteropID", "lin_ap0_scene", &error));
    if (rows[i].observer != NULL)
      OK(abbe_image_set_attribute(&image, "abbe:observer", rows[i].observer, &error));
    OK(abbe_exr_write(path, &image, &error));
    MADE(abbe_image, back, abbe_exr_read(path, &back, &error));
    const char *id = abbe_image_attribute_text(&back, "colorInteropID");
    if ((id == NULL) != (rows[i].id == NULL) || (id != NULL && strcmp(id, rows[i].id) != 0))
      fail_msg("row %zu: %s, not %s", i, id != NULL ? id : "none",
               rows[i].id != NULL ? rows[i].id : "none");
  }
}

/* A float or a half: of all bits even, but no NaN and no infinity. */
static uint32_t noise(uint64_t *seed, bool half, float *value) {
  const uint32_t bits = (uint32_t)random_bits(seed) & (half ? 0xbfff : 0xbfffffff);
  if (!half)
    memcpy(value, &bits, sizeof *value);
  else if ((bits & 0x7c00) == 0) /* below the least normal one */
    *value = (float)ldexp((double)(bits & 0x3ff), -24);
  else
    *value = (float)ldexp((double)(0x400 | (bits & 0x3ff)), (int)(bits >> 10 & 31) - 25);
  if (half && bits & 0x8000) *value = -*value;
  return bits;
}

enum { CHUNK_LINES = 16, MOST_BYTES = 4096 };

/* Of count bytes, as OpenEXR's ZIP orders them before it deflates. */
static size_t deflated_size(const uint8_t *raw, size_t count) {
  static uint8_t ordered[MOST_BYTES], packed[2 * MOST_BYTES];
  for (size_t i = 0; i < count; i++) ordered[i / 2 + (i % 2) * ((count + 1) / 2)] = raw[i];
  for (size_t i = count - 1; i > 0; i--) ordered[i] = (uint8_t)(ordered[i] - ordered[i - 1] + 128);
  uLongf size = sizeof packed;
  int level = 0;
  exr_get_default_zip_compression_level(&level);
  assert_int_equal(compress2(packed, &size, ordered, (uLong)count, level), Z_OK);
  return size;
}

/* Two equal chunks of noise that begin with a 1 and zeros; the size that one deflates to, less its
 * own. */
static long fill_chunks(abbe_image *image, bool half, uint64_t seed, size_t zeros) {
  uint8_t raw[MOST_BYTES];
  size_t at = 0;
  const size_t bytes = half ? 2 : 4, row = image->width * image->channels;
  for (size_t y = 0; y < CHUNK_LINES; y++)
    for (size_t c = 0; c < image->channels; c++)
      for (size_t x = 0; x < image->width; x++) {
        float *value = &image->data[y * row + x * image->channels + c];
        uint32_t bits = noise(&seed, half, value);
        if (at / bytes <= zeros) *value = 0, bits = 0;
        if (at == 0) *value = 1, bits = half ? 0x3c00 : 0x3f800000; /* stored in units of 1 */
        for (size_t k = 0; k < bytes; k++) raw[at++] = (uint8_t)(bits >> 8 * k);
      }
  memcpy(image->data + CHUNK_LINES * row, image->data, CHUNK_LINES * row * sizeof *image->data);
  return (long)deflated_size(raw, at) - (long)at;
}

/* What deflates to its own size, to a byte more or less, is read as it was: at 3.1.5 OpenEXR's C
 * core keeps the deflated bytes of the first, which readers take for samples. */
TEST(chunks_that_deflate_to_their_own_size) {
  for (size_t channels = 1; channels <= 3; channels++)
    for (int half = 0; half < 2; half++) {
      size_t met[3] = {0};
      MADE(abbe_image, image,
           abbe_image_make(16, 2 * CHUNK_LINES, channels, names, &image, &error));
      for (uint64_t seed = 0; seed < 64 && met[1] < 4; seed++)
        for (size_t zeros = 0; zeros < 64 && met[1] < 4; zeros++) {
          const long more = fill_chunks(&image, half, seed, zeros);
          if (labs(more) > 1) continue;
          met[more + 1]++;
          const char *what = printed("seed %d, %zu zeros, %zu channels, half %d, %ld bytes more",
                                     (int)seed, zeros, channels, half, more);
          OK((half ? abbe_exr_write_half : abbe_exr_write)(path, &image, &error));
          compare(&image, names, (int)channels, what);
          MADE(abbe_image, back, abbe_exr_read(path, &back, &error));
          compare(&back, names, (int)channels, what);
        }
      if (met[1] == 0) fail_msg("%zu channels, half %d: no such chunk", channels, half);
    }
}

static void leave(void) {
  unlink(path);
}

static void begin(void) {
  snprintf(path, sizeof path, "/tmp/abbe_test_exr_files_%ld.exr", (long)getpid());
}

GROUP(begin, leave);
