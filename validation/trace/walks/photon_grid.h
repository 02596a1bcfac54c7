/* photon_grid.h: the photons of one pass, found by place.
 *
 * A hashed grid of cubes; a gather adds up the hits within a radius on the same side of the
 * same surface. The estimate is the flux within the disk over its area: its bias vanishes as the
 * radius shrinks from pass to pass [KnausZwicker2011]. Internal to validation/trace/walks/.
 */
#ifndef ABBE_VALIDATION_TRACE_WALKS_PHOTON_GRID_H
#define ABBE_VALIDATION_TRACE_WALKS_PHOTON_GRID_H

#include "base/error.h"
#include "validation/trace/walks/light_walk.h"

#include <stddef.h>
#include <stdint.h>

/* A photon as the grid keeps it. */
typedef struct abbe_grid_photon {
  float p[3];
  float flux; /* W; the sign is the side of the face that it hit */
  uint32_t surface;
  uint32_t colour; /* light * steps + step */
} abbe_grid_photon;

typedef struct abbe_photon_grid {
  size_t count, room;
  abbe_grid_photon *photon; /* [count] sorted by cell */
  uint32_t *own;            /* [count] cells of the photons that it was filled with */
  uint32_t *first;          /* [cells + 1] */
  size_t cells;             /* a power of two */
  float cell;               /* side, frame */
} abbe_photon_grid;

void abbe_photon_grid_free(abbe_photon_grid *grid);

/* Sorts count photons (kept in their order within a cell) for gathers of up to that radius.
 * Reuses the grid's memory. ABBE_NO_MEMORY. */
abbe_result abbe_photon_grid_fill(abbe_photon_grid *grid, const abbe_grid_photon *photon,
                                  size_t count, float radius, size_t threads, abbe_error *error);

/* Calls take(user, photon) for each photon on that surface and side within radius (at most the
 * one that the grid was filled for) of p. */
void abbe_photon_grid_gather(const abbe_photon_grid *grid, const float p[3], float radius,
                             uint32_t surface, float side,
                             void (*take)(void *user, const abbe_grid_photon *photon), void *user);

#endif
