/* radiance_cube.h: radiance by direction as a cube of six square faces, and coarser levels of it.
 *
 * Faces, rows and columns are those of OpenGL's cube maps: +x, -x, +y, -y, +z, -z of the map's own
 * directions. A texel is the mean over its solid angle, of every level: so each level holds the
 * same light. It has no rotation and no units of its own: environment.h has.
 */
#ifndef ABBE_SCENES_ENVIRONMENT_RADIANCE_CUBE_H
#define ABBE_SCENES_ENVIRONMENT_RADIANCE_CUBE_H

#include "base/error.h"
#include "scenes/environment/radiance_map.h"

#include <stddef.h>

#define ABBE_RADIANCE_CUBE_MAX_SIDE 1024
#define ABBE_RADIANCE_CUBE_LEVELS 11 /* at the most: of side, side / 2 and so on to 1 */

typedef struct abbe_radiance_cube {
  size_t side, level_count;
  float *level[ABBE_RADIANCE_CUBE_LEVELS]; /* [6][side >> k][side >> k][3] */
} abbe_radiance_cube;

/* side: a power of two up to ABBE_RADIANCE_CUBE_MAX_SIDE. ABBE_INVALID_ARGUMENT, ABBE_NO_MEMORY. */
abbe_result abbe_radiance_cube_make(const abbe_radiance_map *map, size_t side,
                                    abbe_radiance_cube *out, abbe_error *error);
void abbe_radiance_cube_free(abbe_radiance_cube *cube);

/* The unit direction of a place of a face, 0 to 6 excluded; x along rows, y down, each 0 to 1. */
void abbe_radiance_cube_direction(size_t face, double x, double y, double direction[3]);
/* A texel of a face with a border of its neighbours' texels, one wide: columns and rows are 0 to
 * (side >> level) + 1. At a corner of the border it is the mean of the three faces that meet. */
void abbe_radiance_cube_bordered(const abbe_radiance_cube *cube, size_t level, size_t face,
                                 size_t column, size_t row, float rgb[3]);
/* The solid angle of a texel of a face of side x side, sr; all 6 side^2 of them have 4 pi. */
double abbe_radiance_cube_solid_angle(size_t side, size_t column, size_t row);

#endif
