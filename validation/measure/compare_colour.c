/* The metrics of colour, pixel by pixel, and what REF's noise alone makes of them. */
#include "validation/measure/compare_state.h"

#include "base/maths.h"
#include "colorimetry/difference.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

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

/* X / Y or Z / Y of the pixels around one: their mean, how they vary, and how errors of X, Y and Z
 * that are independent would make them vary; all weighted by Y. */
typedef struct tint {
  double weight, sum, squares, noise;
} tint;

static void add_tint(const double xyz[3], const double error[3], int c, tint *t) {
  double ratio = xyz[c] / xyz[1];
  t->weight += xyz[1];
  t->sum += xyz[c];
  t->squares += xyz[c] * ratio;
  t->noise += (error[c] * error[c] + ratio * ratio * error[1] * error[1]) / xyz[1];
}

/* REF at a pixel less what its noise does to its tint. */
typedef struct quiet {
  double xyz[3];
  double together[3]; /* correlation of the errors of X and of Z with that of Y */
} quiet;

/* The tint of the pixels around where they vary no more than their errors explain, the pixel's own
 * where they vary much more, and in between by their variances [Lee1980]. Where they vary less than
 * independent errors would make them, the errors go together: by how much follows. So few pixels
 * give a variance to a quarter or so; it is taken larger by that, lest chance be taken for
 * togetherness. */
static void quieten_tint(const tint *t, const double error[3], int c, quiet *q) {
  double mean = t->sum / t->weight, independent = t->noise / t->weight;
  double variance = fmax(0, t->squares / t->weight - mean * mean);
  double keep = variance > 0 ? fmax(0, variance - independent) / variance : 0;
  double ratio = mean + keep * (q->xyz[c] / q->xyz[1] - mean);
  double less = independent > 0 ? fmax(0, 1 - 1.3 * variance / independent) : 0;
  double own = error[c] * error[c] + ratio * ratio * error[1] * error[1];
  double most = 2 * ratio * error[c] * error[1];
  q->together[c] = most > 0 ? fmin(1, less * own / most) : 0;
  q->xyz[c] = q->xyz[1] * ratio;
}

/* Noise drawn about REF itself would be drawn about colours that noise has tinted, and there
 * differences of colour count less than about the true ones. */
static quiet quieten(const abbe_compare_state *s, size_t pixel) {
  enum { REACH = 2 };
  const abbe_field *f = s->reference;
  size_t x = pixel % f->width, y = pixel / f->width;
  tint t[3] = {{0}};
  quiet q = {0};
  double own_error[3];
  abbe_field_xyz(f, pixel, q.xyz, own_error);
  if (!(q.xyz[1] > 0)) return q;
  for (size_t j = y > REACH ? y - REACH : 0; j <= y + REACH && j < f->height; j++)
    for (size_t i = x > REACH ? x - REACH : 0; i <= x + REACH && i < f->width; i++) {
      double near[3], error[3];
      if (s->bad[j * f->width + i] != 0) continue;
      abbe_field_xyz(f, j * f->width + i, near, error);
      for (int c = 0; c < 3 && near[1] > 0; c += 2) add_tint(near, error, c, &t[c]);
    }
  for (int c = 0; c < 3; c += 2) quieten_tint(&t[c], own_error, c, &q);
  return q;
}

/* Adds noise of the errors of a field of the same pixels. */
static void add_noise(const abbe_compare_state *s, const abbe_field *field, double scale,
                      uint64_t stream, size_t pixel, const quiet *q, double xyz[3]) {
  double value[3], error[3], drawn[3];
  abbe_field_xyz(field, pixel, value, error);
  for (size_t c = 0; c < 3; c++)
    drawn[c] = error[c] > 0 ? normal(s->options->seed, 2 * (3 * pixel + c) + stream) : 0;
  xyz[1] += scale * error[1] * drawn[1];
  for (int c = 0; c < 3; c += 2) {
    double r = q->together[c];
    xyz[c] += scale * error[c] * (r * drawn[1] + sqrt(1 - r * r) * drawn[c]);
  }
}

/* The metrics that are means of a value a pixel. */
enum { CIEDE2000, CIE76, CIE94, ITP, UV, KINDS };
static const abbe_compare_metric mean_metric[UV] = {ABBE_COMPARE_CIEDE2000_MEAN,
                                                    ABBE_COMPARE_CIE76_MEAN,
                                                    ABBE_COMPARE_CIE94_MEAN, ABBE_COMPARE_ITP_MEAN};

/* [pixels] each; NaN where there is none. */
typedef struct arrays {
  float *of[KINDS];
} arrays;

void abbe_compare_take_sides(const abbe_compare_state *s, abbe_compare_sides who, size_t pixel,
                             double b[3], double a[3]) {
  if (who == ABBE_COMPARE_TEST) {
    abbe_field_xyz(s->reference, pixel, b, NULL);
    abbe_field_xyz(s->test, pixel, a, NULL);
    for (int c = 0; c < 3; c++) a[c] *= s->out->scale;
    return;
  }
  quiet q = quieten(s, pixel);
  for (int c = 0; c < 3; c++) b[c] = a[c] = q.xyz[c];
  add_noise(s, s->reference, 1, 0, pixel, &q, b);
  if (who == ABBE_COMPARE_NOISE_OF_BOTH) add_noise(s, s->test, s->out->scale, 1, pixel, &q, a);
}

bool abbe_compare_knows(const abbe_compare_state *s, abbe_compare_sides who) {
  return who == ABBE_COMPARE_TEST ||
         (s->reference->colour.error != NULL &&
          (who == ABBE_COMPARE_NOISE_OF_REFERENCE || s->test->colour.error != NULL));
}

static double itp(const double b[3], const double a[3], double white_y) {
  const double unit = ABBE_DIFFERENCE_HDR_WHITE / white_y;
  double ictcp[2][3];
  for (int side = 0; side < 2; side++) {
    double light[3];
    for (int c = 0; c < 3; c++) light[c] = unit * (side == 0 ? b : a)[c];
    abbe_difference_ictcp(light, ictcp[side]);
  }
  return abbe_difference_itp(ictcp[0], ictcp[1]);
}

static void fill(const abbe_compare_state *s, abbe_compare_sides who, arrays out) {
  const double *white = s->out->white;
  for (size_t p = 0; p < s->pixels; p++) {
    for (int k = 0; k < KINDS; k++) out.of[k][p] = NAN;
    if (s->bad[p] != 0) continue;
    double b[3], a[3], lab_b[3], lab_a[3], uv_b[2], uv_a[2];
    abbe_compare_take_sides(s, who, p, b, a);
    abbe_difference_lab(b, white, lab_b);
    abbe_difference_lab(a, white, lab_a);
    out.of[CIEDE2000][p] = (float)abbe_difference_ciede2000(lab_b, lab_a);
    out.of[CIE76][p] = (float)abbe_difference_cie76(lab_b, lab_a);
    out.of[CIE94][p] = (float)abbe_difference_cie94(lab_b, lab_a);
    out.of[ITP][p] = (float)itp(b, a, white[1]);
    if (abbe_difference_uv(b, uv_b) && abbe_difference_uv(a, uv_a))
      out.of[UV][p] = (float)hypot(uv_b[0] - uv_a[0], uv_b[1] - uv_a[1]);
  }
}

/* A mean, and two standard deviations of it above it. */
typedef struct mean {
  double value, limit;
} mean;

/* Magnitudes of errors, of one sign or of two components, spread by 0.2 to 0.4 of their mean
 * square (half-normal: 1 - 2/pi); what pixels differ by beyond that is theirs and not chance. */
static const double spread = 0.4;

static mean weighted_mean(double sum, double weights, double weighted_squares) {
  double value = sum / weights;
  return (mean){value, value + 2 * sqrt(spread * weighted_squares) / weights};
}

/* The region's values in ascending order; sorted has capacity for them. */
static size_t order(const abbe_compare_state *s, const abbe_mask *mask, const float *values,
                    float *sorted) {
  size_t count = 0;
  for (size_t p = 0; p < s->pixels; p++)
    if (abbe_compare_has(s, mask, p) && !isnan(values[p])) sorted[count++] = values[p];
  qsort(sorted, count, sizeof *sorted, abbe_order_ascending_floats);
  return count;
}

static mean mean_of(const float *values, size_t count) {
  double sum = 0, squares = 0;
  for (size_t i = 0; i < count; i++) {
    sum += (double)values[i];
    squares += (double)values[i] * (double)values[i];
  }
  return weighted_mean(sum, (double)count, squares);
}

static mean mean_uv(const abbe_compare_state *s, const abbe_mask *mask, const float *uv,
                    double *share) {
  double sum = 0, squares = 0, weights = 0, all = 0;
  for (size_t p = 0; p < s->pixels; p++) {
    double xyz[3];
    if (!abbe_compare_has(s, mask, p)) continue;
    abbe_field_xyz(s->reference, p, xyz, NULL);
    double y = fmax(0, xyz[1]), d = (double)uv[p];
    all += y;
    if (isnan(d)) continue;
    weights += y;
    sum += y * d;
    squares += y * y * d * d;
  }
  *share = weights / all;
  return weighted_mean(sum, weights, squares);
}

/* How well the noise of colour is known: within 5 % of what independent errors of up to a tenth of
 * the light do; that of errors that go together is estimated a little too large. */
static const double slack = 0.05;

static void set(abbe_compare_value *v, abbe_compare_sides who, mean m) {
  m.limit *= 1 + slack;
  if (who == ABBE_COMPARE_TEST) {
    v->value = m.value;
  } else if (who == ABBE_COMPARE_NOISE_OF_REFERENCE) {
    v->noise = m.value;
    v->limit = m.limit;
  } else {
    v->both_noise = m.value;
    v->both_limit = m.limit;
  }
}

static void summarise(const abbe_compare_state *s, const abbe_mask *mask, abbe_compare_sides who,
                      arrays values, float *sorted, abbe_compare_region *region) {
  abbe_compare_value *metric = region->metric;
  for (int k = 0; k < UV; k++) {
    size_t count = order(s, mask, values.of[k], sorted);
    if (count == 0) return;
    set(&metric[mean_metric[k]], who, mean_of(sorted, count));
    if (k != CIEDE2000) continue;
    double p95 = (double)sorted[(95 * count + 99) / 100 - 1], top = (double)sorted[count - 1];
    set(&metric[ABBE_COMPARE_CIEDE2000_P95], who, (mean){p95, p95});
    set(&metric[ABBE_COMPARE_CIEDE2000_MAX], who, (mean){top, NAN}); /* one pixel of one draw */
  }
  double share;
  mean uv = mean_uv(s, mask, values.of[UV], &share);
  set(&metric[ABBE_COMPARE_UV_MEAN], who, uv);
  if (who == ABBE_COMPARE_TEST) region->uv_share = share;
}

static void measure(const abbe_compare_state *s, arrays values, float *sorted) {
  for (int i = ABBE_COMPARE_TEST; i <= ABBE_COMPARE_NOISE_OF_BOTH; i++) {
    const abbe_compare_sides who = (abbe_compare_sides)i;
    if (!abbe_compare_knows(s, who)) continue;
    fill(s, who, values);
    summarise(s, NULL, who, values, sorted, &s->out->whole);
    if (s->out->masked) summarise(s, s->options->mask, who, values, sorted, &s->out->mask);
  }
}

abbe_result abbe_compare_colour(const abbe_compare_state *s, abbe_error *error) {
  float *room = calloc(s->pixels, (KINDS + 1) * sizeof *room);
  if (room == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for %zu colour differences",
                          s->pixels);
  arrays values;
  for (size_t k = 0; k < KINDS; k++) values.of[k] = room + k * s->pixels;
  measure(s, values, room + KINDS * s->pixels);
  free(room);
  return ABBE_OK;
}
