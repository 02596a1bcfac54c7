#include "scenes/environment/environment_source.h"

#include "base/maths.h"
#include "base/thread/watch.h"

#include <assert.h>
#include <stdlib.h>

/* a, b of the gradation; c, d, e of the scattering [CIES011, table 1]. */
static const double parameters[15][5] = {
    {4.0, -0.70, 0, -1.0, 0},      {4.0, -0.70, 2, -1.5, 0.15},   {1.1, -0.80, 0, -1.0, 0},
    {1.1, -0.80, 2, -1.5, 0.15},   {0.0, -1.00, 0, -1.0, 0},      {0.0, -1.00, 2, -1.5, 0.15},
    {0.0, -1.00, 5, -2.5, 0.30},   {0.0, -1.00, 10, -3.0, 0.45},  {-1.0, -0.55, 2, -1.5, 0.15},
    {-1.0, -0.55, 5, -2.5, 0.30},  {-1.0, -0.55, 10, -3.0, 0.45}, {-1.0, -0.32, 10, -3.0, 0.45},
    {-1.0, -0.32, 16, -3.0, 0.30}, {-1.0, -0.15, 16, -3.0, 0.30}, {-1.0, -0.15, 24, -2.8, 0.15}};

bool abbe_sky_needs_sun(int type) {
  return type >= 1 && type <= 15 && parameters[type - 1][2] > 0;
}

/* By the cosine of the angle from the zenith. */
static double gradation(const double p[5], double cosine) {
  return 1 + p[0] * exp(p[1] / cosine);
}

/* By the cosine of the angle from the sun. */
static double scattering(const double p[5], double cosine) {
  const double held = fmin(fmax(cosine, -1), 1);
  return 1 + p[2] * (exp(p[3] * acos(held)) - exp(p[3] * ABBE_PI / 2)) + p[4] * held * held;
}

double abbe_sky_relative(const abbe_sky *sky, const double direction[3]) {
  if (!(direction[2] > 0) || sky->type < 1 || sky->type > ABBE_SKY_TYPES) return 0;
  if (sky->type == ABBE_SKY_OVERCAST) return (1 + 2 * direction[2]) / 3;
  const double *p = parameters[sky->type - 1];
  const double relative = gradation(p, direction[2]) / gradation(p, 1);
  if (!abbe_sky_needs_sun(sky->type)) return relative;
  return relative * scattering(p, abbe_vector_dot(direction, sky->sun)) /
         scattering(p, sky->sun[2]);
}

/* Midpoints, even in z: smooth as far as the horizon. */
double abbe_sky_horizontal(const abbe_sky *sky) {
  enum { RINGS = 500, PLACES = 800 };
  double sum = 0;
  for (int i = 0; i < RINGS; i++) {
    const double z = (i + 0.5) / RINGS, aside = sqrt(1 - z * z);
    for (int j = 0; j < PLACES; j++) {
      const double azimuth = 2 * ABBE_PI * (j + 0.5) / PLACES;
      const double direction[3] = {aside * cos(azimuth), aside * sin(azimuth), z};
      sum += z * abbe_sky_relative(sky, direction);
    }
  }
  return 2 * ABBE_PI * sum / (RINGS * PLACES);
}

enum { FINEST = 256, DOME_PLACES = 1 << 20 };
static const double spot_reach = 6; /* standard deviations: below 2e-8 of the middle beyond */

/* --- what each kind is --- */

/* Simpson's rule. */
static double spot_solid_angle(double sigma) {
  enum { STEPS = 2000 };
  const double end = fmin(spot_reach * sigma, ABBE_PI), step = end / STEPS;
  double sum = 0;
  for (int i = 0; i <= STEPS; i++) {
    const double angle = i * step;
    const double weight = i == 0 || i == STEPS ? 1 : i % 2 ? 4 : 2;
    sum += weight * exp(-0.5 * (angle / sigma) * (angle / sigma)) * sin(angle);
  }
  return 2 * ABBE_PI * sum * step / 3;
}

double abbe_environment_source_solid_angle(const abbe_environment_source *s) {
  const double half = sin(s->radius_rad / 2);
  switch (s->kind) {
  case ABBE_SOURCE_UNIFORM:
    return 4 * ABBE_PI;
  case ABBE_SOURCE_DISK:
    return 4 * ABBE_PI * half * half;
  case ABBE_SOURCE_RECTANGLE:
    return 4 * asin(sin(s->half_width_rad) * sin(s->half_height_rad));
  case ABBE_SOURCE_SPOT:
    return spot_solid_angle(s->radius_rad);
  case ABBE_SOURCE_SKY:
  case ABBE_SOURCE_DOME:
    break;
  }
  return 0;
}

double abbe_environment_source_disk_radiance(double irradiance, double radius_rad) {
  return irradiance / (ABBE_PI * sin(radius_rad) * sin(radius_rad));
}

double abbe_environment_source_spot_sigma(double solid_angle) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; i++) {
    const double middle = (low + high) / 2;
    if (spot_solid_angle(middle) < solid_angle)
      low = middle;
    else
      high = middle;
  }
  return (low + high) / 2;
}

/* What is made of a source once: its edges as it is asked of every place. */
typedef struct profile {
  const abbe_environment_source *source;
  double right[3];
  double reach_rad; /* nothing is farther from the centre */
  double least_rad; /* its smallest measure */
  double edge_rad;  /* over which edges fade: a step between places that are asked */
  /* for a rectangle's width and height: tangents up to which a place is wholly inside, and from
   * which it is outside; places are tested only between these angles */
  double inside[2], outside[2];
} profile;

static profile profile_of(const abbe_environment_source *s) {
  profile p = {.source = s, .reach_rad = ABBE_PI, .least_rad = INFINITY};
  if (s->kind == ABBE_SOURCE_DISK || s->kind == ABBE_SOURCE_SPOT) {
    p.least_rad = s->radius_rad;
    p.reach_rad =
        s->kind == ABBE_SOURCE_DISK ? s->radius_rad : fmin(spot_reach * s->radius_rad, ABBE_PI);
  }
  if (s->kind == ABBE_SOURCE_RECTANGLE) {
    abbe_vector_cross(s->centre, s->up, p.right);
    p.reach_rad = atan(hypot(tan(s->half_width_rad), tan(s->half_height_rad)));
    p.least_rad = fmin(s->half_width_rad, s->half_height_rad);
  }
  return p;
}

static void set_edges(profile *p) {
  const double rounding = 1e-9;
  const double half[2] = {p->source->half_width_rad, p->source->half_height_rad};
  for (int i = 0; i < 2; i++) {
    const double from = half[i] - p->edge_rad / 2 - rounding;
    const double to = half[i] + p->edge_rad / 2 + rounding;
    p->inside[i] = from > 0 ? tan(from) : 0;
    p->outside[i] = to < ABBE_PI / 2 ? tan(to) : INFINITY;
  }
}

/* How far inside an edge, as a share of a step that is covered. */
static double cover(const profile *p, double inside_rad) {
  return fmin(fmax(0.5 + inside_rad / p->edge_rad, 0), 1);
}

/* From 0 to 1 of its radiance (a sky may be brighter than its zenith). */
static double value_at(const profile *p, const double direction[3]) {
  const abbe_environment_source *s = p->source;
  if (s->kind == ABBE_SOURCE_SKY) return abbe_sky_relative(&s->sky, direction);
  if (s->kind == ABBE_SOURCE_RECTANGLE) {
    const double along = abbe_vector_dot(direction, s->centre);
    const double x = fabs(abbe_vector_dot(direction, p->right));
    const double y = fabs(abbe_vector_dot(direction, s->up));
    if (x > p->outside[0] * along || y > p->outside[1] * along) return 0;
    if (x < p->inside[0] * along && y < p->inside[1] * along) return 1;
    return along > 0 ? cover(p, s->half_width_rad - atan2(x, along)) *
                           cover(p, s->half_height_rad - atan2(y, along))
                     : 0;
  }
  /* by the chord, which is exact for small angles */
  double apart[3];
  abbe_vector_subtract(direction, s->centre, apart);
  const double angle = 2 * asin(fmin(abbe_vector_length(apart) / 2, 1));
  if (s->kind == ABBE_SOURCE_DISK) return cover(p, s->radius_rad - angle);
  const double bell = exp(-0.5 * (angle / s->radius_rad) * (angle / s->radius_rad));
  return angle <= spot_reach * s->radius_rad ? bell : 0;
}

/* --- into the map --- */

/* Each texel's mean by its share, from parts x parts places a texel: the light that places add to
 * it, over the solid angle that they stand for. */
typedef struct gathering {
  const abbe_radiance_map *map;
  size_t parts;
  double *light; /* [height][width] */
  double *solid; /* [height]: of one texel of the row */
} gathering;

static double strip(const gathering *g, size_t row) {
  const double step = ABBE_PI / (double)(g->map->height * g->parts), from = step * (double)row;
  return (cos(from) - cos(from + step)) * 2 * ABBE_PI / (double)(g->map->width * g->parts);
}

static void gather_solid(const gathering *g) {
  const size_t rows = g->map->height * g->parts;
  for (size_t row = 0; row < rows; row++) {
    const double y = ((double)row + 0.5) / (double)g->parts;
    size_t texel[4];
    double share[4];
    abbe_radiance_map_texels(g->map, 0.5, y, texel, share);
    for (int i = 0; i < 4; i++)
      g->solid[texel[i] / g->map->width] += share[i] * strip(g, row) * (double)g->parts;
  }
}

static void gather_row(const gathering *g, const profile *p, size_t row, size_t first,
                       size_t count) {
  const size_t columns = g->map->width * g->parts;
  const double y = ((double)row + 0.5) / (double)g->parts, solid = strip(g, row);
  const double polar = ABBE_PI * y / (double)g->map->height, across = sin(polar), up = cos(polar);
  for (size_t c = 0; c < count; c++) {
    const double x = ((double)((first + c) % columns) + 0.5) / (double)g->parts;
    /* abbe_radiance_map_direction, with what a row has in common */
    const double azimuth = ABBE_PI - 2 * ABBE_PI * x / (double)g->map->width;
    const double direction[3] = {across * cos(azimuth), across * sin(azimuth), up};
    double share[4];
    size_t texel[4];
    const double value = value_at(p, direction);
    if (!(value > 0)) continue;
    abbe_radiance_map_texels(g->map, x, y, texel, share);
    for (int i = 0; i < 4; i++) g->light[texel[i]] += share[i] * value * solid;
  }
}

/* Only the rows and columns that a source can reach are asked. */
static void gather(const gathering *g, const profile *p) {
  const size_t rows = g->map->height * g->parts, columns = g->map->width * g->parts;
  const double step = ABBE_PI / (double)rows;
  const double polar = acos(fmin(fmax(p->source->centre[2], -1), 1));
  const double azimuth = atan2(p->source->centre[1], p->source->centre[0]);
  size_t top = 0, bottom = rows, first = 0, count = columns;
  if (p->reach_rad < ABBE_PI) {
    top = (size_t)(fmax(polar - p->reach_rad, 0) / step);
    bottom = (size_t)fmin((polar + p->reach_rad) / step + 1, (double)rows);
    const bool pole = polar - p->reach_rad <= step || polar + p->reach_rad >= ABBE_PI - step;
    const double half = pole || p->reach_rad >= ABBE_PI / 2
                            ? ABBE_PI
                            : asin(fmin(sin(p->reach_rad) / sin(polar), 1));
    const double from = (ABBE_PI - azimuth - half) / (2 * ABBE_PI) * (double)columns - 1;
    count = (size_t)fmin(half / ABBE_PI * (double)columns + 3, (double)columns);
    first = (size_t)(from < 0 ? from + (double)columns : from);
  }
  for (size_t row = top; row < bottom && abbe_watch_goes_on(); row++)
    gather_row(g, p, row, first, count);
}

/* The map's texels from what was gathered; a source whose integral is known is scaled to it. */
static abbe_result deposit(const gathering *g, const abbe_environment_source *s,
                           abbe_radiance_map *map, abbe_error *error) {
  const double exact = abbe_environment_source_solid_angle(s);
  double total = 0;
  for (size_t row = 0; row < map->height; row++) {
    const double counts = abbe_radiance_map_solid_angle(map, row) / g->solid[row];
    for (size_t i = row * map->width; i < (row + 1) * map->width; i++)
      total += g->light[i] * counts;
  }
  if (!(total > 0))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a source of the surroundings is too small for a map of %zu x %zu texels",
                          map->width, map->height);
  const double scale = exact > 0 ? exact / total : 1;
  for (size_t i = 0; i < map->width * map->height; i++)
    for (size_t k = 0; k < 3 && g->light[i] > 0; k++)
      map->rgb[3 * i + k] =
          (float)((double)map->rgb[3 * i + k] +
                  scale * s->radiance[k] * g->light[i] / g->solid[i / map->width]);
  return ABBE_OK;
}

static abbe_result add_profile(const abbe_environment_source *s, abbe_radiance_map *map,
                               abbe_error *error) {
  const double texel = ABBE_PI / (double)map->height;
  profile p = profile_of(s);
  gathering g = {.map = map, .parts = 2};
  if (isfinite(p.least_rad)) g.parts = (size_t)fmin(fmax(ceil(8 * texel / p.least_rad), 4), FINEST);
  p.edge_rad = texel / (double)g.parts;
  set_edges(&p);
  p.reach_rad = fmin(p.reach_rad + p.edge_rad, ABBE_PI);
  g.light = calloc(map->width * map->height, sizeof *g.light);
  g.solid = calloc(map->height, sizeof *g.solid);
  abbe_result result;
  if (g.light && g.solid) {
    gather_solid(&g);
    gather(&g, &p);
    result = abbe_watch_check(error);
    if (result == ABBE_OK) result = deposit(&g, s, map, error);
  } else {
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a map of %zu x %zu texels",
                            map->width, map->height);
  }
  free(g.light);
  free(g.solid);
  return result;
}

static void add_uniform(const abbe_environment_source *s, abbe_radiance_map *map) {
  for (size_t i = 0; i < 3 * map->width * map->height; i++)
    map->rgb[i] = (float)((double)map->rgb[i] + s->radiance[i % 3]);
}

/* --- domes --- */

static void dome_at(const abbe_environment_source *s, double elevation, double rgb[3]) {
  size_t low = 0, high = s->knot_count; /* knots: the last that is not above, and the next */
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (s->knot[middle].elevation_rad <= elevation)
      low = middle + 1;
    else
      high = middle;
  }
  rgb[0] = rgb[1] = rgb[2] = 0;
  if (low == 0 || low == s->knot_count) return;
  const abbe_dome_knot *below = &s->knot[low - 1], *above = &s->knot[low];
  const double t =
      (elevation - below->elevation_rad) / (above->elevation_rad - below->elevation_rad);
  for (int k = 0; k < 3; k++)
    rgb[k] = s->radiance[k] * ((1 - t) * below->rgb[k] + t * above->rgb[k]);
}

/* A row is of one value; its mean is by many places over its texels' share. */
static void add_dome(const abbe_environment_source *s, abbe_radiance_map *map) {
  const double step = ABBE_PI / (double)map->height;
  const size_t places = 2 + DOME_PLACES / map->height;
  for (size_t row = 0; row < map->height; row++) {
    double sum[3] = {0}, whole = 0;
    const double middle = ((double)row + 0.5) * step;
    for (size_t i = 0; i < places; i++) {
      const double polar = middle + step * (((double)i + 0.5) * 2 / (double)places - 1);
      const double share = (1 - fabs(polar - middle) / step) * fabs(sin(polar));
      const double held = polar < 0 ? -polar : polar > ABBE_PI ? 2 * ABBE_PI - polar : polar;
      double rgb[3];
      dome_at(s, ABBE_PI / 2 - held, rgb);
      whole += share;
      for (int k = 0; k < 3; k++) sum[k] += share * rgb[k];
    }
    for (size_t i = row * map->width; i < (row + 1) * map->width; i++)
      for (size_t k = 0; k < 3; k++)
        map->rgb[3 * i + k] = (float)((double)map->rgb[3 * i + k] + sum[k] / whole);
  }
}

static bool is_size(double angle, double most) {
  return angle >= ABBE_SOURCE_LEAST_RAD && angle <= most;
}

abbe_result abbe_environment_source_add(const abbe_environment_source *s, abbe_radiance_map *map,
                                        abbe_error *error) {
  assert(map->rgb);
  bool fine = true;
  switch (s->kind) {
  case ABBE_SOURCE_UNIFORM:
    add_uniform(s, map);
    return ABBE_OK;
  case ABBE_SOURCE_DOME:
    add_dome(s, map);
    return ABBE_OK;
  case ABBE_SOURCE_SKY:
    fine = s->sky.type >= 1 && s->sky.type <= ABBE_SKY_TYPES;
    break;
  case ABBE_SOURCE_DISK:
    fine = is_size(s->radius_rad, ABBE_PI);
    break;
  case ABBE_SOURCE_SPOT:
    fine = is_size(s->radius_rad, 1.05);
    break;
  case ABBE_SOURCE_RECTANGLE:
    fine = is_size(s->half_width_rad, 1.5) && is_size(s->half_height_rad, 1.5);
    break;
  }
  if (!fine)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a source of the surroundings has a size or a type that is not possible");
  return add_profile(s, map, error);
}
