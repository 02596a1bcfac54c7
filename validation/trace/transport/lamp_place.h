/* lamp_place.h: a place on a light, drawn evenly over its area, and kept clear of its surface.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRANSPORT_LAMP_PLACE_H
#define ABBE_VALIDATION_TRACE_TRANSPORT_LAMP_PLACE_H

#include "base/maths.h"
#include "validation/trace/transport/geometry.h"

/* The place (frame) of a light that is not directional, for u in [0, 1)^2. Returns W/sr along the
 * direction of full intensity, as if the place were all of it. */
static inline float abbe_lamp_place(const abbe_geometry *g, const abbe_light *light,
                                    const float u[2], float place[3]) {
  float power = (float)light->power;
  abbe_geometry_to_frame(g, light->position, place);
  if (light->kind == ABBE_LIGHT_DISK) {
    float n[3], a[3], b[3], r = (float)(light->radius / g->unit) * sqrtf(u[0]);
    float angle = 6.28318531f * u[1];
    for (int k = 0; k < 3; k++) n[k] = -(float)light->direction[k];
    abbe_geometry_across(n, a, b);
    for (int k = 0; k < 3; k++) place[k] += r * (cosf(angle) * a[k] + sinf(angle) * b[k]);
    power *= (float)(3.14159265358979 * light->radius * light->radius);
  } else if (light->kind == ABBE_LIGHT_RECTANGLE) {
    const float x = 2 * u[0] - 1, y = 2 * u[1] - 1, unit = (float)g->unit;
    for (int k = 0; k < 3; k++)
      place[k] += (x * (float)light->edge[0][k] + y * (float)light->edge[1][k]) / unit;
    power *= (float)abbe_light_area(light);
  }
  return power;
}

/* A place on a light, moved off it to the side that shines, by more than rays between there and
 * `from` are rounded and start off a face at `from`: they do not meet the light itself. A light
 * without size is left where it is. */
static inline void abbe_lamp_clear(const abbe_light *light, const float from[3], float place[3]) {
  float size = 0;
  if (!abbe_light_has_size(light)) return;
  for (int k = 0; k < 3; k++) size = fmaxf(size, fmaxf(fabsf(place[k]), fabsf(from[k])));
  for (int k = 0; k < 3; k++)
    place[k] += 4 * ABBE_GEOMETRY_OFFSET * size * (float)light->direction[k];
}

/* How bright a white receiver in the middle of the scene is by each of its lights, its ambient
 * light, its background and its environment: the range that a picture's sums are to hold. */

/* W/(m2 sr): about, of what is not dark; both 1 where all is. */
typedef struct abbe_light_range {
  double least, greatest;
} abbe_light_range;

void abbe_light_range_find(const abbe_geometry *geometry, abbe_light_range *out);

#endif
