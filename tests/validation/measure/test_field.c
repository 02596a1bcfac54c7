#include "validation/measure/field.h"

#include "colorimetry/image/exr.h"
#include "colorimetry/rgb_space.h"
#include "scenes/view/map_layout.h"
#include "tests/check.h"

#include <unistd.h>

static abbe_image image_of(size_t width, size_t height, size_t channels, const char *const *names) {
  abbe_image image = {0};
  OK(abbe_image_make(width, height, channels, names, &image, &error));
  for (size_t i = 0; i < width * height * channels; i++) image.data[i] = (float)(i + 1);
  return image;
}

static void set(abbe_image *image, const char *key, const char *text) {
  OK(abbe_image_set_attribute(image, key, text, &error));
}

static abbe_field field_of(const abbe_image *image) {
  abbe_field field = {0};
  OK(abbe_field_make(image, "it", &field, &error));
  return field;
}

/* A layout whose window begins at left; far is where its range ends. */
static abbe_map_layout layout_of(double left, double far) {
  static const double origin[3] = {0, 0, 2.5}, forward[3] = {0, 0, -1}, up[3] = {0, 1, 0};
  abbe_view view;
  abbe_map_layout layout;
  abbe_view_look(origin, forward, up, false, &view);
  const double window[4] = {left, 1, -1, 1};
  memcpy(view.window, window, sizeof window);
  view.near = 0.5;
  view.far = far;
  abbe_map_layout_make(&view, &layout);
  return layout;
}

static abbe_field map_of(size_t width, size_t height, const abbe_map_layout *layout,
                         const char *light) {
  static const char *const names[] = {"X", "Y", "Z", "stderr.X", "stderr.Y", "stderr.Z"};
  OWNED(abbe_image, image) = image_of(width, height, 6, names);
  if (layout != NULL) OK(abbe_map_layout_write(layout, light, &image, &error));
  set(&image, "abbe:kind", "receiver map");
  return field_of(&image);
}

TEST(layers_by_name) {
  static const char *const names[] = {"stderr.G",
                                      "B",
                                      "S0.550,500000nm",
                                      "G",
                                      "Z",
                                      "stderr.R",
                                      "R",
                                      "stderr.B",
                                      "S0.430nm",
                                      "stderr.S0.430nm",
                                      "caustic.G",
                                      "stderr.S0.550,500000nm",
                                      "caustic.B",
                                      "caustic.R",
                                      "S0.tall"};
  OWNED(abbe_image, image) = image_of(2, 1, 15, names);
  set(&image, "abbe:passes", "64");
  OWNED(abbe_field, f) = field_of(&image);
  assert_int_equal(f.kind, ABBE_FIELD_PICTURE);
  assert_int_equal(f.passes, 64);
  assert_true(f.space_assumed && !f.is_xyz);
  assert_string_equal(f.space, "rec709");
  const float colour[6] = {7, 4, 2, 22, 19, 17}, error[6] = {6, 1, 8, 21, 16, 23};
  assert_memory_equal(f.colour.value, colour, sizeof colour);
  assert_memory_equal(f.colour.error, error, sizeof error);
  assert_int_equal(f.bands.channels, 2);
  assert_near(f.lambda_nm[0], 430, 0);
  assert_near(f.lambda_nm[1], 550.5, 0);
  const float bands[4] = {9, 3, 24, 18}, band_errors[4] = {10, 12, 25, 27};
  assert_memory_equal(f.bands.value, bands, sizeof bands);
  assert_memory_equal(f.bands.error, band_errors, sizeof band_errors);
  assert_near((double)f.caustic.value[0], 14, 0);
  abbe_field_free(&f);
}

/* Bands are compared in one unit, whatever the file's is; what is not read of a spectrum counts. */
TEST(units_of_bands) {
  static const char *const names[] = {"S0.500nm",        "S0.600nm", "stderr.S0.500nm",
                                      "stderr.S0.600nm", "S1.500nm", "w500nm"};
  OWNED(abbe_image, image) = image_of(1, 1, 6, names);
  set(&image, "emissiveUnits", "mW.m^-2.sr^-1.nm^-1");
  OWNED(abbe_field, f) = field_of(&image);
  const double bands[2] = {1e-3, 2e-3}, errors[2] = {3e-3, 4e-3};
  for (int i = 0; i < 2; i++) {
    assert_near((double)f.bands.value[i], bands[i], 1e-9);
    assert_near((double)f.bands.error[i], errors[i], 1e-9);
  }
  assert_int_equal(f.unread, 2);
}

TEST(errors_that_are_not_known) {
  static const char *const names[] = {"X", "Y", "Z", "stderr.X", "stderr.Y", "stderr.Z"};
  OWNED(abbe_image, image) = image_of(2, 1, 6, names);
  for (size_t i = 0; i < 12; i++)
    if (i % 6 >= 3) image.data[i] = INFINITY;
  OWNED(abbe_field, f) = field_of(&image);
  assert_null(f.colour.error);
  abbe_field_free(&f);
  image.data[11] = 1;
  f = field_of(&image);
  assert_non_null(f.colour.error);
}

TEST(spaces) {
  static const char *const names[] = {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"};
  for (int s = 0; s < ABBE_RGB_SPACE_XYZ; s++)
    for (int by_word = 0; by_word < 2; by_word++) {
      OWNED(abbe_image, image) = image_of(1, 1, 6, names);
      if (by_word)
        set(&image, "abbe:space", abbe_rgb_space_name((abbe_rgb_space)s));
      else
        abbe_rgb_space_chromaticities((abbe_rgb_space)s, image.xy);
      OWNED(abbe_field, f) = field_of(&image);
      assert_false(f.space_assumed);
      assert_string_equal(f.space, abbe_rgb_space_name((abbe_rgb_space)s));
      double m[9], xyz[3], error[3];
      const double rgb[3] = {1, 2, 3};
      double expected[3];
      abbe_rgb_space_to_xyz((abbe_rgb_space)s, m);
      abbe_rgb_space_apply(m, rgb, expected);
      abbe_field_xyz(&f, 0, xyz, error);
      for (int k = 0; k < 3; k++) {
        assert_near(xyz[k], expected[k], 1e-12);
        double bound = 4 * fabs(m[3 * k]) + 5 * fabs(m[3 * k + 1]) + 6 * fabs(m[3 * k + 2]);
        assert_near(error[k], bound, 1e-12);
      }
      abbe_field_become_xyz(&f);
      assert_true(f.is_xyz);
      double again[3], error_again[3];
      abbe_field_xyz(&f, 0, again, error_again);
      for (int k = 0; k < 3; k++) {
        assert_near(again[k], expected[k], 1e-6);
        assert_near(error_again[k], error[k], 1e-6);
      }
    }
}

TEST(what_cannot_be_compared) {
  static const char *const depth[] = {"Z", "depth"}, *const half[] = {"R", "B"},
                           *const errors[] = {"X", "Y", "Z", "stderr.X"},
                           *const twice[] = {"S0.550nm", "S0.550,0nm"},
                           *const rgb[] = {"R", "G", "B"};
  static const struct {
    const char *const *names;
    size_t count;
    const char *says;
  } rows[] = {{depth, 2, "no channels R, G, B"},
              {half, 2, "'G'"},
              {errors, 4, "'stderr.Z'"},
              {twice, 2, "one wavelength"}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
    OWNED(abbe_image, image) = image_of(2, 2, rows[i].count, rows[i].names);
    abbe_field field = {0};
    REFUSED(ABBE_INVALID_ARGUMENT, rows[i].says, abbe_field_make(&image, "a.exr", &field, &error));
    assert_contains(last_error.text, "a.exr");
    assert_null(field.colour.value);
  }
  OWNED(abbe_image, image) = image_of(1, 1, 3, rgb);
  abbe_image empty = {0};
  for (int i = 0; i < 8; i++) image.xy[i] = 0.3;
  abbe_field field = {0};
  REFUSED(ABBE_INVALID_ARGUMENT, "span no colour space",
          abbe_field_make(&image, "a.exr", &field, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "the picture is empty",
          abbe_field_make(&empty, "a.exr", &field, &error));
  REFUSED(ABBE_IO, "No such file or directory", abbe_field_load("/no/such.exr", &field, &error));
}

TEST(summing_down_keeps_the_flux) {
  OWNED(abbe_field, f) = map_of(6, 4, NULL, NULL);
  double before[3] = {0}, squares = 0;
  for (size_t i = 0; i < 24; i++)
    for (size_t c = 0; c < 3; c++) before[c] += (double)f.colour.value[3 * i + c];
  for (size_t y = 0; y < 2; y++)
    for (size_t x = 0; x < 3; x++) squares += pow((double)f.colour.error[3 * (6 * y + x) + 1], 2);
  float corner = 0;
  for (size_t y = 0; y < 2; y++)
    for (size_t x = 0; x < 3; x++) corner += f.colour.value[3 * (6 * y + x) + 1];
  assert_int_equal(abbe_field_sum_down(&f, 4, 2, NULL), ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_field_sum_down(&f, 0, 2, NULL), ABBE_INVALID_ARGUMENT);
  OK(abbe_field_sum_down(&f, 2, 2, &error));
  assert_int_equal(f.width, 2);
  assert_near((double)f.colour.value[1], (double)corner, 0);
  assert_near((double)f.colour.error[1], sqrt(squares), 1e-5);
  for (size_t c = 0; c < 3; c++) {
    double after = 0;
    for (size_t i = 0; i < 4; i++) after += (double)f.colour.value[3 * i + c];
    assert_near(after, before[c], 1e-9);
  }
}

TEST(maps_align) {
  static const size_t sizes[][2] = {{8, 2}, {2, 8}, {4, 4}};
  for (int i = 0; i < 3; i++) {
    abbe_map_layout near = layout_of(-1, 5), far = layout_of(-1, 9);
    OWNED(abbe_field, a) = map_of(sizes[i][0], sizes[i][0], &near, "lamp"),
                      b = map_of(sizes[i][1], sizes[i][1], &far, NULL);
    OK(abbe_field_align(&a, "a", &b, "b", &error));
    assert_int_equal(a.width, b.width);
    assert_int_equal(a.width, sizes[i][0] < sizes[i][1] ? sizes[i][0] : sizes[i][1]);
  }
}

static void refuse(abbe_field *a, abbe_field *b, const char *says) {
  REFUSED(ABBE_INVALID_ARGUMENT, says, abbe_field_align(a, "a.exr", b, "b.exr", &error));
  assert_contains(last_error.text, "a.exr");
  abbe_field_free(a);
  abbe_field_free(b);
}

TEST(what_does_not_align) {
  static const char *const rgb[] = {"R", "G", "B"}, *const bands[] = {"S0.500nm", "S0.600nm"},
                           *const others[] = {"S0.500nm", "S0.601nm"};
  abbe_map_layout layout = layout_of(-1, 5), shifted = layout_of(-1.001, 5), warped = layout;
  warped.knot[1][5] *= 1.01;
  const abbe_map_layout *const other_layouts[] = {&shifted, &warped, NULL};
  for (int i = 0; i < 3; i++) {
    abbe_field a = map_of(4, 4, &layout, NULL), b = map_of(4, 4, other_layouts[i], NULL);
    refuse(&a, &b, "abbe:map_view");
  }
  abbe_field a = map_of(4, 4, &layout, NULL), b = map_of(4, 4, &layout, NULL);
  set(&b.header, "abbe:map_view", "perspective, from above");
  REFUSED(ABBE_PARSE, "b.exr", abbe_field_align(&a, "a.exr", &b, "b.exr", &error));
  abbe_field_free(&a);
  abbe_field_free(&b);
  a = map_of(4, 4, &layout, NULL), b = map_of(4, 4, &layout, NULL);
  b.header.display_window = (abbe_image_window){-1, 7, 2, 10};
  refuse(&a, &b, "b.exr (-1, 7) to (2, 10)");
  a = map_of(4, 4, &layout, NULL), b = map_of(3, 4, &layout, NULL);
  refuse(&a, &b, "4 x 4");
  OWNED(abbe_image, image) = image_of(4, 4, 3, rgb), small = image_of(2, 2, 3, rgb);
  OWNED(abbe_image, band) = image_of(4, 4, 2, bands), other = image_of(4, 4, 2, others);
  a = map_of(4, 4, &layout, NULL), b = field_of(&image);
  refuse(&a, &b, "a receiver map and");
  a = field_of(&image), b = field_of(&small);
  refuse(&a, &b, "pictures must have one size");
  a = field_of(&image), b = field_of(&band);
  refuse(&a, &b, "nothing in common");
  a = field_of(&other), b = field_of(&band);
  refuse(&a, &b, "nothing in common");
  a = map_of(4, 4, &layout, "lamp"), b = map_of(4, 4, &layout, "sun");
  refuse(&a, &b, "different lights");
}

TEST(spaces_align) {
  static const char *const rgb[] = {"R", "G", "B", "S0.500nm"};
  OWNED(abbe_image, image) = image_of(2, 2, 4, rgb), without = image_of(2, 2, 3, rgb);
  set(&image, "abbe:space", "acescg");
  set(&without, "abbe:space", "acescg");
  OWNED(abbe_field, a) = field_of(&image), b = field_of(&without);
  OK(abbe_field_align(&a, "a", &b, "b", &error));
  assert_true(!a.is_xyz && !b.is_xyz);
  assert_int_equal(a.bands.channels, 0);
  abbe_field_free(&b);
  set(&without, "abbe:space", "rec709");
  b = field_of(&without);
  double xyz[3];
  abbe_field_xyz(&a, 3, xyz, NULL);
  OK(abbe_field_align(&a, "a", &b, "b", &error));
  assert_true(a.is_xyz && b.is_xyz);
  for (size_t k = 0; k < 3; k++) assert_near((double)a.colour.value[9 + k], xyz[k], 1e-5);
}

TEST(from_a_file) {
  static const char *const names[] = {"X", "Y", "Z"};
  const char *path = printed("/tmp/abbe_test_field_%ld.exr", (long)getpid());
  OWNED(abbe_image, image) = image_of(3, 2, 3, names);
  abbe_map_layout layout = layout_of(-1, 5);
  OK(abbe_map_layout_write(&layout, NULL, &image, &error));
  OK(abbe_exr_write(path, &image, &error));
  MADE(abbe_field, f, abbe_field_load(path, &f, &error));
  unlink(path);
  assert_int_equal(f.kind, ABBE_FIELD_RECEIVER_MAP);
  assert_true(f.is_xyz && f.colour.error == NULL && f.passes == 0);
  assert_memory_equal(f.colour.value, image.data, 18 * sizeof(float));
}
