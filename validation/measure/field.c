#include "validation/measure/field.h"

#include "base/number.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/picture_space.h"
#include "colorimetry/spectral_picture/spectral_channels.h"
#include "scenes/view/map_layout.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Bringing two fields to one size, one layout and one space. */

/* Adds blocks of nx x ny texels up; squares are added and rooted for errors. */
static abbe_result sum_blocks(float **samples, size_t channels, size_t width, size_t height,
                              size_t nx, size_t ny, bool squares, abbe_error *error) {
  if (*samples == NULL) return ABBE_OK;
  size_t to_width = width / nx, to_height = height / ny;
  float *out = malloc(to_width * to_height * channels * sizeof *out);
  if (out == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for a map of %zu x %zu texels",
                          to_width, to_height);
  for (size_t y = 0; y < to_height; y++)
    for (size_t x = 0; x < to_width; x++)
      for (size_t c = 0; c < channels; c++) {
        double sum = 0;
        for (size_t j = 0; j < ny; j++)
          for (size_t i = 0; i < nx; i++) {
            double v = (double)(*samples)[((y * ny + j) * width + x * nx + i) * channels + c];
            sum += squares ? v * v : v;
          }
        out[(y * to_width + x) * channels + c] = (float)(squares ? sqrt(sum) : sum);
      }
  free(*samples);
  *samples = out;
  return ABBE_OK;
}

abbe_result abbe_field_sum_down(abbe_field *field, size_t width, size_t height, abbe_error *error) {
  if (width < 1 || height < 1 || field->width % width != 0 || field->height % height != 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a map of %zu x %zu texels cannot be summed down to %zu x %zu; whole "
                          "numbers of texels make one",
                          field->width, field->height, width, height);
  abbe_field_samples *const all[] = {&field->colour, &field->bands, &field->caustic};
  size_t nx = field->width / width, ny = field->height / height;
  abbe_result result = ABBE_OK;
  for (int i = 0; i < 3 && result == ABBE_OK; i++) {
    result = sum_blocks(&all[i]->value, all[i]->channels, field->width, field->height, nx, ny,
                        false, error);
    if (result == ABBE_OK)
      result = sum_blocks(&all[i]->error, all[i]->channels, field->width, field->height, nx, ny,
                          true, error);
  }
  if (result != ABBE_OK) { /* some are summed and some are not */
    abbe_field_free(field);
    return result;
  }
  field->width = width;
  field->height = height;
  return ABBE_OK;
}

/* Layouts */

static abbe_result differ(const char *name_a, const char *name_b, const char *of, const char *how,
                          abbe_error *error) {
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s and %s are maps of different %s: %s; 'abbe render' and 'abbe trace' "
                        "make one that can be compared with --map-like %s and --map-light",
                        name_a, name_b, of, how, name_a);
}

static abbe_result check_lights(const abbe_field *a, const char *name_a, const abbe_field *b,
                                const char *name_b, abbe_error *error) {
  const char *x = abbe_image_attribute_text(&a->header, "abbe:map_light");
  const char *y = abbe_image_attribute_text(&b->header, "abbe:map_light");
  if (x == NULL || y == NULL || strcmp(x, y) == 0) return ABBE_OK;
  char how[200];
  snprintf(how, sizeof how, "'%.80s' and '%.80s'", x, y);
  return differ(name_a, name_b, "lights", how, error);
}

static abbe_result check_layout(const abbe_field *a, const char *name_a, const abbe_field *b,
                                const char *name_b, abbe_error *error) {
  abbe_map_layout x, y;
  abbe_result result = abbe_map_layout_read(&a->header, name_a, &x, error);
  bool bare_a = result == ABBE_NOT_FOUND;
  if (result == ABBE_OK || bare_a) result = abbe_map_layout_read(&b->header, name_b, &y, error);
  bool bare_b = result == ABBE_NOT_FOUND;
  if (result != ABBE_OK && !bare_b) return result;
  if (bare_a != bare_b)
    return differ(name_a, name_b, "layouts", "only one of them says its abbe:map_view", error);
  if (bare_a || abbe_map_layout_same(&x, &y)) return check_lights(a, name_a, b, name_b, error);
  return differ(name_a, name_b, "layouts",
                "their abbe:map_view, abbe:map_warp_x or abbe:map_warp_y put places into other "
                "texels",
                error);
}

static bool divides(const abbe_field *coarse, const abbe_field *fine) {
  return fine->width % coarse->width == 0 && fine->height % coarse->height == 0;
}

static abbe_result align_sizes(abbe_field *a, const char *name_a, abbe_field *b, const char *name_b,
                               abbe_error *error) {
  if (a->width == b->width && a->height == b->height) return ABBE_OK;
  bool maps = a->kind == ABBE_FIELD_RECEIVER_MAP;
  if (maps && divides(a, b)) return abbe_field_sum_down(b, a->width, a->height, error);
  if (maps && divides(b, a)) return abbe_field_sum_down(a, b->width, b->height, error);
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s has %zu x %zu pixels and %s has %zu x %zu; %s", name_a, a->width,
                        a->height, name_b, b->width, b->height,
                        maps ? "maps must have one size, or one whole multiples of the other's"
                             : "pictures must have one size to be compared");
}

static void drop(abbe_field_samples *samples) {
  free(samples->value);
  free(samples->error);
  *samples = (abbe_field_samples){0};
}

static void drop_bands(abbe_field *field) {
  drop(&field->bands);
  free(field->lambda_nm);
  field->lambda_nm = NULL;
}

static bool same_bands(const abbe_field *a, const abbe_field *b) {
  if (a->bands.channels != b->bands.channels) return false;
  for (size_t i = 0; i < a->bands.channels; i++)
    if (!(fabs(a->lambda_nm[i] - b->lambda_nm[i]) <= 1e-3)) return false;
  return true;
}

static void align_channels(abbe_field *a, abbe_field *b) {
  if (!same_bands(a, b)) {
    drop_bands(a);
    drop_bands(b);
  }
  if (a->colour.channels == 0 || b->colour.channels == 0) {
    drop(&a->colour);
    drop(&b->colour);
    return;
  }
  bool same = a->is_xyz == b->is_xyz;
  for (int i = 0; i < 9; i++) same = same && fabs(a->to_xyz[i] - b->to_xyz[i]) <= 1e-5;
  if (same) return;
  abbe_field_become_xyz(a);
  abbe_field_become_xyz(b);
}

abbe_result abbe_field_align(abbe_field *a, const char *name_a, abbe_field *b, const char *name_b,
                             abbe_error *error) {
  if (a->kind != b->kind)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s is a %s and %s a %s; two of a kind can be compared", name_a,
                          abbe_field_kind_name(a->kind), name_b, abbe_field_kind_name(b->kind));
  if (a->kind == ABBE_FIELD_RECEIVER_MAP) ABBE_TRY(check_layout(a, name_a, b, name_b, error));
  ABBE_TRY(align_sizes(a, name_a, b, name_b, error));
  ABBE_TRY(abbe_image_check_place(&a->header, name_a, &b->header, name_b, error));
  bool colour = a->colour.channels > 0 && b->colour.channels > 0;
  if (!colour && (a->bands.channels == 0 || !same_bands(a, b)))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s and %s have nothing in common that can be compared: neither colour "
                          "nor the same bands",
                          name_a, name_b);
  align_channels(a, b);
  return ABBE_OK;
}

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
  f->unread += list.terms - list.count; /* of re-radiation */
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
  for (size_t i = 0; i < image->attribute_count; i++)
    ABBE_TRY(abbe_image_set_attribute(&f->header, image->attribute[i].name,
                                      image->attribute[i].text, error));
  return ABBE_OK;
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
  ABBE_TRY(copy_attributes(image, f, error));
  ABBE_TRY(take_colour(image, name, f, error));
  ABBE_TRY(take_bands(image, name, f, error));
  if (f->colour.channels == 0 && f->bands.channels == 0)
    ABBE_TRY(abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s: it has no channels R, G, B, nor X, Y, Z, nor bands such as "
                            "S0.550,000000nm; its first channel is '%s'",
                            name, image->channel[0]));
  return ABBE_OK;
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
  ABBE_OWNED(abbe_image, image) = {0};
  *out = (abbe_field){0};
  ABBE_TRY(abbe_exr_read(path, &image, error));
  return abbe_field_make(&image, path, out, error);
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
