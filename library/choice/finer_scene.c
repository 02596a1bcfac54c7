#include "library/choice/finer_scene.h"

#include "gl/plan/plan.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void middle(const double a[3], const double b[3], bool unit, double out[3]) {
  double length = 0;
  for (int k = 0; k < 3; k++) {
    out[k] = 0.5 * (a[k] + b[k]);
    length += out[k] * out[k];
  }
  for (int k = 0; k < 3 && unit && length > 0; k++) out[k] /= sqrt(length);
}

/* Every face in four, flat: three corners and three middles of edges each. */
static abbe_result quarter(const abbe_mesh *from, abbe_mesh *out, abbe_error *error) {
  static const uint32_t part[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
  size_t faces = from->face_count;
  abbe_result result = abbe_mesh_make(6 * faces, 4 * faces, from->uv != NULL, out, error);
  for (size_t i = 0; i < faces && result == ABBE_OK; i++) {
    const uint32_t *corner = from->face[i];
    for (size_t k = 0; k < 3; k++) {
      uint32_t a = corner[k], b = corner[(k + 1) % 3];
      memcpy(out->position[6 * i + k], from->position[a], sizeof *out->position);
      memcpy(out->normal[6 * i + k], from->normal[a], sizeof *out->normal);
      middle(from->position[a], from->position[b], false, out->position[6 * i + 3 + k]);
      middle(from->normal[a], from->normal[b], true, out->normal[6 * i + 3 + k]);
      for (int c = 0; c < 2 && from->uv != NULL; c++) {
        out->uv[6 * i + k][c] = from->uv[a][c];
        out->uv[6 * i + 3 + k][c] = 0.5 * (from->uv[a][c] + from->uv[b][c]);
      }
    }
    for (size_t p = 0; p < 4; p++)
      for (size_t k = 0; k < 3; k++) out->face[4 * i + p][k] = (uint32_t)(6 * i) + part[p][k];
  }
  return result;
}

/* Each face's coating for the four that it is cut into. */
static abbe_result quarter_coatings(abbe_coatings *c, abbe_error *error) {
  if (c == NULL || c->face == NULL) return ABBE_OK;
  uint8_t *face = malloc(4 * c->face_count + 1);
  if (face == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for coated faces");
  for (size_t i = 0; i < c->face_count; i++) memset(face + 4 * i, c->face[i], 4);
  free(c->face);
  c->face = face;
  c->face_count *= 4;
  return ABBE_OK;
}

size_t abbe_finer_scene_faces(const abbe_scene *scene) {
  size_t faces = 0;
  for (size_t i = 0; i < scene->object_count; i++)
    if (abbe_object_kind_of(&scene->object[i]) == ABBE_OBJECT_REFRACTOR)
      faces += scene->object[i].mesh.face_count;
  return faces;
}

abbe_result abbe_finer_scene_cut(abbe_scene *scene, abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < scene->object_count && result == ABBE_OK; i++) {
    abbe_object *object = &scene->object[i];
    abbe_mesh finer = {0};
    if (abbe_object_kind_of(object) != ABBE_OBJECT_REFRACTOR) continue;
    result = quarter(&object->mesh, &finer, error);
    if (result == ABBE_OK) result = quarter_coatings(object->coatings, error);
    if (result == ABBE_OK) result = quarter_coatings(object->roughness, error);
    abbe_mesh_free(result == ABBE_OK ? &object->mesh : &finer);
    if (result == ABBE_OK) object->mesh = finer;
  }
  return result;
}

abbe_result abbe_matched_physics(const abbe_scene *scene, double min_nm, double max_nm,
                                 abbe_physics *out, abbe_error *error) {
  abbe_plan plan;
  const abbe_render_desc desc = {.min_nm = min_nm, .max_nm = max_nm};
  ABBE_TRY(abbe_plan_make(scene, &desc, &plan, error));
  *out = (abbe_physics){.matched = true,
                        .orders = plan.desc.exits,
                        .energy_share = plan.desc.energy_share,
                        .eye_orders = plan.eye_exits,
                        .eye_share = plan.eye_share};
  abbe_plan_free(&plan);
  return ABBE_OK;
}
