#include "gl/reach.h"

#include "scenes/vector.h"
#include "scenes/view.h"

#include <math.h>

/* An exact sphere stands out of its triangles. */
static void bounds(const abbe_object *object, double min[3], double max[3]) {
  const abbe_exact *exact = &object->exact;
  for (int k = 0; k < 3; k++) {
    bool ball = exact->kind == ABBE_EXACT_SPHERE;
    min[k] = ball ? exact->centre[k] - exact->radius : object->min[k];
    max[k] = ball ? exact->centre[k] + exact->radius : object->max[k];
  }
}

bool abbe_reach_light(const abbe_light *light, const abbe_object *object) {
  static const double rounding_rad = 1e-4;
  double min[3], max[3], to[3], radius = 0;
  if (light->kind != ABBE_LIGHT_SPOT) return true;
  bounds(object, min, max);
  for (int k = 0; k < 3; k++) {
    to[k] = 0.5 * (min[k] + max[k]) - light->position[k];
    radius += 0.25 * (max[k] - min[k]) * (max[k] - min[k]);
  }
  radius = object->exact.kind == ABBE_EXACT_SPHERE ? object->exact.radius : sqrt(radius);
  double distance = abbe_vector_length(to);
  if (!(distance > radius)) return true;
  double cosine = abbe_vector_dot(to, light->direction) / distance;
  double off_rad = acos(fmin(fmax(cosine, -1), 1));
  return off_rad <= light->cone_rad + asin(radius / distance) + rounding_rad;
}

bool abbe_reach_eye(const abbe_camera *camera, size_t width, size_t height,
                    const abbe_object *object) {
  double min[3], max[3], forward[3], most[5] = {-1, -1, -1, -1, -1};
  double up = tan(0.5 * camera->fov_y_rad), right = up * (double)width / (double)height;
  abbe_view view;
  abbe_vector_subtract(camera->target, camera->eye, forward);
  abbe_view_look(camera->eye, forward, camera->up, false, &view);
  up *= 1 + 2 / (double)height;
  right *= 1 + 2 / (double)width;
  bounds(object, min, max);
  for (int corner = 0; corner < 8; corner++) {
    double to[3];
    for (int k = 0; k < 3; k++) to[k] = (corner >> k & 1 ? max[k] : min[k]) - camera->eye[k];
    double x = abbe_vector_dot(to, view.right), y = abbe_vector_dot(to, view.up);
    double z = abbe_vector_dot(to, view.forward);
    const double inside[5] = {z, right * z - x, right * z + x, up * z - y, up * z + y};
    for (int side = 0; side < 5; side++)
      if (inside[side] >= 0) most[side] = 1;
  }
  for (int side = 0; side < 5; side++)
    if (most[side] < 0) return false;
  return true;
}
