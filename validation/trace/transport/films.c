#include "scenes/geometry/digest.h"
#include "validation/trace/transport/media.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const abbe_coatings *coatings_of(const abbe_geometry *g, size_t refractor) {
  return g->scene->object[g->refractor_object[refractor]].coatings;
}

static abbe_result fill(const abbe_geometry *g, abbe_films *f, abbe_error *error) {
  size_t film = 0;
  for (size_t i = 0; i < g->refractor_count; i++) {
    const abbe_coatings *c = coatings_of(g, i);
    f->on[i] = c;
    f->first[i] = film;
    for (size_t k = 0; c != NULL && k < c->count; k++, film++) {
      f->layers[film] = c->coating[k].count;
      for (size_t s = 0; s <= f->steps; s++) {
        const abbe_result result = abbe_coating_at(&c->coating[k], f->lambda_nm[s],
                                                   f->layer[film * (f->steps + 1) + s], error);
        if (result != ABBE_OK) return result;
        f->key = abbe_coating_digest(f->key, &c->coating[k], f->lambda_nm[s]);
      }
    }
    if (c != NULL) f->key = abbe_digest(f->key, &i, sizeof i);
    if (c != NULL) f->key = abbe_digest_array(f->key, c->face, c->face_count, 1);
  }
  return ABBE_OK;
}

abbe_result abbe_films_make(const abbe_geometry *geometry, const double *lambda_nm, size_t steps,
                            abbe_films *out, abbe_error *error) {
  abbe_films f = {.steps = steps};
  *out = f;
  for (size_t i = 0; i < geometry->refractor_count; i++)
    f.count += coatings_of(geometry, i) != NULL ? coatings_of(geometry, i)->count : 0;
  if (f.count == 0) return ABBE_OK;
  f.lambda_nm = malloc((steps + 1) * sizeof *f.lambda_nm);
  f.layers = calloc(f.count, sizeof *f.layers);
  f.layer = calloc(f.count * (steps + 1), sizeof *f.layer);
  f.on = calloc(geometry->refractor_count, sizeof *f.on);
  f.first = calloc(geometry->refractor_count, sizeof *f.first);
  abbe_result result = ABBE_OK;
  if (f.lambda_nm == NULL || f.layers == NULL || f.layer == NULL || f.on == NULL || f.first == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for tables of %zu films", f.count);
  if (result == ABBE_OK) {
    memcpy(f.lambda_nm, lambda_nm, (steps + 1) * sizeof *f.lambda_nm);
    result = fill(geometry, &f, error);
  }
  if (result != ABBE_OK) abbe_films_free(&f);
  *out = f;
  return result;
}

void abbe_films_free(abbe_films *f) {
  free(f->lambda_nm);
  free(f->layers);
  free(f->layer);
  free(f->on);
  free(f->first);
  *f = (abbe_films){0};
}

double abbe_films_at(const abbe_films *f, int film, uint32_t k, float within,
                     abbe_film_layer layer[ABBE_FILM_MOST_LAYERS]) {
  const abbe_film_layer *low = f->layer[(size_t)film * (f->steps + 1) + k],
                        *high = f->layer[(size_t)film * (f->steps + 1) + k + 1];
  const double part = (double)within;
  for (size_t i = 0; i < f->layers[film]; i++)
    layer[i] = (abbe_film_layer){low[i].n + part * (high[i].n - low[i].n),
                                 low[i].k + part * (high[i].k - low[i].k), low[i].nm, low[i].table};
  return f->lambda_nm[k] + part * (f->lambda_nm[k + 1] - f->lambda_nm[k]);
}

float abbe_films_reflectance(const abbe_films *f, int film, bool entering, float n_from, float n_to,
                             float cos_i, uint32_t k, float within, float *passes) {
  const double to[2] = {(double)n_to, 0};
  abbe_film_layer at[ABBE_FILM_MOST_LAYERS];
  abbe_film_light light;
  double reflected, transmitted;
  const double lambda_nm = abbe_films_at(f, film, k, within, at);
  abbe_film_light_at(at, f->layers[film], !entering, (double)n_from, to, (double)cos_i, lambda_nm,
                     &light);
  abbe_film_unpolarised(&light, &reflected, &transmitted);
  const double sum = reflected + transmitted;
  *passes = (float)fmin(sum, 1);
  return sum > 0 ? (float)(reflected / sum) : 1;
}
