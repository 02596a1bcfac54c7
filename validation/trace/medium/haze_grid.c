#include "validation/trace/medium/haze_grid.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

void abbe_haze_grid_free(abbe_haze_grid *g) {
  if (g == NULL) return;
  free(g->photon);
  free(g->own);
  free(g->first);
  *g = (abbe_haze_grid){0};
}

/* ---- sorting ---- */

/* The cube of a coordinate, those beyond the box at its edges. */
static size_t cube_of(const abbe_haze_grid *g, int k, float x) {
  const float at = (x - g->low[k]) / g->cell, most = (float)(g->side[k] - 1);
  return at > 0 ? (size_t)fminf(at, most) : 0;
}

/* As many cubes as photons, about, and none narrower than the disk of a gather. */
static void lay_out(abbe_haze_grid *g, const abbe_haze_photon *photon, size_t count, float radius) {
  float high[3], size = 0;
  for (int k = 0; k < 3; k++) {
    g->low[k] = count > 0 ? photon[0].p[k] : 0;
    high[k] = g->low[k];
    for (size_t i = 1; i < count; i++) {
      g->low[k] = fminf(g->low[k], photon[i].p[k]);
      high[k] = fmaxf(high[k], photon[i].p[k]);
    }
    size = fmaxf(size, high[k] - g->low[k]);
  }
  g->cell = fmaxf(2 * radius, size / ABBE_HAZE_GRID_SIDE);
  if (!(g->cell > 0)) g->cell = 1;
  g->cubes = 1;
  for (int k = 0; k < 3; k++) {
    const float cubes = ceilf((high[k] - g->low[k]) / g->cell);
    g->side[k] = cubes >= 1 ? (size_t)cubes : 1;
    g->cubes *= g->side[k];
  }
}

static abbe_result make_room(abbe_haze_grid *g, size_t count, abbe_error *error) {
  uint32_t *first = realloc(g->first, (g->cubes + 1) * sizeof *first);
  if (first != NULL) g->first = first;
  if (count > g->room || g->photon == NULL) {
    free(g->photon);
    free(g->own);
    g->photon = malloc((count + 1) * sizeof *g->photon);
    g->own = malloc((count + 1) * sizeof *g->own);
    g->room = count;
  }
  if (first != NULL && g->photon != NULL && g->own != NULL) return ABBE_OK;
  abbe_haze_grid_free(g);
  return abbe_error_set(error, ABBE_NO_MEMORY,
                        "no memory for %zu photons in a medium: ask for fewer a pass", count);
}

abbe_result abbe_haze_grid_fill(abbe_haze_grid *g, const abbe_haze_photon *photon, size_t count,
                                float radius, abbe_error *error) {
  lay_out(g, photon, count, radius);
  ABBE_TRY(make_room(g, count, error));
  g->count = count;
  memset(g->first, 0, (g->cubes + 1) * sizeof *g->first);
  for (size_t i = 0; i < count; i++) {
    size_t at = 0;
    for (int k = 2; k >= 0; k--) at = at * g->side[k] + cube_of(g, k, photon[i].p[k]);
    g->own[i] = (uint32_t)at;
    g->first[at + 1]++;
  }
  for (size_t c = 0; c < g->cubes; c++) g->first[c + 1] += g->first[c];
  /* first[c] runs to the end of its cube while the cubes fill, and is put back after that */
  for (size_t i = 0; i < count; i++) g->photon[g->first[g->own[i]]++] = photon[i];
  memmove(g->first + 1, g->first, g->cubes * sizeof *g->first);
  g->first[0] = 0;
  return ABBE_OK;
}

/* ---- along a ray ---- */

typedef struct search {
  const abbe_haze_grid *g;
  const float *o, *d;
  float from, to, radius;
  int medium;
  void (*take)(void *user, const abbe_haze_photon *photon, float t);
  void *user;
} search;

static void look_into(const search *s, size_t cube) {
  const abbe_haze_grid *g = s->g;
  for (uint32_t j = g->first[cube]; j < g->first[cube + 1]; j++) {
    const abbe_haze_photon *q = &g->photon[j];
    float v[3], t = 0, square = 0;
    for (int k = 0; k < 3; k++) {
      v[k] = q->p[k] - s->o[k];
      t += v[k] * s->d[k];
    }
    for (int k = 0; k < 3; k++) square += (v[k] - t * s->d[k]) * (v[k] - t * s->d[k]);
    if (square <= s->radius * s->radius && t >= s->from && t <= s->to && q->medium == s->medium)
      s->take(s->user, q, t);
  }
}

/* The cubes of coordinate k from which the part [a, b] of the ray is within the radius; false where
 * there are none. */
static bool range_of(const search *s, int k, float a, float b, size_t range[2]) {
  const abbe_haze_grid *g = s->g;
  const float x = s->o[k] + a * s->d[k], y = s->o[k] + b * s->d[k];
  const float low = fminf(x, y) - s->radius, high = fmaxf(x, y) + s->radius;
  if (high < g->low[k] || low > g->low[k] + g->cell * (float)g->side[k]) return false;
  range[0] = cube_of(g, k, low);
  range[1] = cube_of(g, k, high);
  return true;
}

/* One layer of cubes across the axis that the ray runs along most: each cube is in one layer. */
static void look_across(const search *s, int axis, size_t layer) {
  const abbe_haze_grid *g = s->g;
  const float low = g->low[axis] + (float)layer * g->cell - s->radius;
  const float high = low + g->cell + 2 * s->radius, slope = 1 / s->d[axis];
  const float a = (low - s->o[axis]) * slope, b = (high - s->o[axis]) * slope;
  const float near = fmaxf(s->from, fminf(a, b)), far = fminf(s->to, fmaxf(a, b));
  size_t x[2], y[2], at[3];
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (near > far || !range_of(s, u, near, far, x) || !range_of(s, v, near, far, y)) return;
  at[axis] = layer;
  for (at[u] = x[0]; at[u] <= x[1]; at[u]++)
    for (at[v] = y[0]; at[v] <= y[1]; at[v]++)
      look_into(s, (at[2] * g->side[1] + at[1]) * g->side[0] + at[0]);
}

void abbe_haze_grid_gather(const abbe_haze_grid *g, const float o[3], const float d[3], float from,
                           float to, float radius, int medium,
                           void (*take)(void *user, const abbe_haze_photon *photon, float t),
                           void *user) {
  const search s = {g, o, d, from, to, radius, medium, take, user};
  size_t layers[2];
  int axis = 0;
  if (g->count == 0) return;
  for (int k = 1; k < 3; k++)
    if (fabsf(d[k]) > fabsf(d[axis])) axis = k;
  if (!range_of(&s, axis, from, to, layers)) return;
  for (size_t layer = layers[0]; layer <= layers[1]; layer++) look_across(&s, axis, layer);
}
