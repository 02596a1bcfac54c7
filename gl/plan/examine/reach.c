#include "gl/plan/examine/examine.h"

#include "base/maths.h"
#include "scenes/view/view.h"

#include <math.h>
#include <string.h>

/* An exact sphere stands out of its triangles. */
static void bounds(const abbe_object *object, double min[3], double max[3]) {
  const abbe_exact *exact = &object->exact;
  for (int k = 0; k < 3; k++) {
    bool ball = exact->kind == ABBE_EXACT_SPHERE;
    min[k] = ball ? exact->centre[k] - exact->radius : object->min[k];
    max[k] = ball ? exact->centre[k] + exact->radius : object->max[k];
  }
}

static double ball_around(const abbe_object *object, double centre[3]) {
  double min[3], max[3], square = 0;
  bounds(object, min, max);
  for (int k = 0; k < 3; k++) {
    centre[k] = 0.5 * (min[k] + max[k]);
    square += 0.25 * (max[k] - min[k]) * (max[k] - min[k]);
  }
  return object->exact.kind == ABBE_EXACT_SPHERE ? object->exact.radius : sqrt(square);
}

bool abbe_reach_light(const abbe_light *light, const abbe_object *object) {
  static const double rounding_rad = 1e-4;
  double to[3];
  if (light->kind != ABBE_LIGHT_SPOT) return true;
  const double radius = ball_around(object, to);
  abbe_vector_subtract(to, light->position, to);
  double distance = abbe_vector_length(to);
  if (!(distance > radius)) return true;
  double cosine = abbe_vector_dot(to, light->direction) / distance;
  double off_rad = acos(fmin(fmax(cosine, -1), 1));
  return off_rad <= light->cone_rad + asin(radius / distance) + rounding_rad;
}

/* Whether a box may hold a place in the pyramid (or prism) of tangents (or widths) right and up
 * about the view's axis, beyond near along it: false where all corners lie beyond one side. */
static bool meets_pyramid(const abbe_view *view, double right, double up, double near,
                          const double min[3], const double max[3]) {
  bool inside[5] = {false};
  for (int corner = 0; corner < 8; corner++) {
    double to[3];
    for (int k = 0; k < 3; k++) to[k] = (corner >> k & 1 ? max[k] : min[k]) - view->origin[k];
    double x = abbe_vector_dot(to, view->right), y = abbe_vector_dot(to, view->up);
    double z = abbe_vector_dot(to, view->forward), scale = view->orthographic ? 1 : z;
    const double side[5] = {z - near, right * scale - x, right * scale + x, up * scale - y,
                            up * scale + y};
    for (int k = 0; k < 5; k++) inside[k] = inside[k] || side[k] >= 0;
  }
  for (int k = 0; k < 5; k++)
    if (!inside[k]) return false;
  return true;
}

bool abbe_reach_through(const abbe_light *light, const abbe_object *object,
                        const abbe_object *behind) {
  static const double up[3] = {0, 0, 1};
  double centre[3], forward[3], min[3], max[3];
  const double radius = ball_around(object, centre);
  const bool parallel = light->kind == ABBE_LIGHT_DIRECTIONAL;
  abbe_vector_subtract(centre, light->position, forward);
  const double distance = abbe_vector_length(forward);
  if (!parallel && !(distance > radius)) return true;
  abbe_view view;
  abbe_view_look(parallel ? centre : light->position, parallel ? light->direction : forward, up,
                 parallel, &view);
  bounds(behind, min, max);
  const double width = parallel ? radius : radius / sqrt(distance * distance - radius * radius);
  return meets_pyramid(&view, width, width, parallel ? -radius : distance - radius, min, max);
}

bool abbe_reach_eye(const abbe_camera *camera, size_t width, size_t height,
                    const abbe_object *object) {
  double min[3], max[3], forward[3];
  double up = tan(0.5 * camera->fov_y_rad), right = up * (double)width / (double)height;
  abbe_view view;
  abbe_vector_subtract(camera->target, camera->eye, forward);
  abbe_view_look(camera->eye, forward, camera->up, false, &view);
  up *= 1 + 2 / (double)height;
  right *= 1 + 2 / (double)width;
  bounds(object, min, max);
  return meets_pyramid(&view, right, up, 0, min, max);
}

double abbe_reach_side(const double p[9], const double at[3]) {
  const double *u = p + 3, *v = p + 6;
  double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  double sum = 0, length = 0;
  for (int k = 0; k < 3; k++) {
    sum += n[k] * (at[k] - p[k]);
    length += n[k] * n[k];
  }
  return sum / sqrt(length);
}

/* Between the boxes that bound them. */
static bool boxes_meet(const double a_min[3], const double a_max[3], const double b_min[3],
                       const double b_max[3]) {
  for (int k = 0; k < 3; k++)
    if (!(a_min[k] < b_max[k] && b_min[k] < a_max[k])) return false;
  return true;
}

bool abbe_reach_is_near(const abbe_object *receiver, const abbe_object *refractor) {
  double min[3], max[3], middle[3];
  const double far = 2 * ball_around(refractor, middle);
  for (int k = 0; k < 3; k++) {
    min[k] = refractor->min[k] - far;
    max[k] = refractor->max[k] + far;
  }
  return boxes_meet(receiver->min, receiver->max, min, max);
}

bool abbe_reach_overlap(const abbe_object *a, const abbe_object *b) {
  if (!boxes_meet(a->min, a->max, b->min, b->max)) return false;
  if (a->exact.kind != ABBE_EXACT_SPHERE || b->exact.kind != ABBE_EXACT_SPHERE) return true;
  double apart[3];
  abbe_vector_subtract(a->exact.centre, b->exact.centre, apart);
  return abbe_vector_length(apart) < a->exact.radius + b->exact.radius;
}

/* Whether the box has corners on both sides of the parallelogram's plane, near enough to touch it.
 */
static bool reaches_into(const double p[9], const abbe_object *refractor) {
  double min[3], max[3], low = INFINITY, high = -INFINITY;
  for (int k = 0; k < 3; k++) {
    min[k] = p[k] + fmin(p[3 + k], 0) + fmin(p[6 + k], 0);
    max[k] = p[k] + fmax(p[3 + k], 0) + fmax(p[6 + k], 0);
    /* a parallelogram in a plane of two axes has no third extent */
    double least = 1e-9 * (refractor->max[k] - refractor->min[k]);
    min[k] -= least;
    max[k] += least;
  }
  if (!boxes_meet(min, max, refractor->min, refractor->max)) return false;
  for (int c = 0; c < 8; c++) {
    double corner[3];
    for (int k = 0; k < 3; k++) corner[k] = c >> k & 1 ? refractor->max[k] : refractor->min[k];
    double side = abbe_reach_side(p, corner);
    low = fmin(low, side);
    high = fmax(high, side);
  }
  return low < 0 && high > 0;
}

bool abbe_reach_into(const abbe_object *receiver, const abbe_object *refractor) {
  const abbe_exact *exact = &receiver->exact;
  if (exact->kind != ABBE_EXACT_PARALLELOGRAMS)
    return boxes_meet(receiver->min, receiver->max, refractor->min, refractor->max);
  for (size_t k = 0; k < exact->count; k++)
    if (reaches_into(exact->parallelogram[k], refractor)) return true;
  return false;
}

bool abbe_reach_is_entered(const abbe_scene *scene, const abbe_object *refractor) {
  for (size_t i = 0; i < scene->object_count; i++)
    if (abbe_object_kind_of(&scene->object[i]) == ABBE_OBJECT_RECEIVER &&
        abbe_reach_into(&scene->object[i], refractor))
      return true;
  return false;
}

/* The plane that a face lies in. */
static size_t plane_of(const abbe_object *object, size_t face) {
  const uint32_t *f = object->mesh.face[face];
  const double *p = object->mesh.position[f[0]];
  double e[2][3], n[3], most = -INFINITY;
  size_t plane = 0;
  for (int k = 0; k < 2; k++) abbe_vector_subtract(object->mesh.position[f[k + 1]], p, e[k]);
  abbe_vector_cross(e[0], e[1], n);
  for (size_t i = 0; i < object->exact.count; i++) {
    const double along = abbe_vector_dot(n, object->exact.plane[i]);
    if (along > most) plane = i;
    most = fmax(most, along);
  }
  return plane;
}

bool abbe_refractor_films(const abbe_object *object, uint8_t *film) {
  uint8_t found[ABBE_SCENE_MAX_PLANES] = {0};
  bool known[ABBE_SCENE_MAX_PLANES] = {false}, alike = true;
  const abbe_coatings *c = object->coatings;
  for (size_t i = 0; i < c->face_count; i++) {
    const size_t plane = plane_of(object, i);
    alike = alike && (!known[plane] || found[plane] == c->face[i]);
    found[plane] = known[plane] && found[plane] != c->face[i] ? 0 : c->face[i];
    known[plane] = true;
  }
  if (film != NULL) memcpy(film, found, object->exact.count);
  return alike;
}
