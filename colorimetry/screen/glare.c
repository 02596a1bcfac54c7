#include "colorimetry/screen/glare.h"

#include "base/maths.h"

#include <gsl/gsl_fft_complex.h>
#include <math.h>
#include <stdlib.h>

double abbe_glare_spread(double theta_deg) {
  const double core = theta_deg / 0.02, far = theta_deg + 0.02;
  return 0.384 * 2.61e6 * exp(-core * core) + 0.478 * 20.91 / (far * far * far) +
         0.138 * 72.37 / (far * far);
}

/* A picture and its mirror images, side by side and above each other: wide x high complex
 * numbers. */
typedef struct plane {
  size_t wide, high;
  double *number;
  gsl_fft_complex_wavetable *table[2];
  gsl_fft_complex_workspace *work[2];
} plane;

static void free_plane(plane *p) {
  for (int i = 0; i < 2; i++) {
    if (p->table[i] != NULL) gsl_fft_complex_wavetable_free(p->table[i]);
    if (p->work[i] != NULL) gsl_fft_complex_workspace_free(p->work[i]);
  }
  free(p->number);
}

static bool make_plane(size_t wide, size_t high, plane *p) {
  const size_t side[2] = {wide, high};
  *p = (plane){.wide = wide, .high = high, .number = calloc(wide * high, 2 * sizeof(double))};
  bool made = p->number != NULL;
  for (int i = 0; i < 2; i++) {
    p->table[i] = gsl_fft_complex_wavetable_alloc(side[i]);
    p->work[i] = gsl_fft_complex_workspace_alloc(side[i]);
    made = made && p->table[i] != NULL && p->work[i] != NULL;
  }
  return made;
}

static void transform(plane *p, gsl_fft_direction sign) {
  for (size_t y = 0; y < p->high; y++)
    gsl_fft_complex_transform(p->number + 2 * y * p->wide, 1, p->wide, p->table[0], p->work[0],
                              sign);
  for (size_t x = 0; x < p->wide; x++)
    gsl_fft_complex_transform(p->number + 2 * x, p->wide, p->high, p->table[1], p->work[1], sign);
}

/* The share of a pixel's light in another one, at (x, y) pixels of so many degrees: near it the
 * mean of a grid, for the spread is narrower than a pixel may be. */
static double share(double x, double y, double deg) {
  enum { NEAR = 6, GRID = 16 };
  const int n = fmax(x, y) <= NEAR ? GRID : 1;
  double sum = 0;
  for (int i = 0; i < n * n; i++)
    sum += abbe_glare_spread(
        deg * hypot(x + (i % n + 0.5) / n - 0.5, y + ((double)(i / n) + 0.5) / n - 0.5));
  return sum / (n * n) * (deg * ABBE_DEGREE) * (deg * ABBE_DEGREE);
}

/* Transformed, it is real, for it is even. */
static void fill_spread(plane *p, double deg) {
  double elsewhere = 0;
  for (size_t y = 0; y < p->high; y++)
    for (size_t x = 0; x < p->wide; x++) {
      const double dx = fmin((double)x, (double)(p->wide - x));
      const double dy = fmin((double)y, (double)(p->high - y));
      if (x + y == 0) continue;
      elsewhere += p->number[2 * (y * p->wide + x)] = share(dx, dy, deg);
    }
  p->number[0] = 1 - elsewhere;
  transform(p, gsl_fft_forward);
}

static double finite(float value) {
  const double most = 1e15;
  return isnan(value) ? 0 : fmin(fmax((double)value, -most), most);
}

static size_t mirrored(size_t at, size_t side) {
  return at < side ? at : 2 * side - 1 - at;
}

/* Channels `a` and, where it is another one, `b`, as real and imaginary part. */
static void spread_two(abbe_image *image, size_t a, size_t b, const plane *spread, plane *p) {
  for (size_t i = 0; i < p->wide * p->high; i++) {
    const float *from =
        image->data + image->channels * (mirrored(i / p->wide, image->height) * image->width +
                                         mirrored(i % p->wide, image->width));
    p->number[2 * i] = finite(from[a]);
    p->number[2 * i + 1] = finite(from[b]);
  }
  transform(p, gsl_fft_forward);
  for (size_t i = 0; i < 2 * p->wide * p->high; i++)
    p->number[i] *= spread->number[i - i % 2] / (double)(p->wide * p->high);
  transform(p, gsl_fft_backward);
  for (size_t i = 0; i < image->width * image->height; i++) {
    const double *of = p->number + 2 * (i / image->width * p->wide + i % image->width);
    image->data[i * image->channels + b] = (float)of[1];
    image->data[i * image->channels + a] = (float)of[0];
  }
}

abbe_result abbe_glare_add(abbe_image *image, double high_deg, abbe_error *error) {
  if (image->width * image->height > ABBE_GLARE_MAX_PIXELS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "glare is for at most %zu pixels, and the picture has %zux%zu",
                          ABBE_GLARE_MAX_PIXELS, image->width, image->height);
  plane spread, p = {0};
  const bool made = make_plane(2 * image->width, 2 * image->height, &spread) &&
                    make_plane(2 * image->width, 2 * image->height, &p);
  if (made) {
    fill_spread(&spread, high_deg / (double)image->height);
    spread_two(image, 0, 1, &spread, &p);
    spread_two(image, 2, 2, &spread, &p);
  }
  free_plane(&p);
  free_plane(&spread);
  return made ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for the glare");
}
