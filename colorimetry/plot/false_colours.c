#include "colorimetry/plot/false_colours.h"

#include "base/maths.h"
#include "base/number.h"
#include "colorimetry/image/picture_space.h"
#include "colorimetry/spectral_picture/spectral_channels.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 512, BESIDE = 190, ABOVE = 34, BELOW = 12 };

static const size_t absent = (size_t)-1;

/* ---- which numbers ---- */

typedef struct source {
  size_t channel;   /* or absent: */
  size_t triple[3]; /* R, G, B of errors */
  bool is_error;
} source;

/* "550nm", "550" */
static bool parse_wavelength(const char *text, double *nm) {
  const char *rest;
  return abbe_number_read(text, &rest, nm) && *nm > 0 && (*rest == '\0' || strcmp(rest, "nm") == 0);
}

/* The channel of the band that holds the wavelength. */
static size_t find_band(const abbe_image *image, const char *layer) {
  double nm;
  abbe_spectral_channels c;
  size_t found = absent;
  if (!parse_wavelength(layer, &nm)) return absent;
  if (abbe_spectral_channels_find(image, NULL, "", &c, NULL) != ABBE_OK) return absent;
  for (size_t i = 0; i < c.count && found == absent; i++)
    if (nm >= c.edge_nm[i] && nm <= c.edge_nm[i + 1]) found = c.channel[i];
  abbe_spectral_channels_free(&c);
  return found;
}

static bool find_source(const abbe_image *image, const char *layer, source *out) {
  static const char *const names[3] = {"R", "G", "B"};
  *out = (source){.channel = abbe_image_find_channel(image, layer),
                  .is_error = strncmp(layer, "stderr", 6) == 0};
  if (out->channel == absent) out->channel = find_band(image, layer);
  if (out->channel != absent) return true;
  for (int k = 0; k < 3 && out->is_error; k++) {
    char name[300];
    snprintf(name, sizeof name, "%s.%s", layer, names[k]);
    out->triple[k] = abbe_image_find_channel(image, name);
    if (out->triple[k] == absent) return false;
  }
  return out->is_error;
}

bool abbe_false_colours_mean(const abbe_image *image, const char *layer) {
  source found;
  return image != NULL && layer != NULL && find_source(image, layer, &found);
}

static abbe_result refuse(const abbe_image *image, const char *layer, const char *name,
                          abbe_error *error) {
  char known[500] = "";
  for (size_t i = 0; i < image->channels; i++) {
    const size_t used = strlen(known);
    snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "", image->channel[i]);
  }
  return abbe_error_set(error, ABBE_NOT_FOUND, "%s: it has no channel or band '%.100s'; it has: %s",
                        name, layer, known);
}

/* By the triangle's inequality, whatever the correlation of the three. */
static abbe_result errors_of_y(const abbe_image *image, const source *of, const char *name,
                               float *out, abbe_error *error) {
  abbe_picture_space space;
  ABBE_TRY(abbe_picture_space_find(image, false, name, &space, error));
  for (size_t p = 0; p < image->width * image->height; p++) {
    double sum = 0;
    for (int k = 0; k < 3; k++)
      sum += fabs(space.to_xyz[3 + k]) * (double)image->data[p * image->channels + of->triple[k]];
    out[p] = (float)sum;
  }
  return ABBE_OK;
}

abbe_result abbe_false_colours_values(const abbe_image *image, const char *layer, const char *name,
                                      float **values, char *title, size_t title_size,
                                      bool *is_error, abbe_error *error) {
  source of;
  abbe_result result = ABBE_OK;
  *values = NULL;
  if (!find_source(image, layer, &of)) return refuse(image, layer, name, error);
  const size_t pixels = image->width * image->height;
  float *value = malloc(pixels * sizeof *value);
  if (value == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for %zu numbers", name, pixels);
  *is_error = of.is_error;
  if (of.channel != absent) {
    snprintf(title, title_size, "%s", image->channel[of.channel]);
    for (size_t p = 0; p < pixels; p++) value[p] = image->data[p * image->channels + of.channel];
  } else {
    snprintf(title, title_size, "%s: of Y, at the most", layer);
    result = errors_of_y(image, &of, name, value, error);
  }
  if (result == ABBE_OK)
    *values = value;
  else
    free(value);
  return result;
}

/* ---- their scale ---- */

static double round_up(double x) {
  static const double step[] = {1, 2, 5, 10};
  const double power = pow(10, floor(log10(x)));
  int k = 0;
  while (k < 3 && step[k] * power < x * (1 - 1e-9)) k++;
  return step[k] * power;
}

void abbe_false_colours_scale(const float *sorted, size_t count, bool is_error,
                              abbe_chart_field *field) {
  const double least = count > 0 ? (double)sorted[0] : 0,
               most = count > 0 ? (double)sorted[count - 1] : 0,
               nearly = count > 0 ? (double)sorted[(size_t)(0.999 * (double)(count - 1))] : 0;
  field->map = ABBE_COLOUR_MAP_AMOUNT;
  if (least < 0) {
    field->map = ABBE_COLOUR_MAP_DIFFERENCE;
    field->max = round_up(fmax(-least, most));
    field->min = -field->max;
    return;
  }
  const double top = nearly > 0 ? nearly : most;
  field->max = top > 0 ? round_up(top) : 1;
  field->min = 0;
  if (is_error) {
    field->log = true;
    field->min = 1e-3 * field->max;
  } else if (least > 0.5 * most && most > least) {
    field->min = least;
    field->max = most;
  }
}

abbe_result abbe_false_colours_draw(const char *path, const abbe_false_colours_desc *d,
                                    float *value, abbe_error *error) {
  assert(d->title && d->label);
  const size_t width = d->width, height = d->height, pixels = width * height;
  float *sorted = malloc(pixels * sizeof *sorted);
  if (sorted == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for %zu numbers", path, pixels);
  size_t count = 0;
  for (size_t p = 0; p < pixels; p++)
    if (isfinite(value[p])) sorted[count++] = value[p];
  qsort(sorted, count, sizeof *sorted, abbe_order_ascending_floats);
  abbe_chart_field field = {.width = width, .height = height, .value = value, .label = d->label};
  abbe_false_colours_scale(sorted, count, d->is_error, &field);
  free(sorted);
  /* A logarithm has no 0: the scale's beginning stands for it. */
  for (size_t p = 0; p < pixels && field.log; p++)
    if (value[p] < (float)field.min) value[p] = (float)field.min;
  const abbe_chart chart = {.title = d->title, .field = &field};
  const size_t side = width > height ? width : height, times = side < SIDE ? SIDE / side : 1;
  return abbe_chart_write(path, &chart, 1, width * times + BESIDE, height * times + ABOVE + BELOW,
                          error);
}

abbe_result abbe_false_colours_write(const char *path, const abbe_image *image, const char *layer,
                                     const char *name, abbe_error *error) {
  ABBE_FREED float *value = NULL;
  char label[400], title[400];
  bool is_error;
  ABBE_TRY(
      abbe_false_colours_values(image, layer, name, &value, label, sizeof label, &is_error, error));
  snprintf(title, sizeof title, "%.300s", name);
  const abbe_false_colours_desc desc = {.width = image->width,
                                        .height = image->height,
                                        .is_error = is_error,
                                        .title = title,
                                        .label = label};
  return abbe_false_colours_draw(path, &desc, value, error);
}
