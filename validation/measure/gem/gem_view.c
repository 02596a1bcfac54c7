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
  memset(view, 0, sizeof *view);
}

/* A row's sums; rows are added in their order, whichever thread made them. */
typedef struct row_sums {
  abbe_gem_sums (*spectrum)[AMOUNTS], colour[3]; /* as the view's */
  double *ray;                                   /* [wavelengths][AMOUNTS][repeats] of a pixel */
} row_sums;

typedef struct work {
  const abbe_gem_stone *stone;
  const abbe_weights *weights;
  abbe_gem_eye eye;
  abbe_gem_light light;
  abbe_gem_view *view;
} work;

/* Repeat r of a pixel at all wavelengths. */
static void follow(const work *w, const double p[3], const double n[3], const double d[3],
                   uint32_t seed, size_t r, float *amount, double *ray,
                   double colour[3][ABBE_GEM_MOST_REPEATS]) {
  abbe_gem_path path;
  for (size_t k = 0; k < w->stone->wavelengths; k++) {
    float own[AMOUNTS];
    abbe_gem_path_follow(w->stone, k, p, n, d, seed, &path);
    abbe_gem_light_judge(&w->light, &path, own);
    const double *weight = w->weights->weight[k];
    for (size_t a = 0; a < AMOUNTS; a++) {
      amount[a] += (float)(weight[1] / w->weights->sum[1]) * own[a];
      ray[(k * AMOUNTS + a) * w->view->repeats + r] = (double)own[a];
    }
    for (int c = 0; c < 3; c++) colour[c][r] += weight[c] * (double)own[ABBE_GEM_RETURN];
  }
}

static void trace_pixel(const work *w, size_t column, size_t row, row_sums *sums) {
  abbe_gem_view *v = w->view;
  const size_t pixel = row * v->side + column, each = v->wavelengths * AMOUNTS;
  float *hit = &v->hit[pixel * v->repeats];
  double colour[3][ABBE_GEM_MOST_REPEATS] = {{0}}, met = 0;
  memset(sums->ray, 0, each * v->repeats * sizeof *sums->ray);
  for (size_t r = 0; r < v->repeats; r++) {
    double x, y, o[3], d[3], p[3], n[3];
    const uint32_t seed = abbe_gem_eye_place(v->side, column, row, r, &x, &y);
    abbe_gem_eye_ray(&w->eye, v->side, column, row, x, y, o, d);
    if (!abbe_gem_path_enter(w->stone, o, d, p, n)) continue;
    hit[r] = 1;
    met++;
    follow(w, p, n, d, seed, r, &v->amount[(pixel * v->repeats + r) * AMOUNTS], sums->ray, colour);
  }
  if (met == 0) return;
  for (size_t i = 0; i < each; i++)
    abbe_gem_sums_add(&sums->spectrum[i / AMOUNTS][i % AMOUNTS], &sums->ray[i * v->repeats], hit,
                      v->repeats);
  for (size_t c = 0; c < 3; c++) {
    double all = 0;
    for (size_t r = 0; r < v->repeats; r++) all += colour[c][r];
    abbe_gem_sums_add(&sums->colour[c], colour[c], hit, v->repeats);
    v->xyz[pixel * 3 + c] = (float)(all / (double)v->repeats);
  }
  v->cover[pixel] = (float)(met / (double)v->repeats);
}

static void add_row(abbe_gem_view *v, const row_sums *row) {
  for (int c = 0; c < 3; c++) abbe_gem_sums_join(&v->colour[c], &row->colour[c]);
  for (size_t i = 0; i < v->wavelengths * AMOUNTS; i++)
    abbe_gem_sums_join(&v->spectrum[i / AMOUNTS][i % AMOUNTS],
                       &row->spectrum[i / AMOUNTS][i % AMOUNTS]);
}

static abbe_result trace(const work *w, size_t threads, abbe_error *error) {
  abbe_gem_view *v = w->view;
  const size_t rays = v->wavelengths * AMOUNTS * v->repeats;
  row_sums *row = calloc(v->side, sizeof *row);
  abbe_gem_sums(*room)[AMOUNTS] = calloc(v->side * v->wavelengths, sizeof *room);
  double *ray = malloc(threads * rays * sizeof *ray);
  const bool made = row != NULL && room != NULL && ray != NULL;
  if (made) {
#pragma omp parallel for schedule(dynamic) num_threads((int)threads)
    for (size_t i = 0; i < v->side; i++) {
      row[i].spectrum = room + i * v->wavelengths;
      row[i].ray = ray + (size_t)omp_get_thread_num() * rays;
      for (size_t column = 0; column < v->side; column++) trace_pixel(w, column, i, &row[i]);
    }
    for (size_t i = 0; i < v->side; i++) add_row(v, &row[i]);
  }
  free(row);
  free(room);
  free(ray);
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
  v->spectrum = calloc(v->wavelengths, sizeof *v->spectrum);
  if (v->hit != NULL && v->amount != NULL && v->xyz != NULL && v->cover != NULL &&
      v->spectrum != NULL)
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
  if (result == ABBE_OK && out->colour[0].weight == 0)
    result = abbe_error_set(error, ABBE_GEOMETRY,
                            "none of %zu x %zu x %zu rays of the eye met the stone: take more",
                            out->side, out->side, out->repeats);
  if (result != ABBE_OK) abbe_gem_view_free(out);
  return result;
}

abbe_gem_number abbe_gem_view_at(const abbe_gem_view *v, abbe_gem_amount amount, size_t k) {
  return abbe_gem_sums_ratio(&v->spectrum[k][amount]);
}

/* The mean over rays that met it of what `of` makes of each; about[2]: what else that needs. */
static abbe_gem_number mean_of(const abbe_gem_view *v,
                               double of(const float *amount, const double about[2]),
                               const double about[2]) {
  abbe_gem_sums sums = {0};
  for (size_t i = 0; i < v->side * v->side * v->repeats; i += v->repeats) {
    double value[ABBE_GEM_MOST_REPEATS] = {0};
    for (size_t r = 0; r < v->repeats; r++)
      if (v->hit[i + r] > 0) value[r] = of(&v->amount[(i + r) * AMOUNTS], about);
    abbe_gem_sums_add(&sums, value, &v->hit[i], v->repeats);
  }
  return abbe_gem_sums_ratio(&sums);
}

static double amount_of(const float *amount, const double about[2]) {
  return (double)amount[(int)about[0]];
}

abbe_gem_number abbe_gem_view_amount(const abbe_gem_view *v, abbe_gem_amount amount) {
  return mean_of(v, amount_of, (const double[2]){(double)amount});
}

/* ---- areas ---- */

enum { BRILLIANT, WINDOW, EXTINCT, AREAS };

/* Of the light that the stone's colour leaves: a deep red one takes most of what the eye weighs,
 * and has its windows all the same. */
static int greatest(const float amount[AMOUNTS]) {
  const float back = amount[ABBE_GEM_RETURN], leak = amount[ABBE_GEM_DOWN];
  const float dark = amount[ABBE_GEM_HEAD] + amount[ABBE_GEM_LEFT];
  return !(back + leak > 0)             ? EXTINCT
         : back >= leak && back >= dark ? BRILLIANT
         : leak >= dark                 ? WINDOW
                                        : EXTINCT;
}

static double is_greatest(const float *amount, const double about[2]) {
  return greatest(amount) == (int)about[0];
}

abbe_result abbe_gem_view_areas(const abbe_gem_view *v, abbe_gem_areas *out, abbe_error *error) {
  if (v->side == 0 || v->repeats < 2 || v->repeats > ABBE_GEM_MOST_REPEATS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a view without repeats has no areas");
  abbe_gem_number *number[AREAS] = {&out->brilliant, &out->window, &out->extinct};
  for (int k = 0; k < AREAS; k++) *number[k] = mean_of(v, is_greatest, (const double[2]){k});
  return ABBE_OK;
}

/* ---- contrast ---- */

static double square_of(const float *amount, const double about[2]) {
  return pow(amount_of(amount, about), 2);
}

/* By how much the contrast would change, were all as this ray is, to the first order. about: means
 * of the return and of its square. */
static double changes_contrast(const float *amount, const double about[2]) {
  const double x = (double)amount[ABBE_GEM_RETURN], mean = about[0], square = about[1];
  const double contrast = sqrt(square / (mean * mean) - 1);
  return (0.5 * (x * x + square) - square * x / mean) / (mean * mean * contrast);
}

abbe_gem_number abbe_gem_view_contrast(const abbe_gem_view *v) {
  const double amount[2] = {ABBE_GEM_RETURN};
  const double about[2] = {mean_of(v, amount_of, amount).value,
                           mean_of(v, square_of, amount).value};
  if (!(about[1] > about[0] * about[0])) return (abbe_gem_number){0, 0};
  return (abbe_gem_number){sqrt(about[1] / (about[0] * about[0]) - 1),
                           mean_of(v, changes_contrast, about).error};
}
