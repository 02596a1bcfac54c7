#include "gl/scene/gpu_scene.h"

#include "base/maths.h"
#include "scenes/mesh/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The numbers of hits are floats, which count so far. */
enum { MOST_CHARTS = 1 << 22 };

static bool add_charts(abbe_receiver_charts *c, const double (*parallelogram)[9], size_t count,
                       size_t object) {
  void *corners = realloc(c->parallelogram, (c->count + count + 1) * sizeof *c->parallelogram);
  if (corners != NULL) c->parallelogram = corners;
  void *objects = realloc(c->object, (c->count + count + 1) * sizeof *c->object);
  if (objects != NULL) c->object = objects;
  if (corners == NULL || objects == NULL) return false;
  memcpy(c->parallelogram + c->count, parallelogram, count * sizeof *parallelogram);
  for (size_t i = 0; i < count; i++) c->object[c->count + i] = object;
  c->count += count;
  return true;
}

/* How far outside the parallelogram a point lies, in parts of its edges and of their product's
 * root. */
static double distance_to(const double p[9], const double at[3]) {
  double from[3], n[3], dual[2][3], far = 0;
  abbe_vector_subtract(at, p, from);
  abbe_vector_cross(p + 3, p + 6, n);
  const double area2 = abbe_vector_dot(n, n);
  abbe_vector_cross(p + 6, n, dual[0]);
  abbe_vector_cross(n, p + 3, dual[1]);
  for (int axis = 0; axis < 2; axis++) {
    const double u = abbe_vector_dot(from, dual[axis]) / area2;
    far = fmax(far, fmax(-u, u - 1));
  }
  return fmax(far, fabs(abbe_vector_dot(from, n)) / pow(area2, 0.75));
}

/* The parallelogram that each face of an exact receiver is of: the nearest to its middle. */
static void find_sides(const abbe_object *object, size_t first, int32_t *side) {
  const abbe_mesh *mesh = &object->mesh;
  for (size_t i = 0; i < mesh->face_count; i++) {
    const uint32_t *f = mesh->face[i];
    double middle[3], normal[3], across[3], nearest = INFINITY;
    size_t found = 0;
    for (int k = 0; k < 3; k++)
      middle[k] = (mesh->position[f[0]][k] + mesh->position[f[1]][k] + mesh->position[f[2]][k]) / 3;
    for (size_t k = 0; k < object->exact.count; k++) {
      const double far = distance_to(object->exact.parallelogram[k], middle);
      if (far < nearest) found = k;
      nearest = fmin(nearest, far);
    }
    const double *p = object->exact.parallelogram[found];
    abbe_vector_triangle(mesh->position[f[0]], mesh->position[f[1]], mesh->position[f[2]], normal);
    abbe_vector_cross(p + 3, p + 6, across);
    side[i] = (int32_t)(2 * (first + found)) + (abbe_vector_dot(normal, across) < 0 ? 1 : 0);
  }
}

static abbe_result add_exact(const abbe_object *object, size_t at, int32_t *side,
                             abbe_receiver_charts *c, abbe_error *error) {
  const size_t first = c->count;
  if (!add_charts(c, (const double(*)[9])object->exact.parallelogram, object->exact.count, at))
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for charts");
  find_sides(object, first, side);
  return ABBE_OK;
}

static abbe_result add_mesh(const abbe_object *object, size_t at, int32_t *side,
                            abbe_receiver_charts *c, abbe_error *error) {
  abbe_mesh_charts own = {0};
  const size_t first = c->count;
  abbe_result result = abbe_mesh_charts_make(&object->mesh, &own, error);
  if (result != ABBE_OK) return result;
  if (first + own.count > MOST_CHARTS)
    result = abbe_error_set(error, ABBE_UNSUPPORTED,
                            "the receivers fall into more than %d flat parts; use smoother meshes",
                            MOST_CHARTS);
  else if (!add_charts(c, (const double(*)[9])own.parallelogram, own.count, at))
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for charts");
  for (size_t i = 0; result == ABBE_OK && i < object->mesh.face_count; i++)
    side[i] = own.count > 0 ? (int32_t)(2 * (first + own.face[i])) : 0; /* or nothing is met */
  abbe_mesh_charts_free(&own);
  return result;
}

abbe_result abbe_receiver_charts_make(const abbe_scene *scene, const abbe_plan *plan,
                                      abbe_receiver_charts *out, abbe_error *error) {
  memset(out, 0, sizeof *out);
  out->face_first = calloc(plan->receiver_count + 1, sizeof *out->face_first);
  if (out->face_first == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for charts");
  for (size_t i = 0; i < plan->receiver_count; i++) {
    out->face_count += scene->object[plan->receiver_object[i]].mesh.face_count;
    out->face_first[i + 1] = out->face_count;
  }
  out->face_side = calloc(out->face_count + 1, sizeof *out->face_side);
  abbe_result result = out->face_side != NULL
                           ? ABBE_OK
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for charts");
  for (int meshes = 0; meshes < 2; meshes++)
    for (size_t i = 0; i < plan->receiver_count && result == ABBE_OK; i++) {
      const bool exact = plan->receiver_model[i] == ABBE_RECEIVER_EXACT;
      const size_t at = plan->receiver_object[i];
      int32_t *side = out->face_side + out->face_first[i];
      if (exact == (meshes == 0))
        result = (exact ? add_exact : add_mesh)(&scene->object[at], at, side, out, error);
    }
  if (result != ABBE_OK) abbe_receiver_charts_free(out);
  return result;
}

void abbe_receiver_charts_free(abbe_receiver_charts *charts) {
  if (charts == NULL) return;
  free(charts->parallelogram);
  free(charts->object);
  free(charts->face_first);
  free(charts->face_side);
  memset(charts, 0, sizeof *charts);
}
