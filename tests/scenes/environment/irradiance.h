/* irradiance.h: what a radiance map, or surroundings as they are turned, shine on an open plane: by
 * a sum over directions. */
#ifndef ABBE_TESTS_SCENES_ENVIRONMENT_IRRADIANCE_H
#define ABBE_TESTS_SCENES_ENVIRONMENT_IRRADIANCE_H

#include "base/maths.h"
#include "scenes/environment/environment.h"

static inline void irradiance_of_map(const abbe_radiance_map *map, const double normal[3],
                                     double rgb[3]) {
  const bool coarse = map->height < 512;
  const size_t rows = coarse ? 512 : map->height, columns = coarse ? 1024 : map->width;
  const double step = ABBE_PI / (double)rows;
  rgb[0] = rgb[1] = rgb[2] = 0;
  for (size_t row = 0; row < rows; row++) {
    const double down = ((double)row + 0.5) * step;
    const double solid = coarse ? step * step * sin(down) : abbe_radiance_map_solid_angle(map, row);
    for (size_t column = 0; column < columns; column++) {
      const double around = ((double)column + 0.5) * 2 * ABBE_PI / (double)columns;
      const double d[3] = {sin(down) * cos(around), sin(down) * sin(around), cos(down)};
      const double faces = abbe_vector_dot(d, normal);
      double radiance[3];
      if (!(faces > 0)) continue;
      abbe_radiance_map_at(map, d, radiance);
      for (int k = 0; k < 3; k++) rgb[k] += solid * faces * radiance[k];
    }
  }
}

static inline void irradiance_of(const abbe_environment *e, const double normal[3], double rgb[3]) {
  double own[3];
  for (int k = 0; k < 3; k++) own[k] = abbe_vector_dot(e->to_map + 3 * k, normal);
  irradiance_of_map(&e->map, own, rgb);
}

#endif
