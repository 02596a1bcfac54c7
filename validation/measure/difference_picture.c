#include "validation/measure/file_comparison.h"

#include "base/maths.h"
#include "colorimetry/plot/chart.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* What the chart keeps free about a field. */
enum { BESIDE = 190, TITLE = 34, ABOVE = 16, BELOW = 12 };

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
  ABBE_TRY(check(reference, test, error));
  size_t pixels = reference->width * reference->height, count = 0;
  float *sizes = malloc(pixels * sizeof *sizes);
  if (sizes == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for %zu differences", pixels);
  for (size_t p = 0; p < pixels; p++) {
    double d = fabs(difference(reference, test, scale, p));
    if (isfinite(d)) sizes[count++] = (float)d;
  }
  qsort(sizes, count, sizeof *sizes, abbe_order_ascending_floats);
  if (count > 0) {
    double most = (double)sizes[(99 * count + 99) / 100 - 1];
    *range = round_up(most > 0 ? most : (double)sizes[count - 1]);
  }
  free(sizes);
  return ABBE_OK;
}

/* Drawing */

static size_t enlargement(const abbe_field *field) {
  size_t side = field->width > field->height ? field->width : field->height;
  return side < ABBE_DIFFERENCE_PICTURE_SIDE ? ABBE_DIFFERENCE_PICTURE_SIDE / side : 1;
}

static abbe_result draw(const char *path, const abbe_field *reference, const abbe_chart_field *f,
                        const char *title, abbe_error *error) {
  const abbe_chart chart = {.title = title, .field = f};
  size_t times = enlargement(reference);
  /* Space enough beside the field; its height decides, so that a pixel is `times` pixels. */
  return abbe_chart_write(path, &chart, 1, f->width * times + BESIDE,
                          f->height * times + (title != NULL ? TITLE : ABOVE) + BELOW, error);
}

abbe_result abbe_difference_picture_write(const char *path, const abbe_field *reference,
                                          const abbe_field *test, double scale, double range,
                                          const char *title, abbe_error *error) {
  ABBE_TRY(check(reference, test, error));
  if (!(range > 0 && isfinite(range)))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "differences of -%g to %g cannot be drawn; the range is above 0", range,
                          range);
  size_t pixels = reference->width * reference->height;
  ABBE_FREED float *value = malloc(pixels * sizeof *value);
  if (value == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for %zu differences", pixels);
  for (size_t p = 0; p < pixels; p++) value[p] = (float)difference(reference, test, scale, p);
  const char *unit = abbe_image_attribute_text(&reference->header, "abbe:unit");
  if (unit == NULL) unit = abbe_image_attribute_text(&test->header, "abbe:unit");
  char label[160];
  snprintf(label, sizeof label, "difference of %s%s%.100s",
           reference->colour.channels > 0 ? "Y" : "the sum of bands", unit != NULL ? ": " : "",
           unit != NULL ? unit : "");
  const abbe_chart_field f = {.width = reference->width,
                              .height = reference->height,
                              .value = value,
                              .min = -range,
                              .max = range,
                              .map = ABBE_COLOUR_MAP_DIFFERENCE,
                              .label = label};
  return draw(path, reference, &f, title, error);
}
