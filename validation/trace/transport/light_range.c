#include "validation/trace/transport/lamp_place.h"

#include <math.h>

static void take(abbe_light_range *r, double radiance) {
  if (!(radiance > 0)) return;
  r->least = fmin(r->least, radiance);
  r->greatest = fmax(r->greatest, radiance);
}

static double radiance_of(const abbe_geometry *g, const abbe_light *light) {
  double square = 1, power = light->power;
  if (light->kind == ABBE_LIGHT_DISK) power *= 3.14159 * light->radius * light->radius;
  if (light->kind == ABBE_LIGHT_RECTANGLE) power *= abbe_light_area(light);
  if (light->kind != ABBE_LIGHT_DIRECTIONAL) {
    square = 0;
    for (int k = 0; k < 3; k++) square += pow(light->position[k] - g->origin[k], 2);
  }
  return power / fmax(square, 1e-6 * g->unit * g->unit);
}

void abbe_light_range_find(const abbe_geometry *geometry, abbe_light_range *out) {
  const abbe_scene *scene = geometry->scene;
  *out = (abbe_light_range){.least = INFINITY};
  take(out, scene->ambient);
  take(out, scene->background);
  if (scene->environment != NULL) take(out, scene->environment->luminance);
  for (size_t l = 0; l < scene->light_count; l++)
    take(out, radiance_of(geometry, &scene->light[l]));
  if (!(out->greatest > 0)) *out = (abbe_light_range){1, 1};
}
