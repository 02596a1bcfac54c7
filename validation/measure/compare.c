#include "validation/measure/compare.h"

#include "validation/measure/compare_state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define METRIC_NAME(code, name, text) name,
#define METRIC_TEXT(code, name, text) text,

const char *abbe_compare_metric_name(abbe_compare_metric metric) {
  static const char *const names[] = {ABBE_COMPARE_METRICS(METRIC_NAME)};
  return (unsigned)metric < ABBE_COMPARE_METRIC_COUNT ? names[metric] : "unknown";
}

const char *abbe_compare_metric_text(abbe_compare_metric metric) {
  static const char *const texts[] = {ABBE_COMPARE_METRICS(METRIC_TEXT)};
  return (unsigned)metric < ABBE_COMPARE_METRIC_COUNT ? texts[metric] : "unknown";
}

abbe_compare_metric abbe_compare_metric_find(const char *name) {
  int m = 0;
  while (m < ABBE_COMPARE_METRIC_COUNT &&
         strcmp(name, abbe_compare_metric_name((abbe_compare_metric)m)) != 0)
    m++;
  return (abbe_compare_metric)m;
}

double abbe_compare_deviation(abbe_compare_metric metric, double value) {
  bool ratio = metric == ABBE_COMPARE_ENERGY_RATIO || metric == ABBE_COMPARE_BANDS_ENERGY_RATIO ||
               metric == ABBE_COMPARE_SSIM;
  return ratio ? fabs(value - 1) : value;
}

abbe_compare_verdict abbe_compare_judge(abbe_compare_metric metric,
                                        const abbe_compare_value *value) {
  double deviation = abbe_compare_deviation(metric, value->value);
  if (!isfinite(deviation) || isnan(value->limit)) return ABBE_COMPARE_UNKNOWN;
  if (deviation <= value->limit) return ABBE_COMPARE_BELOW_REFERENCE;
  return deviation <= value->both_limit ? ABBE_COMPARE_BELOW_BOTH : ABBE_COMPARE_ABOVE;
}

/* Which pixels can be compared */

static bool is_finite(const abbe_field_samples *samples, size_t pixel) {
  for (size_t c = 0; c < samples->channels; c++) {
    size_t i = pixel * samples->channels + c;
    if (!isfinite(samples->value[i])) return false;
    if (samples->error != NULL && !(isfinite(samples->error[i]) && samples->error[i] >= 0))
      return false;
  }
  return true;
}

static abbe_result find_bad_pixels(abbe_compare_state *s, abbe_error *error) {
  s->bad = calloc(s->pixels, 1);
  if (s->bad == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory to compare %zu pixels",
                          s->pixels);
  size_t good = 0;
  for (size_t p = 0; p < s->pixels; p++) {
    if (!is_finite(&s->reference->colour, p) || !is_finite(&s->reference->bands, p))
      s->bad[p] |= ABBE_COMPARE_BAD_REFERENCE;
    if (!is_finite(&s->test->colour, p) || !is_finite(&s->test->bands, p))
      s->bad[p] |= ABBE_COMPARE_BAD_TEST;
    good += s->bad[p] == 0;
  }
  if (good > 0) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "there is nothing to compare: no pixel is finite on both sides");
}

static abbe_result check_sides(const abbe_compare_state *s, abbe_error *error) {
  const abbe_field *a = s->reference, *b = s->test;
  const abbe_mask *mask = s->options->mask;
  if (a->width != b->width || a->height != b->height || s->pixels == 0 ||
      a->colour.channels != b->colour.channels || a->bands.channels != b->bands.channels)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "fields of %zu x %zu and %zu x %zu pixels, or of other channels, cannot "
                          "be compared before they are aligned",
                          a->width, a->height, b->width, b->height);
  if (mask == NULL || mask->count == s->pixels) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "the mask has %zu pixels, and what is compared has %zu x %zu", mask->count,
                        a->width, a->height);
}

/* Degrees of freedom of the standard errors: of the side with fewer estimates behind them. */
static double find_freedom(const abbe_field *reference, const abbe_field *test) {
  const abbe_field *sides[] = {reference, test};
  double freedom = 0;
  for (int i = 0; i < 2; i++) {
    bool errors = sides[i]->colour.error != NULL || sides[i]->bands.error != NULL;
    if (!errors || sides[i]->passes < 2) continue;
    double own = (double)sides[i]->passes - 1;
    freedom = freedom == 0 ? own : fmin(freedom, own);
  }
  return freedom;
}

static void count_bad(const abbe_compare_state *s, const abbe_mask *mask,
                      abbe_compare_region *region) {
  for (size_t p = 0; p < s->pixels; p++) {
    if (mask != NULL && !mask->in[p]) continue;
    region->pixels += s->bad[p] == 0;
    region->invalid_reference += (s->bad[p] & ABBE_COMPARE_BAD_REFERENCE) != 0;
    region->invalid_test += (s->bad[p] & ABBE_COMPARE_BAD_TEST) != 0;
  }
}

static void forget(abbe_compare_region *region) {
  for (int m = 0; m < ABBE_COMPARE_METRIC_COUNT; m++)
    region->metric[m] = (abbe_compare_value){NAN, NAN, NAN, NAN, NAN, NAN};
  region->uv_share = NAN;
}

static abbe_result compare(abbe_compare_state *s, abbe_error *error) {
  abbe_comparison *out = s->out;
  const abbe_mask *mask = s->options->mask;
  abbe_result result = find_bad_pixels(s, error);
  if (result == ABBE_OK) result = abbe_compare_find_units(s, error);
  if (result != ABBE_OK) return result;
  out->freedom = find_freedom(s->reference, s->test);
  out->masked = mask != NULL;
  forget(&out->whole);
  forget(&out->mask);
  count_bad(s, NULL, &out->whole);
  result = abbe_compare_light(s, NULL, &out->whole, error);
  if (out->masked) count_bad(s, mask, &out->mask);
  if (out->masked && result == ABBE_OK) result = abbe_compare_light(s, mask, &out->mask, error);
  if (result == ABBE_OK && s->reference->colour.channels > 0)
    result = abbe_compare_colour(s, error);
  if (result == ABBE_OK && s->options->structure && s->reference->colour.channels > 0 &&
      s->reference->kind == ABBE_FIELD_PICTURE)
    result = abbe_compare_structure(s, error);
  return result;
}

abbe_result abbe_compare(const abbe_field *reference, const abbe_field *test,
                         const abbe_compare_options *options, abbe_comparison *out,
                         abbe_error *error) {
  static const abbe_compare_options defaults = {0};
  abbe_comparison comparison = {0};
  *out = comparison;
  abbe_compare_state s = {.reference = reference,
                          .test = test,
                          .options = options == NULL ? &defaults : options,
                          .pixels = reference->width * reference->height,
                          .out = &comparison};
  abbe_result result = check_sides(&s, error);
  if (result == ABBE_OK) result = compare(&s, error);
  free(s.bad);
  if (result == ABBE_OK)
    *out = comparison;
  else
    abbe_comparison_free(&comparison);
  return result;
}

void abbe_comparison_free(abbe_comparison *comparison) {
  if (comparison == NULL) return;
  free(comparison->whole.channel);
  free(comparison->mask.channel);
  *comparison = (abbe_comparison){0};
}
