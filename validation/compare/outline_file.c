#include "validation/compare/outline_file.h"

#include "colorimetry/rgb_space.h"
#include "validation/compare/field.h"

#include <stdlib.h>
#include <string.h>

/* Adds factor times the field's caustic, or its colour where it has none apart, in Rec.709. */
static abbe_result add_picture(const abbe_field *field, const char *name, double factor,
                               bool caustic, double (*rgb)[3], abbe_error *error) {
  const bool apart = caustic && field->caustic.channels == 3;
  const abbe_field_samples *samples = apart ? &field->caustic : &field->colour;
  if (samples->channels != 3)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: there is no colour in it; R, G, B or X, Y, Z are wanted", name);
  double from_xyz[9];
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, from_xyz);
  for (size_t i = 0; i < field->width * field->height; i++) {
    double v[3] = {samples->value[3 * i], samples->value[3 * i + 1], samples->value[3 * i + 2]};
    abbe_rgb_space_apply(field->to_xyz, v, v);
    abbe_rgb_space_apply(from_xyz, v, v);
    for (int c = 0; c < 3; c++) rgb[i][c] += factor * v[c];
  }
  return ABBE_OK;
}

abbe_result abbe_outline_load(const char *path, const char *minus,
                              const abbe_outline_options *options, abbe_outline *out,
                              abbe_image place[2], abbe_error *error) {
  abbe_field field = {0}, dark = {0};
  double(*rgb)[3] = NULL;
  abbe_result result = abbe_field_load(path, &field, error);
  if (result == ABBE_OK && minus != NULL) result = abbe_field_load(minus, &dark, error);
  if (result == ABBE_OK && minus != NULL &&
      (field.width != dark.width || field.height != dark.height))
    result = abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s has %zu x %zu pixels and %s %zu x %zu; they must be of one size",
                            path, field.width, field.height, minus, dark.width, dark.height);
  if (result == ABBE_OK && minus != NULL)
    result = abbe_image_check_place(&field.header, path, &dark.header, minus, error);
  for (int i = 0; i < 2; i++) {
    const abbe_image *header = i == 0 ? &field.header : &dark.header;
    place[i] = (abbe_image){.display_window = header->display_window};
    memcpy(place[i].part, header->part, sizeof header->part);
  }
  if (result == ABBE_OK) {
    rgb = calloc(field.width * field.height, sizeof *rgb);
    if (rgb == NULL)
      result = abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for its pixels", path);
  }
  if (result == ABBE_OK) result = add_picture(&field, path, 1, minus == NULL, rgb, error);
  if (result == ABBE_OK && minus != NULL) result = add_picture(&dark, minus, -1, false, rgb, error);
  if (result == ABBE_OK)
    result =
        abbe_outline_make((const double(*)[3])rgb, field.width, field.height, options, out, error);
  free(rgb);
  abbe_field_free(&field);
  abbe_field_free(&dark);
  return result;
}
