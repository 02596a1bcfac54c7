#include "scenes/object_motion.h"

#include "base/maths.h"
#include "scenes/geometry/transform.h"

#include <math.h>

/* False where there are none of that kind. */
static bool find_middle(const abbe_scene *scene, abbe_object_kind kind, double middle[3]) {
  double min[3] = {INFINITY, INFINITY, INFINITY}, max[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (size_t i = 0; i < scene->object_count; i++)
    for (int k = 0; k < 3 && abbe_object_kind_of(&scene->object[i]) == kind; k++) {
      min[k] = fmin(min[k], scene->object[i].min[k]);
      max[k] = fmax(max[k], scene->object[i].max[k]);
    }
  for (int k = 0; k < 3; k++) middle[k] = 0.5 * (min[k] + max[k]);
  return min[0] <= max[0];
}

static void turn_about(const double middle[3], double rad, const double axis[3], double out[16]) {
  const double back[3] = {-middle[0], -middle[1], -middle[2]};
  double step[16];
  abbe_transform_translate(back, out);
  abbe_transform_rotate(rad, axis, step);
  abbe_transform_multiply(step, out, out);
  abbe_transform_translate(middle, step);
  abbe_transform_multiply(step, out, out);
}

/* Refractors and the metal that holds them, and with them other mirrors or not, turned about the
 * axis through a place. */
static abbe_result turn(abbe_scene *scene, bool mirrors, const double middle[3],
                        const double axis[3], double rad, abbe_error *error) {
  double matrix[16];
  turn_about(middle, rad, axis, matrix);
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object_kind kind = abbe_object_kind_of(&scene->object[i]);
    if (kind == ABBE_OBJECT_REFRACTOR || scene->object[i].holds ||
        (mirrors && kind == ABBE_OBJECT_MIRROR))
      ABBE_TRY(abbe_object_move(&scene->object[i], matrix, error));
  }
  return abbe_scene_check(scene, error);
}

abbe_result abbe_refractors_tilt(abbe_scene *scene, double tilt_rad, double axis_rad,
                                 abbe_error *error) {
  const double axis[3] = {cos(axis_rad), sin(axis_rad), 0};
  double middle[3];
  if (!isfinite(tilt_rad) || !isfinite(axis_rad))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a tilt takes two finite angles");
  if (!find_middle(scene, ABBE_OBJECT_REFRACTOR, middle))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "nothing to tilt: the scene has no refractor");
  return turn(scene, false, middle, axis, tilt_rad, error);
}

abbe_result abbe_piece_turn(abbe_scene *scene, const double axis[3], double turn_rad,
                            abbe_error *error) {
  double middle[3];
  if (!isfinite(turn_rad) || !abbe_vector_finite(axis) || !(abbe_vector_length(axis) > 0))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a turn takes an axis and a finite angle");
  if (!find_middle(scene, ABBE_OBJECT_REFRACTOR, middle) &&
      !find_middle(scene, ABBE_OBJECT_MIRROR, middle))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "nothing to turn: the scene has neither refractor nor mirror");
  return turn(scene, true, middle, axis, turn_rad, error);
}

/* Axes of one length, at right angles, right-handed; their length. */
static bool is_motion(const double m[16], double *scale) {
  const double least = 1e-9;
  *scale = abbe_vector_length(m);
  if (!(*scale > 0) || !isfinite(*scale)) return false;
  for (int i = 0; i < 3; i++) {
    const double *a = m + 4 * i, *b = m + 4 * ((i + 1) % 3);
    if (!(fabs(abbe_vector_length(a) - *scale) <= least * *scale) ||
        !(fabs(abbe_vector_dot(a, b)) <= least * *scale * *scale) || m[4 * i + 3] != 0)
      return false;
  }
  return m[15] == 1 && abbe_vector_finite(m + 12) && abbe_transform_determinant3(m) > 0;
}

static void move_exact(abbe_exact *e, const double m[16], double scale) {
  if (e->kind == ABBE_EXACT_SPHERE) abbe_transform_point(m, e->centre, e->centre);
  e->radius *= scale;
  for (size_t i = 0; e->plane != NULL && i < e->count; i++) {
    double *p = e->plane[i], on[3];
    for (int k = 0; k < 3; k++) on[k] = p[3] * p[k];
    abbe_transform_point(m, on, on);
    abbe_transform_direction(m, p, p);
    const double length = abbe_vector_length(p);
    for (int k = 0; k < 3; k++) p[k] /= length;
    p[3] = abbe_vector_dot(p, on);
  }
  for (size_t i = 0; e->parallelogram != NULL && i < e->count; i++) {
    double *p = e->parallelogram[i];
    abbe_transform_point(m, p, p);
    abbe_transform_direction(m, p + 3, p + 3);
    abbe_transform_direction(m, p + 6, p + 6);
  }
  abbe_transform_point(m, e->convex.place, e->convex.place);
  e->convex.size *= scale;
  if (e->convex.verdict == ABBE_CONVEX_DENTED) e->convex.off *= scale;
}

double abbe_object_square_axes(abbe_object *object) {
  const double *z = object->axis, along = abbe_vector_dot(object->axis_x, z);
  double *x = object->axis_x;
  for (int k = 0; k < 3; k++) x[k] -= along * z[k];
  const double sine = abbe_vector_length(x);
  if (sine < ABBE_AXES_SQUARE) {
    const int least = fabs(z[0]) < 0.6 ? 0 : 1;
    for (int k = 0; k < 3; k++) x[k] = (k == least) - z[least] * z[k];
  }
  abbe_vector_normalise(x);
  return sine;
}

void abbe_object_turn_axes(abbe_object *object, const double matrix[16]) {
  abbe_transform_direction(matrix, object->axis, object->axis);
  abbe_vector_normalise(object->axis);
  if (!(abbe_vector_length(object->axis_x) > 0)) return;
  abbe_transform_direction(matrix, object->axis_x, object->axis_x);
  abbe_vector_normalise(object->axis_x);
  abbe_object_square_axes(object);
}

abbe_result abbe_object_move(abbe_object *object, const double matrix[16], abbe_error *error) {
  double scale;
  if (!is_motion(matrix, &scale))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "an object may be moved, turned and scaled alike in all directions; this "
                          "matrix does something else");
  for (int k = 0; k < 8; k++) {
    double corner[3];
    for (int axis = 0; axis < 3; axis++)
      corner[axis] = (k >> axis & 1) != 0 ? object->max[axis] : object->min[axis];
    abbe_transform_point(matrix, corner, corner);
    if (!abbe_vector_finite(corner))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the object would have no finite place");
  }
  ABBE_TRY(abbe_mesh_transform(&object->mesh, matrix, error));
  move_exact(&object->exact, matrix, scale);
  abbe_object_turn_axes(object, matrix);
  abbe_brushing_move(&object->brushing, matrix);
  abbe_object_bound(object);
  return ABBE_OK;
}
