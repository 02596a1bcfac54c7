#include "scenes/environment/irradiance_map.h"

#include "base/maths.h"

#include <math.h>

void abbe_irradiance_map_normal(size_t row, size_t column, double normal[3]) {
  const double theta = ABBE_PI * (double)row / (ABBE_IRRADIANCE_MAP_ROWS - 1);
  const double phi = 2 * ABBE_PI * (double)column / ABBE_IRRADIANCE_MAP_COLUMNS;
  normal[0] = sin(theta) * cos(phi);
  normal[1] = sin(theta) * sin(phi);
  normal[2] = cos(theta);
}

void abbe_irradiance_map_at(const abbe_irradiance_map *map, const double normal[3], double rgb[3]) {
  enum { ROWS = ABBE_IRRADIANCE_MAP_ROWS, COLUMNS = ABBE_IRRADIANCE_MAP_COLUMNS };
  const double y = atan2(hypot(normal[0], normal[1]), normal[2]) / ABBE_PI * (ROWS - 1);
  double x = atan2(normal[1], normal[0]) / (2 * ABBE_PI) * COLUMNS;
  if (x < 0) x += COLUMNS;
  const size_t row = (size_t)fmin(y, ROWS - 2), column = (size_t)fmin(x, COLUMNS - 1);
  const double down = y - (double)row, along = x - (double)column;
  const size_t next = (column + 1) % COLUMNS;
  for (int k = 0; k < 3; k++) {
    const double above =
        (1 - along) * (double)map->rgb[row][column][k] + along * (double)map->rgb[row][next][k];
    const double below = (1 - along) * (double)map->rgb[row + 1][column][k] +
                         along * (double)map->rgb[row + 1][next][k];
    rgb[k] = (1 - down) * above + down * below;
  }
}
