/* point_grid.h: points in cubic cells, by a hash of the cell: who is within a cell's edge of a
 * place.
 *
 * The points are the caller's; the grid holds their numbers. It may grow while it is asked.
 * Internal to scenes/samples/.
 */
#ifndef ABBE_SCENES_SAMPLES_POINT_GRID_H
#define ABBE_SCENES_SAMPLES_POINT_GRID_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct abbe_point_grid {
  double cell;    /* edge of a cell, m */
  uint32_t *head; /* [mask + 1] last number of a cell's chain, or UINT32_MAX */
  uint32_t *next; /* [capacity] */
  uint32_t *key;  /* [capacity] of each number's cell, which separates those of a chain */
  size_t mask, room;
} abbe_point_grid;

/* Makes an empty grid for numbers below `room`; cell > 0. ABBE_INVALID_ARGUMENT, ABBE_NO_MEMORY. */
abbe_result abbe_point_grid_make(double cell, size_t room, abbe_point_grid *out, abbe_error *error);
void abbe_point_grid_free(abbe_point_grid *grid);

/* Adds a number below the capacity, once, at its place. */
void abbe_point_grid_add(abbe_point_grid *grid, const double at[3], size_t number);

/* Called with a number of such a cell; false: no more. */
typedef bool (*abbe_point_visit)(void *user, size_t number);
/* All numbers of the 27 cells around a place: those of all points no farther than a cell's edge are
 * among them. */
void abbe_point_grid_visit(const abbe_point_grid *grid, const double at[3], abbe_point_visit visit,
                           void *user);

#endif
