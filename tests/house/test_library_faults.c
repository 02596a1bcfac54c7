/* Each call of OpenEXR and Little CMS failing in turn, and each that reads or writes a picture's
 * bytes: a sentence and no picture, the old file, or just what is handed back when nothing fails.
 */
#include "tests/check.h"
#include "tests/colorimetry/image/exr_library.h"
#include "tests/faults/library.h"

#include "base/file.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/picture_file.h"
#include "colorimetry/image/png_file.h"
#include "colorimetry/image/rgb_encoding.h"
#include "colorimetry/rgb_space.h"

#include <errno.h>
#include <openexr.h>
#include <unistd.h>

#define CORPUS ABBE_SOURCE_DIR "/tests/fuzz/corpus/"

static char folder[] = "/tmp/abbe-test-library-XXXXXX";
static const char *const names[] = {"R", "G", "B", "normal.X"};

static const char *at(const char *name) {
  return printed("%s/%s", folder, name);
}

/* 36 lines: three chunks of ZIP, in two parts, for R, G and B have an ID. */
static abbe_image picture(double scale) {
  abbe_image image;
  OK(abbe_image_make(9, 36, 4, names, &image, &error));
  for (size_t i = 0; i < image.width * image.height * 4; i++)
    image.data[i] = (float)(scale * (double)(i % 100));
  abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_ACESCG, image.xy);
  OK(abbe_image_set_attribute(&image, "note", "a text", &error));
  return image;
}

static void begin(void) {
  assert_non_null(mkdtemp(folder));
  OWNED(abbe_image, image) = picture(1);
  OK(abbe_exr_write(at("lines.exr"), &image, &error));
  const exr_library_file levels = {.channels = 1,
                                   .name = {"Y"},
                                   .type = {2},
                                   .tile = {4, 4},
                                   .levels = 1,
                                   .data_window = {0, 0, 8, 8},
                                   .display_window = {0, 0, 8, 8}};
  char why[200];
  assert_true(exr_library_write(at("levels.exr"), &levels, why, sizeof why));
  OK(abbe_image_set_attribute(&image, ABBE_PNG_TEXT, "words", &error));
  OK(abbe_png_write(at("text.png"), &image, 8, &error));
  static const char head[] = "ENVI\nsamples = 9\nlines = 36\nbands = 4\ninterleave = bip\n"
                             "data type = 4\nbyte order = 0\n";
  OK(abbe_file_write(at("cube.hdr"), head, sizeof head - 1, &error));
  OK(abbe_file_write(at("cube.raw"), image.data, sizeof(float) * 9 * 36 * 4, &error));
}

static void end(void) {
  assert_int_equal(system(printed("rm -r %s", folder)), 0);
}

GROUP(begin, end);

/* ---- what is done; what it hands back goes into one image ---- */

static abbe_result read_lines(abbe_image *out, abbe_error *error) {
  return abbe_exr_read(at("lines.exr"), out, error);
}

static abbe_result read_tiles(abbe_image *out, abbe_error *error) {
  return abbe_exr_read(CORPUS "exr/piz_half_tiles.exr", out, error);
}

/* A coarse picture first, then the rest; or a level; or sums. */
static abbe_result read_in_passes(abbe_image *out, abbe_error *error) {
  abbe_exr_reader *reader = NULL;
  double share = 0;
  ABBE_TRY(abbe_exr_open(at("lines.exr"), &reader, error));
  abbe_result result = abbe_exr_read_first(reader, 64, out, error);
  if (result == ABBE_OK) result = abbe_exr_read_on(reader, 60, out, &share, error);
  abbe_exr_close(reader);
  return result;
}

static abbe_result read_level(abbe_image *out, abbe_error *error) {
  abbe_exr_reader *reader = NULL;
  ABBE_TRY(abbe_exr_open(at("levels.exr"), &reader, error));
  const abbe_result result = abbe_exr_read_level(reader, 1, NULL, out, error);
  abbe_exr_close(reader);
  return result;
}

static abbe_result read_sums(abbe_image *out, abbe_error *error) {
  static const double weight[1][3] = {{1, 2, 3}}, one = 1;
  const size_t green = 1;
  abbe_exr_reader *reader = NULL;
  abbe_image_odd odd;
  ABBE_TRY(abbe_exr_open(at("lines.exr"), &reader, error));
  abbe_result result = abbe_image_make(9, 36, 3, names, out, error);
  if (result == ABBE_OK)
    result =
        abbe_exr_read_sums(reader, 1, &green, (const double(*)[3])weight, &one, out, &odd, error);
  abbe_exr_close(reader);
  return result;
}

static abbe_result read_cube(abbe_image *out, abbe_error *error) {
  return abbe_picture_file_read(at("cube.hdr"), out, error);
}

static abbe_result read_png(abbe_image *out, abbe_error *error) {
  return abbe_png_read(CORPUS "png/profile.png", out, error);
}

/* The old file or the new one: what stands there is read when nothing fails any more. */
static abbe_result write_as(double scale,
                            abbe_result (*write)(const char *, const abbe_image *, abbe_error *),
                            abbe_error *error) {
  OWNED(abbe_image, image) = picture(scale);
  assert_int_equal(abbe_file_write(at("out.exr"), "old", 3, NULL), ABBE_OK);
  const abbe_result result = write(at("out.exr"), &image, error);
  FREED char *data = NULL;
  size_t size = 0;
  assert_int_equal(abbe_file_read(at("out.exr"), 1 << 20, &data, &size, NULL), ABBE_OK);
  assert_true(result == ABBE_OK ? size > 100 : size == 3 && memcmp(data, "old", 3) == 0);
  return result;
}

static abbe_result write_lines(abbe_image *out, abbe_error *error) {
  (void)out;
  return write_as(1, abbe_exr_write, error);
}

static abbe_result write_half(abbe_image *out, abbe_error *error) {
  (void)out;
  return write_as(1e5, abbe_exr_write_half, error);
}

static abbe_result write_p3(const char *path, const abbe_image *image, abbe_error *error) {
  abbe_image p3 = *image;
  abbe_rgb_encoding_display_p3(p3.xy, p3.curve);
  return abbe_png_write(path, &p3, 8, error);
}

static abbe_result write_png(abbe_image *out, abbe_error *error) {
  (void)out;
  return write_as(0.01, write_p3, error);
}

typedef abbe_result work(abbe_image *out, abbe_error *error);

/* A call may fail for nothing only where `spared` is true. */
static void fail_each(const char *name, work *run, faults_library_kind kind, int code,
                      unsigned results, bool spared) {
  OWNED(abbe_image, whole) = {0};
  faults_library_begin(kind, 0, 0);
  OK(run(&whole, &error));
  const size_t calls = faults_library_end();
  assert_true(calls > 0 || kind == FAULTS_OF_PACKERS); /* that may not be there */
  for (size_t n = 1; n <= calls; n++) {
    OWNED(abbe_image, image) = {0};
    abbe_error error = {0};
    faults_library_begin(kind, n, code);
    const abbe_result result = run(&image, &error);
    faults_library_end();
    const size_t count = image.width * image.height * image.channels;
    const bool same = count == whole.width * whole.height * whole.channels &&
                      (count == 0 || memcmp(image.data, whole.data, count * sizeof(float)) == 0) &&
                      image.attribute_count == whole.attribute_count;
    if (result == ABBE_OK ? !spared || !same
                          : (results >> result & 1) == 0 || error.text[0] == '\0')
      fail_msg("%s, call %zu of %zu, %s: %s: %s", name, n, calls, faults_library_what(),
               abbe_result_text(result), error.text);
  }
}

static const struct {
  const char *name;
  work *run;
} reads[] = {{"lines", read_lines},   {"tiles", read_tiles}, {"passes", read_in_passes},
             {"a level", read_level}, {"sums", read_sums},   {"a cube", read_cube},
             {"PNG", read_png}},
  writes[] = {{"lines", write_lines}, {"halves", write_half}, {"PNG", write_png}};

TEST(calls_of_libraries) {
  const unsigned refused = 1u << ABBE_UNSUPPORTED, colour = 1u << ABBE_COLOUR;
  for (size_t i = 0; i < 5; i++)
    fail_each(reads[i].name, reads[i].run, FAULTS_OF_CALLS, EXR_ERR_FEATURE_NOT_IMPLEMENTED,
              i == 3 ? refused | 1u << ABBE_INVALID_ARGUMENT : refused, false);
  fail_each("PNG", read_png, FAULTS_OF_CALLS, 0, colour, false);
  for (size_t i = 0; i < 2; i++)
    fail_each(writes[i].name, writes[i].run, FAULTS_OF_CALLS, EXR_ERR_INCORRECT_PART,
              1u << ABBE_INVALID_ARGUMENT, false);
  fail_each("PNG", write_png, FAULTS_OF_CALLS, 0, colour, false);
}

/* OpenEXR's own packs and unpacks where libdeflate cannot. */
TEST(packers) {
  for (size_t i = 0; i < 5; i++)
    fail_each(reads[i].name, reads[i].run, FAULTS_OF_PACKERS, 0, 0, true);
  for (size_t i = 0; i < 2; i++)
    fail_each(writes[i].name, writes[i].run, FAULTS_OF_PACKERS, 0, 0, true);
}

/* A call that a signal interrupts is made again; else the disk's word is handed on. An offset that
 * the system cannot seek to is the file's fault. */
TEST(reading_and_writing) {
  const unsigned io = 1u << ABBE_IO, file = 1u << ABBE_PARSE,
                 format = file | 1u << ABBE_UNSUPPORTED;
  for (size_t i = 0; i < sizeof reads / sizeof *reads; i++) {
    const bool streams = i >= 5;
    if (!streams) fail_each(reads[i].name, reads[i].run, FAULTS_OF_READING, EINTR, 0, true);
    fail_each(reads[i].name, reads[i].run, FAULTS_OF_READING, EIO, io | format, true);
    fail_each(reads[i].name, reads[i].run, FAULTS_OF_READING, EINVAL, io | format, true);
    fail_each(reads[i].name, reads[i].run, FAULTS_OF_READING, EOVERFLOW, io | format, true);
    fail_each(reads[i].name, reads[i].run, FAULTS_OF_READING, 0, io | format, true);
  }
  for (size_t i = 0; i < 2; i++) {
    fail_each(writes[i].name, writes[i].run, FAULTS_OF_READING, EINTR, 0, true);
    fail_each(writes[i].name, writes[i].run, FAULTS_OF_READING, EIO, io, false);
    fail_each(writes[i].name, writes[i].run, FAULTS_OF_READING, 0, io, false);
  }
}

/* A text that cannot be read is none. */
TEST(a_pngs_text) {
  size_t found = 0;
  for (size_t n = 0; n <= 20; n++) {
    FREED char *text = NULL;
    abbe_error error = {0};
    faults_library_begin(FAULTS_OF_READING, n, EIO);
    const abbe_result result = abbe_png_read_text(at("text.png"), &text, &error);
    faults_library_end();
    assert_true(result == ABBE_OK || n == 1);
    if (text != NULL) assert_string_equal(text, "words");
    found += text != NULL;
  }
  assert_true(found > 0 && found < 20);
  /* behind another's, whose check is passed over by a seek */
  char bytes[120] = "\x89PNG\r\n\x1a\n\0\0\0\x20tEXt";
  FREED char *text = NULL;
  memcpy(bytes + 52, "\0\0\0", 3);
  bytes[55] = (char)(sizeof ABBE_PNG_TEXT + 5);
  memcpy(bytes + 56, "tEXt" ABBE_PNG_TEXT "\0words", sizeof "tEXt" ABBE_PNG_TEXT "\0words");
  OK(abbe_file_write(at("texts.png"), bytes, sizeof bytes, &error));
  OK(abbe_png_read_text(at("texts.png"), &text, &error));
  assert_string_equal(text, "words");
  for (size_t n = 3; n <= 6; n++) {
    FREED char *none = NULL;
    faults_library_begin(FAULTS_OF_READING, n, EIO);
    OK(abbe_png_read_text(at("texts.png"), &none, &error));
    faults_library_end();
    assert_null(none);
  }
}

/* The reason that a picture's reader gives is the disk's. */
TEST(the_disks_word_is_handed_on) {
  abbe_image image = {0};
  faults_library_begin(FAULTS_OF_READING, 1, EIO);
  REFUSED(ABBE_IO, strerror(EIO), read_lines(&image, &error));
  faults_library_begin(FAULTS_OF_READING, 1, EIO);
  REFUSED(ABBE_IO, strerror(EIO), read_png(&image, &error));
  faults_library_begin(FAULTS_OF_READING, 1, 0); /* the file has become shorter */
  REFUSED(ABBE_IO, strerror(EIO), read_lines(&image, &error));
  faults_library_begin(FAULTS_OF_READING, 1, EINVAL);
  REFUSED(ABBE_PARSE, strerror(EINVAL), read_lines(&image, &error));
  faults_library_end();
}
