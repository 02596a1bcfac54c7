/* projection_map.h: where a light's rays go: at refractors, and nowhere else.
 *
 * The rays of a light are a plane: directions in Lambert's equal-area map around the way to the
 * refractors (point, spot, disk) or around a spot's own where its cone is narrower, or the plane
 * across the beam (directional). It is cut into square
 * cells. A cell is kept if a ray of it can meet a refractor: each face's bounding ball is
 * projected, so nothing that refracts is missed and the estimate stays unbiased. A few trial rays a
 * cell then say where refractors are seen past other things; more photons go there, never none
 * elsewhere. Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_WALKS_PROJECTION_MAP_H
#define ABBE_VALIDATION_TRACE_WALKS_PROJECTION_MAP_H

#include "base/error.h"
#include "validation/trace/transport/geometry.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define ABBE_PROJECTION_MAP_SIDE 256 /* cells a side, at the most */

typedef struct abbe_projection_map_cell {
  uint16_t x, y;
  float share; /* share of the light's photons; 1 over all cells */
} abbe_projection_map_cell;

typedef struct abbe_projection_map {
  const abbe_light *light;
  bool parallel;                  /* a directional light */
  float origin[3];                /* frame: of the light, or of the plane's middle */
  float right[3], up[3], way[3];  /* unit; way: the plane's middle */
  float low, step;                /* for both axes: plane = low + step * (cell + place in it) */
  float measure;                  /* measure of a cell: sr, or m2 */
  double reach;                   /* W that all cells hold, before anything is met */
  float radius;                   /* frame: of a disk light, or around a rectangle */
  float edge[2][3];               /* frame: half of a rectangle's sides */
  float facing[3], power;         /* the light's direction; W/sr, W/m2, or W/(m2 sr) times m2 */
  float outer, inner;             /* spot: 1 - cos of the cone, and of the part at full intensity */
  size_t count;                   /* cells kept; 0: no refractor, or the light misses them all */
  abbe_projection_map_cell *cell; /* [count] along a Z-order curve: neighbours stay together */
} abbe_projection_map;

/* Makes the map of one of the scene's lights, which outlives it. ABBE_NO_MEMORY, ABBE_CANCELLED by
 * the thread's watch (base/thread/watch.h). */
abbe_result abbe_projection_map_make(const abbe_geometry *geometry, size_t light,
                                     abbe_projection_map *out, abbe_error *error);
void abbe_projection_map_free(abbe_projection_map *map);

/* A ray of a cell: uv in [0, 1)^2 its place in it, disk in [0, 1)^2 the place on a disk light. The
 * origin (frame), the unit direction, and the flux in W of the whole cell if all its light left as
 * this ray does; 0: no light leaves that way. */
float abbe_projection_map_ray(const abbe_projection_map *map, const abbe_projection_map_cell *cell,
                              const float uv[2], const float disk[2], float o[3], float d[3]);

/* Rays side by side: of a light without a size. In: the cell and the place in it, x and y, of each.
 */
#define ABBE_PROJECTION_MAP_LANES 16
typedef struct abbe_projection_map_rays {
  __attribute__((aligned(64))) float x[ABBE_PROJECTION_MAP_LANES], y[ABBE_PROJECTION_MAP_LANES];
  float o[3][ABBE_PROJECTION_MAP_LANES], d[3][ABBE_PROJECTION_MAP_LANES];
  float flux[ABBE_PROJECTION_MAP_LANES];
} abbe_projection_map_rays;
void abbe_projection_map_aim(const abbe_projection_map *map, abbe_projection_map_rays *rays);

#endif
