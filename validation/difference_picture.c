#include "validation/difference_picture.h"

#include "colorimetry/rgb_space.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

enum { MARGIN = 12, BAR = 24, TICK = 8, TICKS = 5, SMALLEST_SIDE = 96 };

static const float background = 0.85f;

/* Colours */

static double encode(double linear) {
  double v = fmin(fmax(linear, 0), 1); /* [IEC61966] */
  return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055;
}

static double lab_inverse(double f) {
  return f > 6.0 / 29 ? f * f * f : 3 * 36.0 / 841 * (f - 4.0 / 29); /* [CIE15] */
}

static void lab_to_srgb(const double lab[3], double rgb[3]) {
  static const double d65[3] = {0.3127 / 0.3290, 1, (1 - 0.3127 - 0.3290) / 0.3290};
  double f = (lab[0] + 16) / 116, from_xyz[9];
  rgb[0] = d65[0] * lab_inverse(f + lab[1] / 500);
  rgb[1] = d65[1] * lab_inverse(f);
  rgb[2] = d65[2] * lab_inverse(f - lab[2] / 200);
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, from_xyz);
  abbe_rgb_space_apply(from_xyz, rgb, rgb);
  for (int c = 0; c < 3; c++) rgb[c] = encode(rgb[c]);
}

void abbe_difference_picture_colour(double t, double rgb[3]) {
  static const double middle[3] = {97, 0, 0}, blue[3] = {34, 26, -58}, red[3] = {34, 56, 42};
  const double *end = t < 0 ? blue : red;
  double share = fmin(fabs(t), 1), lab[3];
  for (int c = 0; c < 3; c++) lab[c] = middle[c] + share * (end[c] - middle[c]);
  lab_to_srgb(lab, rgb);
}

/* Differences */

static double light(const abbe_field *field, size_t pixel) {
  if (field->colour.channels > 0) {
    double xyz[3];
    abbe_field_xyz(field, pixel, xyz, NULL);
    return xyz[1];
  }
  double sum = 0;
  for (size_t c = 0; c < field->bands.channels; c++)
    sum += (double)field->bands.value[pixel * field->bands.channels + c];
  return sum;
}

static double difference(const abbe_field *reference, const abbe_field *test, double scale,
                         size_t pixel) {
  return scale * light(test, pixel) - light(reference, pixel);
}

static abbe_result check(const abbe_field *reference, const abbe_field *test, abbe_error *error) {
  if (reference->width == test->width && reference->height == test->height &&
      reference->width > 0 && (reference->colour.channels > 0) == (test->colour.channels > 0))
    return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "the difference of %zu x %zu and %zu x %zu pixels cannot be drawn before "
                        "they are aligned",
                        reference->width, reference->height, test->width, test->height);
}

static int ascending(const void *a, const void *b) {
  float x = *(const float *)a, y = *(const float *)b;
  return (x > y) - (x < y);
}

static double round_up(double value) {
  if (!(value > 0)) return 0;
  double power = pow(10, floor(log10(value)));
  static const double steps[] = {1, 2, 5};
  for (int i = 0; i < 3; i++)
    if (value <= steps[i] * power * (1 + 1e-6)) return steps[i] * power;
  return 10 * power;
}

abbe_result abbe_difference_picture_range(const abbe_field *reference, const abbe_field *test,
                                          double scale, double *range, abbe_error *error) {
  *range = 0;
  abbe_result result = check(reference, test, error);
  if (result != ABBE_OK) return result;
  size_t pixels = reference->width * reference->height, count = 0;
  float *sizes = malloc(pixels * sizeof *sizes);
  if (sizes == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for %zu differences", pixels);
  for (size_t p = 0; p < pixels; p++) {
    double d = fabs(difference(reference, test, scale, p));
    if (isfinite(d)) sizes[count++] = (float)d;
  }
  qsort(sizes, count, sizeof *sizes, ascending);
  if (count > 0) {
    double most = (double)sizes[(99 * count + 99) / 100 - 1];
    *range = round_up(most > 0 ? most : (double)sizes[count - 1]);
  }
  free(sizes);
  return ABBE_OK;
}

/* Drawing */

static void put(abbe_image *image, size_t x, size_t y, const double rgb[3]) {
  for (size_t c = 0; c < 3; c++) image->data[(y * image->width + x) * 3 + c] = (float)rgb[c];
}

static void draw_field(const abbe_field *reference, const abbe_field *test, double scale,
                       double range, size_t times, abbe_image *image) {
  for (size_t p = 0; p < reference->width * reference->height; p++) {
    double rgb[3] = {0}, d = difference(reference, test, scale, p);
    if (isfinite(d)) abbe_difference_picture_colour(d / range, rgb);
    size_t left = p % reference->width * times, top = p / reference->width * times;
    for (size_t y = 0; y < times; y++)
      for (size_t x = 0; x < times; x++) put(image, MARGIN + left + x, MARGIN + top + y, rgb);
  }
}

/* From range at the top to -range at the bottom, with ticks at every half. */
static void draw_bar(size_t left, size_t height, abbe_image *image) {
  static const double black[3] = {0};
  for (size_t y = 0; y < height; y++) {
    double rgb[3];
    abbe_difference_picture_colour(1 - 2 * ((double)y + 0.5) / (double)height, rgb);
    for (size_t x = 0; x < BAR; x++) put(image, left + x, MARGIN + y, rgb);
  }
  for (size_t i = 0; i < TICKS; i++)
    for (size_t x = 0; x < TICK; x++)
      put(image, left + BAR + x, MARGIN + i * (height - 1) / (TICKS - 1), black);
}

static size_t enlargement(const abbe_field *field) {
  size_t side = field->width > field->height ? field->width : field->height;
  return side < ABBE_DIFFERENCE_PICTURE_SIDE ? ABBE_DIFFERENCE_PICTURE_SIDE / side : 1;
}

abbe_result abbe_difference_picture_make(const abbe_field *reference, const abbe_field *test,
                                         double scale, double range, abbe_image *out,
                                         abbe_error *error) {
  static const char *const names[] = {"R", "G", "B"};
  *out = (abbe_image){0};
  abbe_result result = check(reference, test, error);
  if (result == ABBE_OK && !(range > 0 && isfinite(range)))
    result = abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "differences of -%g to %g cannot be drawn; the range is above 0", range,
                            range);
  if (result != ABBE_OK) return result;
  size_t times = enlargement(reference);
  size_t width = reference->width * times, height = reference->height * times;
  size_t bar = height > SMALLEST_SIDE ? height : SMALLEST_SIDE;
  result = abbe_image_make(width + BAR + TICK + 3 * (size_t)MARGIN, bar + 2 * (size_t)MARGIN, 3,
                           names, out, error);
  if (result != ABBE_OK) return result;
  for (size_t i = 0; i < out->width * out->height * 3; i++) out->data[i] = background;
  draw_field(reference, test, scale, range, times, out);
  draw_bar(width + 2 * (size_t)MARGIN, bar, out);
  return ABBE_OK;
}
