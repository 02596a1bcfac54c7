#include "validation/compare/file_comparison.h"

#include "base/file.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/png_file.h"
#include "validation/compare/difference_picture.h"

#include <assert.h>
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static bool ends_with_png(const char *path) {
  size_t n = strlen(path);
  return n > 4 && path[n - 4] == '.' && tolower((unsigned char)path[n - 3]) == 'p' &&
         tolower((unsigned char)path[n - 2]) == 'n' && tolower((unsigned char)path[n - 1]) == 'g';
}

static abbe_result load_mask(const abbe_file_comparison_desc *q, abbe_file_comparison *w,
                             abbe_error *error) {
  const abbe_field *reference = &w->field[0];
  abbe_image image = {0};
  abbe_error why = {0};
  const bool png = ends_with_png(q->mask);
  abbe_result result =
      png ? abbe_png_read(q->mask, &image, error) : abbe_exr_read(q->mask, &image, error);
  if (result != ABBE_OK) return result;
  if (image.width != reference->width || image.height != reference->height)
    result =
        abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                       "%s: the mask has %zu x %zu pixels; what is compared has %zu x %zu", q->mask,
                       image.width, image.height, reference->width, reference->height);
  else if (!png) /* a PNG says of no place where it lies */
    result = abbe_image_check_place(&image, q->mask, &reference->header, q->path[0], error);
  if (result == ABBE_OK && abbe_mask_make_drawn(&image, &w->mask, &why) != ABBE_OK)
    result = abbe_error_set(error, why.code, "%s: %.400s", q->mask, why.text);
  memcpy(w->mask_part, image.part, sizeof w->mask_part);
  abbe_image_free(&image);
  return result;
}

static abbe_result find_mask(const abbe_file_comparison_desc *q, abbe_file_comparison *w,
                             abbe_error *error) {
  if (q->mask == NULL) return ABBE_OK;
  if (strcmp(q->mask, "caustic") == 0)
    return abbe_mask_make_caustic(&w->field[0], q->path[0], q->mask_share, &w->mask, error);
  return load_mask(q, w, error);
}

static abbe_result compare(const abbe_file_comparison_desc *q, abbe_file_comparison *w,
                           abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (int side = 0; side < 2 && result == ABBE_OK; side++) {
    result = abbe_field_load(q->path[side], &w->field[side], error);
    w->size[side][0] = w->field[side].width;
    w->size[side][1] = w->field[side].height;
  }
  if (result == ABBE_OK)
    result = abbe_field_align(&w->field[0], q->path[0], &w->field[1], q->path[1], error);
  if (result == ABBE_OK) result = find_mask(q, w, error);
  abbe_compare_options options = q->options;
  if (q->mask != NULL) options.mask = &w->mask;
  abbe_error why = {0};
  if (result == ABBE_OK &&
      abbe_compare(&w->field[0], &w->field[1], &options, &w->comparison, &why) != ABBE_OK)
    result = abbe_error_set(error, why.code, "%s and %s: %.600s", q->path[0], q->path[1], why.text);
  return result;
}

abbe_result abbe_file_comparison_make(const abbe_file_comparison_desc *desc,
                                      abbe_file_comparison *out, abbe_error *error) {
  assert(desc->path[0] && desc->path[1]);
  const bool found = desc->mask != NULL && strcmp(desc->mask, "caustic") == 0;
  *out = (abbe_file_comparison){.path = {desc->path[0], desc->path[1]},
                                .mask_name = desc->mask,
                                .mask_share = found ? desc->mask_share : 0};
  abbe_result result = compare(desc, out, error);
  if (result != ABBE_OK) abbe_file_comparison_free(out);
  return result;
}

void abbe_file_comparison_free(abbe_file_comparison *c) {
  if (c == NULL) return;
  abbe_comparison_free(&c->comparison);
  abbe_mask_free(&c->mask);
  abbe_field_free(&c->field[0]);
  abbe_field_free(&c->field[1]);
}

const char *abbe_file_comparison_attribute(const abbe_file_comparison *c, int side,
                                           const char *key) {
  return abbe_image_attribute_text(&c->field[side].header, key);
}

const abbe_compare_region *abbe_file_comparison_region(const abbe_file_comparison *c, bool mask) {
  return mask ? &c->comparison.mask : &c->comparison.whole;
}

bool abbe_file_comparison_has_errors(const abbe_file_comparison *c, int side) {
  return c->field[side].colour.error != NULL || c->field[side].bands.error != NULL;
}

/* What a tolerance bounds must be known: a bound that is not looked at would be kept for ever. */
abbe_result abbe_file_comparison_check(const abbe_file_comparison *c,
                                       const abbe_compare_tolerance *tolerance, size_t count,
                                       abbe_error *error) {
  for (size_t i = 0; i < count; i++) {
    const abbe_compare_tolerance *t = &tolerance[i];
    const abbe_compare_region *region = abbe_file_comparison_region(c, t->mask);
    if (!isnan(region->metric[t->metric].value) || region->invalid_test > 0) continue;
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "--tolerance %s: it is not known for %s and %s (bands and standard "
                          "errors must be there, and light in the region)",
                          abbe_compare_metric_name(t->metric), c->path[0], c->path[1]);
  }
  return ABBE_OK;
}

bool abbe_file_comparison_keeps(const abbe_file_comparison *c, const abbe_compare_tolerance *t) {
  const abbe_compare_region *region = abbe_file_comparison_region(c, t->mask);
  return region->invalid_test == 0 &&
         abbe_compare_deviation(t->metric, region->metric[t->metric].value) <= t->tolerance;
}

/* The first tolerance that is not kept, and how many more. */
abbe_result abbe_file_comparison_judge(const abbe_file_comparison *c,
                                       const abbe_compare_tolerance *tolerance, size_t count,
                                       abbe_error *error) {
  const abbe_compare_tolerance *first = NULL;
  size_t failed = 0;
  for (size_t i = 0; i < count; i++) {
    if (abbe_file_comparison_keeps(c, &tolerance[i])) continue;
    if (failed++ == 0) first = &tolerance[i];
  }
  if (failed == 0) return ABBE_OK;
  const abbe_compare_region *region = abbe_file_comparison_region(c, first->mask);
  char more[64] = "", bad[64] = "";
  if (failed > 1) snprintf(more, sizeof more, "; %zu more are out of tolerance", failed - 1);
  if (region->invalid_test > 0)
    snprintf(bad, sizeof bad, " and %zu pixels are not finite", region->invalid_test);
  return abbe_error_set(
      error, ABBE_TOLERANCE, "%s: %s of the %s is %.4g%s, out of the tolerance of %g%s", c->path[1],
      abbe_compare_metric_name(first->metric), first->mask ? "mask" : "whole field",
      region->metric[first->metric].value, bad, first->tolerance, more);
}

abbe_result abbe_file_comparison_draw(const abbe_file_comparison *c, const char *path, double range,
                                      abbe_error *error) {
  assert(c->path[0] && c->path[1]);
  const double scale = c->comparison.scale;
  char title[160];
  snprintf(title, sizeof title, "%.70s less %.70s", abbe_file_name(c->path[1]),
           abbe_file_name(c->path[0]));
  abbe_result result = ABBE_OK;
  if (range == 0)
    result = abbe_difference_picture_range(&c->field[0], &c->field[1], scale, &range, error);
  if (range == 0) range = c->comparison.unit; /* nothing differs */
  if (result == ABBE_OK)
    result =
        abbe_difference_picture_write(path, &c->field[0], &c->field[1], scale, range, title, error);
  return result;
}
