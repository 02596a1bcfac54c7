#include "gl/accuracy/error_picture.h"

#include "base/order.h"
#include "colorimetry/plot/chart.h"
#include "colorimetry/rgb_space.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 512, BESIDE = 190, ABOVE = 34, BELOW = 12 };

static double round_up(double x) {
  static const double step[] = {1, 2, 5, 10};
  double power = pow(10, floor(log10(x)));
  int k = 0;
  while (k < 3 && step[k] * power < x * (1 - 1e-9)) k++;
  return step[k] * power;
}

static double scale_end(const float *value, size_t count, float *sorted) {
  memcpy(sorted, value, count * sizeof *value);
  qsort(sorted, count, sizeof *sorted, abbe_order_ascending_floats);
  double most = (double)sorted[(size_t)(0.999 * (double)(count - 1))];
  if (!(most > 0)) most = (double)sorted[count - 1];
  return most > 0 ? round_up(most) : 1;
}

static void errors_of_y(const abbe_error_bars *bars, float *out) {
  abbe_rgb_space space = ABBE_RGB_SPACE_ACESCG;
  double to_xyz[9];
  const char *name = abbe_image_attribute_text(&bars->mean, "abbe:space");
  for (int i = 0; name != NULL && i < ABBE_RGB_SPACE_COUNT; i++)
    if (strcmp(name, abbe_rgb_space_name((abbe_rgb_space)i)) == 0) space = (abbe_rgb_space)i;
  abbe_rgb_space_to_xyz(space, to_xyz);
  for (size_t p = 0; p < bars->error.width * bars->error.height; p++) {
    double sum = 0;
    for (size_t c = 0; c < 3; c++) sum += fabs(to_xyz[3 + c]) * (double)bars->error.data[3 * p + c];
    out[p] = (float)sum;
  }
}

abbe_result abbe_error_picture_write(const char *path, const abbe_error_bars *bars,
                                     abbe_error *error) {
  ABBE_REQUIRE(path && bars && bars->error.data, error);
  size_t width = bars->error.width, height = bars->error.height, pixels = width * height;
  float *value = malloc(2 * pixels * sizeof *value);
  if (value == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for %zu errors", pixels);
  errors_of_y(bars, value);
  double end = scale_end(value, pixels, value + pixels);
  /* A logarithm has no 0: the scale's beginning stands for it. */
  for (size_t p = 0; p < pixels; p++) value[p] = (float)fmax((double)value[p], 1e-3 * end);
  const abbe_chart_field field = {.width = width,
                                  .height = height,
                                  .value = value,
                                  .min = 1e-3 * end,
                                  .max = end,
                                  .log = true,
                                  .map = ABBE_COLOUR_MAP_AMOUNT,
                                  .label = "error of Y: radiance, W/(m2 sr)"};
  const abbe_chart chart = {.title = "One standard error, estimated", .field = &field};
  size_t side = width > height ? width : height, times = side < SIDE ? SIDE / side : 1;
  abbe_result result = abbe_chart_write(path, &chart, 1, width * times + BESIDE,
                                        height * times + ABOVE + BELOW, error);
  free(value);
  return result;
}
