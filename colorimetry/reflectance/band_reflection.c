#include "colorimetry/reflectance/reflected_light.h"

#include "colorimetry/rgb_space.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TURNS = ABBE_BAND_REFLECTION_TURNS, RINGS = ABBE_BAND_REFLECTION_RINGS, MOST_WIDTHS = 64 };

/* Shares of the distance to the locus: mixtures below, bands above. */
static const double mixed = 0.3, banded = 0.7;

/* A band in one direction: how far from the white, its shares, and its X + Y + Z. */
typedef struct place {
  double turn, off[2], distance, share[3], light;
} place;

typedef struct work {
  const abbe_reflected_light *light;
  size_t steps;
  double (*all)[3], (*kept)[3]; /* [steps + 1], sums up to each step of the light, and reflected */
  double white[2], whole[3];    /* its chromaticity, and shares of all of it */
  double matrix[9];             /* matrix of the mixture */
  place *ring;                  /* [steps], bands of one width */
  size_t count[TURNS];
  place (*found)[MOST_WIDTHS]; /* [TURNS], of each width */
} work;

/* 0 to 4. */
static double turn_of(const double off[2]) {
  const double size = fabs(off[0]) + fabs(off[1]), t = size > 0 ? off[1] / size : 0;
  return off[0] < 0 ? 2 - t : t < 0 ? 4 + t : t;
}

static void set_shares(const double all[3], const double kept[3], double share[3]) {
  const double least = 1e-7, sum = all[0] + all[1] + all[2];
  const double mean = (kept[0] + kept[1] + kept[2]) / sum;
  for (int k = 0; k < 3; k++) share[k] = all[k] > least * sum ? kept[k] / all[k] : mean;
}

/* Sums the steps from `first` on, going on at the beginning. */
static void sum_band(const work *w, const double (*sum)[3], size_t first, size_t width,
                     double out[3]) {
  const size_t end = first + width;
  for (int k = 0; k < 3; k++)
    out[k] = end <= w->steps ? sum[end][k] - sum[first][k]
                             : sum[w->steps][k] - sum[first][k] + sum[end - w->steps][k];
}

/* Bands of that width, those without light left out. */
static size_t find_bands(work *w, size_t width) {
  const double *total = w->all[w->steps];
  const double least = 1e-9 * (total[0] + total[1] + total[2]);
  size_t count = 0;
  for (size_t first = 0; first < w->steps; first++) {
    double all[3], kept[3];
    place *p = &w->ring[count];
    sum_band(w, (const double(*)[3])w->all, first, width, all);
    sum_band(w, (const double(*)[3])w->kept, first, width, kept);
    p->light = all[0] + all[1] + all[2];
    if (!(p->light > least)) continue;
    for (int k = 0; k < 2; k++) p->off[k] = all[k] / p->light - w->white[k];
    p->turn = turn_of(p->off);
    set_shares(all, kept, p->share);
    count++;
  }
  return count;
}

/* The place on the chord from a to b, a share `part` along it. */
static place between(const place *a, const place *b, double part) {
  place p = {.light = fmin(a->light, b->light)};
  for (int k = 0; k < 2; k++) p.off[k] = a->off[k] + part * (b->off[k] - a->off[k]);
  for (int k = 0; k < 3; k++) p.share[k] = a->share[k] + part * (b->share[k] - a->share[k]);
  p.distance = hypot(p.off[0], p.off[1]);
  return p;
}

/* Where neighbouring bands lie on both sides of a direction, one on it lies between; of several the
 * brightest counts. */
static void cross(work *w, size_t bands) {
  place best[TURNS];
  memset(best, 0, sizeof best);
  for (size_t i = 0; i < bands; i++) {
    const place *a = &w->ring[i], *b = &w->ring[(i + 1) % bands];
    double by = b->turn - a->turn;
    if (by > 2) by -= 4;
    if (by < -2) by += 4;
    if (by == 0) continue;
    const double low = fmin(a->turn, a->turn + by), high = fmax(a->turn, a->turn + by);
    for (long t = lround(ceil(low * TURNS / 4)); t <= high * TURNS / 4; t++) {
      const place here = between(a, b, ((double)t * 4 / TURNS - a->turn) / by);
      place *to = &best[(t + TURNS) % TURNS];
      if (here.light > to->light) *to = here;
    }
  }
  for (size_t t = 0; t < TURNS; t++)
    if (best[t].light > 0 && w->count[t] + 1 < MOST_WIDTHS) w->found[t][w->count[t]++] = best[t];
}

static int by_distance(const void *a, const void *b) {
  const double x = ((const place *)a)->distance, y = ((const place *)b)->distance;
  return (x > y) - (x < y);
}

/* At a distance among those of one direction, which begin at the white. */
static void band_at(const place *found, size_t count, double distance, double share[3]) {
  size_t i = 0;
  while (i + 2 < count && found[i + 1].distance < distance) i++;
  const place *a = &found[i], *b = &found[i + 1 < count ? i + 1 : i];
  const double span = b->distance - a->distance;
  const double part = span > 0 ? fmin(fmax((distance - a->distance) / span, 0), 1) : 0;
  for (int k = 0; k < 3; k++) share[k] = a->share[k] + part * (b->share[k] - a->share[k]);
}

static void mixture_at(const work *w, const double off[2], const double otherwise[3],
                       double share[3]) {
  const double least = 1e-6, x = w->white[0] + off[0], y = w->white[1] + off[1];
  const double xyz[3] = {x, y, 1 - x - y};
  double kept[3];
  abbe_rgb_space_apply(w->matrix, xyz, kept);
  for (int k = 0; k < 3; k++) share[k] = xyz[k] > least ? kept[k] / xyz[k] : otherwise[k];
}

static void fill_direction(work *w, size_t t, float (*cell)[4]) {
  place *found = w->found[t];
  const double turn = (double)t * 4 / TURNS;
  const double x = turn <= 2 ? 1 - turn : turn - 3, y = turn <= 1   ? turn
                                                        : turn <= 3 ? 2 - turn
                                                                    : turn - 4;
  const double size = hypot(x, y);
  found[w->count[t]] = (place){.share = {w->whole[0], w->whole[1], w->whole[2]}};
  const size_t count = w->count[t] + 1;
  qsort(found, count, sizeof *found, by_distance);
  const double most = fmax(found[count - 1].distance, 1e-6);
  for (size_t r = 0; r <= RINGS; r++) {
    const double way = (double)r / RINGS, distance = way * most;
    const double off[2] = {distance * x / size, distance * y / size};
    const double along = fmin(fmax((way - mixed) / (banded - mixed), 0), 1);
    const double weight = along * along * (3 - 2 * along);
    double band[3], mixture[3];
    band_at(found, count, distance, band);
    mixture_at(w, off, band, mixture);
    for (int k = 0; k < 3; k++) cell[r][k] = (float)(weight * band[k] + (1 - weight) * mixture[k]);
    cell[r][3] = (float)most;
  }
}

static void sum_steps(work *w, const abbe_spectrum *measured, const double rgb[3]) {
  for (size_t i = 0; i < w->steps; i++) {
    double nm, xyz[3], channel[3];
    abbe_reflected_light_step(w->light, i, &nm, xyz);
    abbe_reflectance_channels(measured, nm, channel);
    const double share = measured != NULL
                             ? channel[0]
                             : rgb[0] * channel[0] + rgb[1] * channel[1] + rgb[2] * channel[2];
    for (int k = 0; k < 3; k++) {
      w->all[i + 1][k] = w->all[i][k] + xyz[k];
      w->kept[i + 1][k] = w->kept[i][k] + share * xyz[k];
    }
  }
}

static void find_matrix(work *w, const abbe_spectrum *measured, const double rgb[3]) {
  double of[3][9];
  abbe_reflected_light_matrices(w->light, measured, of);
  for (int i = 0; i < 9; i++)
    w->matrix[i] =
        measured != NULL ? of[0][i] : rgb[0] * of[0][i] + rgb[1] * of[1][i] + rgb[2] * of[2][i];
}

abbe_result abbe_band_reflection_fill(const abbe_reflected_light *light,
                                      const abbe_spectrum *measured, const double rgb[3],
                                      float (*cell)[4], abbe_error *error) {
  work w = {.light = light, .steps = abbe_reflected_light_steps(light)};
  w.all = calloc(w.steps + 1, sizeof *w.all);
  w.kept = calloc(w.steps + 1, sizeof *w.kept);
  w.ring = calloc(w.steps, sizeof *w.ring);
  w.found = calloc(TURNS, sizeof *w.found);
  const bool made = w.all != NULL && w.kept != NULL && w.ring != NULL && w.found != NULL;
  if (made) {
    sum_steps(&w, measured, rgb);
    const double *total = w.all[w.steps], sum = total[0] + total[1] + total[2];
    memset(cell, 0, ABBE_BAND_REFLECTION_CELLS * sizeof *cell);
    if (sum > 0) { /* else no light is seen */
      for (int k = 0; k < 2; k++) w.white[k] = total[k] / sum;
      set_shares(total, w.kept[w.steps], w.whole);
      find_matrix(&w, measured, rgb);
      const size_t step = w.steps / (MOST_WIDTHS - 8) + 1;
      for (size_t width = 1; width < w.steps; width += width == 1 ? step - (step > 1) : step)
        cross(&w, find_bands(&w, width));
      for (size_t t = 0; t < TURNS; t++) fill_direction(&w, t, cell + t * (RINGS + 1));
    }
  }
  free(w.all);
  free(w.kept);
  free(w.ring);
  free(w.found);
  return made ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for reflections");
}

void abbe_band_reflection_apply(const float (*cell)[4], const double white[3], const double xyz[3],
                                double out[3]) {
  const double all = white[0] + white[1] + white[2], sum = xyz[0] + xyz[1] + xyz[2];
  for (int k = 0; k < 3; k++) out[k] = 0;
  if (!(all > 0 && sum > 0)) return;
  const double off[2] = {xyz[0] / sum - white[0] / all, xyz[1] / sum - white[1] / all};
  const double turn = turn_of(off) * TURNS / 4;
  const size_t a = (size_t)turn % TURNS, b = (a + 1) % TURNS;
  const float(*at_a)[4] = cell + a * (RINGS + 1), (*at_b)[4] = cell + b * (RINGS + 1);
  const double part = turn - floor(turn);
  const double most = (1 - part) * (double)at_a[0][3] + part * (double)at_b[0][3];
  const double way = RINGS * fmin(hypot(off[0], off[1]) / fmax(most, 1e-6), 1);
  const size_t r = way < RINGS ? (size_t)way : RINGS - 1;
  const double above = way - (double)r;
  for (int k = 0; k < 3; k++) {
    const double share_a = (1 - above) * (double)at_a[r][k] + above * (double)at_a[r + 1][k];
    const double share_b = (1 - above) * (double)at_b[r][k] + above * (double)at_b[r + 1][k];
    out[k] = ((1 - part) * share_a + part * share_b) * xyz[k];
  }
}
