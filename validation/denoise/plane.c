#include "validation/denoise/plane.h"

/* Sums are of doubles, so that what enters and leaves them cancels to nothing that counts. */
static void mean_of_line(const float *from, size_t count, size_t stride, size_t reach, float *out) {
  double sum = 0;
  for (size_t i = 0; i < count && i < reach; i++) sum += (double)from[i * stride];
  for (size_t i = 0; i < count; i++) {
    if (i + reach < count) sum += (double)from[(i + reach) * stride];
    if (i > reach) sum -= (double)from[(i - reach - 1) * stride];
    const size_t first = i > reach ? i - reach : 0;
    const size_t last = i + reach < count ? i + reach : count - 1;
    out[i * stride] = (float)(sum / (double)(last - first + 1));
  }
}

void abbe_plane_mean(const float *from, size_t width, size_t height, size_t reach, size_t threads,
                     float *room, float *out) {
#pragma omp parallel for num_threads((int)threads)
  for (size_t y = 0; y < height; y++)
    mean_of_line(from + y * width, width, 1, reach, room + y * width);
#pragma omp parallel for num_threads((int)threads)
  for (size_t x = 0; x < width; x++) mean_of_line(room + x, height, width, reach, out + x);
}
