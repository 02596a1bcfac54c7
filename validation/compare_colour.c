/* The metrics of colour: CIEDE2000 and u'v', and what REF's noise alone makes of them. */
#include "validation/compare_state.h"

#include "colorimetry/difference.h"
#include "colorimetry/rgb_space.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

/* What stands opposite REF: TEST, or REF again with the noise of REF's errors, or of both. */
typedef enum opposite { TEST, NOISE_OF_REFERENCE, NOISE_OF_BOTH } opposite;

/* [Steele2014]: a well-mixed number of a counter. */
static uint64_t mix(uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/* A normal number of a counter, by Box and Muller. */
static double normal(uint64_t seed, uint64_t counter) {
  uint64_t a = mix(mix(seed) ^ (2 * counter)), b = mix(mix(seed) ^ (2 * counter + 1));
  double u = ((double)(a >> 11) + 0.5) * 0x1p-53, v = (double)(b >> 11) * 0x1p-53;
  return sqrt(-2 * log(u)) * cos(6.283185307179586 * v);
}

/* REF's own channels plus noise, in XYZ; the errors of its channels are taken as independent. */
static void add_noise(const abbe_compare_state *s, size_t pixel, bool both, double xyz[3]) {
  const abbe_field *f = s->reference;
  double value[3];
  for (size_t c = 0; c < 3; c++) {
    size_t i = 3 * pixel + c;
    double error = (double)f->colour.error[i];
    if (both) error = hypot(error, s->out->scale * (double)s->test->colour.error[i]);
    value[c] = (double)f->colour.value[i];
    if (error > 0) value[c] += error * normal(s->options->seed, i);
  }
  abbe_rgb_space_apply(f->to_xyz, value, xyz);
}

/* [pixels] each; NaN where there is none. */
typedef struct arrays {
  float *ciede2000, *uv;
} arrays;

static void fill(const abbe_compare_state *s, opposite who, arrays out) {
  const double *white = s->out->white;
  for (size_t p = 0; p < s->pixels; p++) {
    out.ciede2000[p] = out.uv[p] = NAN;
    if (s->bad[p] != 0) continue;
    double b[3], a[3], lab_b[3], lab_a[3], uv_b[2], uv_a[2];
    abbe_field_xyz(s->reference, p, b, NULL);
    if (who == TEST) {
      abbe_field_xyz(s->test, p, a, NULL);
      for (int c = 0; c < 3; c++) a[c] *= s->out->scale;
    } else {
      add_noise(s, p, who == NOISE_OF_BOTH, a);
    }
    abbe_difference_lab(b, white, lab_b);
    abbe_difference_lab(a, white, lab_a);
    out.ciede2000[p] = (float)abbe_difference_ciede2000(lab_b, lab_a);
    if (abbe_difference_uv(b, uv_b) && abbe_difference_uv(a, uv_a))
      out.uv[p] = (float)hypot(uv_b[0] - uv_a[0], uv_b[1] - uv_a[1]);
  }
}

/* A mean and two of its standard deviations above it. */
typedef struct mean {
  double value, limit;
} mean;

static int ascending(const void *a, const void *b) {
  float x = *(const float *)a, y = *(const float *)b;
  return (x > y) - (x < y);
}

/* Mean, 95th percentile and greatest of the region's CIEDE2000; sorted is room for them. */
static size_t order(const abbe_compare_state *s, const abbe_mask *mask, const float *values,
                    float *sorted) {
  size_t count = 0;
  for (size_t p = 0; p < s->pixels; p++)
    if (abbe_compare_has(s, mask, p) && !isnan(values[p])) sorted[count++] = values[p];
  qsort(sorted, count, sizeof *sorted, ascending);
  return count;
}

static mean mean_of(const float *values, size_t count) {
  double sum = 0, squares = 0, n = (double)count;
  for (size_t i = 0; i < count; i++) {
    sum += (double)values[i];
    squares += (double)values[i] * (double)values[i];
  }
  double value = sum / n, variance = fmax(0, squares / n - value * value);
  return (mean){value, value + 2 * sqrt(variance / n)};
}

static mean mean_uv(const abbe_compare_state *s, const abbe_mask *mask, const float *uv,
                    double *share) {
  double sum = 0, squares = 0, weights = 0, all = 0, weights2 = 0;
  for (size_t p = 0; p < s->pixels; p++) {
    double xyz[3];
    if (!abbe_compare_has(s, mask, p)) continue;
    abbe_field_xyz(s->reference, p, xyz, NULL);
    double y = fmax(0, xyz[1]), d = (double)uv[p];
    all += y;
    if (isnan(d)) continue;
    weights += y;
    weights2 += y * y;
    sum += y * d;
    squares += y * d * d;
  }
  *share = weights / all;
  double value = sum / weights, variance = fmax(0, squares / weights - value * value);
  return (mean){value, value + 2 * sqrt(variance * weights2) / weights};
}

static void set(abbe_compare_value *v, opposite who, mean m) {
  if (who == TEST) {
    v->value = m.value;
  } else if (who == NOISE_OF_REFERENCE) {
    v->noise = m.value;
    v->limit = m.limit;
  } else {
    v->both_noise = m.value;
    v->both_limit = m.limit;
  }
}

static void summarise(const abbe_compare_state *s, const abbe_mask *mask, opposite who,
                      arrays values, float *sorted, abbe_compare_region *region) {
  abbe_compare_value *metric = region->metric;
  size_t count = order(s, mask, values.ciede2000, sorted);
  if (count == 0) return;
  double p95 = (double)sorted[(95 * count + 99) / 100 - 1], top = (double)sorted[count - 1];
  set(&metric[ABBE_COMPARE_CIEDE2000_MEAN], who, mean_of(sorted, count));
  set(&metric[ABBE_COMPARE_CIEDE2000_P95], who, (mean){p95, p95});
  set(&metric[ABBE_COMPARE_CIEDE2000_MAX], who, (mean){top, top});
  double share;
  mean uv = mean_uv(s, mask, values.uv, &share);
  set(&metric[ABBE_COMPARE_UV_MEAN], who, uv);
  if (who == TEST) region->uv_share = share;
}

static void measure(const abbe_compare_state *s, arrays values, float *sorted) {
  bool errors[] = {true, s->reference->colour.error != NULL,
                   s->reference->colour.error != NULL && s->test->colour.error != NULL};
  for (int who = TEST; who <= NOISE_OF_BOTH; who++) {
    if (!errors[who]) continue;
    fill(s, (opposite)who, values);
    summarise(s, NULL, (opposite)who, values, sorted, &s->out->whole);
    if (s->out->masked)
      summarise(s, s->options->mask, (opposite)who, values, sorted, &s->out->mask);
  }
}

abbe_result abbe_compare_colour(const abbe_compare_state *s, abbe_error *error) {
  float *room = calloc(s->pixels, 3 * sizeof *room);
  if (room == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for %zu colour differences",
                          s->pixels);
  measure(s, (arrays){room, room + s->pixels}, room + 2 * s->pixels);
  free(room);
  return ABBE_OK;
}
