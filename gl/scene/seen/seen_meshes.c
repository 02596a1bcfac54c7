#include "gl/scene/seen/seen_meshes.h"

#include "gl/scene/seen/cut_mesh.h"

#include <stdlib.h>

static abbe_result cut_object(abbe_seen_meshes *seen, const abbe_view *view, size_t i,
                              abbe_error *error) {
  const abbe_object *object = &seen->scene->local->object[i];
  abbe_mesh cut;
  if (!abbe_cut_mesh_needed(&object->mesh, object->min, object->max, view)) return ABBE_OK;
  abbe_result result = abbe_cut_mesh_make(&object->mesh, view, &cut, &seen->face_of[i], error);
  if (result == ABBE_OK) result = abbe_gpu_mesh_upload(seen->scene, &cut, &seen->cut[i], error);
  abbe_mesh_free(&cut);
  return result;
}

abbe_result abbe_seen_meshes_make(const abbe_gpu_scene *scene, const abbe_view *view,
                                  abbe_seen_meshes *out, abbe_error *error) {
  const size_t count = scene->local->object_count;
  *out = (abbe_seen_meshes){.scene = scene,
                            .cut = calloc(count + 1, sizeof *out->cut),
                            .face_of = calloc(count + 1, sizeof *out->face_of),
                            .count = count};
  if (out->cut == NULL || out->face_of == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for what the camera sees");
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < count && result == ABBE_OK; i++)
    result = cut_object(out, view, i, error);
  return result;
}

void abbe_seen_meshes_free(abbe_seen_meshes *seen) {
  if (seen->scene == NULL) return;
  for (size_t i = 0; i < seen->count && seen->cut != NULL && seen->face_of != NULL; i++) {
    abbe_gpu_mesh_free(seen->scene, &seen->cut[i]);
    free(seen->face_of[i]);
  }
  free(seen->cut);
  free(seen->face_of);
  *seen = (abbe_seen_meshes){0};
}

bool abbe_seen_meshes_is_cut(const abbe_seen_meshes *seen, size_t object) {
  return seen->cut[object].array != 0;
}

void abbe_seen_meshes_draw(const abbe_seen_meshes *seen, size_t object) {
  const abbe_gl *gl = seen->scene->gpu->gl;
  if (!abbe_seen_meshes_is_cut(seen, object)) {
    abbe_gpu_meshes_draw(seen->scene, object);
    return;
  }
  gl->BindVertexArray(seen->cut[object].array);
  gl->DrawElements(GL_TRIANGLES, seen->cut[object].index_count, GL_UNSIGNED_INT, NULL);
}

/* Faces that follow one another at a time: parts of one face do not. */
void abbe_seen_meshes_draw_numbered(const abbe_seen_meshes *seen, size_t object, GLint location,
                                    size_t face_first) {
  const abbe_gl *gl = seen->scene->gpu->gl;
  const uint32_t *face_of = seen->face_of[object];
  const size_t count = (size_t)seen->cut[object].index_count / 3;
  gl->Uniform1i(location, (GLint)face_first);
  if (!abbe_seen_meshes_is_cut(seen, object)) {
    abbe_gpu_meshes_draw(seen->scene, object);
    return;
  }
  gl->BindVertexArray(seen->cut[object].array);
  for (size_t i = 0, end = 0; i < count; i = end) {
    for (end = i + 1; end < count && face_of[end] == face_of[end - 1] + 1; end++) continue;
    gl->Uniform1i(location, (GLint)(face_first + face_of[i]));
    gl->DrawElements(GL_TRIANGLES, (GLsizei)(3 * (end - i)), GL_UNSIGNED_INT,
                     (const char *)NULL + 3 * i * sizeof(GLuint));
  }
}
