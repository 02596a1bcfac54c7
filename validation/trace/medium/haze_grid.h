/* haze_grid.h: photons that are scattered in a medium, found along a ray.
 *
 * A grid of cubes over the box that holds them. A gather takes what was scattered within a radius
 * of the ray: the estimate is the power there over the disk's area, which leaves a bias that goes
 * with the squared radius and the curvature of the light across the ray, and of what scatters less
 * than the whole within a radius of the medium's edge (what glows there: shaft_photons.h); both
 * vanish as the radius shrinks from pass to pass [Jarosz2008], [KnausZwicker2011].
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_MEDIUM_HAZE_GRID_H
#define ABBE_VALIDATION_TRACE_MEDIUM_HAZE_GRID_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

#define ABBE_HAZE_GRID_SIDE 160 /* cubes a side, at the most */

/* Where a photon is scattered. */
typedef struct abbe_haze_photon {
  float p[3], d[3]; /* frame; the way that it came, unit */
  float flux;       /* W, of what is scattered */
  float glow;       /* W, of what is absorbed there to glow */
  uint32_t colour;  /* light * steps + step */
  int32_t medium;   /* refractor, or -1: the air */
} abbe_haze_photon;

typedef struct abbe_haze_grid {
  size_t count, room;
  abbe_haze_photon *photon; /* [count] sorted by cube, in their order within one */
  uint32_t *own;            /* [count] cubes of the photons that it was filled with */
  uint32_t *first;          /* [cubes + 1] */
  size_t side[3], cubes;
  float low[3], cell; /* frame */
} abbe_haze_grid;

void abbe_haze_grid_free(abbe_haze_grid *grid);

/* Sorts photons for gathers of about that radius. Reuses the grid's memory. ABBE_NO_MEMORY. */
abbe_result abbe_haze_grid_fill(abbe_haze_grid *grid, const abbe_haze_photon *photon, size_t count,
                                float radius, abbe_error *error);

/* Calls take(user, photon, t) once for each photon of the medium whose place on the ray from o
 * along unit d, t, is in [from, to], finite, and which is within radius of it. The order is the
 * same for the same photons. */
void abbe_haze_grid_gather(const abbe_haze_grid *grid, const float o[3], const float d[3],
                           float from, float to, float radius, int medium,
                           void (*take)(void *user, const abbe_haze_photon *photon, float t),
                           void *user);

#endif
