#include "validation/measure/compare.h"

#include "base/maths.h"
#include "colorimetry/rgb_space.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

static double light_of(double value) {
  return value > 0 && isfinite(value) ? value : 0;
}

static abbe_result make_empty(size_t count, abbe_mask *mask, abbe_error *error) {
  *mask = (abbe_mask){.count = count, .in = calloc(count, 1)};
  if (mask->in != NULL) return ABBE_OK;
  return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for a mask of %zu pixels",
                        count);
}

/* What the faintest element inside holds, and how many elements are inside. */
typedef struct threshold {
  double faintest;
  size_t inside;
} threshold;

static threshold find_threshold(const double *sorted, size_t count, double share) {
  double total = 0, held = 0;
  for (size_t i = count; i-- > 0;) total += sorted[i];
  threshold found = {0};
  while (found.inside < count && sorted[found.inside] > 0 &&
         (found.inside == 0 || held < share * total)) {
    found.faintest = sorted[found.inside++];
    held += found.faintest;
  }
  return found;
}

static void fill(const double *light, threshold t, abbe_mask *mask) {
  size_t brighter = 0;
  for (size_t i = 0; i < mask->count; i++) brighter += light_of(light[i]) > t.faintest;
  size_t equals = t.inside - brighter;
  for (size_t i = 0; i < mask->count; i++) {
    double value = light_of(light[i]);
    bool equal = value == t.faintest && equals > 0;
    if (equal) equals--;
    mask->in[i] = value > t.faintest || equal;
  }
  mask->inside = t.inside;
}

abbe_result abbe_mask_make_brightest(const double *light, size_t count, double share,
                                     abbe_mask *out, abbe_error *error) {
  *out = (abbe_mask){0};
  if (count < 1 || count > SIZE_MAX / sizeof(double) || !(share > 0 && share <= 1))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a mask of %zu pixels that holds %g of the light cannot be made; it has "
                          "one pixel or more, and a share above 0 and at most 1",
                          count, share);
  double *sorted = malloc(count * sizeof *sorted);
  if (sorted == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory to sort %zu pixels", count);
  for (size_t i = 0; i < count; i++) sorted[i] = light_of(light[i]);
  qsort(sorted, count, sizeof *sorted, abbe_order_descending);
  threshold t = find_threshold(sorted, count, share);
  free(sorted);
  if (t.inside == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "there is no light to find a mask by: all %zu pixels are dark", count);
  ABBE_TRY(make_empty(count, out, error));
  fill(light, t, out);
  return ABBE_OK;
}

static double caustic_light(const abbe_field *f, size_t pixel) {
  if (f->kind == ABBE_FIELD_PICTURE) {
    const float *v = f->caustic.value + 3 * pixel;
    const double rgb[3] = {v[0], v[1], v[2]};
    double xyz[3];
    abbe_rgb_space_apply(f->to_xyz, rgb, xyz);
    return xyz[1];
  }
  if (f->colour.channels > 0) {
    double xyz[3];
    abbe_field_xyz(f, pixel, xyz, NULL);
    return xyz[1];
  }
  double sum = 0;
  for (size_t c = 0; c < f->bands.channels; c++)
    sum += (double)f->bands.value[pixel * f->bands.channels + c];
  return sum;
}

abbe_result abbe_mask_make_caustic(const abbe_field *field, const char *name, double share,
                                   abbe_mask *out, abbe_error *error) {
  *out = (abbe_mask){0};
  if (field->kind == ABBE_FIELD_PICTURE && field->caustic.channels == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: a picture without the layers caustic.* does not tell where its "
                          "caustic is; a picture of 'abbe trace' or of 'abbe render --aovs' "
                          "does, and so does a mask that is drawn",
                          name);
  size_t count = field->width * field->height;
  double *light = count > SIZE_MAX / sizeof *light ? NULL : malloc(count * sizeof *light);
  if (light == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for a mask of %zu pixels",
                          count);
  for (size_t i = 0; i < count; i++) light[i] = caustic_light(field, i);
  abbe_error why = {0};
  abbe_result result = abbe_mask_make_brightest(light, count, share, out, &why);
  free(light);
  if (result == ABBE_OK) return ABBE_OK;
  return abbe_error_set(error, result, "%s: its caustic has no mask: %.400s", name, why.text);
}

static size_t drawn_channel(const abbe_image *image) {
  static const char *const names[] = {"R", "Y"};
  for (int i = 0; i < 2; i++) {
    size_t channel = abbe_image_find_channel(image, names[i]);
    if (channel != (size_t)-1) return channel;
  }
  return 0;
}

abbe_result abbe_mask_make_drawn(const abbe_image *image, abbe_mask *out, abbe_error *error) {
  *out = (abbe_mask){0};
  if (image->data == NULL || image->channels == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the picture of a mask is empty");
  size_t channel = drawn_channel(image);
  abbe_mask mask = {0};
  ABBE_TRY(make_empty(image->width * image->height, &mask, error));
  for (size_t i = 0; i < mask.count; i++) {
    mask.in[i] = image->data[i * image->channels + channel] > 0.5f;
    mask.inside += mask.in[i];
  }
  if (mask.inside == 0) {
    abbe_mask_free(&mask);
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the mask holds no pixel: its channel '%s' is nowhere above 0.5",
                          image->channel[channel]);
  }
  *out = mask;
  return ABBE_OK;
}

void abbe_mask_free(abbe_mask *mask) {
  if (mask == NULL) return;
  free(mask->in);
  *mask = (abbe_mask){0};
}
