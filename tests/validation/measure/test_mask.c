#include "validation/measure/compare.h"

#include "tests/check.h"

static abbe_mask brightest(const double *light, size_t count, double share) {
  abbe_mask mask = {0};
  OK(abbe_mask_make_brightest(light, count, share, &mask, &error));
  return mask;
}

TEST(the_fewest_pixels_that_hold_the_share) {
  const double light[] = {1, 50, 2, 40, 7};
  static const struct {
    double share;
    const char *in;
  } rows[] = {{0.001, "01000"}, {0.5, "01000"},  {0.51, "01010"}, {0.9, "01010"},
              {0.95, "01011"},  {0.98, "01111"}, {1, "11111"}};
  for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
    OWNED(abbe_mask, mask) = brightest(light, 5, rows[r].share);
    size_t inside = 0;
    for (size_t i = 0; i < 5; i++) {
      assert_int_equal(mask.in[i], rows[r].in[i] - '0');
      inside += mask.in[i];
    }
    assert_int_equal(mask.inside, inside);
  }
}

TEST(of_equals_the_first) {
  const double light[] = {1, 1, 1, 1, 0, 0};
  OWNED(abbe_mask, mask) = brightest(light, 6, 0.5);
  assert_memory_equal(mask.in, "\1\1\0\0\0\0", 6);
  abbe_mask_free(&mask);
  mask = brightest(light, 6, 1);
  assert_int_equal(mask.inside, 4);
}

/* A wide field: the mask holds the share, and without its faintest pixel it would not. */
TEST(smallest_on_many_pixels) {
  enum { COUNT = 20000 };
  FREED double *light = malloc(COUNT * sizeof *light);
  assert_non_null(light);
  double total = 0;
  for (int i = 0; i < COUNT; i++) total += light[i] = exp(8 * sin(i * 0.7) * cos(i * 0.0123));
  OWNED(abbe_mask, mask) = brightest(light, COUNT, ABBE_MASK_CAUSTIC_SHARE);
  double held = 0, faintest = INFINITY, brightest_out = 0;
  for (int i = 0; i < COUNT; i++) {
    if (mask.in[i]) held += light[i], faintest = fmin(faintest, light[i]);
    if (!mask.in[i]) brightest_out = fmax(brightest_out, light[i]);
  }
  assert_true(held >= 0.95 * total);
  assert_true(held - faintest < 0.95 * total);
  assert_true(brightest_out <= faintest);
}

TEST(what_is_no_light) {
  const double light[] = {NAN, -5, 3, INFINITY, 1};
  abbe_mask mask = brightest(light, 5, 1);
  assert_memory_equal(mask.in, "\0\0\1\0\1", 5);
  abbe_mask_free(&mask);
  const double dark[] = {0, -1, NAN};
  REFUSED(ABBE_INVALID_ARGUMENT, "dark", abbe_mask_make_brightest(dark, 3, 0.95, &mask, &error));
  static const double shares[] = {0, -1, 1.01, NAN};
  for (int i = 0; i < 4; i++)
    REFUSED(ABBE_INVALID_ARGUMENT, "",
            abbe_mask_make_brightest(light, 5, shares[i], &mask, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_mask_make_brightest(light, 0, 0.95, &mask, &error));
  assert_null(mask.in);
}

TEST(drawn) {
  static const char *const names[] = {"B", "G", "R"};
  abbe_image image = {0};
  OK(abbe_image_make(3, 2, 3, names, &image, &error));
  for (size_t i = 0; i < 6; i++) image.data[3 * i] = 1; /* blue draws nothing */
  abbe_mask mask = {0};
  REFUSED(ABBE_INVALID_ARGUMENT, "'R'", abbe_mask_make_drawn(&image, &mask, &error));
  image.data[3 * 1 + 2] = 0.51f;
  image.data[3 * 2 + 2] = 0.5f;
  image.data[3 * 5 + 2] = 1;
  image.data[3 * 4 + 2] = NAN;
  OK(abbe_mask_make_drawn(&image, &mask, &error));
  assert_memory_equal(mask.in, "\0\1\0\0\0\1", 6);
  assert_int_equal(mask.inside, 2);
  abbe_mask_free(&mask);
  abbe_mask_free(&mask);
  abbe_image_free(&image);
  REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_mask_make_drawn(&image, &mask, &error));
}

static abbe_field field_of(const char *const *names, size_t channels, const char *kind,
                           const float *values) {
  abbe_field field = {0};
  MADE(abbe_image, image, abbe_image_make(4, 1, channels, names, &image, &error));
  memcpy(image.data, values, 4 * channels * sizeof *values);
  OK(abbe_image_set_attribute(&image, "abbe:kind", kind, &error));
  OK(abbe_field_make(&image, "it.exr", &field, &error));
  return field;
}

static void assert_caustic(abbe_field field, const char *in) {
  MADE(abbe_mask, mask, abbe_mask_make_caustic(&field, "it.exr", 0.95, &mask, &error));
  assert_memory_equal(mask.in, in, 4);
  abbe_field_free(&field);
}

/* Of a map by Y or by the sum of its bands; of a picture by its caustic layers and not by itself.
 */
TEST(caustic) {
  static const char *const xyz[] = {"X", "Y", "Z", "caustic.X", "caustic.Y", "caustic.Z"},
                           *const bands[] = {"S0.450nm", "S0.650nm"};
  static const float map[12] = {9, 0, 9, 0, 50, 0, 0, 46, 0, 9, 2, 9},
                     band[8] = {1, 1, 50, 0, 0, 46, 0, 0},
                     picture[24] = {9, 9, 9, 0, 0, 0, 1, 1, 1, 0, 8, 0,
                                    9, 9, 9, 5, 0, 5, 1, 1, 1, 0, 8, 0};
  assert_caustic(field_of(xyz, 3, "receiver map", map), "\0\1\1\0");
  assert_caustic(field_of(bands, 2, "receiver map", band), "\0\1\1\0");
  assert_caustic(field_of(xyz, 6, "picture", picture), "\0\1\0\1");
  OWNED(abbe_field, bare) = field_of(xyz, 3, "picture", map);
  abbe_mask mask = {0};
  REFUSED(ABBE_INVALID_ARGUMENT, "it.exr",
          abbe_mask_make_caustic(&bare, "it.exr", 0.95, &mask, &error));
  abbe_field_free(&bare);
  static const float dark[12] = {1, 0, 1};
  bare = field_of(xyz, 3, "receiver map", dark);
  REFUSED(ABBE_INVALID_ARGUMENT, "it.exr",
          abbe_mask_make_caustic(&bare, "it.exr", 0.95, &mask, &error));
}
