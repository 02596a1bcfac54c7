#include "validation/trace/walks/eye_walk.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void abbe_photon_grid_free(abbe_photon_grid *grid) {
  if (grid == NULL) return;
  free(grid->photon);
  free(grid->own);
  free(grid->first);
  *grid = (abbe_photon_grid){0};
}

static int32_t coordinate(float x, float cell) {
  float at = x / cell;
  at = at > -1e9f ? at : -1e9f;
  at = at < 1e9f ? at : 1e9f;
  int32_t whole = (int32_t)at;
  return whole - (at < (float)whole);
}

static size_t hash(const abbe_photon_grid *g, int32_t x, int32_t y, int32_t z) {
  uint32_t h = (uint32_t)x * 73856093u ^ (uint32_t)y * 19349663u ^ (uint32_t)z * 83492791u;
  h = (h ^ h >> 15) * 0x2c1b3c6du;
  return (h ^ h >> 13) & (g->cells - 1);
}

static size_t cell_of(const abbe_photon_grid *g, const float p[3]) {
  return hash(g, coordinate(p[0], g->cell), coordinate(p[1], g->cell), coordinate(p[2], g->cell));
}

static abbe_result make_room(abbe_photon_grid *g, size_t count, abbe_error *error) {
  size_t cells = 1024;
  while (cells < count && cells < (size_t)1 << 24) cells *= 2;
  if (count > g->room || g->first == NULL || cells != g->cells) {
    abbe_photon_grid_free(g);
    g->photon = malloc((count + 1) * sizeof *g->photon);
    g->own = malloc((count + 1) * sizeof *g->own);
    g->first = malloc((cells + 1) * sizeof *g->first);
    g->room = count;
  }
  g->cells = cells;
  if (g->photon != NULL && g->own != NULL && g->first != NULL) return ABBE_OK;
  abbe_photon_grid_free(g);
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu photons: ask for fewer a pass",
                        count);
}

abbe_result abbe_photon_grid_fill(abbe_photon_grid *g, const abbe_grid_photon *photon, size_t count,
                                  float radius, size_t threads, abbe_error *error) {
  abbe_result result = make_room(g, count, error);
  if (result != ABBE_OK) return result;
  g->count = count;
  g->cell = 2 * radius;
  memset(g->first, 0, (g->cells + 1) * sizeof *g->first);
#pragma omp parallel for num_threads((int)threads)
  for (size_t i = 0; i < count; i++) g->own[i] = (uint32_t)cell_of(g, photon[i].p);
  for (size_t i = 0; i < count; i++) g->first[g->own[i] + 1]++;
  for (size_t c = 0; c < g->cells; c++) g->first[c + 1] += g->first[c];
  /* first[c] runs to the end of its cell while the cells fill, and is put back after that */
  for (size_t i = 0; i < count; i++) g->photon[g->first[g->own[i]]++] = photon[i];
  memmove(g->first + 1, g->first, g->cells * sizeof *g->first);
  g->first[0] = 0;
  return ABBE_OK;
}

void abbe_photon_grid_gather(const abbe_photon_grid *g, const float p[3], float radius,
                             uint32_t surface, float side,
                             void (*take)(void *user, const abbe_grid_photon *photon), void *user) {
  if (g->count == 0) return;
  int32_t low[3], high[3];
  for (int k = 0; k < 3; k++) {
    low[k] = coordinate(p[k] - radius, g->cell);
    high[k] = coordinate(p[k] + radius, g->cell);
  }
  /* two cubes an axis, or three where single precision is coarse against them */
  size_t seen[27], cells = 0;
  for (int32_t z = low[2]; z <= high[2]; z++)
    for (int32_t y = low[1]; y <= high[1]; y++)
      for (int32_t x = low[0]; x <= high[0]; x++) {
        /* different cubes may share a cell, which is to be read once */
        size_t c = hash(g, x, y, z), i = 0;
        while (i < cells && seen[i] != c) i++;
        if (i == cells && cells < 27) seen[cells++] = c;
      }
  for (size_t i = 0; i < cells; i++)
    for (uint32_t j = g->first[seen[i]]; j < g->first[seen[i] + 1]; j++) {
      const abbe_grid_photon *q = &g->photon[j];
      float square = 0;
      for (int k = 0; k < 3; k++) square += (q->p[k] - p[k]) * (q->p[k] - p[k]);
      if (square <= radius * radius && q->surface == surface && (q->flux > 0) == (side > 0))
        take(user, q);
    }
}
