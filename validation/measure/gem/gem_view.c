#include "validation/measure/gem/gem_view.h"

#include "base/maths.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum { AMOUNTS = ABBE_GEM_AMOUNT_COUNT };

void abbe_gem_view_free(abbe_gem_view *view) {
  if (view == NULL) return;
  free(view->hit);
  free(view->amount);
  free(view->xyz);
  free(view->cover);
  free(view->spectrum);
  free(view->met);
  memset(view, 0, sizeof *view);
}

/* A row's sums; rows are added in their order, whichever thread made them. */
typedef struct row_sums {
  double (*spectrum)[AMOUNTS]; /* [repeats][wavelengths] */
  double met[ABBE_GEM_MOST_REPEATS], colour[ABBE_GEM_MOST_REPEATS][3];
} row_sums;

typedef struct work {
  const abbe_gem_stone *stone;
  const abbe_weights *weights;
  abbe_gem_eye eye;
  abbe_gem_light light;
  abbe_gem_view *view;
} work;

/* One ray of the eye at all wavelengths. */
static void follow(const work *w, const double p[3], const double n[3], const double d[3],
                   uint32_t seed, float *amount, double (*spectrum)[AMOUNTS], double colour[3]) {
  abbe_gem_path path;
  for (size_t k = 0; k < w->stone->wavelengths; k++) {
    float own[AMOUNTS];
    abbe_gem_path_follow(w->stone, k, p, n, d, seed, &path);
    abbe_gem_light_judge(&w->light, &path, own);
    const double *weight = w->weights->weight[k];
    for (int a = 0; a < AMOUNTS; a++) {
      amount[a] += (float)(weight[1] / w->weights->sum[1]) * own[a];
      spectrum[k][a] += (double)own[a];
    }
    for (int c = 0; c < 3; c++) colour[c] += weight[c] * (double)own[ABBE_GEM_RETURN];
  }
}

static void trace_row(const work *w, size_t row, row_sums *sums) {
  abbe_gem_view *v = w->view;
  for (size_t column = 0; column < v->side; column++) {
    const size_t pixel = row * v->side + column;
    double all[3] = {0}, covered = 0;
    for (size_t r = 0; r < v->repeats; r++) {
      double x, y, o[3], d[3], p[3], n[3], colour[3] = {0};
      const uint32_t seed = abbe_gem_eye_place(v->side, column, row, r, &x, &y);
      abbe_gem_eye_ray(&w->eye, v->side, column, row, x, y, o, d);
      if (!abbe_gem_path_enter(w->stone, o, d, p, n)) continue;
      v->hit[pixel * v->repeats + r] = 1;
      sums->met[r]++;
      covered++;
      follow(w, p, n, d, seed, &v->amount[(pixel * v->repeats + r) * AMOUNTS],
             &sums->spectrum[r * v->wavelengths], colour);
      for (int c = 0; c < 3; c++) {
        sums->colour[r][c] += colour[c];
        all[c] += colour[c];
      }
    }
    for (int c = 0; c < 3; c++)
      v->xyz[pixel * 3 + (size_t)c] = (float)(all[c] / (double)v->repeats);
    v->cover[pixel] = (float)(covered / (double)v->repeats);
  }
}

static void add_row(abbe_gem_view *v, const row_sums *row) {
  for (size_t r = 0; r < v->repeats; r++) {
    v->met[r] += row->met[r];
    for (int c = 0; c < 3; c++) v->colour[r][c] += row->colour[r][c];
  }
  for (size_t i = 0; i < v->repeats * v->wavelengths; i++)
    for (int a = 0; a < AMOUNTS; a++) v->spectrum[i][a] += row->spectrum[i][a];
}

static abbe_result trace(const work *w, size_t threads, abbe_error *error) {
  abbe_gem_view *v = w->view;
  const size_t each = v->repeats * v->wavelengths;
  row_sums *row = calloc(v->side, sizeof *row);
  double(*room)[AMOUNTS] = calloc(v->side * each, sizeof *room);
  const bool made = row != NULL && room != NULL;
  if (made) {
#pragma omp parallel for schedule(dynamic) num_threads((int)threads)
    for (size_t i = 0; i < v->side; i++) {
      row[i].spectrum = room + i * each;
      trace_row(w, i, &row[i]);
    }
    for (size_t i = 0; i < v->side; i++) add_row(v, &row[i]);
  }
  free(row);
  free(room);
  return made ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a view of a stone");
}

abbe_result abbe_gem_view_check(const abbe_gem_stone *stone, const abbe_weights *weights,
                                double head_rad, abbe_error *error) {
  if (!(head_rad >= 0 && head_rad < 0.25 * ABBE_PI))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a head's half angle of %g rad; it is at least 0 and below %g", head_rad,
                          0.25 * ABBE_PI);
  if (weights->count != stone->wavelengths || stone->plane_count == 0 || !(weights->sum[1] > 0))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a stone of %zu planes at %zu wavelengths, and weights of %zu",
                          stone->plane_count, stone->wavelengths, weights->count);
  return ABBE_OK;
}

static abbe_result check(const abbe_gem_stone *stone, const abbe_weights *weights,
                         const abbe_gem_view_desc *d, abbe_error *error) {
  if (d->side > ABBE_GEM_MOST_SIDE || d->repeats == 1 || d->repeats > ABBE_GEM_MOST_REPEATS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu pixels a side and %zu repeats; there are 1 to %d and 2 to %d",
                          d->side, d->repeats, ABBE_GEM_MOST_SIDE, ABBE_GEM_MOST_REPEATS);
  if (!isfinite(d->axis_rad) || !isfinite(d->tilt_rad))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a stone tilted by %g rad about an axis at %g rad; both are finite",
                          d->tilt_rad, d->axis_rad);
  return abbe_gem_view_check(stone, weights, d->head_rad, error);
}

static abbe_result allocate(abbe_gem_view *v, abbe_error *error) {
  const size_t pixels = v->side * v->side;
  v->hit = calloc(pixels * v->repeats, sizeof *v->hit);
  v->amount = calloc(pixels * v->repeats * AMOUNTS, sizeof *v->amount);
  v->xyz = calloc(pixels * 3, sizeof *v->xyz);
  v->cover = calloc(pixels, sizeof *v->cover);
  v->spectrum = calloc(v->repeats * v->wavelengths, sizeof *v->spectrum);
  v->met = calloc(v->repeats, sizeof *v->met);
  if (v->hit != NULL && v->amount != NULL && v->xyz != NULL && v->cover != NULL &&
      v->spectrum != NULL && v->met != NULL)
    return ABBE_OK;
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a view of %zu x %zu pixels", v->side,
                        v->side);
}

abbe_result abbe_gem_view_make(const abbe_gem_stone *stone, const abbe_weights *weights,
                               const abbe_gem_view_desc *desc, abbe_gem_view *out,
                               abbe_error *error) {
  memset(out, 0, sizeof *out);
  ABBE_TRY(check(stone, weights, desc, error));
  out->side = desc->side > 0 ? desc->side : 128;
  out->repeats = desc->repeats > 0 ? desc->repeats : 8;
  out->wavelengths = stone->wavelengths;
  abbe_result result = allocate(out, error);
  if (result == ABBE_OK) {
    const abbe_gem_eye eye = abbe_gem_eye_make(desc->axis_rad, desc->tilt_rad);
    const work w = {.stone = stone,
                    .weights = weights,
                    .eye = eye,
                    .light = abbe_gem_light_make(eye.to_eye, desc->head_rad),
                    .view = out};
    result = trace(&w, desc->threads > 0 ? desc->threads : (size_t)omp_get_max_threads(), error);
  }
  double met = 0;
  for (size_t r = 0; r < out->repeats && result == ABBE_OK; r++) met += out->met[r];
  if (result == ABBE_OK && met == 0)
    result = abbe_error_set(error, ABBE_GEOMETRY,
                            "none of %zu x %zu x %zu rays of the eye met the stone: take more",
                            out->side, out->side, out->repeats);
  if (result != ABBE_OK) abbe_gem_view_free(out);
  return result;
}

/* What a view of a stone amounts to: means, areas, contrast. */
enum { GEM_VIEW_MEASURES_AMOUNTS = ABBE_GEM_AMOUNT_COUNT };

abbe_gem_number abbe_gem_view_at(const abbe_gem_view *v, abbe_gem_amount amount, size_t k) {
  double sum[ABBE_GEM_MOST_REPEATS];
  for (size_t r = 0; r < v->repeats; r++) sum[r] = v->spectrum[r * v->wavelengths + k][amount];
  return abbe_gem_number_ratio(sum, v->met, v->repeats);
}

abbe_gem_number abbe_gem_view_amount(const abbe_gem_view *v, abbe_gem_amount amount) {
  double sum[ABBE_GEM_MOST_REPEATS] = {0};
  for (size_t i = 0; i < v->side * v->side; i++)
    for (size_t r = 0; r < v->repeats; r++)
      sum[r] += (double)v->amount[(i * v->repeats + r) * GEM_VIEW_MEASURES_AMOUNTS + amount];
  return abbe_gem_number_ratio(sum, v->met, v->repeats);
}

/* ---- areas ---- */

enum { BRILLIANT, WINDOW, EXTINCT, AREAS };

static int greatest(const float amount[GEM_VIEW_MEASURES_AMOUNTS]) {
  const float back = amount[ABBE_GEM_RETURN], leak = amount[ABBE_GEM_DOWN];
  const float dark = amount[ABBE_GEM_HEAD] + amount[ABBE_GEM_ABSORBED] + amount[ABBE_GEM_LEFT];
  return back >= leak && back >= dark ? BRILLIANT : leak >= dark ? WINDOW : EXTINCT;
}

abbe_result abbe_gem_view_areas(const abbe_gem_view *v, abbe_gem_areas *out, abbe_error *error) {
  double area[AREAS][ABBE_GEM_MOST_REPEATS] = {{0}};
  if (v->side == 0 || v->repeats < 2 || v->repeats > ABBE_GEM_MOST_REPEATS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a view without repeats has no areas");
  for (size_t i = 0; i < v->side * v->side * v->repeats; i++)
    if (v->hit[i] > 0) area[greatest(&v->amount[i * GEM_VIEW_MEASURES_AMOUNTS])][i % v->repeats]++;
  abbe_gem_number *number[AREAS] = {&out->brilliant, &out->window, &out->extinct};
  for (int k = 0; k < AREAS; k++) *number[k] = abbe_gem_number_ratio(area[k], v->met, v->repeats);
  return ABBE_OK;
}

/* ---- contrast ---- */

static double contrast(const abbe_gem_view *v, size_t without) {
  double count = 0, sum = 0, square = 0;
  for (size_t i = 0; i < v->side * v->side * v->repeats; i++) {
    const double x = (double)v->amount[i * GEM_VIEW_MEASURES_AMOUNTS + ABBE_GEM_RETURN];
    if (!(v->hit[i] > 0) || i % v->repeats == without) continue;
    count++;
    sum += x;
    square += x * x;
  }
  return sum > 0 ? sqrt(fmax(count * square / (sum * sum) - 1, 0)) : 0;
}

abbe_gem_number abbe_gem_view_contrast(const abbe_gem_view *v) {
  double without[ABBE_GEM_MOST_REPEATS];
  if (v->repeats < 3) return (abbe_gem_number){contrast(v, v->repeats), NAN};
  for (size_t r = 0; r < v->repeats; r++) without[r] = contrast(v, r);
  return abbe_gem_number_jackknife(contrast(v, v->repeats), without, v->repeats);
}
