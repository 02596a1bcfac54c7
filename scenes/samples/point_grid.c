#include "scenes/samples/surface_samples.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Finaliser of splitmix64 [Steele2014]. */
static uint64_t mix(uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

static uint64_t hash_of(const int64_t cell[3]) {
  return mix((uint64_t)cell[0] ^ mix((uint64_t)cell[1] ^ mix((uint64_t)cell[2])));
}

static void cell_of(const abbe_point_grid *grid, const double at[3], int64_t cell[3]) {
  for (int k = 0; k < 3; k++)
    cell[k] = (int64_t)fmin(fmax(floor(at[k] / grid->cell), -0x1p60), 0x1p60);
}

abbe_result abbe_point_grid_make(double cell, size_t room, abbe_point_grid *out,
                                 abbe_error *error) {
  *out = (abbe_point_grid){0};
  if (!(cell > 0) || !isfinite(cell) || room >= UINT32_MAX)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a grid of cells of %g m for %zu points; cells are above 0 m wide", cell,
                          room);
  size_t size = 16;
  while (size < room) size *= 2;
  out->cell = cell;
  out->mask = size - 1;
  out->room = room;
  out->head = malloc(size * sizeof *out->head);
  out->next = malloc((room + 1) * sizeof *out->next);
  out->key = malloc((room + 1) * sizeof *out->key);
  if (out->head == NULL || out->next == NULL || out->key == NULL) {
    abbe_point_grid_free(out);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a grid of %zu points", room);
  }
  memset(out->head, 0xff, size * sizeof *out->head);
  return ABBE_OK;
}

void abbe_point_grid_free(abbe_point_grid *grid) {
  if (grid == NULL) return;
  free(grid->head);
  free(grid->next);
  free(grid->key);
  *grid = (abbe_point_grid){0};
}

void abbe_point_grid_add(abbe_point_grid *grid, const double at[3], size_t number) {
  int64_t cell[3];
  cell_of(grid, at, cell);
  const uint64_t hash = hash_of(cell);
  const size_t chain = hash & grid->mask;
  grid->key[number] = (uint32_t)(hash >> 32);
  grid->next[number] = grid->head[chain];
  grid->head[chain] = (uint32_t)number;
}

void abbe_point_grid_visit(const abbe_point_grid *grid, const double at[3], abbe_point_visit visit,
                           void *user) {
  /* Its own cell first, then those beside it, where most points that are near are. */
  static const int8_t order[27] = {13, 4,  10, 12, 14, 16, 22, 1, 3, 5,  7,  9,  11, 15,
                                   17, 19, 21, 23, 25, 0,  2,  6, 8, 18, 20, 24, 26};
  int64_t middle[3];
  cell_of(grid, at, middle);
  for (int k = 0; k < 27; k++) {
    const int i = order[k];
    const int64_t cell[3] = {middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1,
                             middle[2] + i / 9 - 1};
    const uint64_t hash = hash_of(cell);
    for (uint32_t n = grid->head[hash & grid->mask]; n != UINT32_MAX; n = grid->next[n])
      if (grid->key[n] == (uint32_t)(hash >> 32) && !visit(user, n)) return;
  }
}
