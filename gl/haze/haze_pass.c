#include "gl/haze/haze_pass.h"

#include <stdio.h>
#include <string.h>

enum { STEPS_ALONG = 48, COARSE_STEPS = 12 }; /* along the camera's path through a medium */
enum { PICTURE_UNIT = 6, BEAM_UNIT = 0 };     /* that nothing of the scene is at */

static const abbe_lighting *lighting_of(const abbe_haze_pass *pass) {
  return pass->picture->receivers->lighting;
}

static const abbe_gpu_scene *scene_of(const abbe_haze_pass *pass) {
  return lighting_of(pass)->scene;
}

/* ---- make ---- */

/* Texels of targets, of which as many as the picture has are drawn. */
static void room_of(const abbe_haze_pass *pass, size_t out[2]) {
  const abbe_camera_view *camera = lighting_of(pass)->camera;
  abbe_picture_size(pass->picture, out);
  for (int k = 0; k < 2; k++)
    out[k] = pass->picture->pixels != 0 ? out[k] : camera->receiver_room[k];
}

static abbe_result make_targets(abbe_haze_pass *pass, abbe_error *error) {
  const abbe_gpu_scene *scene = scene_of(pass);
  size_t room[2];
  room_of(pass, room);
  const size_t w = room[0], h = room[1];
  ABBE_TRY(abbe_gpu_make_texture(scene->gpu, GL_RGBA32F, w, h, 0, false, &pass->scattered, error));
  return abbe_gpu_make_texture(scene->gpu, GL_DEPTH_COMPONENT32F, w, h, 0, false, &pass->depth,
                               error);
}

/* The refractor that the camera is in, the last of several; -1: the air. */
static int around_eye(const abbe_plan *plan) {
  int r = plan->eye_in_air ? -1 : (int)plan->refractor_count - 1;
  while (r > 0 && (plan->eye_inside >> r & 1) == 0) r--;
  return r;
}

static bool has_shafts(const abbe_plan *plan, int medium) {
  bool found = false;
  for (size_t i = 0; i < plan->shaft_count; i++)
    found = found || plan->shaft[i].refractor == medium;
  return found;
}

/* Where no beams are drawn the grid of them shows them, if there is one around the camera. */
static abbe_result make_shine(abbe_haze_pass *pass, const abbe_shader_variant *variant,
                              abbe_error *error) {
  static const abbe_program_stage stages[] = {{GL_VERTEX_SHADER, "screen.vert"},
                                              {GL_FRAGMENT_SHADER, "haze.frag"}};
  const abbe_plan *plan = scene_of(pass)->plan;
  const int medium = around_eye(plan);
  const bool by_grid = pass->caustics == NULL && has_shafts(plan, medium);
  char facts[64] = "", shafts[40];
  if (plan->eye_in_air) strcpy(facts, "#define IN_AIR\n");
  snprintf(shafts, sizeof shafts, "#define SHAFTS_AROUND %d\n", medium);
  if (by_grid) strcat(facts, shafts);
  return abbe_shader_variant_program(variant, scene_of(pass)->gpu, stages, 2, facts, &pass->shine,
                                     error);
}

abbe_result abbe_haze_pass_make(abbe_picture *picture, abbe_caustics *caustics,
                                const abbe_shader_variant *variant, abbe_haze_pass *out,
                                abbe_error *error) {
  static const abbe_program_stage beams[] = {{GL_VERTEX_SHADER, "beam.vert"},
                                             {GL_FRAGMENT_SHADER, "beam.frag"}};
  static const abbe_program_stage overs[] = {{GL_VERTEX_SHADER, "screen.vert"},
                                             {GL_FRAGMENT_SHADER, "haze_over.frag"}};
  static const abbe_program_stage occluders[] = {{GL_VERTEX_SHADER, "surface.vert"},
                                                 {GL_FRAGMENT_SHADER, "depth.frag"}};
  const abbe_plan *plan = picture->receivers->lighting->scene->plan;
  *out = (abbe_haze_pass){0};
  if (!plan->hazy) return ABBE_OK;
  /* beams are of all photons anew, in each picture: what moves is not kept waiting for them */
  const bool beams_too = plan->caustics && plan->desc.coarse == ABBE_COARSE_NONE;
  *out = (abbe_haze_pass){.picture = picture, .caustics = beams_too ? caustics : NULL};
  abbe_gpu *gpu = scene_of(out)->gpu;
  abbe_result result = abbe_shader_variant_program(variant, gpu, overs, 2, NULL, &out->over, error);
  if (result == ABBE_OK) result = make_targets(out, error);
  if (result == ABBE_OK) result = make_shine(out, variant, error);
  if (result != ABBE_OK || out->caustics == NULL) return result;
  result = abbe_shader_variant_program(variant, gpu, beams, 2, NULL, &out->draw_beams, error);
  if (result == ABBE_OK) result = abbe_gpu_program(gpu, occluders, 2, NULL, &out->occluder, error);
  out->beams = (abbe_beam_list){
      .caustics = caustics, .camera = lighting_of(out)->camera, .medium = around_eye(plan)};
  return result == ABBE_OK ? abbe_beam_list_make(variant, &out->beams, error) : result;
}

void abbe_haze_pass_free(abbe_haze_pass *pass) {
  if (pass->picture == NULL) return;
  abbe_gpu *gpu = scene_of(pass)->gpu;
  GLuint textures[] = {pass->scattered, pass->depth};
  abbe_gpu_drop_textures(gpu, sizeof textures / sizeof *textures, textures);
  abbe_beam_list_free(&pass->beams);
  *pass = (abbe_haze_pass){0};
}

/* ---- the target ---- */

static abbe_result set_target(abbe_haze_pass *pass, abbe_error *error) {
  static const int flat = -1;
  size_t size[2];
  abbe_picture_size(pass->picture, size);
  return abbe_gpu_set_target(scene_of(pass)->gpu, &pass->scattered, &flat, 1, pass->depth, size[0],
                             size[1], error);
}

static void set_size(const abbe_haze_pass *pass, GLuint program) {
  const abbe_gl *gl = scene_of(pass)->gpu->gl;
  size_t size[2];
  abbe_picture_size(pass->picture, size);
  gl->Uniform2f(gl->GetUniformLocation(program, "size"), (GLfloat)size[0], (GLfloat)size[1]);
}

static abbe_result clear_target(abbe_haze_pass *pass, abbe_error *error) {
  static const GLfloat nothing[4] = {0, 0, 0, 0};
  const abbe_gl *gl = scene_of(pass)->gpu->gl;
  ABBE_TRY(set_target(pass, error));
  gl->ClearBufferfv(GL_COLOR, 0, nothing);
  return ABBE_OK;
}

/* ---- beams of light ---- */

/* Whatever the camera's rays meet first hides what is behind it. */
static void draw_occluders(abbe_haze_pass *pass) {
  const abbe_gpu_scene *scene = scene_of(pass);
  const abbe_gl *gl = scene->gpu->gl;
  abbe_lighting_use(lighting_of(pass), pass->occluder);
  gl->ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  abbe_gpu_begin_depths(scene->gpu, true);
  for (size_t i = 0; i < scene->local->object_count; i++)
    abbe_seen_meshes_draw(lighting_of(pass)->meshes, i);
  abbe_gpu_end_depths(scene->gpu);
  gl->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

static abbe_result draw_listed(void *user, size_t beams, abbe_error *error) {
  abbe_haze_pass *pass = user;
  const abbe_gpu_scene *scene = scene_of(pass);
  const abbe_gl *gl = scene->gpu->gl;
  ABBE_TRY(set_target(pass, error));
  abbe_lighting_use(lighting_of(pass), pass->draw_beams);
  abbe_gpu_bind_texels(scene->gpu, pass->draw_beams, "beams", BEAM_UNIT, GL_RGBA32F,
                       pass->beams.beams);
  set_size(pass, pass->draw_beams);
  abbe_gpu_begin_depths(scene->gpu, false);
  gl->DepthMask(GL_FALSE);
  gl->Enable(GL_BLEND);
  gl->BlendFunc(GL_ONE, GL_ONE);
  gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  abbe_gpu_draw_things(scene->gpu, GL_TRIANGLES, beams, 6);
  gl->BlendFunc(GL_ONE, GL_ZERO);
  gl->Disable(GL_BLEND);
  gl->DepthMask(GL_TRUE);
  abbe_gpu_end_depths(scene->gpu);
  return ABBE_OK;
}

abbe_result abbe_haze_pass_begin(abbe_haze_pass *pass, abbe_beam_use *draws, abbe_error *error) {
  const abbe_result result = clear_target(pass, error);
  if (result == ABBE_OK) draw_occluders(pass);
  *draws = (abbe_beam_use){&pass->beams, draw_listed, pass};
  pass->begun = true;
  return result;
}

/* Where no other pass has done so for this picture. */
static abbe_result draw_beams(abbe_haze_pass *pass, abbe_error *error) {
  abbe_beam_use draws;
  ABBE_TRY(abbe_haze_pass_begin(pass, &draws, error));
  ABBE_TRY(abbe_light_layers_run(pass->caustics->layers, error));
  return abbe_beam_list_run(&draws, 1, error);
}

/* ---- the picture ---- */

/* Direct light of lights in the air, and what is left of what is behind. */
static abbe_result draw_shine(abbe_haze_pass *pass, abbe_error *error) {
  const abbe_gpu_scene *scene = scene_of(pass);
  const abbe_gl *gl = scene->gpu->gl;
  ABBE_TRY(set_target(pass, error));
  abbe_lighting_use(lighting_of(pass), pass->shine);
  abbe_gpu_bind_texture(scene->gpu, pass->shine, "picture", PICTURE_UNIT,
                        abbe_picture_texture(pass->picture));
  set_size(pass, pass->shine);
  abbe_gpu_set_int(scene->gpu, pass->shine, "steps_along",
                   scene->plan->desc.coarse == ABBE_COARSE_NONE ? STEPS_ALONG : COARSE_STEPS);
  gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  gl->Enable(GL_BLEND);
  gl->BlendFunc(GL_ONE, GL_ONE);
  abbe_gpu_draw_screen(scene->gpu);
  gl->BlendFunc(GL_ONE, GL_ZERO);
  gl->Disable(GL_BLEND);
  return ABBE_OK;
}

/* The picture's distances stay. */
static abbe_result lay_over(abbe_haze_pass *pass, abbe_error *error) {
  const abbe_gpu_scene *scene = scene_of(pass);
  const abbe_gl *gl = scene->gpu->gl;
  const abbe_picture *picture = pass->picture;
  const int layer = picture->pixels != 0 ? -1 : 0; /* layer of a texture, or of an array */
  const GLuint pixels = picture->pixels != 0 ? picture->pixels : picture->receivers->colour;
  size_t size[2];
  abbe_picture_size(picture, size);
  ABBE_TRY(abbe_gpu_set_target(scene->gpu, &pixels, &layer, 1, 0, size[0], size[1], error));
  abbe_lighting_use(lighting_of(pass), pass->over);
  abbe_gpu_bind_texture(scene->gpu, pass->over, "scattered", PICTURE_UNIT, pass->scattered);
  gl->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);
  gl->Enable(GL_BLEND);
  for (int adds = 0; adds < 2; adds++) {
    gl->BlendFunc(adds ? GL_ONE : GL_ZERO, adds ? GL_ONE : GL_SRC_COLOR);
    abbe_gpu_set_int(scene->gpu, pass->over, "adds", adds);
    abbe_gpu_draw_screen(scene->gpu);
  }
  gl->BlendFunc(GL_ONE, GL_ZERO);
  gl->Disable(GL_BLEND);
  gl->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  return ABBE_OK;
}

abbe_result abbe_haze_pass_run(abbe_haze_pass *pass, abbe_error *error) {
  if (pass->picture == NULL) return ABBE_OK;
  abbe_gpu *gpu = scene_of(pass)->gpu;
  abbe_gpu_start_lap(gpu);
  abbe_result result = ABBE_OK;
  if (pass->caustics == NULL)
    result = clear_target(pass, error);
  else if (!pass->begun)
    result = draw_beams(pass, error);
  pass->begun = false;
  if (result == ABBE_OK && !gpu->stopped) result = draw_shine(pass, error);
  if (result == ABBE_OK && !gpu->stopped) result = lay_over(pass, error);
  abbe_gpu_book_lap(gpu, ABBE_PASS_EYE_HAZE);
  return result;
}
