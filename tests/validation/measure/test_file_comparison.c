/* Files held against each other: tolerances that are kept, broken and unknown; what notes say. */
#include "tests/check.h"

#include "colorimetry/image/exr.h"
#include "colorimetry/image/picture_space.h"
#include "colorimetry/image/png_file.h"
#include "tests/fontconfig.h"
#include "validation/measure/file_comparison.h"

#include <unistd.h>

static char paths[3][64];

static void write_picture(const char *path, float value, bool errors) {
  static const char *const names[] = {"X", "Y", "Z", "stderr.X", "stderr.Y", "stderr.Z"};
  MADE(abbe_image, image, abbe_image_make(4, 4, errors ? 6 : 3, names, &image, &error));
  for (size_t i = 0; i < 16; i++)
    for (size_t k = 0; k < image.channels; k++)
      image.data[i * image.channels + k] = k < 3 ? value : 0.001f;
  OK(abbe_exr_write(path, &image, &error));
}

static abbe_file_comparison compare(const char *a, const char *b) {
  const abbe_file_comparison_desc desc = {.path = {a, b}};
  abbe_file_comparison c;
  OK(abbe_file_comparison_make(&desc, &c, &error));
  return c;
}

static bool says(const abbe_compare_notes *notes, const char *part) {
  for (size_t i = 0; i < notes->count; i++)
    if (strstr(notes->note[i], part) != NULL) return true;
  return false;
}

static void begin(void) {
  for (int i = 0; i < 3; i++)
    snprintf(paths[i], sizeof paths[i], "/tmp/abbe_test_file_comparison_%ld_%d.exr", (long)getpid(),
             i);
  write_picture(paths[0], 1, true);
  write_picture(paths[1], 1.1f, true);
  write_picture(paths[2], 1, false);
}

static void finish(void) {
  for (int i = 0; i < 3; i++) unlink(paths[i]);
}

GROUP(begin, finish);

TEST(tolerances) {
  OWNED(abbe_file_comparison, c) = compare(paths[0], paths[1]);
  const abbe_compare_tolerance kept = {ABBE_COMPARE_RELATIVE_RMSE, false, 0.11};
  const abbe_compare_tolerance broken[] = {{ABBE_COMPARE_RELATIVE_RMSE, false, 0.09},
                                           {ABBE_COMPARE_ENERGY_RATIO, false, 0.01}};
  const abbe_compare_tolerance unknown = {ABBE_COMPARE_BANDS_RELATIVE_RMSE, false, 1};
  assert_near(c.comparison.whole.metric[ABBE_COMPARE_RELATIVE_RMSE].value, 0.1, 1e-6);
  assert_true(abbe_file_comparison_keeps(&c, &kept));
  OK(abbe_file_comparison_judge(&c, &kept, 1, &error));
  REFUSED(ABBE_TOLERANCE, "is 0.1, out of the tolerance of 0.09; 1 more are out of tolerance",
          abbe_file_comparison_judge(&c, broken, 2, &error));
  OK(abbe_file_comparison_check(&c, broken, 2, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "is not known for",
          abbe_file_comparison_check(&c, &unknown, 1, &error));
}

TEST(notes) {
  abbe_compare_notes notes;
  OWNED(abbe_file_comparison, c) = compare(paths[0], paths[1]);
  abbe_compare_notes_make(&c, &notes);
  assert_true(says(&notes, "the two differ by more than noise"));
  assert_false(says(&notes, "the reference has no standard errors"));
  abbe_file_comparison_free(&c);
  c = compare(paths[2], paths[1]);
  abbe_compare_notes_make(&c, &notes);
  assert_true(says(&notes, "the reference has no standard errors"));
  assert_true(says(&notes, "the white of CIEDE2000 is D65 at Y"));
}

TEST(masks) {
  abbe_file_comparison c;
  abbe_file_comparison_desc desc = {.path = {paths[0], paths[1]}, .mask = paths[2]};
  OK(abbe_file_comparison_make(&desc, &c, &error));
  assert_int_equal(c.mask.inside, 16);
  assert_true(c.comparison.masked);
  abbe_file_comparison_free(&c);
  desc.mask = "caustic";
  REFUSED(ABBE_INVALID_ARGUMENT, "without the layers caustic.*",
          abbe_file_comparison_make(&desc, &c, &error));
  desc.mask = "no.png";
  REFUSED(ABBE_IO, "No such file or directory", abbe_file_comparison_make(&desc, &c, &error));
}

static abbe_field field_of(size_t width, size_t height, double y) {
  static const char *const names[] = {"X", "Y", "Z"};
  abbe_field field = {0};
  MADE(abbe_image, image, abbe_image_make(width, height, 3, names, &image, &error));
  OK(abbe_field_make(&image, "it", &field, &error));
  for (size_t i = 0; i < width * height; i++) field.colour.value[3 * i + 1] = (float)y;
  return field;
}

static double range_of(const abbe_field *b, const abbe_field *a, double scale) {
  double range = -1;
  OK(abbe_difference_picture_range(b, a, scale, &range, &error));
  return range;
}

TEST(range) {
  OWNED(abbe_field, b) = field_of(10, 20, 0), a = field_of(10, 20, 0);
  assert_near(range_of(&b, &a, 1), 0, 0);
  a.colour.value[1] = 3; /* one of 200: above 99 % of all, which are equal */
  assert_near(range_of(&b, &a, 1), 5, 1e-12);
  for (size_t i = 0; i < 10; i++) a.colour.value[3 * i + 1] = -0.0012f;
  assert_near(range_of(&b, &a, 1), 0.002, 1e-15);
  assert_near(range_of(&b, &a, 10), 0.02, 1e-14);
  for (size_t i = 0; i < 10; i++) a.colour.value[3 * i + 1] = 1000;
  a.colour.value[4] = NAN;
  assert_near(range_of(&b, &a, 1), 1000, 1e-9);
}

/* Pixels of the colour of t in the picture at path, the scale bar's too. */
static size_t count(const char *path, double t, size_t *width, size_t *height) {
  double rgb[3];
  size_t found = 0;
  MADE(abbe_image, image, abbe_png_read(path, &image, &error));
  abbe_colour_map_at(ABBE_COLOUR_MAP_DIFFERENCE, t, rgb);
  for (size_t i = 0; i < image.width * image.height; i++) {
    double distance = 0;
    for (size_t c = 0; c < 3; c++)
      distance = fmax(distance, fabs((double)image.data[3 * i + c] - rgb[c]));
    found += distance < 0.75 / 255;
  }
  *width = image.width;
  *height = image.height;
  return found;
}

static void draw(const char *path, const abbe_field *b, const abbe_field *a) {
  OK(abbe_difference_picture_write(path, b, a, 1, 2, "a - b", &error));
}

/* Each pixel is four by four of the picture, in the colour of its difference. */
TEST(the_picture) {
  const char *path = printed("/tmp/abbe_test_difference_%ld.png", (long)getpid());
  OWNED(abbe_field, b) = field_of(128, 64, 1), a = field_of(128, 64, 1);
  static const double y[] = {3, -1, 1.5, NAN, 1e9};
  static const double t[] = {1, 0, 0.625, NAN, 1};
  size_t width, height, before[5];
  draw(path, &b, &a);
  for (int i = 0; i < 5; i++) before[i] = count(path, t[i], &width, &height);
  assert_true(width > 512 && width < 800 && height > 256 && height < 330);
  assert_true(count(path, 0.5, &width, &height) >= 510 * 254); /* the frame lies on its rim */
  for (int i = 0; i < 5; i++) a.colour.value[3 * (128 * 30 + 20 + i) + 1] = (float)y[i];
  draw(path, &b, &a);
  for (int i = 0; i < 5; i++)
    assert_int_equal(count(path, t[i], &width, &height) - before[i], t[i] == 1 ? 32 : 16);
  unlink(path);
}

TEST(what_cannot_be_drawn) {
  OWNED(abbe_field, b) = field_of(4, 4, 1), small = field_of(4, 2, 1);
  abbe_field empty = {0};
  double range;
  static const double ranges[] = {0, -1, NAN, INFINITY};
  for (int i = 0; i < 4; i++)
    REFUSED(ABBE_INVALID_ARGUMENT, "",
            abbe_difference_picture_write("/no/such.png", &b, &b, 1, ranges[i], NULL, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_difference_picture_write("/no/such.png", &b, &small, 1, 1, NULL, &error));
  REFUSED(ABBE_IO, "/no/such.png",
          abbe_difference_picture_write("/no/such.png", &b, &b, 1, 1, NULL, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "",
          abbe_difference_picture_range(&empty, &empty, 1, &range, &error));
}
