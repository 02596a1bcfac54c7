/* Files held against each other: tolerances that are kept, broken and unknown; what notes say. */
#include "tests/check.h"

#include "colorimetry/image/exr.h"
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
