#include "gl/plan/examine/examine.h"
#include "gl/scene/spectra/camera_bands.h"

#include <math.h>
#include <stdlib.h>

enum { ANGLES = 2 * ABBE_FILM_ANGLES + 1, STEPS = 160 };

/* Shares of light by angle: reflected from outside and from inside, passed. */
typedef double shares[ANGLES][3];

/* The range in narrow steps, each with its light. */
typedef struct steps {
  double min, max, light[STEPS];
  shares *of; /* [STEPS] of one film */
} steps;

const abbe_coatings *abbe_film_tables_of(const abbe_scene *scene, const abbe_plan *plan, size_t r,
                                         uint32_t *first) {
  *first = 0;
  if (!plan->filmed) return NULL;
  for (size_t i = 0; i < r; i++) {
    const abbe_coatings *c = scene->object[plan->refractor_object[i]].coatings;
    if (c != NULL) *first += (uint32_t)c->count;
  }
  return r < plan->refractor_count ? scene->object[plan->refractor_object[r]].coatings : NULL;
}

/* Films of crystals have tables for two of the indices. */
static bool is_crystal(const abbe_scene *scene, const abbe_plan *plan, size_t r) {
  const abbe_material *m = scene->object[plan->refractor_object[r]].material;
  return plan->crystals && m != NULL && abbe_material_is_crystal(m);
}

/* The outer index that is farther from that of glass's tables. */
static int other_axis(const abbe_material *material, double lambda_nm) {
  double n[3] = {0};
  for (int k = 0; k < 3; k++) abbe_material_n_along(material, k, lambda_nm, &n[k], NULL);
  return fabs(n[0] - n[1]) > fabs(n[2] - n[1]) ? 0 : 2;
}

static size_t plane_count(const abbe_scene *scene, const abbe_plan *plan) {
  size_t count = 0;
  for (size_t r = 0; r < plan->refractor_count; r++)
    if (plan->model[r] == ABBE_REFRACTOR_CONVEX)
      count += scene->object[plan->refractor_object[r]].exact.count;
  return count > 0 ? count : 1; /* as the shaders' table of planes */
}

static size_t row_count(const abbe_plan *plan, size_t *bands) {
  size_t levels;
  *bands = abbe_camera_bands_count(plan->desc.wavelengths, &levels);
  return plan->desc.wavelengths + ABBE_CAMERA_BAND_SETS * *bands;
}

size_t abbe_film_tables_texels(const abbe_scene *scene, const abbe_plan *plan) {
  uint32_t films;
  size_t bands;
  abbe_film_tables_of(scene, plan, plan->refractor_count, &films);
  for (size_t r = 0; r < plan->refractor_count; r++) {
    uint32_t first;
    const abbe_coatings *c = abbe_film_tables_of(scene, plan, r, &first);
    if (c != NULL && is_crystal(scene, plan, r)) films += (uint32_t)c->count;
  }
  return plan->refractor_count + plane_count(scene, plan) +
         films * row_count(plan, &bands) * ANGLES;
}

/* Which film is on which refractor and plane. */
static void fill_numbers(const abbe_scene *scene, const abbe_plan *plan, float (*texel)[4]) {
  float(*plane)[4] = texel + plan->refractor_count;
  uint32_t others;
  abbe_film_tables_of(scene, plan, plan->refractor_count, &others);
  for (size_t r = 0; r < plan->refractor_count; r++) {
    const abbe_object *o = &scene->object[plan->refractor_object[r]];
    const bool planes = plan->model[r] == ABBE_REFRACTOR_CONVEX;
    uint8_t film[ABBE_SCENE_MAX_PLANES];
    uint32_t first;
    const abbe_coatings *c = abbe_film_tables_of(scene, plan, r, &first);
    const bool apart = c != NULL && c->face != NULL;
    texel[r][0] = c == NULL ? -1 : !apart ? (float)first : planes ? -2 : -1;
    if (c != NULL && is_crystal(scene, plan, r)) {
      texel[r][1] = (float)(others - first);
      texel[r][2] = (float)other_axis(o->material, (plan->desc.min_nm + plan->desc.max_nm) / 2);
      others += (uint32_t)c->count;
    }
    if (!planes) continue;
    if (apart) abbe_refractor_films(o, film);
    for (size_t i = 0; apart && i < o->exact.count; i++)
      plane[i][0] = film[i] == 0 ? -1 : (float)(first + film[i] - 1);
    plane += o->exact.count;
  }
}

/* On the index of an axis; -1: on that of glass, or the ordinary or middle one. */
static abbe_result evaluate(const abbe_coating *coating, const abbe_material *material, int axis,
                            double lambda_nm, shares out, abbe_error *error) {
  abbe_film_layer layer[ABBE_FILM_MOST_LAYERS];
  abbe_film_light light;
  const double air[2] = {1, 0};
  double n = 1, ignored;
  ABBE_TRY(abbe_coating_at(coating, lambda_nm, layer, error));
  ABBE_TRY(axis < 0 ? abbe_material_n(material, lambda_nm, &n, error)
                    : abbe_material_n_along(material, axis, lambda_nm, &n, error));
  for (int i = 0; i < ANGLES; i++) {
    const double along = (i - ABBE_FILM_ANGLES) / (double)ABBE_FILM_ANGLES;
    const double beyond = 2 * along / (1 + along * along);
    const double c2 = along < 0 ? -beyond * beyond * (n - 1) * (n + 1) : along * along;
    const double inside2 = 1 - (1 - c2) / (n * n), to[2] = {n, 0};
    out[i][0] = out[i][1] = 1;
    out[i][2] = 0;
    if (inside2 > -1e-12) {
      abbe_film_light_at(layer, coating->count, true, n, air, sqrt(fmax(inside2, 0)), lambda_nm,
                         &light);
      abbe_film_unpolarised(&light, &out[i][1], &ignored);
    }
    if (along < 0) continue;
    abbe_film_light_at(layer, coating->count, false, 1, to, along, lambda_nm, &light);
    abbe_film_unpolarised(&light, &out[i][0], &out[i][2]);
  }
  return ABBE_OK;
}

static void store(const shares of, float (*texel)[4]) {
  for (int i = 0; i < ANGLES; i++)
    for (int k = 0; k < 3; k++) texel[i][k] = (float)of[i][k];
}

/* The mean over a band. */
static void store_band(const steps *s, const double range_nm[2], float (*texel)[4]) {
  const double width = (s->max - s->min) / STEPS;
  double all = 0;
  shares sum = {{0}};
  for (int k = 0; k < STEPS; k++) {
    const double from = s->min + width * k,
                 part = fmin(from + width, range_nm[1]) - fmax(from, range_nm[0]);
    if (!(part > 0)) continue;
    all += s->light[k] * part;
    for (int i = 0; i < ANGLES; i++)
      for (int c = 0; c < 3; c++) sum[i][c] += s->light[k] * part * s->of[k][i][c];
  }
  for (int i = 0; i < ANGLES; i++)
    for (int c = 0; c < 3; c++) sum[i][c] /= all;
  store((const double(*)[3])sum, texel);
}

static abbe_result fill_film(const abbe_coating *coating, const abbe_material *material, int axis,
                             const abbe_plan *plan, const abbe_wavelengths *w, steps *s,
                             float (*texel)[4], abbe_error *error) {
  abbe_result result = ABBE_OK;
  size_t bands;
  row_count(plan, &bands);
  for (size_t i = 0; i < w->count && result == ABBE_OK; i++, texel += ANGLES) {
    result = evaluate(coating, material, axis, w->lambda_nm[i], s->of[0], error);
    store((const double(*)[3])s->of[0], texel);
  }
  for (int k = 0; k < STEPS && result == ABBE_OK; k++)
    result = evaluate(coating, material, axis, s->min + (s->max - s->min) * (k + 0.5) / STEPS,
                      s->of[k], error);
  for (int set = 0; set < ABBE_CAMERA_BAND_SETS && result == ABBE_OK; set++)
    for (size_t i = 0; i < bands; i++, texel += ANGLES) {
      double range_nm[2];
      abbe_camera_bands_range(plan, w, set, i, range_nm);
      store_band(s, (const double *)range_nm, texel);
    }
  return result;
}

abbe_result abbe_film_tables_fill(const abbe_scene *scene, const abbe_plan *plan,
                                  const abbe_spectral_tables *tables, float (*texel)[4],
                                  abbe_error *error) {
  const abbe_wavelengths *w = &tables->all;
  steps s = {.min = w->edge_nm[0], .max = w->edge_nm[w->count]};
  abbe_weights_range light;
  size_t bands;
  const size_t rows = row_count(plan, &bands) * ANGLES;
  s.of = calloc(STEPS, sizeof *s.of);
  if (s.of == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for films");
  abbe_weights_range_make_by(plan->desc.observer, abbe_scene_illuminant(scene), s.min, s.max,
                             &light);
  for (int k = 0; k < STEPS; k++) {
    double xyz[3];
    abbe_weights_range_xyz(&light, s.min + (s.max - s.min) * k / STEPS,
                           s.min + (s.max - s.min) * (k + 1) / STEPS, xyz);
    s.light[k] = xyz[0] + xyz[1] + xyz[2] + 1e-9;
  }
  fill_numbers(scene, plan, texel);
  texel += plan->refractor_count + plane_count(scene, plan);
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < 2 * plan->refractor_count; i++) {
    const size_t r = i % plan->refractor_count;
    const bool other = i >= plan->refractor_count;
    const abbe_material *m = scene->object[plan->refractor_object[r]].material;
    uint32_t first;
    const abbe_coatings *c = abbe_film_tables_of(scene, plan, r, &first);
    if (other && !is_crystal(scene, plan, r)) continue;
    const int axis = other ? other_axis(m, (plan->desc.min_nm + plan->desc.max_nm) / 2) : -1;
    for (size_t k = 0; c != NULL && k < c->count && result == ABBE_OK; k++, texel += rows)
      result = fill_film(&c->coating[k], m, axis, plan, w, &s, texel, error);
  }
  free(s.of);
  return result;
}
