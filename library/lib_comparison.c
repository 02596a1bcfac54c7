#include "library/lib_comparison.h"

#include "library/lib_handles.h"
#include "library/lib_settings.h"
#include "validation/measure/compare.h"
#include "validation/measure/file_comparison.h"

#include <math.h>
#include <stdlib.h>

struct abbe_lib_comparison {
  abbe_field field[2];
  abbe_mask mask;
  abbe_comparison comparison;
};

static const char *const sides[] = {"the reference", "the test"};

typedef struct request {
  double mask_share;
  size_t seed;
  bool best_scale, structure;
  int caustic;
} request;

static abbe_result read_request(const char *const *settings, size_t count, bool drawn, request *q,
                                abbe_error *error) {
  static const char *const masks[] = {"caustic"};
  q->caustic = -1;
  const abbe_lib_setting known[] = {ABBE_LIB_CHOICE("mask", &q->caustic, masks),
                                    ABBE_LIB_NUMBER("mask_share", &q->mask_share, 1e-6, 1),
                                    ABBE_LIB_FLAG("best_scale", &q->best_scale),
                                    ABBE_LIB_FLAG("structure", &q->structure),
                                    ABBE_LIB_COUNT("seed", &q->seed, 0, 9e15)};
  ABBE_TRY(abbe_library_settings_read("compare", known, sizeof known / sizeof *known, settings,
                                      count, error));
  if (drawn && q->caustic == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "compare: a drawn mask and mask=caustic; only one can be taken");
  return ABBE_OK;
}

static abbe_result find_mask(const request *q, const abbe_lib_picture *drawn,
                             abbe_lib_comparison *c, abbe_error *error) {
  const abbe_field *reference = &c->field[0];
  if (q->caustic == 0)
    return abbe_mask_make_caustic(reference, sides[0], q->mask_share, &c->mask, error);
  if (drawn == NULL) return ABBE_OK;
  if (drawn->image.width != reference->width || drawn->image.height != reference->height)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the mask has %zu x %zu pixels; what is compared has %zu x %zu",
                          drawn->image.width, drawn->image.height, reference->width,
                          reference->height);
  return abbe_mask_make_drawn(&drawn->image, &c->mask, error);
}

static abbe_result compare(const request *q, const abbe_lib_picture *const picture[2],
                           const abbe_lib_picture *drawn, abbe_lib_comparison *c,
                           abbe_error *error) {
  for (int side = 0; side < 2; side++)
    ABBE_TRY(abbe_field_make(&picture[side]->image, sides[side], &c->field[side], error));
  ABBE_TRY(abbe_field_align(&c->field[0], sides[0], &c->field[1], sides[1], error));
  ABBE_TRY(find_mask(q, drawn, c, error));
  const abbe_compare_options options = {.mask = c->mask.count > 0 ? &c->mask : NULL,
                                        .best_scale = q->best_scale,
                                        .structure = q->structure,
                                        .seed = q->seed};
  return abbe_compare(&c->field[0], &c->field[1], &options, &c->comparison, error);
}

abbe_result abbe_lib_comparison_make(const abbe_lib_picture *reference,
                                     const abbe_lib_picture *test, const abbe_lib_picture *mask,
                                     const char *const *settings, size_t count,
                                     abbe_lib_comparison **out, abbe_error *error) {
  ABBE_REQUIRE(reference && test && (settings || count == 0) && out, error);
  request q = {.mask_share = ABBE_MASK_CAUSTIC_SHARE};
  *out = NULL;
  ABBE_TRY(read_request(settings, count, mask != NULL, &q, error));
  abbe_lib_comparison *c = calloc(1, sizeof *c);
  if (c == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory to compare");
  abbe_result result =
      compare(&q, (const abbe_lib_picture *const[]){reference, test}, mask, c, error);
  if (result == ABBE_OK)
    *out = c;
  else
    abbe_lib_comparison_free(c);
  return result;
}

void abbe_lib_comparison_free(abbe_lib_comparison *c) {
  if (c == NULL) return;
  abbe_comparison_free(&c->comparison);
  abbe_mask_free(&c->mask);
  abbe_field_free(&c->field[0]);
  abbe_field_free(&c->field[1]);
  free(c);
}

const char *abbe_lib_comparison_metric(size_t index) {
  const bool is_one = index < ABBE_COMPARE_METRIC_COUNT;
  return is_one ? abbe_compare_metric_name((abbe_compare_metric)index) : NULL;
}

static const abbe_compare_region *region_of(const abbe_lib_comparison *c, bool masked) {
  return masked ? &c->comparison.mask : &c->comparison.whole;
}

abbe_result abbe_lib_comparison_value(const abbe_lib_comparison *c, const char *metric, bool masked,
                                      double *value, double *noise, double *limit,
                                      abbe_error *error) {
  ABBE_REQUIRE(c && metric && value && noise && limit, error);
  const abbe_compare_metric which = abbe_compare_metric_find(metric);
  if (which == ABBE_COMPARE_METRIC_COUNT)
    return abbe_error_set(error, ABBE_NOT_FOUND, "'%.60s' is no metric of comparisons", metric);
  if (masked && !c->comparison.masked)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the comparison has no mask; make it with mask=caustic or a drawn one");
  const abbe_compare_value *v = &region_of(c, masked)->metric[which];
  *value = v->value;
  *noise = v->noise;
  *limit = v->limit;
  return ABBE_OK;
}

double abbe_lib_comparison_both_noise(const abbe_lib_comparison *c, const char *metric,
                                      bool masked) {
  if (c == NULL || metric == NULL || (masked && !c->comparison.masked)) return NAN;
  const abbe_compare_metric which = abbe_compare_metric_find(metric);
  return which == ABBE_COMPARE_METRIC_COUNT ? NAN : region_of(c, masked)->metric[which].both_noise;
}

double abbe_lib_comparison_scale(const abbe_lib_comparison *c) {
  return c == NULL ? NAN : c->comparison.scale;
}

const char *abbe_lib_comparison_verdict(const abbe_lib_comparison *c, const char *metric,
                                        bool masked) {
  if (c == NULL || metric == NULL || (masked && !c->comparison.masked)) return NULL;
  const abbe_compare_metric which = abbe_compare_metric_find(metric);
  if (which == ABBE_COMPARE_METRIC_COUNT) return NULL;
  switch (abbe_compare_judge(which, &region_of(c, masked)->metric[which])) {
  case ABBE_COMPARE_BELOW_REFERENCE:
    return "below the reference's noise";
  case ABBE_COMPARE_BELOW_BOTH:
    return "below the noise of both";
  case ABBE_COMPARE_ABOVE:
    return "above the noise";
  default:
    return "unknown";
  }
}

size_t abbe_lib_comparison_pixels(const abbe_lib_comparison *c, bool masked) {
  return c == NULL || (masked && !c->comparison.masked) ? 0 : region_of(c, masked)->pixels;
}

abbe_result abbe_lib_comparison_draw(const abbe_lib_comparison *c, const char *path, double range,
                                     const char *title, abbe_error *error) {
  ABBE_REQUIRE(c && path, error);
  const abbe_field *reference = &c->field[0], *test = &c->field[1];
  const double scale = c->comparison.scale;
  abbe_result result = ABBE_OK;
  if (range == 0) result = abbe_difference_picture_range(reference, test, scale, &range, error);
  if (range == 0) range = c->comparison.unit; /* nothing differs */
  return result == ABBE_OK
             ? abbe_difference_picture_write(path, reference, test, scale, range, title, error)
             : result;
}
