/* The metrics of light: X, Y, Z, the bands, and the Z-test. */
#include "validation/measure/compare_state.h"

#include "base/maths.h"
#include "base/number.h"
#include "colorimetry/weights.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What 0.01 is added to, in (a-b)^2/(b+0.01)^2. */
static const double softening = 0.01;

/* Single-precision files and sums round; where errors are stated but tiny, this much of a value is
 * no difference. */
static const double rounding = 0x1p-22;

/* Where REF errs downwards, (a-b)^2/(b+0.01)^2 weighs more: of normal errors with the relative
 * variance r its mean is r + 9 r^2 + …, of which r at the erring b
 * gives r + 3 r^2; beyond r = 1 the series means nothing. */
static const double noisy_weight = 6;

/* Sums of one channel, or of several together. */
typedef struct sums {
  double count, channels, reference, test;
  double square, relative; /* sums of the metrics' terms */
  /* variances in the same weights, of REF and of both, and their squares */
  double variance[2], variance2[2], relative_variance[2], relative_variance2[2];
} sums;

static void add(sums *s, double b, double a, double variance_b, double variance_a, double unit) {
  const double variance[2] = {variance_b, variance_b + variance_a};
  double d = a - b, weight = 1 / (fmax(b, 0) / unit + softening) / unit;
  weight *= weight;
  s->count++;
  s->reference += b;
  s->test += a;
  s->square += d * d;
  s->relative += d * d * weight;
  for (int k = 0; k < 2; k++) {
    double r = variance[k] * weight;
    r += noisy_weight * r * fmin(r, 1);
    s->variance[k] += variance[k];
    s->variance2[k] += variance[k] * variance[k];
    s->relative_variance[k] += r;
    s->relative_variance2[k] += r * r;
  }
}

static void merge(sums *s, const sums *more) {
  s->count += more->count;
  s->channels += more->channels;
  s->reference += more->reference;
  s->test += more->test;
  s->square += more->square;
  s->relative += more->relative;
  for (int k = 0; k < 2; k++) {
    s->variance[k] += more->variance[k];
    s->variance2[k] += more->variance2[k];
    s->relative_variance[k] += more->relative_variance[k];
    s->relative_variance2[k] += more->relative_variance2[k];
  }
}

/* Mean of squared normal errors, and two standard deviations above it. Channels of one pixel may
 * err together: their squares then spread by the root of their count more. */
static double mean_limit(const sums *s, double variance, double variance2) {
  return variance / s->count + 2 * sqrt(2 * variance2 * s->channels) / s->count;
}

/* Which side's errors there are: [0] REF's, [1] both. */
typedef struct known {
  bool errors[2];
} known;

static abbe_compare_value relative_rmse(const sums *s, known k) {
  abbe_compare_value v = {NAN, NAN, NAN, NAN, NAN, NAN};
  double mean = s->reference / s->count, square = s->square / s->count;
  if (!(mean > 0)) return v;
  v.value = sqrt(square) / mean;
  for (int i = 0; i < 2; i++) {
    if (!k.errors[i]) continue;
    *(i == 0 ? &v.noise : &v.both_noise) = sqrt(s->variance[i] / s->count) / mean;
    *(i == 0 ? &v.limit : &v.both_limit) =
        sqrt(mean_limit(s, s->variance[i], s->variance2[i])) / mean;
    v.net = sqrt(fmax(0, square - s->variance[i] / s->count)) / mean;
  }
  return v;
}

static abbe_compare_value squared_relative(const sums *s, known k) {
  abbe_compare_value v = {NAN, NAN, NAN, NAN, NAN, NAN};
  v.value = s->relative / s->count;
  for (int i = 0; i < 2; i++) {
    if (!k.errors[i]) continue;
    *(i == 0 ? &v.noise : &v.both_noise) = s->relative_variance[i] / s->count;
    *(i == 0 ? &v.limit : &v.both_limit) =
        mean_limit(s, s->relative_variance[i], s->relative_variance2[i]);
    v.net = fmax(0, v.value - s->relative_variance[i] / s->count);
  }
  return v;
}

static abbe_compare_value energy_ratio(const sums *s, known k) {
  abbe_compare_value v = {NAN, NAN, NAN, NAN, NAN, NAN};
  if (!(s->reference > 0)) return v;
  v.value = s->test / s->reference;
  for (int i = 0; i < 2; i++) {
    if (!k.errors[i]) continue;
    double standard_error = sqrt(s->variance[i] * s->channels) / s->reference;
    *(i == 0 ? &v.noise : &v.both_noise) = standard_error;
    *(i == 0 ? &v.limit : &v.both_limit) = 2 * standard_error;
  }
  return v;
}

static void describe(const sums *s, known k, abbe_compare_channel *channel) {
  channel->mean_reference = s->reference / s->count;
  channel->mean_test = s->test / s->count;
  channel->relative_rmse = relative_rmse(s, k);
  channel->squared_relative = squared_relative(s, k);
  channel->energy_ratio = energy_ratio(s, k);
}

static known known_errors(const abbe_field_samples *reference, const abbe_field_samples *test) {
  bool both = reference->error != NULL && test->error != NULL;
  return (known){{reference->error != NULL, both}};
}

static double square(double x) {
  return x * x;
}

/* Colour */

static void add_xyz(const abbe_compare_state *s, size_t pixel, double unit, sums of[3]) {
  double b[3], a[3], error_b[3], error_a[3], scale = s->out->scale;
  abbe_field_xyz(s->reference, pixel, b, error_b);
  abbe_field_xyz(s->test, pixel, a, error_a);
  for (int c = 0; c < 3; c++)
    add(&of[c], b[c], scale * a[c], square(error_b[c]), square(scale * error_a[c]), unit);
}

static void measure_colour(const abbe_compare_state *s, const abbe_mask *mask,
                           abbe_compare_region *region) {
  static const char *const names[] = {"X", "Y", "Z"};
  sums of[3] = {{.channels = 1}, {.channels = 1}, {.channels = 1}}, all = {0};
  known k = known_errors(&s->reference->colour, &s->test->colour);
  for (size_t p = 0; p < s->pixels; p++)
    if (abbe_compare_has(s, mask, p)) add_xyz(s, p, s->out->unit, of);
  for (int c = 0; c < 3; c++) {
    snprintf(region->channel[c].name, sizeof region->channel[c].name, "%s", names[c]);
    describe(&of[c], k, &region->channel[c]);
    merge(&all, &of[c]);
  }
  region->metric[ABBE_COMPARE_RELATIVE_RMSE] = relative_rmse(&all, k);
  region->metric[ABBE_COMPARE_SQUARED_RELATIVE] = squared_relative(&all, k);
  region->metric[ABBE_COMPARE_ENERGY_RATIO] = energy_ratio(&of[1], k);
}

/* Bands */

static void measure_bands(const abbe_compare_state *s, const abbe_mask *mask, double unit,
                          abbe_compare_region *region, size_t first) {
  const abbe_field_samples *b = &s->reference->bands, *a = &s->test->bands;
  known k = known_errors(b, a);
  sums all = {0};
  for (size_t c = 0; c < b->channels; c++) {
    sums of = {.channels = 1};
    for (size_t p = 0; p < s->pixels; p++) {
      if (!abbe_compare_has(s, mask, p)) continue;
      size_t i = p * b->channels + c;
      double error_b = b->error != NULL ? (double)b->error[i] : 0;
      double error_a = a->error != NULL ? (double)a->error[i] : 0;
      add(&of, (double)b->value[i], s->out->scale * (double)a->value[i], square(error_b),
          square(s->out->scale * error_a), unit);
    }
    abbe_compare_channel *channel = &region->channel[first + c];
    channel->lambda_nm = s->reference->lambda_nm[c];
    abbe_number_format(channel->name, sizeof channel->name, "%.6g nm", channel->lambda_nm);
    describe(&of, k, channel);
    merge(&all, &of);
  }
  region->metric[ABBE_COMPARE_BANDS_RELATIVE_RMSE] = relative_rmse(&all, k);
  region->metric[ABBE_COMPARE_BANDS_SQUARED_RELATIVE] = squared_relative(&all, k);
  region->metric[ABBE_COMPARE_BANDS_ENERGY_RATIO] = energy_ratio(&all, k);
}

/* The Z-test */

static void test_pixel(const abbe_field_samples *b, const abbe_field_samples *a, size_t pixel,
                       double scale, abbe_ztest *z) {
  for (size_t c = 0; c < b->channels; c++) {
    size_t i = pixel * b->channels + c;
    double vb = (double)b->value[i], va = scale * (double)a->value[i];
    double variance = (b->error != NULL ? square((double)b->error[i]) : 0) +
                      (a->error != NULL ? square(scale * (double)a->error[i]) : 0);
    if (variance > 0) variance += square(rounding * fmax(fabs(va), fabs(vb)));
    abbe_ztest_add(z, va - vb, variance);
  }
}

static void measure_z(const abbe_compare_state *s, const abbe_mask *mask,
                      abbe_compare_region *region) {
  bool colour = s->reference->colour.channels > 0;
  const abbe_field_samples *b = colour ? &s->reference->colour : &s->reference->bands;
  const abbe_field_samples *a = colour ? &s->test->colour : &s->test->bands;
  region->z_critical = NAN;
  if (b->error == NULL && a->error == NULL) return;
  for (size_t p = 0; p < s->pixels; p++)
    if (abbe_compare_has(s, mask, p)) test_pixel(b, a, p, s->out->scale, &region->z);
  double freedom = s->out->freedom, n = (double)region->z.count;
  region->z_critical = abbe_ztest_critical(region->z.count, ABBE_ZTEST_LEVEL, freedom);
  const double value[] = {abbe_ztest_share_over2(&region->z), abbe_ztest_share_over3(&region->z),
                          abbe_ztest_mean_square(&region->z), region->z.max / region->z_critical};
  const double share[] = {abbe_ztest_expected_share(2, freedom),
                          abbe_ztest_expected_share(3, freedom)};
  const double mean = abbe_ztest_expected_mean_square(freedom);
  /* The variance of z^2 is 2 for exact errors; that of Student's is not finite up to 4 degrees. */
  const double spread = freedom == 0  ? 2
                        : freedom > 4 ? mean * mean * 2 * (freedom - 1) / (freedom - 4)
                                      : INFINITY;
  const double noise[] = {share[0], share[1], mean, 1};
  const double limit[] = {share[0] + 2 * sqrt(share[0] * (1 - share[0]) / n),
                          share[1] + 2 * sqrt(share[1] * (1 - share[1]) / n),
                          mean + 2 * sqrt(spread / n), 1};
  for (int m = 0; m < 4; m++)
    region->metric[ABBE_COMPARE_Z_OVER_2 + m] =
        (abbe_compare_value){value[m], noise[m], limit[m], NAN, NAN, NAN};
}

/* Both together */

static double mean_of_bands(const abbe_compare_state *s) {
  const abbe_field_samples *b = &s->reference->bands;
  double sum = 0, count = 0;
  for (size_t p = 0; p < s->pixels; p++)
    for (size_t c = 0; s->bad[p] == 0 && c < b->channels; c++, count++)
      sum += (double)b->value[p * b->channels + c];
  return sum / count;
}

abbe_result abbe_compare_light(const abbe_compare_state *s, const abbe_mask *mask,
                               abbe_compare_region *region, abbe_error *error) {
  size_t colour = s->reference->colour.channels, bands = s->reference->bands.channels;
  region->channels = colour + bands;
  region->channel = calloc(region->channels, sizeof *region->channel);
  if (region->channel == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for %zu channels",
                          region->channels);
  if (colour > 0) measure_colour(s, mask, region);
  if (bands > 0) measure_bands(s, mask, mean_of_bands(s), region, colour);
  measure_z(s, mask, region);
  return ABBE_OK;
}

/* Units of the whole field */

static void add_to_fit(double a, double b, double *aa, double *ab) {
  *aa += a * a;
  *ab += a * b;
}

static abbe_result find_scale(const abbe_compare_state *s, double *scale, abbe_error *error) {
  double aa = 0, ab = 0;
  for (size_t p = 0; p < s->pixels; p++) {
    if (s->bad[p] != 0) continue;
    if (s->reference->colour.channels > 0) {
      double b[3], a[3];
      abbe_field_xyz(s->reference, p, b, NULL);
      abbe_field_xyz(s->test, p, a, NULL);
      for (int c = 0; c < 3; c++) add_to_fit(a[c], b[c], &aa, &ab);
      continue;
    }
    size_t n = s->reference->bands.channels;
    for (size_t i = p * n; i < (p + 1) * n; i++)
      add_to_fit((double)s->test->bands.value[i], (double)s->reference->bands.value[i], &aa, &ab);
  }
  if (!(aa > 0 && ab > 0 && isfinite(ab / aa)))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "no scale brings the picture to the reference: it is black, or nowhere "
                          "bright where the reference is");
  *scale = ab / aa;
  return ABBE_OK;
}

/* Nominal for the observer of 1931, else what the observer sees of its table. */
static void find_d65(abbe_observer observer, double xyz[3]) {
  static const abbe_illuminant table = {.kind = ABBE_ILLUMINANT_D65};
  static const double nominal[3] = {0.3127 / 0.3290, 1, (1 - 0.3127 - 0.3290) / 0.3290};
  if (observer == ABBE_OBSERVER_CIE_1931)
    memcpy(xyz, nominal, sizeof nominal);
  else
    abbe_weights_white(observer, &table, ABBE_OBSERVER_MIN_NM, ABBE_OBSERVER_MAX_NM, xyz);
}

abbe_result abbe_compare_white(const abbe_field *field, const uint8_t *bad, double white[3],
                               abbe_error *error) {
  const size_t pixels = field->width * field->height;
  float *lit = malloc(pixels * sizeof *lit);
  if (lit == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory to sort %zu pixels", pixels);
  size_t count = 0;
  for (size_t p = 0; p < pixels; p++) {
    double xyz[3];
    abbe_field_xyz(field, p, xyz, NULL);
    if ((bad == NULL || bad[p] == 0) && xyz[1] > 0) lit[count++] = (float)xyz[1];
  }
  qsort(lit, count, sizeof *lit, abbe_order_descending_floats);
  double y = count > 0 ? (double)lit[count / 100] : 0;
  free(lit);
  double d65[3];
  find_d65(field->observer, d65);
  for (int c = 0; c < 3; c++) white[c] = y * d65[c];
  return ABBE_OK;
}

static double mean_y(const abbe_compare_state *s) {
  double sum = 0, count = 0;
  for (size_t p = 0; p < s->pixels; p++) {
    double xyz[3];
    if (s->bad[p] != 0) continue;
    abbe_field_xyz(s->reference, p, xyz, NULL);
    sum += xyz[1];
    count++;
  }
  return sum / count;
}

abbe_result abbe_compare_find_units(abbe_compare_state *s, abbe_error *error) {
  bool colour = s->reference->colour.channels > 0;
  const double *white = s->options->white;
  abbe_comparison *out = s->out;
  out->scale = 1;
  out->unit = colour ? mean_y(s) : mean_of_bands(s);
  if (!(out->unit > 0))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the reference is black: its mean is %g, and errors are told relative "
                          "to it",
                          out->unit);
  if (s->options->best_scale) ABBE_TRY(find_scale(s, &out->scale, error));
  if (!colour) return ABBE_OK;
  out->white_found = white[0] == 0 && white[1] == 0 && white[2] == 0;
  for (int c = 0; c < 3; c++) out->white[c] = white[c];
  return out->white_found ? abbe_compare_white(s->reference, s->bad, out->white, error) : ABBE_OK;
}
