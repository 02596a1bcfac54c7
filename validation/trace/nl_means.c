#include "validation/trace/nl_means.h"

#include "base/maths.h"

#include <math.h>
#include <omp.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

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

enum { TILE = 64, MOST_PATCH = 4, ROOM = TILE + 2 * MOST_PATCH };

/* Planes with a rim of mirrored pixels, so that no patch leaves them. */
typedef struct rimmed {
  size_t stride, rim;
  float *compare[ABBE_NL_MEANS_PLANES], *compare_variance[ABBE_NL_MEANS_PLANES];
  float *feature[ABBE_NL_MEANS_PLANES], *feature_variance[ABBE_NL_MEANS_PLANES];
  float *filter[ABBE_NL_MEANS_PLANES], *filter_variance[ABBE_NL_MEANS_PLANES];
  float *inside; /* 1 in the picture, 0 in the rim */
  float *block;
} rimmed;

static size_t mirror(ptrdiff_t at, size_t size) {
  const ptrdiff_t period = 2 * (ptrdiff_t)size;
  at = (at % period + period) % period;
  return (size_t)(at < (ptrdiff_t)size ? at : period - 1 - at);
}

static float *add_plane(const abbe_nl_means *job, rimmed *r, float **next, const float *from) {
  const size_t rows = job->height + 2 * r->rim;
  float *to = *next;
  *next += rows * r->stride;
  for (size_t y = 0; y < rows; y++)
    for (size_t x = 0; x < r->stride; x++)
      to[y * r->stride + x] =
          from[mirror((ptrdiff_t)y - (ptrdiff_t)r->rim, job->height) * job->width +
               mirror((ptrdiff_t)x - (ptrdiff_t)r->rim, job->width)];
  return to;
}

static abbe_result make_rimmed(const abbe_nl_means *job, rimmed *r, abbe_error *error) {
  *r = (rimmed){.rim = job->window + job->patch};
  r->stride = job->width + 2 * r->rim;
  const size_t plane = r->stride * (job->height + 2 * r->rim);
  r->block =
      malloc(plane * (2 * (job->compared + job->features + job->filtered) + 1) * sizeof(float));
  if (r->block == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to filter %zu x %zu pixels", job->width,
                          job->height);
  float *next = r->block;
  for (size_t i = 0; i < job->compared; i++) {
    r->compare[i] = add_plane(job, r, &next, job->compare[i].value);
    r->compare_variance[i] = add_plane(job, r, &next, job->compare[i].variance);
  }
  for (size_t i = 0; i < job->features; i++) {
    r->feature[i] = add_plane(job, r, &next, job->feature[i].value);
    r->feature_variance[i] = add_plane(job, r, &next, job->feature[i].variance);
  }
  for (size_t i = 0; i < job->filtered; i++) {
    r->filter[i] = add_plane(job, r, &next, job->filter[i].value);
    r->filter_variance[i] = add_plane(job, r, &next, job->filter[i].variance);
  }
  r->inside = next;
  memset(r->inside, 0, plane * sizeof(float));
  for (size_t y = 0; y < job->height; y++)
    for (size_t x = 0; x < job->width; x++) r->inside[(y + r->rim) * r->stride + x + r->rim] = 1;
  return ABBE_OK;
}

/* Sums of a tile. */
typedef struct tile {
  size_t features; /* that vary in and around the tile */
  size_t feature[ABBE_NL_MEANS_PLANES];
  size_t x0, y0, width, height;
  float distance[ROOM * ROOM], across[ROOM * ROOM];
  float weight[TILE], most[TILE];
  float total[TILE * TILE];
  float sum[ABBE_NL_MEANS_PLANES][TILE * TILE], square[ABBE_NL_MEANS_PLANES][TILE * TILE];
} tile;

/* d += of one row: differences beyond the noise of both. */
SIDE_BY_SIDE static void add_distance(const float *restrict a, const float *restrict va,
                                      const float *restrict b, const float *restrict vb, float k2,
                                      size_t count, float *restrict d) {
  for (size_t i = 0; i < count; i++) {
    const float off = a[i] - b[i], least = va[i] < vb[i] ? va[i] : vb[i];
    d[i] += (off * off - (va[i] + least)) / (1e-20f + k2 * (va[i] + vb[i]));
  }
}

SIDE_BY_SIDE static void add_feature(const float *restrict a, const float *restrict va,
                                     const float *restrict b, const float *restrict vb,
                                     size_t count, float *restrict most) {
  for (size_t i = 0; i < count; i++) {
    const float off = a[i] - b[i], least = va[i] < vb[i] ? va[i] : vb[i];
    const float scale = va[i] > 1 ? va[i] : 1;
    const float d = (off * off - (va[i] + least)) / scale - 1;
    most[i] = most[i] > d ? most[i] : d;
  }
}

SIDE_BY_SIDE static void add_rows(const float *restrict from, size_t stride, size_t rows,
                                  float scale, size_t count, float *restrict out) {
  for (size_t i = 0; i < count; i++) out[i] = 0;
  for (size_t y = 0; y < rows; y++)
    for (size_t i = 0; i < count; i++) out[i] += from[y * stride + i];
  for (size_t i = 0; i < count; i++) out[i] *= scale;
}

SIDE_BY_SIDE static void add_columns(const float *restrict from, size_t columns, size_t count,
                                     float *restrict out) {
  for (size_t i = 0; i < count; i++) out[i] = from[i];
  for (size_t x = 1; x < columns; x++)
    for (size_t i = 0; i < count; i++) out[i] += from[i + x];
}

/* exp(-d), to 2e-4; 1 below 0, and 0 from 15 on. */
SIDE_BY_SIDE static void weigh(const float *restrict d, const float *restrict inside, size_t count,
                               float *restrict w) {
  for (size_t i = 0; i < count; i++) {
    float x = d[i] > 0 ? d[i] : 0;
    const float kept = x < 15 ? inside[i] : 0;
    x = (x < 15 ? x : 15) * -1.44269504f + 32;
    const int32_t whole = (int32_t)x;
    const float part = x - (float)whole;
    const float power = 1 + part * (0.69565f + part * (0.2261f + part * 0.07825f));
    const union {
      int32_t bits;
      float number;
    } scale = {.bits = (whole + 127 - 32) << 23};
    w[i] = power * scale.number * kept;
  }
}

SIDE_BY_SIDE static void add_weighted(const float *restrict w, const float *restrict value,
                                      const float *restrict variance, size_t count,
                                      float *restrict sum, float *restrict square) {
  for (size_t i = 0; i < count; i++) {
    sum[i] += w[i] * value[i];
    square[i] += w[i] * w[i] * variance[i];
  }
}

static void add_offset(const abbe_nl_means *job, const rimmed *r, tile *t, ptrdiff_t dy,
                       ptrdiff_t dx) {
  const size_t f = job->patch, side = 2 * f + 1, columns = t->width + 2 * f;
  const float k2 = job->noise * job->noise;
  const float scale = 1 / ((float)(side * side) * (float)job->compared);
  const ptrdiff_t move = dy * (ptrdiff_t)r->stride + dx;
  for (size_t y = 0; y < t->height + 2 * f; y++) {
    float *d = t->distance + y * ROOM;
    const size_t at = (t->y0 + y + r->rim - f) * r->stride + t->x0 + r->rim - f;
    memset(d, 0, columns * sizeof *d);
    for (size_t i = 0; i < job->compared; i++)
      add_distance(r->compare[i] + at, r->compare_variance[i] + at,
                   r->compare[i] + (ptrdiff_t)at + move,
                   r->compare_variance[i] + (ptrdiff_t)at + move, k2, columns, d);
    add_columns(d, side, t->width, t->across + y * ROOM);
  }
  for (size_t y = 0; y < t->height; y++) {
    const size_t at = (t->y0 + y + r->rim) * r->stride + t->x0 + r->rim;
    const size_t other = (size_t)((ptrdiff_t)at + move);
    add_rows(t->across + y * ROOM, ROOM, side, scale, t->width, t->most);
    for (size_t i = 0; i < t->features; i++) {
      const size_t k = t->feature[i];
      add_feature(r->feature[k] + at, r->feature_variance[k] + at, r->feature[k] + other,
                  r->feature_variance[k] + other, t->width, t->most);
    }
    weigh(t->most, r->inside + other, t->width, t->weight);
    for (size_t x = 0; x < t->width; x++) t->total[y * TILE + x] += t->weight[x];
    for (size_t i = 0; i < job->filtered; i++)
      add_weighted(t->weight, r->filter[i] + other, r->filter_variance[i] + other, t->width,
                   t->sum[i] + y * TILE, t->square[i] + y * TILE);
  }
}

/* Features that nowhere differ by 1 say nothing. */
static void find_features(const abbe_nl_means *job, const rimmed *r, tile *t) {
  t->features = 0;
  for (size_t i = 0; i < job->features; i++) {
    float least = INFINITY, most = -INFINITY;
    for (size_t y = t->y0 + job->patch; y < t->y0 + t->height + 2 * r->rim - job->patch; y++)
      for (size_t x = t->x0 + job->patch; x < t->x0 + t->width + 2 * r->rim - job->patch; x++) {
        const float at = r->feature[i][y * r->stride + x];
        least = at < least ? at : least;
        most = at > most ? at : most;
      }
    if (most - least > 1) t->feature[t->features++] = i;
  }
}

static void run_tile(const abbe_nl_means *job, const rimmed *r, tile *t) {
  const ptrdiff_t window = (ptrdiff_t)job->window;
  find_features(job, r, t);
  memset(t->total, 0, sizeof t->total);
  memset(t->sum, 0, sizeof t->sum);
  memset(t->square, 0, sizeof t->square);
  for (ptrdiff_t dy = -window; dy <= window; dy++)
    for (ptrdiff_t dx = -window; dx <= window; dx++) add_offset(job, r, t, dy, dx);
  for (size_t y = 0; y < t->height; y++)
    for (size_t x = 0; x < t->width; x++) {
      const size_t at = (t->y0 + y) * job->width + t->x0 + x, in = y * TILE + x;
      const float own = 1 / t->total[in];
      if (job->own != NULL) job->own[at] = own;
      for (size_t i = 0; i < job->filtered; i++) {
        job->out[i][at] = t->sum[i][in] * own;
        if (job->out_variance[i] != NULL) job->out_variance[i][at] = t->square[i][in] * own * own;
      }
    }
}

abbe_result abbe_nl_means_run(const abbe_nl_means *job, size_t threads, abbe_error *error) {
  rimmed r;
  abbe_result result = make_rimmed(job, &r, error);
  if (result != ABBE_OK) return result;
  tile *room = malloc(threads * sizeof *room);
  const size_t across = (job->width + TILE - 1) / TILE, down = (job->height + TILE - 1) / TILE;
  if (room == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a filter's tiles");
#pragma omp parallel for schedule(dynamic) num_threads((int)threads) if (room != NULL)
  for (size_t i = 0; i < (room != NULL ? across * down : 0); i++) {

    tile *t = &room[omp_get_thread_num()];
    t->x0 = i % across * TILE;
    t->y0 = i / across * TILE;
    t->width = job->width - t->x0 < TILE ? job->width - t->x0 : TILE;
    t->height = job->height - t->y0 < TILE ? job->height - t->y0 : TILE;
    run_tile(job, &r, t);
  }
  free(room);
  free(r.block);
  return result;
}
