#include "validation/difference_picture.h"

#include "colorimetry/difference.h"
#include "colorimetry/rgb_space.h"
#include "tests/check.h"

static abbe_field field_of(size_t width, size_t height, double y) {
  static const char *const names[] = {"X", "Y", "Z"};
  abbe_image image = {0};
  abbe_field field = {0};
  assert_int_equal(abbe_image_make(width, height, 3, names, &image, NULL), ABBE_OK);
  assert_int_equal(abbe_field_make(&image, "it", &field, NULL), ABBE_OK);
  abbe_image_free(&image);
  for (size_t i = 0; i < width * height; i++) field.colour.value[3 * i + 1] = (float)y;
  return field;
}

static void lab_of(double t, double lab[3]) {
  static const double d65[3] = {0.3127 / 0.3290, 1, (1 - 0.3127 - 0.3290) / 0.3290};
  double rgb[3], m[9];
  abbe_difference_picture_colour(t, rgb);
  for (int c = 0; c < 3; c++) {
    assert_true(rgb[c] >= 0 && rgb[c] <= 1);
    rgb[c] = rgb[c] <= 0.04045 ? rgb[c] / 12.92 : pow((rgb[c] + 0.055) / 1.055, 2.4);
  }
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_REC709, m);
  abbe_rgb_space_apply(m, rgb, rgb);
  abbe_difference_lab(rgb, d65, lab);
}

/* Away from the middle it only grows darker, equally on both sides' scale, and nothing clips. */
static void test_colours_are_even(void **state) {
  (void)state;
  double before[2][3], lab[3];
  lab_of(0, before[0]);
  lab_of(-0.0, before[1]);
  assert_near(before[0][0], 97, 0.01);
  for (int i = 1; i <= 20; i++)
    for (int side = 0; side < 2; side++) {
      lab_of((side == 0 ? 0.05 : -0.05) * i, lab);
      double step = before[side][0] - lab[0];
      assert_near(step, 63.0 / 20, 0.05);
      assert_true(side == 0 ? lab[1] > before[side][1] && lab[2] > before[side][2]
                            : lab[2] < before[side][2]);
      memcpy(before[side], lab, sizeof lab);
    }
  double end[3], beyond[3];
  abbe_difference_picture_colour(-1, end);
  abbe_difference_picture_colour(-7, beyond);
  assert_memory_equal(end, beyond, sizeof end);
}

static double range_of(const abbe_field *b, const abbe_field *a, double scale) {
  double range = -1;
  assert_int_equal(abbe_difference_picture_range(b, a, scale, &range, NULL), ABBE_OK);
  return range;
}

static void test_range(void **state) {
  (void)state;
  abbe_field b = field_of(10, 20, 0), a = field_of(10, 20, 0);
  assert_near(range_of(&b, &a, 1), 0, 0);
  a.colour.value[1] = 3; /* one of 200: above 99 % of all, which are equal */
  assert_near(range_of(&b, &a, 1), 5, 1e-12);
  for (size_t i = 0; i < 10; i++) a.colour.value[3 * i + 1] = -0.0012f;
  assert_near(range_of(&b, &a, 1), 0.002, 1e-15);
  assert_near(range_of(&b, &a, 10), 0.02, 1e-14);
  for (size_t i = 0; i < 10; i++) a.colour.value[3 * i + 1] = 1000;
  a.colour.value[4] = NAN;
  assert_near(range_of(&b, &a, 1), 1000, 1e-9);
  abbe_field_free(&a);
  abbe_field_free(&b);
}

static const float *at(const abbe_image *image, size_t x, size_t y) {
  return image->data + 3 * (y * image->width + x);
}

static void assert_colour(const float *pixel, double t) {
  double rgb[3];
  abbe_difference_picture_colour(t, rgb);
  for (int c = 0; c < 3; c++) assert_near((double)pixel[c], rgb[c], 1e-6);
}

static void test_the_picture(void **state) {
  (void)state;
  abbe_field b = field_of(128, 64, 1), a = field_of(128, 64, 1);
  a.colour.value[3 * (10 * 128 + 20) + 1] = 1.5f;
  a.colour.value[3 * (10 * 128 + 21) + 1] = 0;
  a.colour.value[3 * (10 * 128 + 22) + 1] = NAN;
  abbe_image image = {0};
  assert_int_equal(abbe_difference_picture_make(&b, &a, 1, 1, &image, NULL), ABBE_OK);
  assert_true(image.width > 512 && image.height > 256 && image.channels == 3);
  /* Four times as wide, twelve from the edge; nearest, not smoothed. */
  assert_colour(at(&image, 12 + 80, 12 + 40), 0.5);
  assert_colour(at(&image, 12 + 83, 12 + 43), 0.5);
  assert_colour(at(&image, 12 + 84, 12 + 40), -1);
  for (int c = 0; c < 3; c++) assert_near((double)at(&image, 12 + 88, 12 + 40)[c], 0, 0);
  assert_colour(at(&image, 12 + 79, 12 + 40), 0);
  /* The bar: brighter at the top. */
  assert_colour(at(&image, 512 + 30, 12), 1 - 1.0 / 256);
  assert_colour(at(&image, 512 + 30, 12 + 255), -1 + 1.0 / 256);
  abbe_image_free(&image);
  abbe_field_free(&a);
  abbe_field_free(&b);
}

static void test_what_cannot_be_drawn(void **state) {
  (void)state;
  abbe_field b = field_of(4, 4, 1), small = field_of(4, 2, 1), empty = {0};
  abbe_image image = {0};
  abbe_error error = {0};
  double range;
  static const double ranges[] = {0, -1, NAN, INFINITY};
  for (int i = 0; i < 4; i++)
    assert_int_equal(abbe_difference_picture_make(&b, &b, 1, ranges[i], &image, &error),
                     ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_difference_picture_make(&b, &small, 1, 1, &image, &error),
                   ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_difference_picture_range(&empty, &empty, 1, &range, &error),
                   ABBE_INVALID_ARGUMENT);
  assert_null(image.data);
  abbe_field_free(&b);
  abbe_field_free(&small);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_colours_are_even), cmocka_unit_test(test_range),
      cmocka_unit_test(test_the_picture), cmocka_unit_test(test_what_cannot_be_drawn)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
