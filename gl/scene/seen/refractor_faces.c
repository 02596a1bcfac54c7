#include "gl/scene/seen/refractor_faces.h"

abbe_result abbe_refractor_faces_make(const abbe_gpu_scene *scene, abbe_refractor_faces *out,
                                      abbe_error *error) {
  static const abbe_program_stage stages[] = {{GL_VERTEX_SHADER, "surface.vert"},
                                              {GL_FRAGMENT_SHADER, "layer.frag"}};
  out->scene = scene;
  return abbe_gpu_program(scene->gpu, stages, 2, NULL, &out->program, error);
}

void abbe_refractor_faces_use(const abbe_refractor_faces *faces, const abbe_view *view) {
  const abbe_gl *gl = faces->scene->gpu->gl;
  const GLuint program = faces->program;
  double matrix[16];
  float clip[16];
  abbe_view_reversed_matrix(view, matrix);
  for (int k = 0; k < 16; k++) clip[k] = (float)matrix[k];
  gl->UseProgram(program);
  gl->UniformMatrix4fv(gl->GetUniformLocation(program, "view_projection"), 1, GL_FALSE, clip);
  gl->Uniform4f(gl->GetUniformLocation(program, "view_origin"), (float)view->origin[0],
                (float)view->origin[1], (float)view->origin[2], view->orthographic ? 0.0f : 1.0f);
  gl->Uniform3f(gl->GetUniformLocation(program, "view_forward"), (float)view->forward[0],
                (float)view->forward[1], (float)view->forward[2]);
}

abbe_result abbe_refractor_faces_draw(const abbe_refractor_faces *faces,
                                      const abbe_faces_target *target, bool clear_alone,
                                      abbe_error *error) {
  static const GLuint nobody[4] = {0, 0, 0, 0};
  const abbe_gpu_scene *scene = faces->scene;
  const abbe_gl *gl = scene->gpu->gl;
  const GLfloat nothing[4] = {0, 0, 0, target->distance};
  const GLuint colour[2] = {target->layers, target->owner};
  const int layer[2] = {target->layer, target->owner_layer};
  const bool owners = !target->back;
  abbe_result result = abbe_gpu_set_target(scene->gpu, colour, layer, owners ? 2 : 1, target->depth,
                                           target->width, target->height, error);
  if (result != ABBE_OK) return result;
  gl->ClearBufferfv(GL_COLOR, 0, nothing);
  if (owners) gl->ClearBufferuiv(GL_COLOR, 1, nobody);
  if (clear_alone) return ABBE_OK;
  abbe_gpu_begin_depths(scene->gpu, true);
  gl->CullFace(target->back ? GL_FRONT : GL_BACK);
  for (size_t i = 0; i < scene->plan->refractor_count; i++) {
    if (scene->plan->mirror[i] || target->both)
      gl->Disable(GL_CULL_FACE); /* a mirror has two sides */
    else
      gl->Enable(GL_CULL_FACE);
    abbe_gpu_set_uint(scene->gpu, faces->program, "owner", i + 1);
    const size_t object = scene->plan->refractor_object[i];
    if (target->meshes != NULL && abbe_seen_meshes_is_cut(target->meshes, object))
      abbe_seen_meshes_draw(target->meshes, object);
    else if (target->coarse)
      abbe_gpu_meshes_draw_coarse(scene, object);
    else
      abbe_gpu_meshes_draw(scene, object);
  }
  gl->Disable(GL_CULL_FACE);
  abbe_gpu_end_depths(scene->gpu);
  return ABBE_OK;
}
