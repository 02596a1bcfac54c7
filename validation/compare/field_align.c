/* Bringing two fields to one size, one layout and one space. */
#include "validation/compare/field.h"

#include "scenes/view/map_layout.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
  abbe_result result = ABBE_OK;
  if (a->kind == ABBE_FIELD_RECEIVER_MAP) result = check_layout(a, name_a, b, name_b, error);
  if (result == ABBE_OK) result = align_sizes(a, name_a, b, name_b, error);
  if (result == ABBE_OK)
    result = abbe_image_check_place(&a->header, name_a, &b->header, name_b, error);
  if (result != ABBE_OK) return result;
  bool colour = a->colour.channels > 0 && b->colour.channels > 0;
  if (!colour && (a->bands.channels == 0 || !same_bands(a, b)))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s and %s have nothing in common that can be compared: neither colour "
                          "nor the same bands",
                          name_a, name_b);
  align_channels(a, b);
  return ABBE_OK;
}
