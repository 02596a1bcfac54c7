/* irradiance_map.h: irradiance by the direction that a plane faces, as light without shadows has
 * it.
 *
 * Nodes by latitude and longitude, of which the rows at both ends are the poles: planes that face
 * along an axis are nodes. Between them it is linear; a cosine's error is then below 0.4 % of the
 * greatest value. Internal to scenes/.
 */
#ifndef ABBE_SCENES_ENVIRONMENT_IRRADIANCE_MAP_H
#define ABBE_SCENES_ENVIRONMENT_IRRADIANCE_MAP_H

#include <stddef.h>

#define ABBE_IRRADIANCE_MAP_ROWS 21    /* from +z to -z */
#define ABBE_IRRADIANCE_MAP_COLUMNS 40 /* from +x by +y */

typedef struct abbe_irradiance_map {
  float rgb[ABBE_IRRADIANCE_MAP_ROWS][ABBE_IRRADIANCE_MAP_COLUMNS][3]; /* W/m2 */
} abbe_irradiance_map;

/* The unit normal of a node; row and column within the map. */
void abbe_irradiance_map_normal(size_t row, size_t column, double normal[3]);
/* At a unit normal. */
void abbe_irradiance_map_at(const abbe_irradiance_map *map, const double normal[3], double rgb[3]);

#endif
