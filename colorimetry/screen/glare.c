#include "colorimetry/screen/screen_file.h"

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
 * numbers. A side is twice the picture's; where that one's transform is slow it is three times or
 * more, with a mirror image on either side of the picture. */
typedef struct plane {
  size_t wide, high;
  double *number;
  gsl_fft_complex_wavetable *table[2];
  gsl_fft_complex_workspace *work[2];
} plane;

/* Whether the side has no greater prime factor. */
static bool has_factors(size_t side, size_t most) {
  for (size_t factor = 2; factor <= most; factor++)
    while (side % factor == 0) side /= factor;
  return side == 1;
}

/* A transform takes a time in proportion to its side's greatest factor. Above so much a longer side
 * is faster. */
static size_t mirrored_side(size_t side) {
  const size_t slow = 100;
  size_t longer = 3 * side;
  while (!has_factors(longer, 7)) longer++;
  return has_factors(2 * side, slow) ? 2 * side : longer;
}

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

/* Light goes as far as the picture is long. A longer side has both ends of that way, each of a
 * half. */
static double reach(double far, size_t side, size_t whole) {
  const double left = (double)side - far;
  return left > 0 || whole == 2 * side ? 1 : left < 0 ? 0 : 0.5;
}

/* Transformed, it is real, for it is even. */
static void fill_spread(plane *p, const abbe_image *image, double deg) {
  double elsewhere = 0;
  for (size_t y = 0; y < p->high; y++)
    for (size_t x = 0; x < p->wide; x++) {
      const double dx = fmin((double)x, (double)(p->wide - x));
      const double dy = fmin((double)y, (double)(p->high - y));
      const double part = reach(dx, image->width, p->wide) * reach(dy, image->height, p->high);
      if (x + y == 0 || !(part > 0)) continue;
      elsewhere += p->number[2 * (y * p->wide + x)] = part * share(dx, dy, deg);
    }
  p->number[0] = 1 - elsewhere;
  transform(p, gsl_fft_forward);
}

static double finite(float value) {
  const double most = 1e15;
  return isnan(value) ? 0 : fmin(fmax((double)value, -most), most);
}

/* What lies between the mirror images of a longer side is not reached. */
static size_t mirrored(size_t at, size_t side, size_t whole) {
  return at < side           ? at
         : at < 2 * side     ? 2 * side - 1 - at
         : at + side < whole ? 0
                             : whole - 1 - at;
}

/* Channels `a` and, where it is another one, `b`, as real and imaginary part. */
static void spread_two(abbe_image *image, size_t a, size_t b, const plane *spread, plane *p) {
  for (size_t i = 0; i < p->wide * p->high; i++) {
    const float *from =
        image->data +
        image->channels * (mirrored(i / p->wide, image->height, p->high) * image->width +
                           mirrored(i % p->wide, image->width, p->wide));
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
  const size_t wide = mirrored_side(image->width), high = mirrored_side(image->height);
  const bool made = make_plane(wide, high, &spread) && make_plane(wide, high, &p);
  if (made) {
    fill_spread(&spread, image, high_deg / (double)image->height);
    spread_two(image, 0, 1, &spread, &p);
    spread_two(image, 2, 2, &spread, &p);
  }
  free_plane(&p);
  free_plane(&spread);
  return made ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for the glare");
}
