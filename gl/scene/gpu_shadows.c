#include "gl/scene/gpu_scene.h"

#include "gl/scene/shadow_planes.h"
#include "scenes/geometry/vector.h"

#include <stdlib.h>
#include <string.h>

typedef struct shadow {
  double plane[2 * ABBE_SCENE_MAX_PLANES + 1][4];
  size_t count;
} shadow;

/* The mean of a solid's corners lies inside. */
static void middle_of(const abbe_mesh *mesh, double out[3]) {
  for (int k = 0; k < 3; k++) {
    out[k] = 0;
    for (size_t i = 0; i < mesh->vertex_count; i++) out[k] += mesh->position[i][k];
    out[k] /= (double)mesh->vertex_count;
  }
}

/* A place between the solid and the light is asked for where a receiver may have any. */
static bool needs_faces(const abbe_gpu_scene *scene, const abbe_object *convex,
                        const abbe_light *light) {
  bool needs = scene->plan->desc.everything;
  for (size_t i = 0; i < scene->plan->receiver_count && !needs; i++)
    needs = abbe_shadow_planes_in_front(convex, light,
                                        &scene->local->object[scene->plan->receiver_object[i]]);
  return needs;
}

static abbe_result make_shadow(abbe_gpu_scene *scene, size_t light, size_t refractor, shadow *out,
                               abbe_error *error) {
  const abbe_object *object = &scene->local->object[scene->plan->refractor_object[refractor]];
  if (scene->plan->model[refractor] != ABBE_REFRACTOR_CONVEX || !scene->plan->reaches[light])
    return ABBE_OK;
  double middle[3];
  middle_of(&object->mesh, middle);
  return abbe_shadow_planes_make((const double(*)[4])object->exact.plane, object->exact.count,
                                 middle, &scene->local->light[light],
                                 needs_faces(scene, object, &scene->local->light[light]),
                                 out->plane, &out->count, error);
}

/* A few counts for all: shaders are compiled for so many, and a light that moves changes its own.
 */
static size_t padded(size_t planes) {
  enum { STEP = 8 };
  return (planes + STEP - 1) / STEP * STEP;
}

static abbe_result keep_shadows(abbe_gpu_scene *scene, const shadow *found, size_t pairs,
                                abbe_error *error) {
  static const float on_no_side[4] = {0, 0, 0, 1e30f}; /* whatever is asked lies within it */
  size_t planes = 0, next = 0;
  for (size_t i = 0; i < pairs; i++) planes += found[i].count;
  const size_t rows = padded(planes);
  if (planes == 0 || (pairs + rows) * sizeof *scene->shadow_row > ABBE_GPU_BLOCK_BYTES)
    return ABBE_OK;
  scene->shadow_row = calloc(pairs + rows, sizeof *scene->shadow_row);
  if (scene->shadow_row == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for shadows");
  scene->shadow_planes = rows;
  for (size_t i = 0; i < pairs; i++) {
    scene->shadow_row[i].range[0] = (int)next;
    scene->shadow_row[i].range[1] = (int)found[i].count;
    for (size_t k = 0; k < found[i].count; k++, next++)
      for (int c = 0; c < 4; c++)
        scene->shadow_row[pairs + next].plane[c] = (float)found[i].plane[k][c];
  }
  for (; next < rows; next++)
    memcpy(scene->shadow_row[pairs + next].plane, on_no_side, sizeof on_no_side);
  return ABBE_OK;
}

static abbe_result upload(abbe_gpu_scene *scene, size_t pairs, abbe_error *error) {
  if (scene->shadow_planes == 0) return ABBE_OK;
  return abbe_gpu_make_buffer(scene->gpu,
                              (pairs + scene->shadow_planes) * sizeof *scene->shadow_row,
                              scene->shadow_row, &scene->shadows, error);
}

abbe_result abbe_gpu_shadows_make(abbe_gpu_scene *scene, abbe_error *error) {
  const size_t refractors = scene->plan->convex ? scene->plan->refractor_count : 0;
  const size_t pairs = scene->plan->light_view_count * refractors;
  if (pairs == 0 || pairs * sizeof *scene->shadow_row > ABBE_GPU_BLOCK_BYTES) return ABBE_OK;
  shadow *found = calloc(pairs, sizeof *found);
  abbe_result result = ABBE_OK;
  if (found == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for shadows");
  for (size_t i = 0; result == ABBE_OK && i < pairs; i++)
    result = make_shadow(scene, i / refractors, i % refractors, &found[i], error);
  if (result == ABBE_OK) result = keep_shadows(scene, found, pairs, error);
  free(found);
  return result == ABBE_OK ? upload(scene, pairs, error) : result;
}

void abbe_gpu_shadows_free(abbe_gpu_scene *scene) {
  abbe_gpu_drop_buffers(scene->gpu, 1, &scene->shadows);
  free(scene->shadow_row);
  scene->shadow_row = NULL;
  scene->shadow_planes = 0;
}
