#include "validation/compare/ssim.h"

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
