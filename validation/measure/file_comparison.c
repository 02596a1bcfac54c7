#include "validation/measure/file_comparison.h"

#include "base/file.h"
#include "base/number.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/image/png_file.h"

#include <assert.h>
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void
note(abbe_compare_notes *out, const char *format, ...) {
  if (out->count == ABBE_COMPARE_MAX_NOTES) return;
  va_list arguments;
  va_start(arguments, format);
  abbe_number_format_list(out->note[out->count++], sizeof out->note[0], format, arguments);
  va_end(arguments);
}

static void note_files(abbe_compare_notes *out, const abbe_file_comparison *r) {
  static const char *const keys[] = {"abbe:scene", "abbe:unit"};
  for (int side = 0; side < 2; side++)
    if (r->field[side].space_assumed)
      note(out,
           "%.150s does not say its colour space; Rec.709 primaries are assumed, as OpenEXR does",
           r->path[side]);
  for (int side = 0; side < 2; side++)
    if (r->field[side].unread > 0)
      note(
          out,
          "left out are %zu channels of a spectrum in %.150s: of polarised light, re-radiation, or "
          "not named as bands are",
          r->field[side].unread, r->path[side]);
  for (int k = 0; k < 2; k++) {
    const char *a = abbe_file_comparison_attribute(r, 0, keys[k]),
               *b = abbe_file_comparison_attribute(r, 1, keys[k]);
    if (a != NULL && b != NULL && strcmp(a, b) != 0)
      note(out, "the files differ in %s: '%.100s' and '%.100s'", keys[k], a, b);
  }
  for (int side = 0; side < 2; side++) {
    const abbe_field *f = &r->field[side];
    if (r->size[side][0] != f->width || r->size[side][1] != f->height)
      note(out, "%.150s was summed down from %zu x %zu texels", r->path[side], r->size[side][0],
           r->size[side][1]);
  }
}

static void note_observers(abbe_compare_notes *out, const abbe_file_comparison *r) {
  const abbe_observer a = r->field[0].observer, b = r->field[1].observer;
  if (r->field[0].colour.channels == 0) return;
  if (a != b)
    note(out,
         "the files are for two observers, %s and %s: they differ even where they show the same "
         "light",
         abbe_observer_text(a), abbe_observer_text(b));
  else if (a != ABBE_OBSERVER_CIE_1931)
    note(out,
         "both are for the observer %s; u', v', ICtCp and FLIP are defined for the one of 1931",
         abbe_observer_text(a));
}

static void note_units(abbe_compare_notes *out, const abbe_file_comparison *r) {
  const abbe_comparison *c = &r->comparison;
  bool colour = r->field[0].colour.channels > 0;
  if (c->scale != 1)
    note(out,
         "the test was multiplied by %.6g, the factor of least squares; its own energy ratio is "
         "the table's divided by it",
         c->scale);
  note(out, "0.01 in (a-b)^2/(b+0.01)^2 is a hundredth of the reference's mean %s, %.4g",
       colour ? "Y" : "over bands", c->unit);
  if (colour && c->white_found)
    note(out,
         "the white of CIEDE2000 is D65 at Y = %.4g, which the brightest 1 %% of the "
         "reference's lit pixels reach",
         c->white[1]);
  else if (colour)
    note(out, "the white of CIEDE2000 is XYZ = %.4g, %.4g, %.4g, as given", c->white[0],
         c->white[1], c->white[2]);
}

static void note_errors(abbe_compare_notes *out, const abbe_file_comparison *r) {
  const abbe_comparison *c = &r->comparison;
  const abbe_ztest *z = &c->whole.z;
  if (!abbe_file_comparison_has_errors(r, 0))
    note(out, "the reference has no standard errors, so nothing tells its noise from a difference");
  else if (!r->field[0].is_xyz && r->field[0].colour.error != NULL)
    note(out, "noise of X, Y, Z is told from R, G, B at the most, for errors that go together");
  if (c->freedom > 0)
    note(out, "the Z-test takes the standard errors to rest on %.0f estimates (Student's t)",
         c->freedom + 1);
  if (z->untested > 0 && z->count > 0)
    note(out,
         "%zu of %zu samples have no standard error, so they are not in the Z-test; %zu of them "
         "differ",
         z->untested, z->untested + z->count, z->untested_differ);
  const char *seed[2] = {abbe_file_comparison_attribute(r, 0, "abbe:seed"),
                         abbe_file_comparison_attribute(r, 1, "abbe:seed")};
  if (seed[0] != NULL && seed[1] != NULL && strcmp(seed[0], seed[1]) == 0 &&
      abbe_file_comparison_has_errors(r, 0) && abbe_file_comparison_has_errors(r, 1))
    note(out,
         "both were traced with the seed %.20s: noise that they share does not show in their "
         "difference, and less of it is there than is told",
         seed[0]);
  if (c->whole.invalid_reference > 0 || c->whole.invalid_test > 0)
    note(out, "left out: %zu pixels that are not finite in the reference, %zu in the test",
         c->whole.invalid_reference, c->whole.invalid_test);
}

/* Which metrics of light and colour noise explains, in one sentence a region. */
static void note_noise(abbe_compare_notes *out, const abbe_file_comparison *r, bool mask) {
  static const char *const of[] = {"the reference's own noise", "the noise of both"};
  for (int who = 0; who < 2; who++) {
    char list[300] = "";
    size_t used = 0;
    for (int m = 0; m < ABBE_COMPARE_Z_OVER_2; m++) {
      const abbe_compare_value *v = &abbe_file_comparison_region(r, mask)->metric[m];
      abbe_compare_verdict verdict = abbe_compare_judge((abbe_compare_metric)m, v);
      if (verdict != (who == 0 ? ABBE_COMPARE_BELOW_REFERENCE : ABBE_COMPARE_BELOW_BOTH)) continue;
      int n = snprintf(list + used, sizeof list - used, "%s%s", used > 0 ? ", " : "",
                       abbe_compare_metric_text((abbe_compare_metric)m));
      used += n > 0 && used + (size_t)n < sizeof list ? (size_t)n : 0;
    }
    if (used > 0)
      note(out, "%s: the difference is below %s in %s", mask ? r->mask_name : "whole field",
           of[who], list);
  }
}

static void note_z(abbe_compare_notes *out, const abbe_file_comparison *r, bool mask) {
  const abbe_compare_region *region = abbe_file_comparison_region(r, mask);
  if (region->z.count == 0) return;
  bool within = region->z.max <= region->z_critical;
  note(out,
       "%s: the greatest |z| of %zu is %.3g; up to %.3g noise explains it (%g %% chance of one "
       "above): the two %s",
       mask ? r->mask_name : "whole field", region->z.count, region->z.max, region->z_critical,
       100 * ABBE_ZTEST_LEVEL, within ? "agree within their errors" : "differ by more than noise");
}

void abbe_compare_notes_make(const abbe_file_comparison *comparison, abbe_compare_notes *out) {
  *out = (abbe_compare_notes){.count = 0};
  note_files(out, comparison);
  note_observers(out, comparison);
  note_units(out, comparison);
  note_errors(out, comparison);
  for (int mask = 0; mask <= (comparison->comparison.masked ? 1 : 0); mask++) {
    note_noise(out, comparison, mask);
    note_z(out, comparison, mask);
  }
}

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
  if (range == 0)
    ABBE_TRY(abbe_difference_picture_range(&c->field[0], &c->field[1], scale, &range, error));
  if (range == 0) range = c->comparison.unit; /* nothing differs */
  return abbe_difference_picture_write(path, &c->field[0], &c->field[1], scale, range, title,
                                       error);
}
