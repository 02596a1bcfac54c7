#include "validation/trace/tracer/tracer_state.h"

#include <math.h>
#include <stdlib.h>

enum { ADDED = ABBE_GUIDE_MEANS - ABBE_GUIDE_EYE };

/* For what is no colour; beyond the limit it is cut. */
static const double plain_unit = 0x1p-40, plain_limit = 0x1p20;

abbe_result abbe_guide_sums_make(size_t pixels, double picture_unit, abbe_guide_sums *out,
                                 abbe_error *error) {
  *out = (abbe_guide_sums){.pixels = pixels,
                           .unit = picture_unit,
                           .adding = calloc(pixels * ADDED, sizeof *out->adding),
                           .sum = calloc(pixels * ABBE_GUIDE_VALUES, sizeof *out->sum)};
  if (out->adding != NULL && out->sum != NULL) return ABBE_OK;
  abbe_guide_sums_free(out);
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a filter's guides of %zu pixels",
                        pixels);
}

void abbe_guide_sums_free(abbe_guide_sums *g) {
  free(g->adding);
  free(g->sum);
  *g = (abbe_guide_sums){0};
}

void abbe_guide_sums_set(abbe_guide_sums *g, size_t pixel, const float rgb[3],
                         const abbe_eye_sample *s) {
  const float values[ADDED] = {rgb[0],       rgb[1],       rgb[2],       s->albedo[0], s->albedo[1],
                               s->albedo[2], s->normal[0], s->normal[1], s->normal[2], s->depth};
  for (size_t k = 0; k < ADDED; k++)
    g->adding[pixel * ADDED + k] = isfinite(values[k]) ? values[k] : 0;
}

static double unit_of(const abbe_guide_sums *g, size_t mean) {
  return mean < ABBE_GUIDE_ALBEDO ? g->unit : plain_unit;
}

/* What the picture's sums make of a colour. */
static abbe_whole_sum colour_of(const abbe_accumulator *picture, float x) {
  uint64_t cut = 0; /* which the picture has counted */
  bool coarse;
  const int64_t whole = abbe_accumulator_quantise(picture, x, &cut, &coarse);
  return (abbe_whole_sum)whole * ((abbe_whole_sum)1 << (coarse ? ABBE_ACCUMULATOR_APART : 0));
}

/* rgb: the picture's, in its units. */
static void end_pixel(const float *adding, const abbe_accumulator *picture,
                      const abbe_whole_sum rgb[3], abbe_whole_sum *sum) {
  abbe_whole_sum x[ABBE_GUIDE_MEANS];
  for (size_t k = 0; k < ADDED; k++)
    x[ABBE_GUIDE_EYE + k] =
        k < 3 ? colour_of(picture, adding[k])
              : abbe_whole_sum_quantise((double)adding[k], 1 / plain_unit, plain_limit);
  for (size_t k = 0; k < 3; k++) x[k] = rgb[k] - x[ABBE_GUIDE_EYE + k];
  for (size_t k = 0; k < ABBE_GUIDE_MEANS; k++) {
    sum[k] += x[k];
    abbe_whole_sum_add_product(x[k], x[k], &sum[ABBE_GUIDE_SQUARES + 2 * k]);
  }
  for (size_t part = 0; part < 2; part++) {
    const abbe_whole_sum *c = x + 3 * part;
    abbe_whole_sum *product = sum + ABBE_GUIDE_PRODUCTS + 6 * part;
    abbe_whole_sum_add_product(c[0], c[1], product);
    abbe_whole_sum_add_product(c[0], c[2], product + 2);
    abbe_whole_sum_add_product(c[1], c[2], product + 4);
  }
}

void abbe_guide_sums_end_pass(abbe_guide_sums *g, const abbe_accumulator *picture,
                              size_t channels) {
#pragma omp parallel for num_threads((int)picture->threads)
  for (size_t i = 0; i < g->pixels; i++) {
    abbe_whole_sum rgb[3];
    for (size_t k = 0; k < 3; k++) rgb[k] = abbe_accumulator_adding(picture, i * channels + k);
    end_pixel(g->adding + i * ADDED, picture, rgb, g->sum + i * ABBE_GUIDE_VALUES);
  }
}

/* In units. */
static double of_means(double product, abbe_whole_sum a, abbe_whole_sum b, size_t passes) {
  const double n = (double)passes, x = (double)a, y = (double)b;
  return (product / n - x / n * (y / n)) / (n - 1);
}

double abbe_guide_sums_mean(const abbe_guide_sums *g, size_t passes, size_t pixel, size_t mean) {
  const abbe_whole_sum sum = g->sum[pixel * ABBE_GUIDE_VALUES + mean];
  return unit_of(g, mean) * (double)sum / (double)passes;
}

double abbe_guide_sums_variance(const abbe_guide_sums *g, size_t passes, size_t pixel,
                                size_t mean) {
  const abbe_whole_sum *sum = g->sum + pixel * ABBE_GUIDE_VALUES;
  const double unit = unit_of(g, mean);
  const double square = abbe_whole_sum_of_products(&sum[ABBE_GUIDE_SQUARES + 2 * mean]);
  return unit * unit * fmax(of_means(square, sum[mean], sum[mean], passes), 0);
}

double abbe_guide_sums_covariance(const abbe_guide_sums *g, size_t passes, size_t pixel,
                                  size_t product) {
  static const size_t first[3] = {0, 0, 1}, second[3] = {1, 2, 2};
  const abbe_whole_sum *sum = g->sum + pixel * ABBE_GUIDE_VALUES, *part = sum + 3 * (product / 3);
  return g->unit * g->unit *
         of_means(abbe_whole_sum_of_products(&sum[ABBE_GUIDE_PRODUCTS + 2 * product]),
                  part[first[product % 3]], part[second[product % 3]], passes);
}
