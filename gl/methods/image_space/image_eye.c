#include "gl/methods/image_space/method.h"

#include "scenes/view/estimator.h"

#include <stdio.h>
#include <stdlib.h>

/* as in the thesis's search for the camera's rays, along the view's axis */
enum { ITERATIONS = 10 };
static const double bias_share = 0.005; /* share of the light's range */

static abbe_result make_programs(abbe_image_eye *e, const abbe_shader_variant *variant,
                                 const char *more, abbe_error *error) {
  char search[1024];
  char lit_by[1024];
  const int length =
      snprintf(search, sizeof search, "%s#define ESTIMATOR %d\n#define ITERATIONS %d\n", more,
               (int)ABBE_ESTIMATOR_AXIS, ITERATIONS);
  snprintf(lit_by, sizeof lit_by, "%s%s", more, e->light->faces > 1 ? "#define LIT_CUBE\n" : "");
  if (length < 0 || (size_t)length >= sizeof search)
    return abbe_error_set(error, ABBE_GL, "a shader's definitions are too long");
  const abbe_image_program all[] = {
      {&e->receivers, "surface.vert", NULL, "image_receivers.frag", lit_by, false},
      {&e->refraction, "screen.vert", NULL, "image_refraction.frag", search, false}};
  return abbe_image_programs_make(variant, e->scene->gpu, all, 2, error);
}

abbe_result abbe_image_eye_make(const abbe_gpu_scene *scene, const abbe_image_places *light,
                                const abbe_shader_variant *variant, const char *more,
                                float (*colour)[3], abbe_image_eye *out, abbe_error *error) {
  const size_t size[2] = {scene->plan->desc.width, scene->plan->desc.height};
  *out = (abbe_image_eye){.scene = scene, .light = light, .colour = colour};
  abbe_camera_view_fit(scene->local, &scene->plan->desc, &out->camera);
  abbe_image_cube sight;
  abbe_image_cube_one(&out->camera.view, &sight);
  ABBE_TRY(abbe_image_places_make(scene, &sight, size, size, false, &out->places, error));
  const abbe_image_texture all[] = {
      {&out->lit, GL_RGBA32F, size[0], size[1], 0, false},
      {&out->lit_depth, GL_DEPTH_COMPONENT32F, size[0], size[1], 0, false},
      {&out->picture, GL_RGBA32F, size[0], size[1], 0, false}};
  ABBE_TRY(abbe_image_textures_make(scene->gpu, all, 3, error));
  return make_programs(out, variant, more, error);
}

void abbe_image_eye_look(abbe_image_eye *e) {
  abbe_camera_view_fit(e->scene->local, &e->scene->plan->desc, &e->camera);
  abbe_image_cube sight;
  abbe_image_cube_one(&e->camera.view, &sight);
  abbe_image_places_look(&e->places, &sight);
}

void abbe_image_eye_free(abbe_image_eye *e) {
  if (e->scene == NULL) return;
  GLuint textures[] = {e->lit, e->lit_depth, e->picture};
  abbe_gpu_drop_textures(e->scene->gpu, sizeof textures / sizeof *textures, textures);
  abbe_image_places_free(&e->places);
  free(e->colour);
  *e = (abbe_image_eye){0};
}

static void set_lighting(abbe_image_eye *e, GLuint caustic_map) {
  const abbe_gpu_scene *scene = e->scene;
  const abbe_gl *gl = scene->gpu->gl;
  const abbe_image_places *light = e->light;
  const double *eye = scene->local->camera.eye;
  GLuint p = e->receivers;
  abbe_image_view_set_clip(scene, p, "view_projection", &e->places.view);
  for (size_t f = 0; f < light->faces; f++)
    abbe_image_view_set_face(scene, p, "lit_from", f, &light->face[f].view);
  abbe_image_view_set_lamp(scene, p, scene->local->light[0].direction);
  abbe_image_view_set_units(scene, p, &light->view.view);
  abbe_gpu_set_float(scene->gpu, p, "shadow_bias", bias_share * light->view.view.far);
  gl->Uniform3f(gl->GetUniformLocation(p, "eye"), (float)eye[0], (float)eye[1], (float)eye[2]);
  abbe_gpu_bind_array(scene->gpu, p, "surface_texture", 1, scene->surface_texture);
  if (light->faces > 1 && !abbe_method_of(scene->plan->desc.profile)->draws_photons)
    abbe_gpu_bind_array(scene->gpu, p, "caustic_map", 0, caustic_map);
  else
    abbe_gpu_bind_texture(scene->gpu, p, "caustic_map", 0, caustic_map);
  if (light->faces > 1)
    abbe_gpu_bind_array(scene->gpu, p, "shadow_map", 2, light->depth);
  else
    abbe_gpu_bind_texture(scene->gpu, p, "shadow_map", 2, light->depth);
}

static abbe_result light_receivers(abbe_image_eye *e, GLuint caustic_map, abbe_error *error) {
  static const int flat = -1;
  static const GLfloat far_away = 1;
  const abbe_gpu_scene *scene = e->scene;
  const abbe_gl *gl = scene->gpu->gl;
  const bool printed = abbe_method_of(scene->plan->desc.profile)->printed;
  const GLfloat sky = printed ? 0 : (float)scene->local->background;
  const GLfloat background[4] = {sky, sky, sky, 0};
  abbe_gpu_start_lap(scene->gpu);
  ABBE_TRY(abbe_image_places_receivers(&e->places, error));
  ABBE_TRY(abbe_gpu_set_target(scene->gpu, &e->lit, &flat, 1, e->lit_depth, e->places.size[0],
                               e->places.size[1], error));
  gl->ClearBufferfv(GL_COLOR, 0, background);
  gl->ClearBufferfv(GL_DEPTH, 0, &far_away);
  gl->Enable(GL_DEPTH_TEST);
  gl->UseProgram(e->receivers);
  set_lighting(e, caustic_map);
  int layer = 0;
  for (size_t i = 0; i < scene->plan->receiver_count; i++) {
    abbe_image_view_set_surface(scene, e->receivers, i, &layer);
    abbe_gpu_meshes_draw(scene, scene->plan->receiver_object[i]);
  }
  abbe_gpu_book_lap(scene->gpu, ABBE_PASS_EYE_RECEIVERS);
  return ABBE_OK;
}

static abbe_result refract_eye(abbe_image_eye *e, abbe_error *error) {
  const abbe_gpu_scene *scene = e->scene;
  const abbe_gl *gl = scene->gpu->gl;
  GLuint p = e->refraction;
  abbe_gpu_start_lap(scene->gpu);
  abbe_result result = abbe_image_places_objects(&e->places, error);
  abbe_gpu_book_lap(scene->gpu, ABBE_PASS_EYE_FRONT_AND_BACK);
  if (result != ABBE_OK) return result;
  gl->UseProgram(p);
  abbe_image_places_set(&e->places, p);
  abbe_image_view_set_units(scene, p, &e->light->view.view);
  abbe_image_view_set_clip(scene, p, "eye_matrix", &e->places.view);
  gl->Uniform3fv(gl->GetUniformLocation(p, "colour"), (GLsizei)scene->plan->desc.wavelengths,
                 &e->colour[0][0]);
  abbe_gpu_bind_texture(scene->gpu, p, "receivers_lit", 0, e->lit);
  abbe_gpu_bind_texture(scene->gpu, p, "receiver_depths", 1, e->lit_depth);
  result = abbe_image_view_draw_screen(scene, e->picture, -1, e->places.size[0], e->places.size[1],
                                       error);
  abbe_gpu_book_lap(scene->gpu, ABBE_PASS_EYE_REFRACTION);
  return result;
}

abbe_result abbe_image_eye_run(abbe_image_eye *e, GLuint caustic_map, abbe_error *error) {
  abbe_gpu_scene_bind(e->scene);
  ABBE_TRY(light_receivers(e, caustic_map, error));
  return refract_eye(e, error);
}

abbe_result abbe_method_see_from_light(abbe_method *m, abbe_error *error) {
  abbe_gpu *gpu = m->scene->gpu;
  abbe_gpu_start_lap(gpu);
  abbe_result result = abbe_image_places_receivers(&m->light, error);
  if (result == ABBE_OK) result = abbe_image_places_shadow(&m->light, error);
  abbe_gpu_book_lap(gpu, ABBE_PASS_RECEIVER_DEPTH);
  if (result == ABBE_OK) result = abbe_image_places_objects(&m->light, error);
  m->photon_count = abbe_image_places_count(&m->light);
  abbe_gpu_book_lap(gpu, ABBE_PASS_LIGHT_FRONT_AND_BACK);
  return result;
}
