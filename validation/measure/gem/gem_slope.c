#include "validation/measure/gem/gem_slope.h"

#include "base/maths.h"
#include "validation/measure/gem/gem_stretch.h"
#include "validation/measure/gem/gem_view.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { REPEATS = ABBE_GEM_SLOPE_REPEATS, MOST = ABBE_GEM_SLOPE_MOST };
/* So far behind the end of a stretch the next is looked for. */
#define BEYOND 1e-9
/* A plane along the line of sight. */
#define UPRIGHT 1e-12

/* ---- lines ---- */

/* Where the line comes to the stone. */
static bool find_start(const abbe_gem_stretch *w, const double o[3], double *low, double *high) {
  const abbe_gem_stone *s = w->stone;
  *low = -INFINITY;
  *high = INFINITY;
  for (size_t i = 0; i < s->plane_count; i++) {
    const double a = abbe_vector_dot(s->plane[i], w->sight);
    if (a > UPRIGHT) continue;
    const double off = s->plane[i][3] - abbe_vector_dot(s->plane[i], o);
    const double run = abbe_vector_dot(s->plane[i], w->line);
    for (size_t j = 0; j < s->plane_count; j++) { /* of an upright plane: itself alone */
      const double c = abbe_vector_dot(s->plane[j], w->sight);
      const bool upright = a >= -UPRIGHT;
      if (upright ? i != j : c <= UPRIGHT) continue;
      const double far = s->plane[j][3] - abbe_vector_dot(s->plane[j], o);
      const double rate = upright ? run : abbe_vector_dot(s->plane[j], w->line) / c - run / a;
      const double space = upright ? off : far / c - off / a;
      if (rate > 0) *high = fmin(*high, space / rate);
      if (rate < 0) *low = fmax(*low, space / rate);
      if (rate == 0 && space < 0) return false;
    }
  }
  return *low < *high;
}

/* Of each measure; behind the last measure's derivatives come those of the area. */
typedef struct sums {
  const abbe_gem_slope_desc *measure;
  size_t count;
  double value[MOST], area;
  abbe_gem_stretch_by by[MOST + 1];
} sums;

/* o: where the line is at 0. The light of all stretches, each weighted alike. pair: room for a
 * stretch and the one before it. */
static void run_line(abbe_gem_stretch *pair, const double o[3], double weight, sums *to) {
  const size_t count = to->count;
  double low, high, before[MOST] = {0}, jump[MOST + 1], value[MOST], drift[MOST];
  abbe_gem_stretch *w = &pair[0], *last = NULL;
  if (!find_start(w, o, &low, &high)) return;
  for (double t = low + BEYOND; t < high; t = fmax(last->high, t) + BEYOND) {
    double at[3];
    for (int k = 0; k < 3; k++) at[k] = o[k] + t * w->line[k];
    w->t = t;
    abbe_gem_stretch_follow(w, at);
    const double from = last == NULL ? w->low : last->high, length = w->high - from;
    abbe_gem_stretch_light(w, 0.5 * (from + w->high), weight * length, to->measure, count, value,
                           drift, to->by);
    to->area += weight * length;
    for (size_t j = 0; j < count; j++) {
      to->value[j] += weight * length * value[j];
      jump[j] = weight * (before[j] - value[j] + 0.5 * length * drift[j]);
      before[j] = value[j] + 0.5 * length * drift[j];
    }
    jump[count] = -weight;
    if (last != NULL)
      abbe_gem_stretch_move(last, true, jump, count, to->by);
    else
      abbe_gem_stretch_move(w, false, jump, count + 1, to->by);
    last = w;
    w = last == pair ? &pair[1] : pair;
  }
  if (last == NULL) return;
  for (size_t j = 0; j < count; j++) jump[j] = weight * before[j];
  jump[count] = weight;
  abbe_gem_stretch_move(last, true, jump, count + 1, to->by);
}

/* As often as it counts in white light. */
static uint32_t wavelength_at(const abbe_weights *weights, double chance) {
  double below = 0;
  uint32_t k = 0;
  while (k + 1 < weights->count) {
    below += weights->weight[k][1] / weights->sum[1];
    if (chance < below) break;
    k++;
  }
  return k;
}

static size_t lines_of(const abbe_gem_slope_desc *q) {
  return q->lines > 0 ? q->lines : 12;
}

/* Says how many lines are done, of which only the first thread tells; false: it was stopped. */
static bool report(const abbe_gem_slope_desc *q, size_t lines, size_t *done, bool *stopped) {
  size_t now;
  bool over;
#pragma omp atomic capture
  now = ++*done;
#pragma omp atomic read
  over = *stopped;
  if (over || q->progress == NULL || omp_get_thread_num() != 0) return !over;
  over = !q->progress(q->user, (double)now / (double)(REPEATS * lines));
  if (over)
#pragma omp atomic write
    *stopped = true;
  return !over;
}

/* Where the line is that has that number, and its wavelength. */
static uint32_t start_line(abbe_gem_stretch w[2], const abbe_weights *weights, size_t lines,
                           size_t line, double shift, const double across[3], double o[3]) {
  const double aside = 2 * ((double)line + shift) / (double)lines - 1;
  const double chance = fmod(0.5 + (double)line * 0.6180339887498949 + shift, 1);
  const uint32_t k = wavelength_at(weights, chance);
  w->n = (double)abbe_media_n(&w->stone->media, 0, k, 0);
  w->n_blue = w->n + w->q->spread;
  w->loss = (double)abbe_media_attenuation(&w->stone->media, 0, k, 0);
  w[1] = w[0];
  for (int c = 0; c < 3; c++) o[c] = aside * across[c] - 2 * w->sight[c];
  return k;
}

/* Lines of a repeat lie side by side in a direction of its own, one wavelength each. */
static void run_repeat(const abbe_gem_stone *s, const abbe_weights *weights,
                       const abbe_gem_slope_desc *q, size_t count, size_t repeat,
                       abbe_gem_stretch w[2], size_t *done, bool *stopped, abbe_gem_slope *out) {
  const abbe_gem_eye eye = abbe_gem_eye_make(q->axis_rad, q->tilt_rad);
  const size_t lines = lines_of(q), planes = repeat * s->plane_count;
  /* directions and places by multiples of irrational numbers: none along a facet's edge */
  const double turn = ABBE_PI * fmod(0.1 + (double)repeat * 0.6180339887498949, 1);
  const double shift = fmod(0.3 + (double)repeat * 0.7548776662466927, 1);
  sums to = {.measure = q, .count = count};
  to.by[count].plane = out->by_area + planes;
  for (size_t j = 0; j < count; j++) to.by[j].plane = out[j].by_sum + planes;
  w->stone = s;
  w->q = q;
  w->light = abbe_gem_light_make(eye.to_eye, q->head_rad);
  double across[3], o[3];
  for (int k = 0; k < 3; k++) {
    w->sight[k] = -eye.to_eye[k];
    w->line[k] = cos(turn) * eye.right[k] + sin(turn) * eye.up[k];
    across[k] = cos(turn) * eye.up[k] - sin(turn) * eye.right[k];
  }
  for (size_t i = 0; i < lines && report(q, lines, done, stopped); i++) {
    const size_t k = repeat * s->wavelengths + start_line(w, weights, lines, i, shift, across, o);
    run_line(w, o, 2 / (double)lines, &to);
    for (size_t j = 0; j < count; j++) {
      abbe_gem_stretch_by *by = &to.by[j];
      out[j].by_n[k] += by->n + by->spread;
      out[j].by_loss[k] += by->loss;
      out[j].by_spread[repeat] += by->spread;
      by->n = by->loss = by->spread = 0;
    }
  }
  for (size_t j = 0; j < count; j++) {
    out[j].sum[repeat] = to.value[j];
    out[j].area[repeat] = to.area;
    if (j > 0)
      memcpy(out[j].by_area + planes, out->by_area + planes, s->plane_count * sizeof *out->by_area);
  }
}

static bool make_rows(const abbe_gem_stone *s, abbe_gem_slope *out) {
  *out = (abbe_gem_slope){.planes = s->plane_count, .wavelengths = s->wavelengths};
  out->by_sum = calloc(REPEATS * s->plane_count, sizeof *out->by_sum);
  out->by_area = calloc(REPEATS * s->plane_count, sizeof *out->by_area);
  out->by_n = calloc(REPEATS * s->wavelengths, sizeof *out->by_n);
  out->by_loss = calloc(REPEATS * s->wavelengths, sizeof *out->by_loss);
  return out->by_sum && out->by_area && out->by_n && out->by_loss;
}

static bool measured(abbe_gem_amount amount) {
  return amount == ABBE_GEM_AMOUNT_COUNT || amount == ABBE_GEM_ISO || amount == ABBE_GEM_COS ||
         amount == ABBE_GEM_RETURN || amount == ABBE_GEM_DOWN || amount == ABBE_GEM_GEMRAY_ISO ||
         amount == ABBE_GEM_GEMRAY_COS || amount == ABBE_GEM_GEMRAY_SC2;
}

abbe_result abbe_gem_slope_make(const abbe_gem_stone *s, const abbe_weights *weights,
                                const abbe_gem_slope_desc *q, size_t count, abbe_gem_slope *out,
                                abbe_error *error) {
  memset(out, 0, count * sizeof *out);
  ABBE_TRY(abbe_gem_view_check(s, weights, q->head_rad, error));
  for (size_t j = 0; j < count; j++)
    if (!measured(q[j].measure))
      return abbe_error_set(error, ABBE_UNSUPPORTED, "there is no derivative of %s",
                            abbe_gem_amount_text(q[j].measure));
  if (q->meetings > ABBE_GEM_SLOPE_MEETINGS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "paths of %zu facets; there are up to %d",
                          q->meetings, ABBE_GEM_SLOPE_MEETINGS);
  ABBE_FREED abbe_gem_stretch *w = calloc(2 * REPEATS, sizeof *w);
  bool made = w != NULL, stopped = false;
  for (size_t j = 0; j < count; j++) made = make_rows(s, &out[j]) && made;
  const int threads = q->threads > 0 ? (int)q->threads : omp_get_max_threads();
  size_t done = 0;
  if (made) {
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (int r = 0; r < REPEATS; r++)
      run_repeat(s, weights, q, count, (size_t)r, &w[2 * r], &done, &stopped, out);
  }
  for (size_t j = 0; j < count && made && !stopped; j++)
    out[j].value = abbe_gem_number_ratio(out[j].sum, out[j].area, REPEATS);
  if (made && !stopped) return ABBE_OK;
  for (size_t j = 0; j < count; j++) abbe_gem_slope_free(&out[j]);
  return stopped ? abbe_error_set(error, ABBE_CANCELLED, "the derivatives were stopped")
                 : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a stone's derivatives");
}

void abbe_gem_slope_free(abbe_gem_slope *slope) {
  if (slope == NULL) return;
  free(slope->by_sum);
  free(slope->by_area);
  free(slope->by_n);
  free(slope->by_loss);
  *slope = (abbe_gem_slope){0};
}

/* Of the mean of all repeats but one (REPEATS: of all). */
static double by_without(const abbe_gem_slope *s, double by[REPEATS][2], size_t without) {
  double sum = 0, area = 0, by_sum = 0, by_area = 0;
  for (size_t r = 0; r < REPEATS; r++) {
    if (r == without) continue;
    sum += s->sum[r];
    area += s->area[r];
    by_sum += by[r][0];
    by_area += by[r][1];
  }
  return area > 0 ? (by_sum - sum / area * by_area) / area : 0;
}

abbe_gem_number abbe_gem_slope_by(const abbe_gem_slope *s, const abbe_gem_change *by) {
  double of[REPEATS][2] = {{0}}, without[REPEATS];
  for (size_t r = 0; r < REPEATS; r++) {
    for (size_t i = 0; i < s->planes && by->plane != NULL; i++)
      for (int k = 0; k < 4; k++) {
        of[r][0] += s->by_sum[r * s->planes + i][k] * by->plane[i][k];
        of[r][1] += s->by_area[r * s->planes + i][k] * by->plane[i][k];
      }
    for (size_t k = 0; k < s->wavelengths; k++) {
      of[r][0] += by->n != NULL ? s->by_n[r * s->wavelengths + k] * by->n[k] : 0;
      of[r][0] += by->loss != NULL ? s->by_loss[r * s->wavelengths + k] * by->loss[k] : 0;
    }
    of[r][0] += s->by_spread[r] * by->spread;
  }
  for (size_t r = 0; r < REPEATS; r++) without[r] = by_without(s, of, r);
  return abbe_gem_number_jackknife(by_without(s, of, REPEATS), without, REPEATS);
}
