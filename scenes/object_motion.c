#include "scenes/object_motion.h"

#include "scenes/geometry/transform.h"
#include "scenes/geometry/vector.h"

#include <math.h>

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
  abbe_result result = abbe_mesh_transform(&object->mesh, matrix, error);
  if (result != ABBE_OK) return result;
  move_exact(&object->exact, matrix, scale);
  abbe_transform_direction(matrix, object->axis, object->axis);
  abbe_vector_normalise(object->axis);
  abbe_brushing_move(&object->brushing, matrix);
  abbe_object_bound(object);
  return ABBE_OK;
}
