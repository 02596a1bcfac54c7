/* ENVI: cubes of every order of numbers become the same picture, and headers that are wrong are
 * refused by their line. */
#include "tests/check.h"

#include "base/file.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/picture_file.h"

#include <sys/stat.h>
#include <unistd.h>

static char folder[] = "/tmp/abbe-test-envi-XXXXXX";

static void begin(void) {
  assert_non_null(mkdtemp(folder));
}

static void end(void) {
  assert_int_equal(system(printed("rm -r %s", folder)), 0);
}

GROUP(begin, end);

enum { W = 4, H = 3, BANDS = 5, SIZE = 2048 };

/* Numbers that every type holds. */
static double number(size_t x, size_t y, size_t band) {
  return (double)(1 + x + 10 * y + 40 * band);
}

static size_t put(int type, bool big, double v, unsigned char *to) {
  static const size_t bytes[16] = {0, 1, 2, 4, 4, 8, 0, 0, 0, 0, 0, 0, 2, 4, 8, 8};
  const float single = (float)v;
  uint64_t bits = (uint64_t)v;
  uint32_t low;
  memcpy(&low, &single, sizeof low);
  if (type == 4) bits = low;
  if (type == 5) memcpy(&bits, &v, sizeof bits);
  for (size_t i = 0; i < bytes[type]; i++)
    to[i] = (unsigned char)(bits >> 8 * (big ? bytes[type] - 1 - i : i));
  return bytes[type];
}

static const char *write_cube(const char *header, int type, bool big, const char *order,
                              size_t offset) {
  unsigned char cube[SIZE] = {0};
  size_t at = offset, n[3];
  const size_t most[3] = {order[2] == 'p'   ? H
                          : order[2] == 'l' ? H
                                            : BANDS,
                          order[2] == 'p'   ? W
                          : order[2] == 'l' ? BANDS
                                            : H,
                          order[2] == 'p' ? BANDS : W};
  for (n[0] = 0; n[0] < most[0]; n[0]++)
    for (n[1] = 0; n[1] < most[1]; n[1]++)
      for (n[2] = 0; n[2] < most[2]; n[2]++) {
        const size_t x = order[2] == 'p' ? n[1] : n[2];
        const size_t y = order[2] == 'q' ? n[1] : n[0];
        const size_t band = order[2] == 'p' ? n[2] : order[2] == 'l' ? n[1] : n[0];
        at += put(type, big, number(x, y, band), cube + at);
      }
  OK(abbe_file_write(printed("%s/cube.raw", folder), cube, at, &error));
  OK(abbe_file_write(printed("%s/cube.hdr", folder), header, strlen(header), &error));
  return printed("%s/cube.hdr", folder);
}

#define SIZES "samples = 4\nlines = 3\nbands = 5\n"
#define LIGHT "wavelength = {\n 500, 450.5,\n 600,\n 550, 650}\n"

TEST(every_order_and_type_of_numbers_is_the_same_picture) {
  static const char *const orders[] = {"bsq", "bil", "bip"};
  static const int types[] = {1, 2, 3, 4, 5, 12, 13, 14, 15};
  static const char *const names[BANDS] = {"S0.500,000000nm", "S0.450,500000nm", "S0.600,000000nm",
                                           "S0.550,000000nm", "S0.650,000000nm"};
  for (size_t o = 0; o < 3; o++)
    for (size_t t = 0; t < 9; t++)
      for (int big = 0; big < 2; big++) {
        const char *header =
            printed("ENVI\n; a remark = none\nDescription = {two\nlines}\n" SIZES
                    "Header offset = 7\ninterleave = %s\ndata type = %d\nbyte order = %d\n"
                    "wavelength units = Nanometers\n" LIGHT,
                    orders[o], types[t], big);
        MADE(abbe_image, image,
             abbe_picture_file_read(write_cube(header, types[t], big, orders[o], 7), &image,
                                    &error));
        assert_true(image.width == W && image.height == H && image.channels == BANDS);
        for (size_t b = 0; b < BANDS; b++) {
          assert_string_equal(image.channel[b], names[b]);
          for (size_t i = 0; i < (size_t)W * H; i++)
            assert_near(image.data[i * BANDS + b], number(i % W, i / W, b), 0);
        }
        assert_contains(abbe_image_attribute_text(&image, "Description"), "lines}");
      }
}

/* The same light in every unit; what is stated of the scale holds. */
TEST(units_and_scales) {
  static const struct {
    const char *lines, *name;
    double value;
  } cases[] = {
      {"wavelength units = um\nwavelength = {.5,.6,.7,.8,.9}\n", "S0.500,000000nm", 41},
      {"wavelength = {.5,.6,.7,.8,.9}\n", "S0.500,000000nm", 41},
      {"wavelength units = Angstroms\nwavelength = {5000,6,7,8,9}\n", "S0.500,000000nm", 41},
      {"wavelength units = Wavenumber\nwavelength = {20000,6,7,8,9}\n", "S0.500,000000nm", 41},
      {"wavelength units = THz\nwavelength = {599.584916,1,2,3,4}\n", "S0.500,000000nm", 41},
      {LIGHT "reflectance scale factor = 4\n", "T.500,000000nm", 10.25},
      {LIGHT "data gain values = {2,1,1,1,1}\ndata offset values = {0.5,0,0,0,0}\n",
       "S0.500,000000nm", 82.5},
      {"band names = {red edge, b, c}\n", "red edge", 41},
      {"band names = {, b, c}\n", "band 1", 41},
      {"wavelength units = unknown\nwavelength = {.5,.6,.7,.8,.9}\n", "S0.500,000000nm", 41},
      {"wavelength units = Index\nwavelength = {500,6,7,8,9}\n", "band 1", 41},
      {"wavelength = {}\nno value\n = 3\nnote =\n\n", "band 1", 41},
      {"a key that is far longer than any that is known, so that it is cut at some place = 3\n",
       "band 1", 41},
      {"", "band 1", 41}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    const char *header =
        printed("ENVI\n" SIZES "interleave = bip\ndata type = 12\n%s", cases[i].lines);
    write_cube(header, 12, false, "bip", 0);
    unsigned char cube[SIZE] = {0};
    for (size_t k = 0; k < (size_t)W * H * BANDS; k++) put(12, false, 41, cube + 2 * k);
    OK(abbe_file_write(printed("%s/cube.raw", folder), cube, 2 * W * H * BANDS, &error));
    MADE(abbe_image, image, abbe_envi_read(printed("%s/cube.hdr", folder), &image, &error));
    assert_string_equal(image.channel[0], cases[i].name);
    assert_near(image.data[0], cases[i].value, 1e-6);
  }
}

TEST(what_a_header_says_wrongly_is_refused_by_its_line) {
  static const struct {
    const char *lines, *says;
    abbe_result code;
  } cases[] = {
      {SIZES "interleave = bip\ndata type = 4\nwavelength = {1,2,x,4,5}\n",
       "cube.hdr:7: number 3 of 'wavelength' is 'x'", ABBE_PARSE},
      {SIZES "interleave = bip\ndata type = 4\nwavelength = {500,550,nan,600,650}\n",
       "cube.hdr:7: number 3", ABBE_PARSE},
      {SIZES "interleave = bip\ndata type = 4\nwavelength = {500,550,600,550,650}\n",
       "cube.hdr:7: wavelengths 2 and 4 are both 550", ABBE_PARSE},
      {SIZES "interleave = bip\ndata type = 4\nwavelength = {500,550,0,600,650}\n"
             "wavelength units = nm\n",
       "cube.hdr:7: wavelength 3 is 0 nm", ABBE_PARSE},
      {SIZES "interleave = bip\ndata type = 4\nwavelength = {50,55,60,61,65}\n",
       "does not say what unit", ABBE_PARSE},
      {SIZES "interleave = bip\ndata type = 4\n" LIGHT "wavelength units = furlongs\n",
       "'furlongs'", ABBE_UNSUPPORTED},
      {SIZES "interleave = bip\ndata type = 4\nwavelength = {500,600}\n", "2 numbers", ABBE_PARSE},
      {SIZES "interleave = bip\ndata type = 6\n", "data type is 6", ABBE_UNSUPPORTED},
      {SIZES "interleave = bip\ndata type = 4\nfile compression = 1\n", "compressed",
       ABBE_UNSUPPORTED},
      {SIZES "interleave = bob\ndata type = 4\n", "interleave is 'bob'", ABBE_PARSE},
      {SIZES "interleave = bip\ndata type = 5\n", "it has 240 bytes", ABBE_PARSE},
      {SIZES "interleave = bip\ndata type = 4\nheader offset = 1\n", "asks for 240 from byte 1",
       ABBE_PARSE},
      {"samples = 4\nbands = 5\ninterleave = bip\ndata type = 4\n", "no line 'lines = '",
       ABBE_PARSE},
      {"samples = -4\n", "cube.hdr:2: 'samples' is '-4'", ABBE_PARSE},
      {"samples = 1e9\nlines = 1e9\nbands = 5\ninterleave = bip\ndata type = 4\n", "32768 a side",
       ABBE_INVALID_ARGUMENT},
      {"samples = 1e999\n", "cube.hdr:2: 'samples' is '1e999'", ABBE_PARSE},
      {"samples = 4x\n", "cube.hdr:2: 'samples' is '4x'", ABBE_PARSE},
      {"samples = four\n", "cube.hdr:2: 'samples' is 'four'", ABBE_PARSE},
      {"description = {two\nlines}\nsamples = 4x\n", "cube.hdr:4: 'samples'", ABBE_PARSE},
      {"samples = 4.5\n", "no line 'samples = ' with a number from 1 on", ABBE_PARSE},
      {"samples = 4\nlines = 1e9\nbands = 5\n", "4 x 1000000000 pixels", ABBE_INVALID_ARGUMENT},
      {"samples = 4\nlines = 3\nbands = 1e9\n", "1000000000 bands", ABBE_INVALID_ARGUMENT},
      {SIZES "interleave = bip\n", "data type is nan", ABBE_UNSUPPORTED},
      {SIZES "interleave = bip\ndata type = 16\n", "data type is 16", ABBE_UNSUPPORTED},
      {SIZES "wavelength = {1,2,3e,4,5}\n", "number 3 of 'wavelength' is '3e'", ABBE_PARSE},
      {SIZES "wavelength = {1,2,1e999,4,5}\n", "number 3 of 'wavelength' is '1e999'", ABBE_PARSE},
      {SIZES "interleave = bip\ndata type = 4\nwavelength = {500,550,1e10,600,650}\n"
             "wavelength units = nm\n",
       "cube.hdr:7: wavelength 3 is 1e+10 nm", ABBE_PARSE},
      {"description = {never\nends\n", "cube.hdr:2: its list has no '}'", ABBE_PARSE}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    abbe_image image;
    const char *path = write_cube(printed("ENVI\n%s", cases[i].lines), 4, false, "bip", 0);
    REFUSED(cases[i].code, cases[i].says, abbe_picture_file_read(path, &image, &error));
    assert_null(image.data);
  }
  abbe_image image;
  assert_int_equal(mkdir(printed("%s/cube", folder), 0700), 0);
  OK(abbe_picture_file_read(
      write_cube("ENVI\n" SIZES "interleave = bip\ndata type = 4\n", 4, false, "bip", 0), &image,
      &error));
  abbe_image_free(&image);
  unlink(printed("%s/cube.raw", folder));
  REFUSED(ABBE_NOT_FOUND, "there is no cube beside",
          abbe_picture_file_read(printed("%s/cube.hdr", folder), &image, &error));
}

/* Names and numbers of more bands than a picture has channels; a header that is called otherwise.
 */
TEST(lists_have_a_most) {
  static char text[10 * (ABBE_IMAGE_MAX_CHANNELS + 20)];
  abbe_image image;
  for (int list = 0; list < 2; list++) {
    size_t used = (size_t)sprintf(text, "ENVI\n" SIZES "interleave = bip\ndata type = 12\n%s = {",
                                  list == 0 ? "band names" : "wavelength");
    for (int i = 0; i <= ABBE_IMAGE_MAX_CHANNELS; i++)
      used += (size_t)sprintf(text + used, "%d, ", 400 + i);
    strcpy(text + used, "}\n");
    const char *path = write_cube(text, 12, false, "bip", 0);
    if (list == 1)
      REFUSED(ABBE_UNSUPPORTED, "'wavelength' has more than", abbe_envi_read(path, &image, &error));
    else
      OK(abbe_envi_read(path, &image, &error));
    if (list == 0) assert_string_equal(image.channel[4], "404");
    if (list == 0) abbe_image_free(&image);
  }
  for (int i = 0; i < 2; i++) {
    const char *other = printed("%s/%s", folder, i == 0 ? "a.head" : "cube.hdr");
    OK(abbe_file_write(other, text, 5, &error));
    REFUSED(ABBE_PARSE, "no line 'samples = '", abbe_envi_read(other, &image, &error));
  }
  const char *header = "ENVI\n" SIZES "interleave = bip\ndata type = 12\n";
  OK(abbe_file_write(printed("%s/a.head", folder), header, strlen(header), &error));
  REFUSED(ABBE_NOT_FOUND, "there is no cube beside this header",
          abbe_envi_read(printed("%s/a.head", folder), &image, &error));
  assert_int_equal(chdir(folder), 0);
  OK(abbe_file_write("h", header, strlen(header), &error));
  REFUSED(ABBE_NOT_FOUND, "there is no cube", abbe_envi_read("h", &image, &error));
  REFUSED(ABBE_IO, "nothing.hdr", abbe_envi_read("nothing.hdr", &image, &error));
  REFUSED(ABBE_IO, "nothing.hdr", abbe_picture_file_read("nothing.hdr", &image, &error));
}

/* More attributes than a picture may have: the first are kept. */
TEST(attributes_have_a_most) {
  static char text[40 * (ABBE_IMAGE_MAX_ATTRIBUTES + 4)];
  size_t used = (size_t)sprintf(text, "ENVI\n" SIZES "interleave = bip\ndata type = 12\n");
  for (int i = 0; i <= ABBE_IMAGE_MAX_ATTRIBUTES; i++)
    used += (size_t)sprintf(text + used, "note %d = %d\n", i, i);
  MADE(abbe_image, image, abbe_envi_read(write_cube(text, 12, false, "bip", 0), &image, &error));
  assert_int_equal(image.attribute_count, ABBE_IMAGE_MAX_ATTRIBUTES);
  assert_string_equal(abbe_image_attribute_text(&image, "note 7"), "7");
}

/* Other files are taken for OpenEXR, whose sentences are known. */
TEST(kinds_are_told_by_their_first_bytes) {
  static const struct {
    const char *bytes;
    abbe_picture_file_kind kind;
  } cases[] = {
      {"ENVI\n", ABBE_PICTURE_FILE_ENVI},          {"ENVIRONMENT", ABBE_PICTURE_FILE_OTHER},
      {"ENVOY\n", ABBE_PICTURE_FILE_OTHER},        {"#?RADIANCE\n", ABBE_PICTURE_FILE_RADIANCE},
      {"\x76\x2f\x31\x01", ABBE_PICTURE_FILE_EXR}, {"", ABBE_PICTURE_FILE_OTHER}};
  const char *path = printed("%s/kind", folder);
  abbe_image image;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    abbe_picture_file_kind kind = ABBE_PICTURE_FILE_OTHER;
    OK(abbe_file_write(path, cases[i].bytes, strlen(cases[i].bytes), &error));
    OK(abbe_picture_file_find_kind(path, &kind, &error));
    assert_int_equal(kind, cases[i].kind);
  }
  REFUSED(ABBE_PARSE, "OpenEXR", abbe_picture_file_read(path, &image, &error));
  OK(abbe_file_write(path, "#?RADIANCE\n\n-Y 1 +X 1\n\x80\x80\x80\x80", 27, &error));
  OK(abbe_picture_file_read(path, &image, &error));
  assert_near(image.data[0], 0.5, 0);
  abbe_image_free(&image);
}
