#include "scenes/environment/radiance_map.h"

#include "base/maths.h"
#include "base/thread/watch.h"

#include <math.h>
#include <stdlib.h>

/* Places of a texel, a side, at which the map is looked up: about three for two of its texels. */
enum { LEAST_PLACES = 2, MOST_PLACES = 64 };

void abbe_radiance_cube_direction(size_t face, double x, double y, double direction[3]) {
  const double s = 2 * x - 1, t = 2 * y - 1;
  const double of[6][3] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t},
                           {s, -1, -t}, {s, -t, 1},  {-s, -t, -1}};
  for (int k = 0; k < 3; k++) direction[k] = of[face < 6 ? face : 5][k];
  abbe_vector_normalise(direction);
}

/* The texel that a direction meets, and the face, for so many texels a side. */
static size_t texel_of(const double direction[3], size_t side) {
  size_t axis = 0;
  for (size_t k = 1; k < 3; k++)
    if (fabs(direction[k]) > fabs(direction[axis])) axis = k;
  const size_t face = 2 * axis + (direction[axis] < 0 ? 1 : 0);
  const double x = direction[0], y = direction[1], z = direction[2];
  const double of[6][2] = {{-z, -y}, {z, -y}, {x, z}, {x, -z}, {x, -y}, {-x, -y}};
  size_t at[2];
  for (int k = 0; k < 2; k++) {
    const double place = 0.5 * (of[face][k] / fabs(direction[axis]) + 1) * (double)side;
    at[k] = (size_t)fmin(fmax(place, 0), (double)side - 1);
  }
  return (face * side + at[1]) * side + at[0];
}

/* Inside its own; beyond an edge the neighbour's; at a corner, where three faces meet, their mean.
 */
void abbe_radiance_cube_bordered(const abbe_radiance_cube *cube, size_t level, size_t face,
                                 size_t column, size_t row, float rgb[3]) {
  static const double just_outside = 1e-6; /* in units of a face */
  const size_t side = cube->side >> level, at[2] = {column, row};
  const bool outside[2] = {column % (side + 1) == 0, row % (side + 1) == 0};
  double place[2], sum[3] = {0, 0, 0}, count = 0;
  for (int k = 0; k < 2; k++)
    place[k] = fmin(fmax((double)at[k] - 0.5, 0.5), (double)side - 0.5) / (double)side;
  for (int k = 0; k < 3; k++) {
    if (k < 2 ? !outside[k] : outside[0] != outside[1]) continue;
    double there[2] = {place[0], place[1]}, direction[3];
    if (k < 2) there[k] = at[k] == 0 ? -just_outside : 1 + just_outside;
    abbe_radiance_cube_direction(face, there[0], there[1], direction);
    const float *texel = cube->level[level] + 3 * texel_of(direction, side);
    for (int c = 0; c < 3; c++) sum[c] += (double)texel[c];
    count++;
  }
  for (int c = 0; c < 3; c++) rgb[c] = (float)(sum[c] / count);
}

/* From the face's middle to a place. */
static double corner_angle(double s, double t) {
  return atan2(s * t, sqrt(s * s + t * t + 1));
}

double abbe_radiance_cube_solid_angle(size_t side, size_t column, size_t row) {
  const double step = 2.0 / (double)side;
  const double s = step * (double)column - 1, t = step * (double)row - 1;
  return corner_angle(s + step, t + step) - corner_angle(s, t + step) - corner_angle(s + step, t) +
         corner_angle(s, t);
}

/* The mean of the map over a texel. */
static void look_up(const abbe_radiance_map *map, size_t side, size_t face, size_t column,
                    size_t row, float rgb[3]) {
  double places = ceil(1.5 * (double)map->width / (4 * (double)side)), sum[3] = {0, 0, 0}, all = 0;
  const int n = (int)fmin(fmax(places, LEAST_PLACES), MOST_PLACES);
  for (int i = 0; i < n * n; i++) {
    const double x = ((double)column + (i % n + 0.5) / n) / (double)side;
    const double y = ((double)row + (i / n + 0.5) / n) / (double)side;
    const double s = 2 * x - 1, t = 2 * y - 1, weight = pow(1 + s * s + t * t, -1.5);
    double d[3], here[3];
    abbe_radiance_cube_direction(face, x, y, d);
    abbe_radiance_map_at(map, d, here);
    for (int k = 0; k < 3; k++) sum[k] += weight * here[k];
    all += weight;
  }
  for (int k = 0; k < 3; k++) rgb[k] = (float)(sum[k] / all);
}

static void join(const float *fine, size_t side, float *out) {
  const size_t half = side / 2;
  for (size_t i = 0; i < 6 * half * half; i++) {
    const size_t face = i / (half * half), row = i / half % half, column = i % half;
    double sum[3] = {0, 0, 0}, all = 0;
    for (size_t c = 0; c < 4; c++) {
      const size_t x = 2 * column + c % 2, y = 2 * row + c / 2;
      const double weight = abbe_radiance_cube_solid_angle(side, x, y);
      const float *from = fine + 3 * ((face * side + y) * side + x);
      for (int k = 0; k < 3; k++) sum[k] += weight * (double)from[k];
      all += weight;
    }
    for (int k = 0; k < 3; k++) out[3 * i + (size_t)k] = (float)(sum[k] / all);
  }
}

abbe_result abbe_radiance_cube_make(const abbe_radiance_map *map, size_t side,
                                    abbe_radiance_cube *out, abbe_error *error) {
  *out = (abbe_radiance_cube){0};
  if (side < 1 || side > ABBE_RADIANCE_CUBE_MAX_SIDE || (side & (side - 1)) != 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a cube of %zu texels a side is not possible; a power of two up to %d is",
                          side, ABBE_RADIANCE_CUBE_MAX_SIDE);
  if (map->rgb == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a cube of a map without texels");
  out->side = side;
  for (size_t n = side; n > 0; n /= 2) {
    float *level = malloc(6 * n * n * 3 * sizeof *level);
    if (level == NULL) {
      abbe_radiance_cube_free(out);
      return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a cube of %zu texels a side",
                            side);
    }
    out->level[out->level_count++] = level;
  }
  for (size_t i = 0; i < 6 * side * side && (i % side > 0 || abbe_watch_goes_on()); i++)
    look_up(map, side, i / (side * side), i % side, i / side % side, out->level[0] + 3 * i);
  const abbe_result wanted = abbe_watch_check(error);
  if (wanted != ABBE_OK) {
    abbe_radiance_cube_free(out);
    return wanted;
  }
  for (size_t k = 1; k < out->level_count; k++)
    join(out->level[k - 1], side >> (k - 1), out->level[k]);
  return ABBE_OK;
}

void abbe_radiance_cube_free(abbe_radiance_cube *cube) {
  if (cube == NULL) return;
  for (size_t k = 0; k < cube->level_count; k++) free(cube->level[k]);
  *cube = (abbe_radiance_cube){0};
}
