#include "gl/renderer_state.h"
#include "gl/scene/shadow_planes.h"
#include "scenes/geometry/vector.h"

#include <stdlib.h>

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
static bool needs_faces(const abbe_renderer *r, const abbe_object *convex,
                        const abbe_light *light) {
  bool needs = r->plan.desc.everything;
  for (size_t i = 0; i < r->plan.receiver_count && !needs; i++)
    needs =
        abbe_shadow_planes_in_front(convex, light, &r->scene->object[r->plan.receiver_object[i]]);
  return needs;
}

static abbe_result make_shadow(abbe_renderer *r, size_t light, size_t refractor, shadow *out,
                               abbe_error *error) {
  const abbe_object *object = &r->scene->object[r->plan.refractor_object[refractor]];
  if (r->plan.model[refractor] != ABBE_REFRACTOR_CONVEX || !r->plan.reaches[light]) return ABBE_OK;
  double middle[3];
  middle_of(&object->mesh, middle);
  return abbe_shadow_planes_make(
      (const double(*)[4])object->exact.plane, object->exact.count, middle, &r->scene->light[light],
      needs_faces(r, object, &r->scene->light[light]), out->plane, &out->count, error);
}

static abbe_result keep_shadows(abbe_renderer *r, const shadow *found, size_t pairs,
                                abbe_error *error) {
  size_t planes = 0, next = 0;
  for (size_t i = 0; i < pairs; i++) planes += found[i].count;
  if (planes == 0 || (pairs + planes) * sizeof *r->shadow_row > BLOCK_BYTES) return ABBE_OK;
  r->shadow_row = calloc(pairs + planes, sizeof *r->shadow_row);
  if (r->shadow_row == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for shadows");
  r->shadow_planes = planes;
  for (size_t i = 0; i < pairs; i++) {
    r->shadow_row[i].range[0] = (int)next;
    r->shadow_row[i].range[1] = (int)found[i].count;
    for (size_t k = 0; k < found[i].count; k++, next++)
      for (int c = 0; c < 4; c++)
        r->shadow_row[pairs + next].plane[c] = (float)found[i].plane[k][c];
  }
  return ABBE_OK;
}

abbe_result abbe_renderer_make_shadows(abbe_renderer *r, abbe_error *error) {
  const size_t refractors = r->plan.convex ? r->plan.refractor_count : 0;
  const size_t pairs = r->plan.light_view_count * refractors;
  if (pairs == 0 || pairs * sizeof *r->shadow_row > BLOCK_BYTES) return ABBE_OK;
  shadow *found = calloc(pairs, sizeof *found);
  abbe_result result = ABBE_OK;
  if (found == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for shadows");
  for (size_t i = 0; result == ABBE_OK && i < pairs; i++)
    result = make_shadow(r, i / refractors, i % refractors, &found[i], error);
  if (result == ABBE_OK) result = keep_shadows(r, found, pairs, error);
  free(found);
  return result;
}

abbe_result abbe_renderer_upload_shadows(abbe_renderer *r, abbe_error *error) {
  const size_t pairs = r->plan.light_view_count * r->plan.refractor_count;
  if (r->shadow_planes == 0) return ABBE_OK;
  return abbe_renderer_make_buffer(r, (pairs + r->shadow_planes) * sizeof *r->shadow_row,
                                   r->shadow_row, &r->table_shadows, error);
}
