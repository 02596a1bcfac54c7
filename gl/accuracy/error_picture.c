#include "gl/accuracy/error_bars.h"

#include "colorimetry/image/picture_space.h"
#include "colorimetry/plot/false_colours.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

static void errors_of_y(const abbe_error_bars *bars, const double to_xyz[9], float *out) {
  for (size_t p = 0; p < bars->error.width * bars->error.height; p++) {
    double sum = 0;
    for (size_t c = 0; c < 3; c++) sum += fabs(to_xyz[3 + c]) * (double)bars->error.data[3 * p + c];
    out[p] = (float)sum;
  }
}

abbe_result abbe_error_picture_write(const char *path, const abbe_error_bars *bars,
                                     abbe_error *error) {
  assert(bars->error.data);
  const abbe_false_colours_desc desc = {.width = bars->error.width,
                                        .height = bars->error.height,
                                        .is_error = true,
                                        .title = "One standard error, estimated",
                                        .label = "error of Y: radiance, W/(m2 sr)"};
  abbe_picture_space space;
  abbe_result result = abbe_picture_space_find(&bars->mean, false, "the mean", &space, error);
  if (result != ABBE_OK) return result;
  float *value = malloc(desc.width * desc.height * sizeof *value);
  if (value == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for %zu errors",
                          desc.width * desc.height);
  errors_of_y(bars, space.to_xyz, value);
  result = abbe_false_colours_draw(path, &desc, value, error);
  free(value);
  return result;
}
