#include "gl/eye/lighting.h"

#include "gl/device/bindings.h"

static void set_glow(const abbe_glow_pass *glow, GLuint program) {
  const abbe_gl *gl = glow->lighting->scene->gpu->gl;
  const GLsizei count = (GLsizei)glow->lighting->scene->plan->refractor_count;
  abbe_gpu_bind_array(glow->lighting->scene->gpu, program, "glow_cells", UNIT_GLOW, glow->cells);
  gl->Uniform4fv(gl->GetUniformLocation(program, "glow_low"), count, glow->low[0]);
  gl->Uniform3fv(gl->GetUniformLocation(program, "glow_size"), count, glow->size[0]);
  gl->Uniform4fv(gl->GetUniformLocation(program, "glow_ball"), count, glow->ball[0]);
  gl->Uniform3fv(gl->GetUniformLocation(program, "glow_light"), count, glow->light[0]);
}

static void set_camera(const abbe_lighting *lighting, GLuint program) {
  const abbe_gl *gl = lighting->scene->gpu->gl;
  const abbe_view *view = &lighting->camera->view;
  double matrix[16];
  float clip[16], packed[24];
  abbe_view_reversed_matrix(view, matrix);
  for (int k = 0; k < 16; k++) clip[k] = (float)matrix[k];
  abbe_view_pack(view, packed);
  gl->UniformMatrix4fv(gl->GetUniformLocation(program, "view_projection"), 1, GL_FALSE, clip);
  gl->Uniform3f(gl->GetUniformLocation(program, "eye"), packed[0], packed[1], packed[2]);
  gl->Uniform2f(gl->GetUniformLocation(program, "eye_samples"),
                (GLfloat)lighting->camera->samples[0], (GLfloat)lighting->camera->samples[1]);
  gl->Uniform2f(gl->GetUniformLocation(program, "receiver_samples"),
                (GLfloat)lighting->camera->receiver_samples[0],
                (GLfloat)lighting->camera->receiver_samples[1]);
  GLint packed_view = gl->GetUniformLocation(program, "eye_view");
  if (packed_view >= 0) gl->Uniform4fv(packed_view, 6, packed);
}

void abbe_lighting_use(const abbe_lighting *lighting, GLuint program) {
  abbe_gpu_scene_bind(lighting->scene);
  abbe_photon_lights_bind(lighting->views);
  abbe_receiver_atlas_bind(lighting->atlas);
  lighting->scene->gpu->gl->UseProgram(program);
  abbe_spectral_map_set(lighting->map, program);
  abbe_gpu_scene_set(lighting->scene, program);
  abbe_light_layers_set(lighting->layers, program);
  abbe_transports_set(lighting->transports, program);
  abbe_shaft_grid_set(lighting->shafts, program);
  if (lighting->scene->plan->glowing) set_glow(lighting->glow, program);
  set_camera(lighting, program);
}
