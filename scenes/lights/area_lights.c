#include "scenes/lights/environment_lights.h"

#include "base/maths.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool has_size(const abbe_light *light) {
  return abbe_light_has_size(light) && light->points == 0;
}

bool abbe_area_lights_any(const abbe_scene *scene) {
  for (size_t i = 0; i < scene->light_count; i++)
    if (has_size(&scene->light[i])) return true;
  return false;
}

/* Two unit vectors across n and each other. */
static void across(const double n[3], double s[3], double t[3]) {
  const double z[3] = {0, 0, 1}, x[3] = {1, 0, 0};
  abbe_vector_cross(fabs(n[2]) < 0.9 ? z : x, n, s);
  abbe_vector_normalise(s);
  abbe_vector_cross(n, s, t);
}

/* Rings of equal area, a point each, the golden angle apart [Vogel1979]. */
static void ring_place(const abbe_light *disk, size_t index, size_t points, double out[3]) {
  const double golden = ABBE_PI * (3 - sqrt(5));
  const double share = ((double)index + 0.5) / (double)points;
  const double r = points > 1 ? disk->radius * sqrt(share) : 0, angle = golden * (double)index;
  double s[3], t[3];
  across(disk->direction, s, t);
  for (int k = 0; k < 3; k++) out[k] = r * (cos(angle) * s[k] + sin(angle) * t[k]);
}

/* How many along the width; as many parts of the height as are left. Parts are as square as so few
 * can be. */
static size_t columns_of(const abbe_light *rectangle, size_t points) {
  const double wide = abbe_vector_length(rectangle->edge[0]),
               high = abbe_vector_length(rectangle->edge[1]);
  const double columns = round(sqrt((double)points * wide / high));
  return columns < 1 ? 1 : columns > (double)points ? points : (size_t)columns;
}

/* The largest number of points, at most so many, that makes even rows. */
static size_t points_of(const abbe_light *light, size_t points) {
  if (light->kind != ABBE_LIGHT_RECTANGLE) return points;
  const size_t columns = columns_of(light, points);
  return columns * (points / columns);
}

static void part_place(const abbe_light *rectangle, size_t index, size_t points, size_t columns,
                       double out[3]) {
  const size_t rows = points / columns;
  const double x = (2 * (double)(index % columns) + 1) / (double)columns - 1;
  const double y = (2 * (double)(index / columns) + 1) / (double)rows - 1;
  for (int k = 0; k < 3; k++) out[k] = x * rectangle->edge[0][k] + y * rectangle->edge[1][k];
}

static size_t put_points(const abbe_light *light, size_t most, abbe_light *out) {
  const size_t points = points_of(light, most);
  const size_t columns = light->kind == ABBE_LIGHT_RECTANGLE ? columns_of(light, most) : 0;
  for (size_t i = 0; i < points; i++) {
    double off[3];
    if (light->kind == ABBE_LIGHT_RECTANGLE)
      part_place(light, i, points, columns, off);
    else
      ring_place(light, i, points, off);
    out[i] = *light;
    memcpy(out[i].centre, light->position, sizeof out->centre);
    for (int k = 0; k < 3; k++) out[i].position[k] += off[k];
    out[i].power = light->power * abbe_light_area(light) / (double)points;
    out[i].points = points;
  }
  return points;
}

abbe_result abbe_area_lights_add(const abbe_scene *scene, size_t points, size_t room,
                                 abbe_scene *out, abbe_error *error) {
  assert(points > 0);
  size_t disks = 0, count = 0;
  for (size_t i = 0; i < scene->light_count; i++) disks += has_size(&scene->light[i]);
  const size_t others = scene->light_count - disks;
  if (disks > 0 && others + disks * points > room) {
    points = room > others ? (room - others) / disks : 1;
    if (points == 0) points = 1;
  }
  *out = *scene;
  out->light = calloc(others + disks * points + 1, sizeof *out->light);
  if (out->light == NULL) {
    *out = (abbe_scene){0};
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for lights with a size");
  }
  for (size_t i = 0; i < scene->light_count; i++) {
    const abbe_light *light = &scene->light[i];
    if (!has_size(light))
      out->light[count++] = *light;
    else
      count += put_points(light, points, &out->light[count]);
  }
  out->light_count = count;
  return ABBE_OK;
}
