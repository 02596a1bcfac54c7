#include "validation/measure/gem/gem_slope.h"

#include "base/maths.h"
#include "validation/measure/gem/gem_stretch.h"
#include "validation/measure/gem/gem_view.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>

enum { REPEATS = ABBE_GEM_SLOPE_REPEATS };
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

typedef struct sums {
  double value, area;
  abbe_gem_stretch_by by_value, by_area;
} sums;

/* o: where the line is at 0. The light of all stretches, each weighted alike. pair: room for a
 * stretch and the one before it. */
static void run_line(abbe_gem_stretch *pair, const double o[3], double weight, sums *to) {
  double low, high, before = 0;
  abbe_gem_stretch *w = &pair[0], *last = NULL;
  if (!find_start(w, o, &low, &high)) return;
  for (double t = low + BEYOND; t < high; t = fmax(last->high, t) + BEYOND) {
    double at[3];
    for (int k = 0; k < 3; k++) at[k] = o[k] + t * w->line[k];
    w->t = t;
    abbe_gem_stretch_follow(w, at);
    const double from = last == NULL ? w->low : last->high, length = w->high - from;
    abbe_gem_stretch_light(w, 0.5 * (from + w->high), weight * length, &to->by_value);
    to->value += weight * length * w->value;
    to->area += weight * length;
    const double begins = w->value - 0.5 * length * w->drift;
    if (last != NULL) {
      abbe_gem_stretch_move(last, true, weight * (before - begins), &to->by_value);
    } else {
      abbe_gem_stretch_move(w, false, -weight * begins, &to->by_value);
      abbe_gem_stretch_move(w, false, -weight, &to->by_area);
    }
    before = w->value + 0.5 * length * w->drift;
    last = w;
    w = last == pair ? &pair[1] : pair;
  }
  if (last == NULL) return;
  abbe_gem_stretch_move(last, true, weight * before, &to->by_value);
  abbe_gem_stretch_move(last, true, weight, &to->by_area);
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

/* Lines of a repeat lie side by side in a direction of its own, one wavelength each. */
static void run_repeat(const abbe_gem_stone *s, const abbe_weights *weights,
                       const abbe_gem_slope_desc *q, size_t repeat, abbe_gem_stretch w[2],
                       abbe_gem_slope *out) {
  sums to = {.by_value.plane = out->by_sum + repeat * s->plane_count,
             .by_area.plane = out->by_area + repeat * s->plane_count};
  const abbe_gem_eye eye = abbe_gem_eye_make(q->axis_rad, q->tilt_rad);
  const size_t lines = q->lines > 0 ? q->lines : 12;
  /* directions and places by multiples of irrational numbers: none along a facet's edge */
  const double turn = ABBE_PI * fmod(0.1 + (double)repeat * 0.6180339887498949, 1);
  double spread = 0;
  const double shift = fmod(0.3 + (double)repeat * 0.7548776662466927, 1);
  w->stone = s;
  w->q = q;
  w->light = abbe_gem_light_make(eye.to_eye, q->head_rad);
  double across[3];
  for (int k = 0; k < 3; k++) {
    w->sight[k] = -eye.to_eye[k];
    w->line[k] = cos(turn) * eye.right[k] + sin(turn) * eye.up[k];
    across[k] = cos(turn) * eye.up[k] - sin(turn) * eye.right[k];
  }
  for (size_t i = 0; i < lines; i++) {
    const double aside = 2 * ((double)i + shift) / (double)lines - 1;
    const double chance = fmod(0.5 + (double)i * 0.6180339887498949 + shift, 1);
    const uint32_t k = wavelength_at(weights, chance);
    w->n = w->n_blue = (double)abbe_media_n(&s->media, 0, k, 0);
    w->n_blue += q->spread;
    w->loss = (double)abbe_media_attenuation(&s->media, 0, k, 0);
    w[1] = w[0];
    double o[3];
    for (int c = 0; c < 3; c++) o[c] = aside * across[c] - 2 * w->sight[c];
    to.by_value.n = to.by_value.loss = 0;
    run_line(w, o, 2 / (double)lines, &to);
    out->by_n[repeat * out->wavelengths + k] += to.by_value.n + to.by_value.spread - spread;
    out->by_loss[repeat * out->wavelengths + k] += to.by_value.loss;
    spread = to.by_value.spread;
  }
  out->sum[repeat] = to.value;
  out->area[repeat] = to.area;
  out->by_spread[repeat] = spread;
}

static bool measured(abbe_gem_amount amount) {
  return amount == ABBE_GEM_AMOUNT_COUNT || amount == ABBE_GEM_ISO || amount == ABBE_GEM_COS ||
         amount == ABBE_GEM_RETURN || amount == ABBE_GEM_DOWN || amount == ABBE_GEM_GEMRAY_ISO ||
         amount == ABBE_GEM_GEMRAY_COS || amount == ABBE_GEM_GEMRAY_SC2;
}

abbe_result abbe_gem_slope_make(const abbe_gem_stone *s, const abbe_weights *weights,
                                const abbe_gem_slope_desc *q, abbe_gem_slope *out,
                                abbe_error *error) {
  *out = (abbe_gem_slope){.planes = s->plane_count, .wavelengths = s->wavelengths};
  ABBE_TRY(abbe_gem_view_check(s, weights, q->head_rad, error));
  if (!measured(q->measure))
    return abbe_error_set(error, ABBE_UNSUPPORTED, "there is no derivative of %s",
                          abbe_gem_amount_text(q->measure));
  if (q->meetings > ABBE_GEM_SLOPE_MEETINGS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "paths of %zu facets; there are up to %d",
                          q->meetings, ABBE_GEM_SLOPE_MEETINGS);
  abbe_gem_stretch *w = calloc(2 * REPEATS, sizeof *w);
  out->by_sum = calloc(REPEATS * s->plane_count, sizeof *out->by_sum);
  out->by_area = calloc(REPEATS * s->plane_count, sizeof *out->by_area);
  out->by_n = calloc(REPEATS * s->wavelengths, sizeof *out->by_n);
  out->by_loss = calloc(REPEATS * s->wavelengths, sizeof *out->by_loss);
  const bool made = w && out->by_sum && out->by_area && out->by_n && out->by_loss;
  const int threads = q->threads > 0 ? (int)q->threads : omp_get_max_threads();
  if (made) {
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (int r = 0; r < REPEATS; r++) run_repeat(s, weights, q, (size_t)r, &w[2 * r], out);
    out->value = abbe_gem_number_ratio(out->sum, out->area, REPEATS);
  }
  free(w);
  if (made) return ABBE_OK;
  abbe_gem_slope_free(out);
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a stone's derivatives");
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
