#include "validation/compare/field.h"

#include "base/number.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/picture_space.h"
#include "colorimetry/spectral_picture/spectral_channels.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const size_t absent = (size_t)-1;

static const char *const colour_names[2][3] = {{"R", "G", "B"}, {"X", "Y", "Z"}};

const char *abbe_field_kind_name(abbe_field_kind kind) {
  static const char *const names[] = {
#define NAME(code, name) name,
      ABBE_FIELD_KINDS(NAME)
#undef NAME
  };
  return (unsigned)kind < ABBE_FIELD_KIND_COUNT ? names[kind] : "unknown";
}

/* Channels */

static size_t find(const abbe_image *image, const char *prefix, const char *name) {
  char full[96];
  int n = snprintf(full, sizeof full, "%s%s", prefix, name);
  return n > 0 && (size_t)n < sizeof full ? abbe_image_find_channel(image, full) : absent;
}

static abbe_result no_memory(const char *name, abbe_error *error) {
  return abbe_error_set(error, ABBE_NO_MEMORY, "%s: there is no memory for its samples", name);
}

/* The samples of the given channels, interleaved. */
static float *gather(const abbe_image *image, const size_t *channel, size_t count) {
  size_t pixels = image->width * image->height;
  if (pixels > SIZE_MAX / sizeof(float) / count) return NULL;
  float *out = malloc(pixels * count * sizeof *out);
  for (size_t i = 0; out != NULL && i < pixels; i++)
    for (size_t c = 0; c < count; c++)
      out[i * count + c] = image->data[i * image->channels + channel[c]];
  return out;
}

/* Takes prefix + names into *out; all, or none where the file has none of them. */
static abbe_result take(const abbe_image *image, const char *prefix, const char *const *names,
                        size_t count, const char *name, float **out, abbe_error *error) {
  size_t channel[ABBE_IMAGE_MAX_CHANNELS], there = 0, missing = 0;
  for (size_t c = 0; c < count; c++) {
    channel[c] = find(image, prefix, names[c]);
    there += channel[c] != absent;
    if (channel[c] == absent) missing = c;
  }
  *out = NULL;
  if (there == 0) return ABBE_OK;
  if (there < count)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: it has some of its %zu channels of one set but not '%s%s'", name,
                          count, prefix, names[missing]);
  *out = gather(image, channel, count);
  return *out == NULL ? no_memory(name, error) : ABBE_OK;
}

/* Standard errors none of which is finite are not known: a trace of one pass has such. */
static void drop_unknown(float **errors, size_t count) {
  if (*errors == NULL) return;
  for (size_t i = 0; i < count; i++)
    if (isfinite((*errors)[i])) return;
  free(*errors);
  *errors = NULL;
}

/* Colour */

static abbe_result take_colour(const abbe_image *image, const char *name, abbe_field *f,
                               abbe_error *error) {
  f->is_xyz = abbe_image_find_channel(image, "R") == absent &&
              abbe_image_find_channel(image, "X") != absent;
  const char *const *names = colour_names[f->is_xyz];
  abbe_result result = take(image, "", names, 3, name, &f->colour.value, error);
  if (result != ABBE_OK || f->colour.value == NULL) return result;
  f->colour.channels = 3;
  result = take(image, "stderr.", names, 3, name, &f->colour.error, error);
  drop_unknown(&f->colour.error, 3 * image->width * image->height);
  if (result == ABBE_OK) result = take(image, "caustic.", names, 3, name, &f->caustic.value, error);
  if (f->caustic.value != NULL) f->caustic.channels = 3;
  abbe_picture_space space;
  if (result == ABBE_OK) result = abbe_picture_space_find(image, f->is_xyz, name, &space, error);
  if (result != ABBE_OK) return result;
  memcpy(f->to_xyz, space.to_xyz, sizeof f->to_xyz);
  snprintf(f->space, sizeof f->space, "%s", space.text);
  f->space_assumed = space.assumed;
  f->observer = space.observer;
  return ABBE_OK;
}

/* Bands */

static void scale(float *value, size_t count, double factor) {
  for (size_t i = 0; value != NULL && factor != 1 && i < count; i++)
    value[i] = (float)((double)value[i] * factor);
}

static abbe_result take_bands(const abbe_image *image, const char *name, abbe_field *f,
                              abbe_error *error) {
  abbe_spectral_channels list = {0};
  const char *names[ABBE_IMAGE_MAX_CHANNELS];
  abbe_result result = abbe_spectral_channels_find(image, NULL, name, &list, error);
  const size_t count = list.count;
  for (size_t i = 0; i < count; i++) names[i] = image->channel[list.channel[i]];
  const double unit = list.unit.factor;
  abbe_spectral_unread unread;
  abbe_spectral_channels_find_unread(image, NULL, &unread);
  for (int k = 0; k < ABBE_SPECTRAL_UNREAD_COUNT; k++) f->unread += unread.count[k];
  f->lambda_nm = list.lambda_nm;
  list.lambda_nm = NULL;
  abbe_spectral_channels_free(&list);
  if (result != ABBE_OK || count == 0) return result;
  result = take(image, "", names, count, name, &f->bands.value, error);
  if (result == ABBE_OK)
    result = take(image, "stderr.", names, count, name, &f->bands.error, error);
  const size_t samples = count * image->width * image->height;
  drop_unknown(&f->bands.error, samples);
  scale(f->bands.value, samples, unit);
  scale(f->bands.error, samples, unit);
  f->bands.channels = f->bands.value == NULL ? 0 : count;
  return result;
}

/* The whole */

static abbe_result copy_attributes(const abbe_image *image, abbe_field *f, abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < image->attribute_count && result == ABBE_OK; i++)
    result = abbe_image_set_attribute(&f->header, image->attribute[i].name,
                                      image->attribute[i].text, error);
  return result;
}

static abbe_field_kind find_kind(const abbe_image *image) {
  const char *word = abbe_image_attribute_text(image, "abbe:kind");
  bool map = word != NULL ? strcmp(word, abbe_field_kind_name(ABBE_FIELD_RECEIVER_MAP)) == 0
                          : abbe_image_attribute_text(image, "abbe:map_view") != NULL;
  return map ? ABBE_FIELD_RECEIVER_MAP : ABBE_FIELD_PICTURE;
}

static size_t find_passes(const abbe_image *image) {
  const char *word = abbe_image_attribute_text(image, "abbe:passes");
  const char *end;
  double passes = 0;
  if (word != NULL) abbe_number_read(word, &end, &passes);
  return passes >= 1 && passes < 1e15 ? (size_t)passes : 0;
}

static abbe_result fill(const abbe_image *image, const char *name, abbe_field *f,
                        abbe_error *error) {
  f->kind = find_kind(image);
  f->width = image->width;
  f->height = image->height;
  f->passes = find_passes(image);
  f->header.display_window = image->display_window;
  memcpy(f->header.part, image->part, sizeof f->header.part);
  abbe_result result = copy_attributes(image, f, error);
  if (result == ABBE_OK) result = take_colour(image, name, f, error);
  if (result == ABBE_OK) result = take_bands(image, name, f, error);
  if (result == ABBE_OK && f->colour.channels == 0 && f->bands.channels == 0)
    result = abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s: it has no channels R, G, B, nor X, Y, Z, nor bands such as "
                            "S0.550,000000nm; its first channel is '%s'",
                            name, image->channel[0]);
  return result;
}

abbe_result abbe_field_make(const abbe_image *image, const char *name, abbe_field *out,
                            abbe_error *error) {
  *out = (abbe_field){0};
  if (image->data == NULL || image->channels == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: the picture is empty", name);
  abbe_field field = {0};
  abbe_result result = fill(image, name, &field, error);
  if (result == ABBE_OK)
    *out = field;
  else
    abbe_field_free(&field);
  return result;
}

abbe_result abbe_field_load(const char *path, abbe_field *out, abbe_error *error) {
  abbe_image image = {0};
  *out = (abbe_field){0};
  abbe_result result = abbe_exr_read(path, &image, error);
  if (result == ABBE_OK) result = abbe_field_make(&image, path, out, error);
  abbe_image_free(&image);
  return result;
}

static void free_samples(abbe_field_samples *samples) {
  free(samples->value);
  free(samples->error);
  *samples = (abbe_field_samples){0};
}

void abbe_field_free(abbe_field *field) {
  if (field == NULL) return;
  free_samples(&field->colour);
  free_samples(&field->bands);
  free_samples(&field->caustic);
  free(field->lambda_nm);
  abbe_image_free(&field->header);
  *field = (abbe_field){0};
}

void abbe_field_xyz(const abbe_field *field, size_t pixel, double xyz[3], double error[3]) {
  const float *v = field->colour.value + 3 * pixel;
  const double value[3] = {v[0], v[1], v[2]};
  abbe_rgb_space_apply(field->to_xyz, value, xyz);
  if (error == NULL) return;
  for (int row = 0; row < 3; row++) {
    error[row] = 0;
    for (size_t c = 0; c < 3 && field->colour.error != NULL; c++)
      error[row] +=
          fabs(field->to_xyz[3 * row + (int)c]) * (double)field->colour.error[3 * pixel + c];
  }
}

void abbe_field_become_xyz(abbe_field *field) {
  if (field->is_xyz || field->colour.channels == 0) return;
  size_t pixels = field->width * field->height;
  for (size_t i = 0; i < pixels; i++) {
    double xyz[3], error[3];
    abbe_field_xyz(field, i, xyz, error);
    for (size_t c = 0; c < 3; c++) {
      field->colour.value[3 * i + c] = (float)xyz[c];
      if (field->colour.error != NULL) field->colour.error[3 * i + c] = (float)error[c];
    }
    if (field->caustic.channels == 0) continue;
    float *v = field->caustic.value + 3 * i;
    double caustic[3] = {v[0], v[1], v[2]};
    abbe_rgb_space_apply(field->to_xyz, caustic, caustic);
    for (size_t c = 0; c < 3; c++) v[c] = (float)caustic[c];
  }
  field->is_xyz = true;
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_XYZ, field->to_xyz);
  snprintf(field->space, sizeof field->space, "%s", abbe_rgb_space_name(ABBE_RGB_SPACE_XYZ));
}
