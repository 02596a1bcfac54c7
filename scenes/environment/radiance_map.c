#include "scenes/environment/radiance_map.h"

#include "base/maths.h"
#include "base/thread/watch.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

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

abbe_result abbe_radiance_map_make(size_t width, abbe_radiance_map *out, abbe_error *error) {
  *out = (abbe_radiance_map){0};
  if (width < ABBE_RADIANCE_MAP_MIN_WIDTH || width > ABBE_RADIANCE_MAP_MAX_WIDTH || width % 2 != 0)
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "a map of %zu texels across is not possible; an even number, %d to %d, is", width,
        ABBE_RADIANCE_MAP_MIN_WIDTH, ABBE_RADIANCE_MAP_MAX_WIDTH);
  out->rgb = calloc(width * (width / 2), 3 * sizeof *out->rgb);
  if (out->rgb == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a map of %zu x %zu texels", width,
                          width / 2);
  out->width = width;
  out->height = width / 2;
  return ABBE_OK;
}

void abbe_radiance_map_free(abbe_radiance_map *map) {
  if (map == NULL) return;
  free(map->rgb);
  *map = (abbe_radiance_map){0};
}

void abbe_radiance_map_direction(const abbe_radiance_map *map, double x, double y,
                                 double direction[3]) {
  const double polar = ABBE_PI * y / (double)map->height;
  const double azimuth = ABBE_PI - 2 * ABBE_PI * x / (double)map->width;
  direction[0] = sin(polar) * cos(azimuth);
  direction[1] = sin(polar) * sin(azimuth);
  direction[2] = cos(polar);
}

void abbe_radiance_map_place(const abbe_radiance_map *map, const double direction[3], double *x,
                             double *y) {
  const double aside = hypot(direction[0], direction[1]);
  *x = (ABBE_PI - atan2(direction[1], direction[0])) / (2 * ABBE_PI) * (double)map->width;
  *y = atan2(aside, direction[2]) / ABBE_PI * (double)map->height;
}

/* Over a pole a row goes on half a turn away. */
static size_t texel_of(const abbe_radiance_map *map, int64_t column, int64_t row) {
  const int64_t width = (int64_t)map->width, height = (int64_t)map->height;
  if (row < 0 || row >= height) {
    row = row < 0 ? -1 - row : 2 * height - 1 - row;
    column += width / 2;
  }
  if (column < 0 || column >= width) column %= width;
  return (size_t)(row * width + (column < 0 ? column + width : column));
}

void abbe_radiance_map_texels(const abbe_radiance_map *map, double x, double y, size_t texel[4],
                              double share[4]) {
  const double left = floor(x - 0.5), above = floor(y - 0.5);
  const double u = x - 0.5 - left, v = y - 0.5 - above;
  const int64_t column = (int64_t)left, row = (int64_t)above;
  for (int i = 0; i < 4; i++) {
    texel[i] = texel_of(map, column + i % 2, row + i / 2);
    share[i] = (i % 2 ? u : 1 - u) * (i / 2 ? v : 1 - v);
  }
}

static void at_place(const abbe_radiance_map *map, double x, double y, double rgb[3]) {
  size_t texel[4];
  double share[4];
  abbe_radiance_map_texels(map, x, y, texel, share);
  for (int k = 0; k < 3; k++) {
    rgb[k] = 0;
    for (int i = 0; i < 4; i++) rgb[k] += share[i] * (double)map->rgb[3 * texel[i] + (size_t)k];
  }
}

void abbe_radiance_map_at(const abbe_radiance_map *map, const double direction[3], double rgb[3]) {
  double x, y;
  abbe_radiance_map_place(map, direction, &x, &y);
  at_place(map, x, y, rgb);
}

/* Integral over [from, to] of (a + b theta) sin(theta), by a six-point Gauss rule: closed forms
 * cancel near the poles. */
static double piece(double a, double b, double from, double to) {
  static const double at[3] = {0.2386191860831969, 0.6612093864662645, 0.9324695142031521};
  static const double weight[3] = {0.4679139345726910, 0.3607615730481386, 0.1713244923791704};
  const double half = (to - from) / 2, middle = from + half;
  double sum = 0;
  for (int i = 0; i < 6; i++) {
    const double theta = middle + (i % 2 ? half : -half) * at[i / 2];
    sum += weight[i / 2] * (a + b * theta) * sin(theta);
  }
  return half * sum;
}

double abbe_radiance_map_solid_angle(const abbe_radiance_map *map, size_t row) {
  const double step = ABBE_PI / (double)map->height, turn = 2 * ABBE_PI / (double)map->width;
  const size_t from_pole = row < map->height - 1 - row ? row : map->height - 1 - row;
  const double middle = ((double)from_pole + 0.5) * step;
  const double below = piece(1 + middle / step, -1 / step, middle, middle + step);
  /* with the part over the pole, the first row's share is 1 up to the pole */
  const double above = from_pole == 0 ? piece(1, 0, 0, middle)
                                      : piece(1 - middle / step, 1 / step, middle - step, middle);
  return turn * (above + below);
}

void abbe_radiance_map_mean(const abbe_radiance_map *map, double rgb[3]) {
  rgb[0] = rgb[1] = rgb[2] = 0;
  for (size_t row = 0; row < map->height; row++) {
    const double share = abbe_radiance_map_solid_angle(map, row) / (4 * ABBE_PI);
    double sum[3] = {0};
    for (size_t i = row * map->width; i < (row + 1) * map->width; i++)
      for (int k = 0; k < 3; k++) sum[k] += (double)map->rgb[3 * i + (size_t)k];
    for (int k = 0; k < 3; k++) rgb[k] += share * sum[k];
  }
}

/* One texel of the halved map, from rows [top, bottom) and columns [left, right) of the map. */
static void average(const abbe_radiance_map *map, double top, double bottom, double left,
                    double right, float out[3]) {
  const double step = ABBE_PI / (double)map->height;
  double sum[3] = {0}, whole = 0;
  for (size_t row = (size_t)top; row < map->height && (double)row < bottom; row++) {
    const double from = fmax((double)row, top), to = fmin((double)row + 1, bottom);
    const double high = cos(from * step) - cos(to * step);
    for (size_t column = (size_t)left; column < map->width && (double)column < right; column++) {
      const double wide = fmin((double)column + 1, right) - fmax((double)column, left);
      const float *texel = map->rgb + 3 * (row * map->width + column);
      whole += high * wide;
      for (int k = 0; k < 3; k++) sum[k] += high * wide * (double)texel[k];
    }
  }
  for (int k = 0; k < 3; k++) out[k] = (float)(sum[k] / whole);
}

abbe_result abbe_radiance_map_halve(const abbe_radiance_map *map, abbe_radiance_map *out,
                                    abbe_error *error) {
  *out = (abbe_radiance_map){0};
  if (map->height < 4)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a map of %zu x %zu texels is too small to be halved", map->width,
                          map->height);
  ABBE_TRY(abbe_radiance_map_make(2 * (map->height / 2), out, error));
  const double wide = (double)map->width / (double)out->width;
  const double high = (double)map->height / (double)out->height;
  for (size_t row = 0; row < out->height; row++)
    for (size_t column = 0; column < out->width; column++)
      average(map, (double)row * high, (double)(row + 1) * high, (double)column * wide,
              (double)(column + 1) * wide, out->rgb + 3 * (row * out->width + column));
  return ABBE_OK;
}

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
static size_t radiance_cube_texel_of(const double direction[3], size_t side) {
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
    const float *texel = cube->level[level] + 3 * radiance_cube_texel_of(direction, side);
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
