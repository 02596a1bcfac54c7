#include "validation/landing/estimator_study.h"

#include "base/clock.h"
#include "base/file.h"
#include "base/maths.h"
#include "base/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double lambda_nm = 550;
static const size_t iterations[] = {1, 2, 3, 5, 8};
enum {
  ROUNDS = 3,
  STEPS = sizeof iterations / sizeof *iterations,
  RATE_STEP = 12,
  LEAST_RATES = 8
};

typedef struct work {
  abbe_landing_rays rays;
  double *error, *rate, *law; /* [rays.count] */
} work;

static int compare_numbers(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return x < y ? -1 : x > y;
}

/* A quantile of sorted numbers. */
static double quantile(const double *sorted, size_t count, double share) {
  return count == 0 ? NAN : sorted[(size_t)(share * (double)(count - 1) + 0.5)];
}

static double median(double *number, size_t count) {
  qsort(number, count, sizeof *number, compare_numbers);
  return quantile(number, count, 0.5);
}

static abbe_estimate estimate(work *w, const abbe_estimator_point *p, size_t n, bool exactly,
                              const abbe_landing_ray *ray) {
  const abbe_estimator_desc desc = {.kind = p->kind,
                                    .iterations = n,
                                    .printed = p->printed,
                                    .view = &w->rays.view,
                                    .lookup = exactly ? abbe_landing_rays_look_exactly
                                                      : abbe_landing_rays_look,
                                    .user = &w->rays};
  return abbe_estimator_run(&desc, ray->origin, ray->direction);
}

/* The least of some rounds, ns a ray. */
static double measure_time(work *w, const abbe_estimator_point *p) {
  double least = INFINITY;
  for (int round = 0; round < ROUNDS; round++) {
    const double start = abbe_clock_seconds();
    for (size_t i = 0; i < w->rays.count; i++)
      if (w->rays.ray[i].reflected == p->reflected)
        w->error[i] = estimate(w, p, p->iterations, false, &w->rays.ray[i]).distance;
    least = fmin(least, abbe_clock_seconds() - start);
  }
  return 1e9 * least / (double)p->rays;
}

static void measure_errors(work *w, abbe_estimator_point *p) {
  size_t found = 0;
  double lookups = 0;
  for (size_t i = 0; i < w->rays.count; i++) {
    const abbe_landing_ray *ray = &w->rays.ray[i];
    if (ray->reflected != p->reflected) continue;
    const abbe_estimate e = estimate(w, p, p->iterations, false, ray);
    double off = e.found ? abbe_landing_rays_texels(&w->rays, e.at, ray->at) : INFINITY;
    p->rays++;
    lookups += (double)e.lookups;
    if (isfinite(off)) w->error[found++] = off;
  }
  if (p->rays == 0) return;
  qsort(w->error, found, sizeof *w->error, compare_numbers);
  p->median = quantile(w->error, found, 0.5);
  p->p95 = quantile(w->error, found, 0.95);
  p->worst = quantile(w->error, found, 1);
  p->lost = 1 - (double)found / (double)p->rays;
  p->lookups = lookups / (double)p->rays;
  p->ns = measure_time(w, p);
}

/* Where errors are small, and far above rounding. */
static bool may_tell(double e, double next, double size) {
  return fabs(e) < 1e-3 * size && fabs(next) > 1e-12 * size;
}

static double law_of(const work *w, const abbe_estimator_point *p, const abbe_landing_ray *ray) {
  const abbe_view *view = &w->rays.view;
  double s[3];
  if (view->orthographic)
    memcpy(s, view->forward, sizeof s);
  else
    abbe_vector_subtract(ray->at, view->origin, s);
  abbe_vector_normalise(s);
  return abbe_estimator_rate(p->kind == ABBE_ESTIMATOR_AXIS, ray->direction, s, ray->normal,
                             view->forward);
}

static void measure_rate(work *w, abbe_estimator_point *p) {
  size_t count = 0;
  p->rate = p->law = NAN;
  if (p->printed || (p->kind != ABBE_ESTIMATOR_SHAH && p->kind != ABBE_ESTIMATOR_AXIS)) return;
  for (size_t i = 0; i < w->rays.count; i++) {
    const abbe_landing_ray *ray = &w->rays.ray[i];
    if (ray->reflected != p->reflected) continue;
    for (size_t n = 1; n < RATE_STEP; n++) {
      const double e = estimate(w, p, n, true, ray).distance - ray->distance;
      const double next = estimate(w, p, n + 1, true, ray).distance - ray->distance;
      if (!may_tell(e, next, ray->distance)) continue;
      w->rate[count] = fabs(next / e);
      w->law[count++] = fabs(law_of(w, p, ray));
      break;
    }
  }
  if (count < LEAST_RATES) return;
  p->rate = median(w->rate, count);
  p->law = median(w->law, count);
}

static void measure(work *w, abbe_estimator kind, bool printed, bool reflected,
                    abbe_estimator_study *out) {
  double rate = NAN, law = NAN;
  for (size_t k = 0; k < STEPS && out->count < ABBE_ESTIMATOR_STUDY_MAX; k++) {
    abbe_estimator_point p = {
        .kind = kind, .printed = printed, .reflected = reflected, .iterations = iterations[k]};
    measure_errors(w, &p);
    if (p.rays == 0) return;
    if (k == 0) {
      measure_rate(w, &p);
      rate = p.rate;
      law = p.law;
    }
    p.rate = rate;
    p.law = law;
    out->point[out->count++] = p;
  }
}

abbe_result abbe_estimator_study_make(const abbe_scene *scene, size_t side, size_t grid,
                                      abbe_estimator_study *out, abbe_error *error) {
  work w = {.error = NULL};
  *out = (abbe_estimator_study){.side = side, .grid = grid};
  abbe_result result = abbe_landing_rays_make(scene, 0, lambda_nm, side, grid, &w.rays, error);
  if (result != ABBE_OK) return result;
  out->hidden = w.rays.hidden;
  w.error = calloc(3 * w.rays.count + 1, sizeof *w.error);
  if (w.error == NULL) {
    abbe_landing_rays_free(&w.rays);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the estimators' errors");
  }
  w.rate = w.error + w.rays.count;
  w.law = w.rate + w.rays.count;
  for (int reflected = 0; reflected < 2; reflected++)
    for (int kind = ABBE_ESTIMATOR_SHAH; kind < ABBE_ESTIMATOR_EXACT; kind++) {
      const bool published = kind == ABBE_ESTIMATOR_SHAH || kind == ABBE_ESTIMATOR_NEWTON;
      if (published) measure(&w, (abbe_estimator)kind, true, reflected, out);
      measure(&w, (abbe_estimator)kind, false, reflected, out);
    }
  free(w.error);
  abbe_landing_rays_free(&w.rays);
  return ABBE_OK;
}

abbe_result abbe_estimator_study_save(const abbe_estimator_study *study, const char *path,
                                      abbe_error *error) {
  abbe_file_writer writer = {0};
  abbe_result result = abbe_file_writer_open(&writer, path, error);
  if (result != ABBE_OK) return result;
  fprintf(writer.stream, "# side: %zu\n# grid: %zu\n# hidden: %zu\n", study->side, study->grid,
          study->hidden);
  fprintf(writer.stream, "light,estimator,printed,iterations,rays,lookups,ns,median_texels,"
                         "p95_texels,worst_texels,lost,rate,law\n");
  for (size_t i = 0; i < study->count; i++) {
    const abbe_estimator_point *p = &study->point[i];
    const double value[] = {p->lookups, p->ns,   p->median, p->p95,
                            p->worst,   p->lost, p->rate,   p->law};
    fprintf(writer.stream, "%s,%s,%d,%zu,%zu", p->reflected ? "reflected" : "refracted",
            abbe_estimator_name(p->kind), p->printed, p->iterations, p->rays);
    for (size_t k = 0; k < sizeof value / sizeof *value; k++) {
      char text[ABBE_NUMBER_TEXT_SIZE];
      fprintf(writer.stream, ",%s", isfinite(value[k]) ? abbe_number_text(value[k], text) : "");
    }
    fprintf(writer.stream, "\n");
  }
  return abbe_file_writer_commit(&writer, error);
}
