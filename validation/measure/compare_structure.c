/* The metrics that look at a pixel's surroundings: SSIM and FLIP, over pictures whose white is 1.
 */
#include "validation/measure/compare_state.h"

#include "colorimetry/image/rgb_encoding.h"
#include "colorimetry/rgb_space.h"

#include <math.h>
#include <stdlib.h>

enum { TAPS = 2 * ABBE_SSIM_REACH + 1, MOMENTS = 5 };

/* Sums over a window: a, b, a^2, b^2, a b. */
typedef struct moments {
  double of[MOMENTS];
} moments;

static void make_window(double weight[TAPS]) {
  double sum = 0;
  for (int i = 0; i < TAPS; i++) {
    const double x = i - ABBE_SSIM_REACH;
    sum += weight[i] = exp(-x * x / (2 * 1.5 * 1.5));
  }
  for (int i = 0; i < TAPS; i++) weight[i] /= sum;
}

/* The sums along the row; NaN spoils those that it is in. */
static moments sum_along(const float *a, const float *b, const double weight[TAPS]) {
  moments m = {{0}};
  for (int i = 0; i < TAPS; i++) {
    const double x = (double)a[i], y = (double)b[i], w = weight[i];
    m.of[0] += w * x;
    m.of[1] += w * y;
    m.of[2] += w * x * x;
    m.of[3] += w * y * y;
    m.of[4] += w * x * y;
  }
  return m;
}

static float index_of(const double m[MOMENTS]) {
  const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
  const double ab = m[0] * m[1], squares = m[0] * m[0] + m[1] * m[1];
  const double covariance = m[4] - ab, variances = m[2] + m[3] - squares;
  return (float)((2 * ab + c1) * (2 * covariance + c2) / ((squares + c1) * (variances + c2)));
}

abbe_result abbe_ssim_map(const float *a, const float *b, size_t width, size_t height, float *out,
                          abbe_error *error) {
  double weight[TAPS];
  moments *rows = calloc(width * height > 0 ? width * height : 1, sizeof *rows);
  if (rows == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the windows of %zu x %zu pixels",
                          width, height);
  make_window(weight);
  for (size_t i = 0; i < width * height; i++) out[i] = NAN;
  for (size_t y = 0; y < height; y++)
    for (size_t x = 0; x + TAPS <= width; x++)
      rows[y * width + x] = sum_along(a + y * width + x, b + y * width + x, weight);
  for (size_t y = 0; y + TAPS <= height; y++)
    for (size_t x = 0; x + TAPS <= width; x++) {
      double m[MOMENTS] = {0};
      for (size_t j = 0; j < TAPS; j++)
        for (int k = 0; k < MOMENTS; k++) m[k] += weight[j] * rows[(y + j) * width + x].of[k];
      out[(y + ABBE_SSIM_REACH) * width + x + ABBE_SSIM_REACH] = index_of(m);
    }
  free(rows);
  return ABBE_OK;
}

/* The two sides as linear Rec.709 and as grey, and a value a pixel. */
typedef struct pair {
  float (*rgb[2])[3], *grey[2], *map;
} pair;

/* [IEC61966] of light that is clipped to 0 to 1. */
static float encode(double light) {
  const double x = light > 0 ? fmin(light, 1) : 0;
  return (float)abbe_srgb_encoded(x);
}

/* REF's Y at a pixel less its noise: the mean of those around it as far as their errors explain how
 * they vary [Lee1980], over its own. Noise that is already there would hide what is drawn on top.
 */
static double calm(const abbe_compare_state *s, size_t pixel) {
  enum { REACH = 2 };
  const abbe_field *f = s->reference;
  const size_t x = pixel % f->width, y = pixel / f->width;
  double own[3], count = 0, sum = 0, squares = 0, noise = 0;
  abbe_field_xyz(f, pixel, own, NULL);
  for (size_t j = y > REACH ? y - REACH : 0; j <= y + REACH && j < f->height; j++)
    for (size_t i = x > REACH ? x - REACH : 0; i <= x + REACH && i < f->width; i++) {
      double near[3], error[3];
      if (s->bad[j * f->width + i] != 0) continue;
      abbe_field_xyz(f, j * f->width + i, near, error);
      count++;
      sum += near[1];
      squares += near[1] * near[1];
      noise += error[1] * error[1];
    }
  const double mean = sum / count, variance = squares / count - mean * mean;
  const double keep = variance > 0 ? fmax(0, 1 - noise / count / variance) : 0;
  return own[1] > 0 && mean > 0 ? (mean + keep * (own[1] - mean)) / own[1] : 1;
}

static void take(const abbe_compare_state *s, abbe_compare_sides who, size_t p, double b[3],
                 double a[3]) {
  abbe_compare_take_sides(s, who, p, b, a);
  if (who == ABBE_COMPARE_TEST) return;
  const double share = calm(s, p);
  double quiet[3];
  abbe_field_xyz(s->reference, p, quiet, NULL);
  for (int c = 0; c < 3; c++) {
    /* both sides stand on one light, which is moved; the noise on it stays */
    const double move = (share - 1) * quiet[c];
    b[c] += move;
    a[c] += move;
  }
}

/* What is not finite is dark on both sides. */
static void fill(const abbe_compare_state *s, abbe_compare_sides who, const pair *out) {
  double from[9];
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, from);
  for (size_t p = 0; p < s->pixels; p++) {
    double xyz[2][3] = {{0}};
    if (s->bad[p] == 0) take(s, who, p, xyz[0], xyz[1]);
    for (int side = 0; side < 2; side++) {
      double rgb[3];
      out->grey[side][p] = encode(xyz[side][1] / s->out->white[1]);
      abbe_rgb_space_apply(from, xyz[side], rgb);
      for (int c = 0; c < 3; c++) out->rgb[side][p][c] = (float)(rgb[c] / s->out->white[1]);
    }
  }
}

/* The mean over a region. Its limit is that of one draw of the noise with a tenth of it: how far
 * draws are apart is not measured. */
static void take_mean(const abbe_compare_state *s, abbe_compare_metric metric,
                      abbe_compare_sides who, const float *map, const abbe_mask *mask,
                      abbe_compare_region *region) {
  const double room = 0.1;
  double sum = 0, count = 0;
  for (size_t p = 0; p < s->pixels; p++) {
    if (!abbe_compare_has(s, mask, p) || isnan(map[p])) continue;
    sum += (double)map[p];
    count++;
  }
  if (count == 0) return;
  abbe_compare_value *v = &region->metric[metric];
  const double mean = sum / count,
               limit = (1 + room) * (metric == ABBE_COMPARE_SSIM ? 1 - mean : mean);
  if (who == ABBE_COMPARE_TEST) {
    v->value = mean;
  } else if (who == ABBE_COMPARE_NOISE_OF_REFERENCE) {
    v->noise = mean;
    v->limit = limit;
  } else {
    v->both_noise = mean;
    v->both_limit = limit;
  }
}

static abbe_result make_map(const abbe_compare_state *s, abbe_compare_metric metric, const pair *of,
                            abbe_error *error) {
  const size_t w = s->reference->width, h = s->reference->height;
  const float(*b)[3] = (const float(*)[3])of->rgb[0], (*a)[3] = (const float(*)[3])of->rgb[1];
  abbe_flip_exposures exposures;
  if (metric == ABBE_COMPARE_SSIM)
    return abbe_ssim_map(of->grey[0], of->grey[1], w, h, of->map, error);
  if (metric == ABBE_COMPARE_FLIP_MEAN) return abbe_flip_map(b, a, w, h, 0, of->map, error);
  return abbe_flip_hdr_map(b, a, w, h, 0, of->map, &exposures, error);
}

static abbe_result measure(const abbe_compare_state *s, abbe_compare_sides who, const pair *of,
                           abbe_error *error) {
  static const abbe_compare_metric metrics[] = {ABBE_COMPARE_SSIM, ABBE_COMPARE_FLIP_MEAN,
                                                ABBE_COMPARE_HDR_FLIP_MEAN};
  fill(s, who, of);
  for (size_t m = 0; m < sizeof metrics / sizeof *metrics; m++) {
    ABBE_TRY(make_map(s, metrics[m], of, error));
    take_mean(s, metrics[m], who, of->map, NULL, &s->out->whole);
    if (s->out->masked) take_mean(s, metrics[m], who, of->map, s->options->mask, &s->out->mask);
  }
  return ABBE_OK;
}

abbe_result abbe_compare_structure(const abbe_compare_state *s, abbe_error *error) {
  ABBE_FREED float *room = calloc(s->pixels, 9 * sizeof *room);
  if (room == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to compare the structure of %zu pixels",
                          s->pixels);
  pair both = {.map = room};
  for (size_t side = 0; side < 2; side++) {
    both.grey[side] = room + (1 + side) * s->pixels;
    both.rgb[side] = (float(*)[3])(room + (3 + 3 * side) * s->pixels);
  }
  for (int i = ABBE_COMPARE_TEST; i <= ABBE_COMPARE_NOISE_OF_BOTH; i++)
    if (abbe_compare_knows(s, (abbe_compare_sides)i))
      ABBE_TRY(measure(s, (abbe_compare_sides)i, &both, error));
  return ABBE_OK;
}
