/* radiance_map.h: radiance by direction, as a latitude-longitude map: twice as wide as high.
 *
 * Row 0 is at the zenith, +z. The middle column looks along +x, its left neighbours towards +y: the
 * map is seen from inside, unmirrored. A texel's value stands at its middle, and the radiance
 * between is bilinear in the two angles. Longitude wraps. Above the middles of the first row it
 * goes on over the pole to that row's texel half a turn away, and so below the last: the map is
 * continuous everywhere. All integrals here are those of this bilinear radiance. It has no rotation
 * and no units of its own: environment.h has.
 */
#ifndef ABBE_SCENES_ENVIRONMENT_RADIANCE_MAP_H
#define ABBE_SCENES_ENVIRONMENT_RADIANCE_MAP_H

#include "base/error.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_RADIANCE_MAP_MIN_WIDTH 4
#define ABBE_RADIANCE_MAP_MAX_WIDTH 8192

typedef struct abbe_radiance_map {
  size_t width, height; /* width = 2 height */
  float *rgb;           /* [height][width][3], finite, >= 0 */
  bool space_assumed;   /* the OpenEXR file that it is of does not say its space */
  char part[40];        /* part of the OpenEXR file, as abbe_image names it */
} abbe_radiance_map;

/* A black map. ABBE_INVALID_ARGUMENT for a width that is odd or outside
 * ABBE_RADIANCE_MAP_MIN_WIDTH to ABBE_RADIANCE_MAP_MAX_WIDTH, ABBE_NO_MEMORY. */
abbe_result abbe_radiance_map_make(size_t width, abbe_radiance_map *out, abbe_error *error);
void abbe_radiance_map_free(abbe_radiance_map *map);

/* Unit direction of a place in the map, in texels: x in [0, width], y in [0, height], (0.5, 0.5)
 * the middle of the first texel. */
void abbe_radiance_map_direction(const abbe_radiance_map *map, double x, double y,
                                 double direction[3]);
/* The place of a direction of any length but 0. */
void abbe_radiance_map_place(const abbe_radiance_map *map, const double direction[3], double *x,
                             double *y);

/* The four texels (row * width + column) around a place, and their shares, >= 0, which add up to 1.
 */
void abbe_radiance_map_texels(const abbe_radiance_map *map, double x, double y, size_t texel[4],
                              double share[4]);

/* Radiance from a direction of any length but 0. */
void abbe_radiance_map_at(const abbe_radiance_map *map, const double direction[3], double rgb[3]);

/* The integral over the sphere of the share of one texel of that row, sr: what its value counts in
 * an integral. Over all texels they add up to 4 pi. */
double abbe_radiance_map_solid_angle(const abbe_radiance_map *map, size_t row);

/* Mean over the sphere. */
void abbe_radiance_map_mean(const abbe_radiance_map *map, double rgb[3]);

/* Half as wide and high, odd heights rounded down: each texel is the mean of those that it covers,
 * in part or whole, by solid angle. The sum over cells of solid angle x radiance stays as it is.
 * ABBE_INVALID_ARGUMENT for a map that is fewer than four texels high, ABBE_NO_MEMORY. */
abbe_result abbe_radiance_map_halve(const abbe_radiance_map *map, abbe_radiance_map *out,
                                    abbe_error *error);

/* Irradiance by the direction that a plane faces, as light without shadows has it.
 *
 * Nodes by latitude and longitude, of which the rows at both ends are the poles: planes that face
 * along an axis are nodes. Between them it is linear; a cosine's error is then below 0.4 % of the
 * greatest value. */

#define ABBE_IRRADIANCE_MAP_ROWS 21    /* from +z to -z */
#define ABBE_IRRADIANCE_MAP_COLUMNS 40 /* from +x by +y */

typedef struct abbe_irradiance_map {
  float rgb[ABBE_IRRADIANCE_MAP_ROWS][ABBE_IRRADIANCE_MAP_COLUMNS][3]; /* W/m2 */
} abbe_irradiance_map;

/* The unit normal of a node; row and column within the map. */
void abbe_irradiance_map_normal(size_t row, size_t column, double normal[3]);
/* At a unit normal. */
void abbe_irradiance_map_at(const abbe_irradiance_map *map, const double normal[3], double rgb[3]);

/* Radiance by direction as a cube of six square faces, and coarser levels of it.
 *
 * Faces, rows and columns are those of OpenGL's cube maps: +x, -x, +y, -y, +z, -z of the map's own
 * directions. A texel is the mean over its solid angle, of every level: so each level holds the
 * same light. It has no rotation and no units of its own: environment.h has. */

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
