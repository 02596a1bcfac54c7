#include "validation/measure/compare_state.h"

#include "base/maths.h"
#include "colorimetry/difference.h"
#include "colorimetry/rgb_space.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* [Andersson2020]: the filters' constants, the exponent of colour (that of features is 1/2) and the
 * share of the colour term. */
static const double csf_a[3][2] = {{1, 0}, {1, 0}, {34.1, 13.5}};
static const double csf_b[3][2] = {{0.0047, 1e-5}, {0.0053, 1e-5}, {0.04, 0.025}};
static const double widest_b = 0.04, edge_width = 0.082;
static const double colour_power = 0.7, knee = 0.4, knee_value = 0.95;

enum { MAX_REACH = 160, MAX_STOPS = 32, BLOCK = 128 /* limits of a row */, LANES = 8 };
static const double max_pixels_per_degree = 1000;

typedef struct kernel {
  int reach;
  double weight[2 * MAX_REACH + 1], sum; /* sum: before the weights were made to add up to 1 */
  float tap[2 * MAX_REACH + 1];          /* taps that a float separates from 0 */
} kernel;

enum { SIDE_PLANES = 5, SHARED_PLANES = 6, PLANES = 2 * SIDE_PLANES + SHARED_PLANES };

/* What a picture is compared by. */
typedef struct side {
  float *colour[3], *edge, *point;
} side;

typedef struct job {
  size_t width, height, pixels;
  double to_xyz[9], from_xyz[9], white[3], greatest;
  kernel csf[3][2], smooth, edge, point;
  double share[3][2];
  float *room;
  side of[2];
  float *ycc[3], *half, *whole, *other;
} job;

/* Tails that are lost in a float's rounding are left out. */
static void set_taps(kernel *k) {
  const double least = 1e-10;
  double most = 0;
  int reach = 0;
  for (int i = 0; i <= 2 * k->reach; i++) most = fmax(most, fabs(k->weight[i]));
  for (int i = 1; i <= k->reach; i++)
    if (fabs(k->weight[k->reach + i]) > least * most) reach = i;
  for (int i = -reach; i <= reach; i++) k->tap[i + reach] = (float)k->weight[i + k->reach];
  k->reach = reach;
}

static kernel gaussian(int reach, double exponent) {
  kernel k = {.reach = reach};
  for (int i = -reach; i <= reach; i++) k.sum += k.weight[i + reach] = exp(-exponent * i * i);
  for (int i = 0; i <= 2 * reach; i++) k.weight[i] /= k.sum;
  set_taps(&k);
  return k;
}

/* A Gaussian times a factor of x whose positive and negative weights each add up to 1. */
static kernel detector(int reach, double deviation, int order) {
  kernel k = {.reach = reach};
  double sum[2] = {0, 0};
  for (int i = -reach; i <= reach; i++) {
    const double t = i / deviation, g = exp(-t * t / 2), w = order == 1 ? -i * g : (t * t - 1) * g;
    k.weight[i + reach] = w;
    sum[w > 0] += fabs(w);
  }
  for (int i = 0; i <= 2 * reach; i++) k.weight[i] /= sum[k.weight[i] > 0];
  set_taps(&k);
  return k;
}

static void make_kernels(job *j, double ppd) {
  const int reach = (int)ceil(3 * sqrt(widest_b / (2 * ABBE_PI * ABBE_PI)) * ppd);
  for (int c = 0; c < 3; c++) {
    double total = 0;
    for (int t = 0; t < 2; t++) {
      j->csf[c][t] = gaussian(reach, ABBE_PI * ABBE_PI / (csf_b[c][t] * ppd * ppd));
      const double s = j->csf[c][t].sum;
      total += j->share[c][t] = csf_a[c][t] * sqrt(ABBE_PI / csf_b[c][t]) * s * s;
    }
    for (int t = 0; t < 2; t++) j->share[c][t] /= total;
  }
  const double deviation = 0.5 * edge_width * ppd;
  const int near = (int)ceil(3 * deviation);
  j->smooth = gaussian(near, 1 / (2 * deviation * deviation));
  j->edge = detector(near, deviation, 1);
  j->point = detector(near, deviation, 2);
}

static long held(long at, long count) {
  return at < 0 ? 0 : at >= count ? count - 1 : at;
}

/* Sums with a kernel that is the same, or the opposite, on both sides of its middle: so many rows
 * lie around in[0], and a block of each is summed where the processor keeps it. */
SIDE_BY_SIDE static void sum_taps(const float *const *in, const kernel *k, int count, float *out) {
  const int reach = k->reach;
  const float *tap = k->tap, sign = tap[0] == tap[2 * reach] ? 1 : -1;
  for (int x = 0; x < count; x += LANES) {
    float sum[LANES];
    for (int l = 0; l < LANES; l++) sum[l] = tap[reach] * in[reach][x + l];
    for (int i = 0; i < reach; i++) {
      const float *a = in[i] + x, *b = in[2 * reach - i] + x, t = tap[i];
      for (int l = 0; l < LANES; l++) sum[l] += t * (a[l] + sign * b[l]);
    }
    for (int l = 0; l < LANES; l++) out[x + l] = sum[l];
  }
}

/* Along rows, whose ends go on. */
static void filter_rows(const job *j, const float *in, const kernel *k, float *out) {
  const long w = (long)j->width, h = (long)j->height;
#pragma omp parallel for
  for (long y = 0; y < h; y++)
    for (long x = 0; x < w; x += BLOCK) {
      const float *row[2 * MAX_REACH + 1];
      float around[BLOCK + 2 * MAX_REACH], sum[BLOCK];
      const int count = (int)(w - x < BLOCK ? w - x : BLOCK);
      const size_t unused = 2 * (size_t)(MAX_REACH - k->reach) * sizeof *around;
      const bool inside = x >= k->reach && x + BLOCK + k->reach <= w;
      if (inside) memcpy(around, in + y * w + x - k->reach, sizeof around - unused);
      for (int i = 0; i < BLOCK + 2 * k->reach && !inside; i++)
        around[i] = in[y * w + held(x - k->reach + i, w)];
      for (int i = 0; i <= 2 * k->reach; i++) row[i] = around + i;
      sum_taps(row, k, BLOCK, sum);
      memcpy(out + y * w + x, sum, (size_t)count * sizeof *sum);
    }
}

/* Along columns, likewise. */
static void filter_columns(const job *j, const float *in, const kernel *k, float *out) {
  const long w = (long)j->width, h = (long)j->height;
#pragma omp parallel for
  for (long y = 0; y < h; y++) {
    const float *row[2 * MAX_REACH + 1];
    for (int i = 0; i <= 2 * k->reach; i++) row[i] = in + held(y - k->reach + i, h) * w;
    const int whole = (int)(w / LANES * LANES);
    sum_taps(row, k, whole, out + y * w);
    for (long x = whole; x < w; x++) {
      float sum = 0;
      for (int i = 0; i <= 2 * k->reach; i++) sum += k->tap[i] * row[i][x];
      out[y * w + x] = sum;
    }
  }
}

static void blur(const job *j, const float *in, const kernel *k, float *out) {
  filter_rows(j, in, k, j->half);
  filter_columns(j, j->half, k, out);
}

static void ycc_of_xyz(const job *j, const double xyz[3], double ycc[3]) {
  const double x = xyz[0] / j->white[0], y = xyz[1] / j->white[1], z = xyz[2] / j->white[2];
  ycc[0] = 116 * y - 16;
  ycc[1] = 500 * (x - y);
  ycc[2] = 200 * (y - z);
}

static void rgb_of_ycc(const job *j, const double ycc[3], double rgb[3]) {
  const double y = (ycc[0] + 16) / 116;
  const double xyz[3] = {(y + ycc[1] / 500) * j->white[0], y * j->white[1],
                         (y - ycc[2] / 200) * j->white[2]};
  abbe_rgb_space_apply(j->from_xyz, xyz, rgb);
}

static double shown(double value) {
  return value > 0 ? fmin(value, 1) : 0; /* not-a-number too */
}

/* L*, a*, b*, with less colour where it is dark: Hunt's effect [Andersson2020]. */
static void hunt_of_rgb(const job *j, const double rgb[3], double lab[3]) {
  double xyz[3];
  abbe_rgb_space_apply(j->to_xyz, rgb, xyz);
  abbe_difference_lab(xyz, j->white, lab);
  lab[1] *= 0.01 * lab[0];
  lab[2] *= 0.01 * lab[0];
}

/* [Abasi2020], HyAB: lightness by the block, colour as the crow flies; to a power. */
static double colour_distance(const double a[3], const double b[3]) {
  const double x = a[1] - b[1], y = a[2] - b[2];
  return pow(fabs(a[0] - b[0]) + sqrt(x * x + y * y), colour_power);
}

/* out = the length of (out, other). */
static void join(const job *j, float *out) {
#pragma omp parallel for
  for (size_t p = 0; p < j->pixels; p++) {
    const double x = (double)out[p], y = (double)j->other[p];
    out[p] = (float)sqrt(x * x + y * y);
  }
}

/* Each detector along rows and the smoothing along columns, and reversed. */
static void detect(const job *j, const side *out) {
  filter_rows(j, j->ycc[0], &j->edge, j->half);
  filter_columns(j, j->half, &j->smooth, out->edge);
  filter_rows(j, j->ycc[0], &j->point, j->half);
  filter_columns(j, j->half, &j->smooth, out->point);
  filter_rows(j, j->ycc[0], &j->smooth, j->half);
  filter_columns(j, j->half, &j->edge, j->other);
  join(j, out->edge);
  filter_columns(j, j->half, &j->point, j->other);
  join(j, out->point);
}

/* A picture, multiplied by gain and tone-mapped where that is requested. */
static void take_ycc(const job *j, const float (*rgb)[3], double gain, double (*tone)(double)) {
#pragma omp parallel for
  for (size_t p = 0; p < j->pixels; p++) {
    double v[3], xyz[3], ycc[3];
    for (int c = 0; c < 3; c++) {
      v[c] = (double)rgb[p][c] * gain;
      v[c] = shown(tone != NULL ? tone(v[c]) : v[c]);
    }
    abbe_rgb_space_apply(j->to_xyz, v, xyz);
    ycc_of_xyz(j, xyz, ycc);
    for (int c = 0; c < 3; c++) j->ycc[c][p] = (float)ycc[c];
  }
}

/* In the terms that are compared. */
static void take(const job *j, const float (*rgb)[3], double gain, double (*tone)(double),
                 const side *out) {
  take_ycc(j, rgb, gain, tone);
  for (int c = 0; c < 3; c++) {
    blur(j, j->ycc[c], &j->csf[c][0], out->colour[c]);
    if (j->share[c][1] == 0) continue;
    blur(j, j->ycc[c], &j->csf[c][1], j->whole);
    for (size_t p = 0; p < j->pixels; p++)
      out->colour[c][p] = (float)(j->share[c][0] * (double)out->colour[c][p] +
                                  j->share[c][1] * (double)j->whole[p]);
  }
#pragma omp parallel for
  for (size_t p = 0; p < j->pixels; p++) {
    double ycc[3], v[3], lab[3];
    for (int c = 0; c < 3; c++) ycc[c] = (double)out->colour[c][p];
    rgb_of_ycc(j, ycc, v);
    for (int c = 0; c < 3; c++) v[c] = shown(v[c]);
    hunt_of_rgb(j, v, lab);
    for (int c = 0; c < 3; c++) out->colour[c][p] = (float)lab[c];
    j->ycc[0][p] = (j->ycc[0][p] + 16) / 116;
  }
  detect(j, out);
}

static double flip_at(const job *j, size_t p) {
  double lab[2][3];
  for (int s = 0; s < 2; s++)
    for (int c = 0; c < 3; c++) lab[s][c] = (double)j->of[s].colour[c][p];
  const double power = colour_distance(lab[0], lab[1]), bend = knee * j->greatest;
  const double colour = power < bend
                            ? knee_value / bend * power
                            : knee_value + (power - bend) / (j->greatest - bend) * (1 - knee_value);
  const double edge = fabs((double)j->of[0].edge[p] - (double)j->of[1].edge[p]);
  const double point = fabs((double)j->of[0].point[p] - (double)j->of[1].point[p]);
  const double feature = sqrt(fmax(edge, point) / sqrt(2));
  return pow(shown(colour), 1 - shown(feature));
}

static void lay_out(job *j) {
  float *next = j->room;
  float **plane[PLANES] = {&j->ycc[0], &j->ycc[1], &j->ycc[2], &j->half, &j->whole, &j->other};
  for (int s = 0; s < 2; s++) {
    float ***at = plane + SHARED_PLANES + SIDE_PLANES * s;
    for (int c = 0; c < 3; c++) at[c] = &j->of[s].colour[c];
    at[3] = &j->of[s].edge;
    at[4] = &j->of[s].point;
  }
  for (int i = 0; i < PLANES; i++) {
    *plane[i] = next;
    next += j->pixels;
  }
}

static abbe_result begin(size_t width, size_t height, double ppd, job *j, abbe_error *error) {
  static const double green[3] = {0, 1, 0}, blue[3] = {0, 0, 1}, one[3] = {1, 1, 1};
  if (ppd == 0) ppd = ABBE_FLIP_PIXELS_PER_DEGREE;
  if (width == 0 || height == 0 || !(ppd >= 1 && ppd <= max_pixels_per_degree))
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "FLIP of %zu x %zu pixels, %g a degree: there must be pixels, and 1 to %g "
        "a degree",
        width, height, ppd, max_pixels_per_degree);
  *j = (job){.width = width, .height = height, .pixels = width * height};
  j->room = calloc(j->pixels, PLANES * sizeof *j->room);
  if (j->room == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the FLIP of %zu x %zu pixels",
                          width, height);
  lay_out(j);
  make_kernels(j, ppd);
  abbe_rgb_space_to_xyz(ABBE_RGB_SPACE_REC709, j->to_xyz);
  abbe_rgb_space_from_xyz(ABBE_RGB_SPACE_REC709, j->from_xyz);
  abbe_rgb_space_apply(j->to_xyz, one, j->white);
  double lab[2][3];
  hunt_of_rgb(j, green, lab[0]);
  hunt_of_rgb(j, blue, lab[1]);
  j->greatest = colour_distance(lab[0], lab[1]);
  return ABBE_OK;
}

abbe_result abbe_flip_map(const float (*reference)[3], const float (*test)[3], size_t width,
                          size_t height, double pixels_per_degree, float *out, abbe_error *error) {
  job *j = malloc(sizeof *j);
  if (j == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for FLIP");
  abbe_result result = begin(width, height, pixels_per_degree, j, error);
  if (result == ABBE_OK) {
    take(j, reference, 1, NULL, &j->of[0]);
    take(j, test, 1, NULL, &j->of[1]);
#pragma omp parallel for
    for (size_t p = 0; p < j->pixels; p++) out[p] = (float)flip_at(j, p);
    free(j->room);
  }
  free(j);
  return result;
}

/* [Narkowicz2015], with its pre-exposure of 0.6 taken back: (a x^2 + b x) / (c x^2 + d x + e). */
static const double tone_a = 0.36 * 2.51, tone_b = 0.6 * 0.03, tone_c = 0.36 * 2.43,
                    tone_d = 0.6 * 0.59, tone_e = 0.14;

static double tone_curve(double x) {
  return x > 0 ? x * (tone_a * x + tone_b) / (x * (tone_c * x + tone_d) + tone_e) : 0;
}

/* The light that the curve makes `value` of. */
static double tone_inverse(double value) {
  const double a = tone_a - value * tone_c, b = tone_b - value * tone_d, c = -value * tone_e;
  return (-b + sqrt(b * b - 4 * a * c)) / (2 * a);
}

/* Brightest and median Y, of the lit pixels where more than half are dark; false: all are. */
static bool find_light(const job *j, const float (*rgb)[3], double *top, double *median) {
  static const double y_of[3] = {0.2126, 0.7152, 0.0722};
  float *y = j->whole;
  size_t lit = 0;
  for (size_t p = 0; p < j->pixels; p++) {
    double sum = 0;
    for (int c = 0; c < 3; c++) sum += y_of[c] * (double)rgb[p][c];
    y[p] = isfinite(sum) && sum > 0 ? (float)sum : 0;
    lit += y[p] > 0;
  }
  if (lit == 0) return false;
  qsort(y, j->pixels, sizeof *y, abbe_order_ascending_floats);
  *top = (double)y[j->pixels - 1];
  *median = (double)y[j->pixels / 2];
  if (*median == 0) *median = (double)y[j->pixels - lit + lit / 2];
  return true;
}

static abbe_flip_exposures find_exposures(const job *j, const float (*rgb)[3]) {
  double top, median;
  if (!find_light(j, rgb, &top, &median)) return (abbe_flip_exposures){0, 0, 2};
  const double first = log2(tone_inverse(0.85) / top);
  const double last = fmin(log2(tone_inverse(0.85) / median), first + MAX_STOPS);
  return (abbe_flip_exposures){first, last, (size_t)fmax(2, ceil(last - first))};
}

abbe_result abbe_flip_hdr_map(const float (*reference)[3], const float (*test)[3], size_t width,
                              size_t height, double pixels_per_degree, float *out,
                              abbe_flip_exposures *exposures, abbe_error *error) {
  job *j = malloc(sizeof *j);
  if (j == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for FLIP");
  abbe_result result = begin(width, height, pixels_per_degree, j, error);
  if (result == ABBE_OK) {
    const abbe_flip_exposures e = *exposures = find_exposures(j, reference);
    memset(out, 0, j->pixels * sizeof *out);
    for (size_t i = 0; i < e.count; i++) {
      const double stops = e.first + (e.last - e.first) * (double)i / (double)(e.count - 1);
      take(j, reference, exp2(stops), tone_curve, &j->of[0]);
      take(j, test, exp2(stops), tone_curve, &j->of[1]);
#pragma omp parallel for
      for (size_t p = 0; p < j->pixels; p++) out[p] = fmaxf(out[p], (float)flip_at(j, p));
    }
    free(j->room);
  }
  free(j);
  return result;
}
