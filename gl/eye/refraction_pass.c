#include "gl/eye/refraction_pass.h"

#include "gl/device/bindings.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of a pixel, traced first; from FINE_FROM wavelengths on, where they are more. */
enum { COARSE_BANDS = 7, FINE_FROM = 9 };
/* Pixels at a time whose bands may ask for all their samples. */
enum { REFINE_ROOM = 1 << 20 };

static const abbe_gpu_scene *scene_of(const abbe_refraction_pass *pass) {
  return pass->lighting->scene;
}

/* One sample a pixel is the picture: refractors are written over receivers. */
static bool resolves(const abbe_refraction_pass *pass) {
  return scene_of(pass)->plan->desc.supersample > 1;
}

static bool refines(const abbe_refraction_pass *pass) {
  const abbe_render_desc *desc = &scene_of(pass)->plan->desc;
  return desc->wavelengths >= FINE_FROM && !desc->everything;
}

/* Where a band's path is dear, the samples of a pixel share its bands among them: half the time for
 * the same error. Facets are cheap and show bands apart: there it would cost 5 % in CIEDE2000. */
static bool interleaves(const abbe_refraction_pass *pass) {
  const abbe_plan *plan = scene_of(pass)->plan;
  const bool dear = plan->multi_refractor_paths || plan->layers;
  return dear && plan->desc.supersample > 1 && !plan->desc.everything;
}

/* Samples of a pixel whose glass spreads light by colour share the spectrum: four of them have four
 * times as many wavelengths between them. */
static bool shares_spectrum(const abbe_refraction_pass *pass) {
  const abbe_render_desc *desc = &scene_of(pass)->plan->desc;
  return desc->supersample > 1 && desc->wavelengths > 1;
}

static abbe_result make_programs(abbe_refraction_pass *pass, const abbe_shader_variant *variant,
                                 abbe_error *error) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  char facts[128], refined[128];
  abbe_shader_variant camera = *variant;
  camera.exits = scene_of(pass)->plan->eye_exits;
  const char *shares = shares_spectrum(pass) ? "#define SHARES_SPECTRUM\n" : "";
  if (refines(pass))
    snprintf(facts, sizeof facts, "%s#define REFINES\n#define COARSE_BANDS %d\n", shares,
             COARSE_BANDS);
  else
    snprintf(facts, sizeof facts, "%s%s", shares, interleaves(pass) ? "#define INTERLEAVES\n" : "");
  snprintf(refined, sizeof refined, "%s#define REFINED\n", shares);
  abbe_result result =
      abbe_shader_variant_compute(&camera, gpu, "refraction.comp", facts, &pass->refract, error);
  if (result == ABBE_OK && refines(pass))
    result = abbe_shader_variant_compute(&camera, gpu, "refraction.comp", refined,
                                         &pass->refract_refined, error);
  if (result != ABBE_OK) return result;
  return abbe_gpu_compute(gpu, "refraction_list.comp", NULL, &pass->list, error);
}

static abbe_result make_targets(abbe_refraction_pass *pass, abbe_error *error) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const abbe_plan *plan = scene_of(pass)->plan;
  const size_t w = pass->lighting->camera->samples[0], h = pass->lighting->camera->samples[1];
  const size_t room = w * h < REFINE_ROOM ? w * h : REFINE_ROOM;
  abbe_result result = ABBE_OK;
  if (resolves(pass))
    result = abbe_gpu_make_texture(gpu, GL_RGBA32F, w, h, 0, false, &pass->colour, error);
  if (result != ABBE_OK || !plan->camera_sees_refractor) return result;
  result = abbe_gpu_make_texture(gpu, GL_RGBA32F, w, h, plan->draw_back ? 2 : 1, false,
                                 &pass->layers, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_texture(gpu, GL_R16UI, w, h, 0, false, &pass->owner, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_texture(gpu, GL_DEPTH_COMPONENT32F, w, h, 0, false, &pass->depth, error);
  if (result == ABBE_OK)
    result =
        abbe_gpu_make_buffer(gpu, ABBE_GPU_LIST_HEADER + 4 * w * h, NULL, &pass->pixels, error);
  if (result == ABBE_OK && refines(pass))
    result = abbe_gpu_make_buffer(gpu, ABBE_GPU_LIST_HEADER + 8 * room, NULL, &pass->refined_pixels,
                                  error);
  return result;
}

abbe_result abbe_refraction_pass_make(const abbe_lighting *lighting,
                                      const abbe_refractor_faces *faces,
                                      const abbe_receivers_pass *receivers,
                                      const abbe_shader_variant *variant, abbe_refraction_pass *out,
                                      abbe_error *error) {
  *out = (abbe_refraction_pass){.lighting = lighting,
                                .faces = faces,
                                .receivers = receivers,
                                .pixel_threads = variant->pixel_threads};
  abbe_result result = make_targets(out, error);
  if (result == ABBE_OK && lighting->scene->plan->camera_sees_refractor)
    result = make_programs(out, variant, error);
  return result;
}

void abbe_refraction_pass_free(abbe_refraction_pass *pass) {
  if (pass->lighting == NULL) return;
  abbe_gpu *gpu = scene_of(pass)->gpu;
  GLuint textures[] = {pass->layers, pass->owner, pass->depth, pass->colour};
  GLuint buffers[] = {pass->pixels, pass->refined_pixels};
  abbe_gpu_drop_textures(gpu, sizeof textures / sizeof *textures, textures);
  abbe_gpu_drop_buffers(gpu, sizeof buffers / sizeof *buffers, buffers);
}

/* Front with its owner, and, where a mesh ends at its back layer, the back. */
abbe_result abbe_refraction_pass_draw(abbe_refraction_pass *pass, abbe_error *error) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  abbe_result result = ABBE_OK;
  if (!scene_of(pass)->plan->camera_sees_refractor) return ABBE_OK;
  abbe_gpu_start_lap(gpu);
  abbe_refractor_faces_use(pass->faces, &pass->lighting->camera->view);
  for (int back = 0; back <= (scene_of(pass)->plan->draw_back ? 1 : 0) && result == ABBE_OK;
       back++) {
    const abbe_faces_target target = {.layers = pass->layers,
                                      .owner = pass->owner,
                                      .depth = pass->depth,
                                      .layer = back,
                                      .owner_layer = -1,
                                      .width = pass->lighting->camera->samples[0],
                                      .height = pass->lighting->camera->samples[1],
                                      .back = back != 0,
                                      .both = scene_of(pass)->plan->eye_inside != 0};
    result = abbe_refractor_faces_draw(pass->faces, &target, false, error);
    abbe_gpu_book_lap(gpu, back ? ABBE_PASS_EYE_BACK : ABBE_PASS_EYE_FRONT);
  }
  return result;
}

static void list_pixels(abbe_refraction_pass *pass) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const size_t *samples = pass->lighting->camera->samples;
  abbe_gpu_clear_list(gpu, pass->pixels);
  abbe_gpu_bind_storage(gpu, BINDING_PIXELS, pass->pixels);
  gpu->gl->UseProgram(pass->list);
  abbe_gpu_bind_array(gpu, pass->list, "eye_layers", 4, pass->layers);
  abbe_gpu_bind_array(gpu, pass->list, "eye_receivers", 5, pass->receivers->colour);
  abbe_gpu_bind_texture(gpu, pass->list, "eye_owner", 6, pass->owner);
  abbe_gpu_dispatch_2d(gpu, pass->list, samples[0], samples[1]);
  gpu->gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT |
                         GL_BUFFER_UPDATE_BARRIER_BIT);
}

static void use(abbe_refraction_pass *pass, GLuint program) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const abbe_camera_view *camera = pass->lighting->camera;
  const double angle =
      (camera->view.window[3] - camera->view.window[2]) / (double)camera->samples[1];
  abbe_lighting_use(pass->lighting, program);
  abbe_gpu_bind_array(gpu, program, "eye_layers", 4, pass->layers);
  abbe_gpu_bind_texture(gpu, program, "eye_owner", 6, pass->owner);
  abbe_gpu_set_float(gpu, program, "share_limit", scene_of(pass)->plan->eye_share);
  abbe_gpu_set_float(gpu, program, "pixel_angle", angle);
  if (scene_of(pass)->plan->multi_refractor_paths)
    abbe_gpu_set_uint(gpu, program, "eye_inside", scene_of(pass)->plan->eye_inside);
}

/* Those of the listed pixels, as far as there are any. */
static void refract_strip(abbe_refraction_pass *pass, size_t first, size_t size) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  gpu->gl->UseProgram(pass->refract);
  abbe_gpu_set_uint(gpu, pass->refract, "pixel_first", first);
  abbe_gpu_set_uint(gpu, pass->refract, "pixel_end", first + size);
  if (refines(pass)) {
    abbe_gpu_clear_list(gpu, pass->refined_pixels);
    abbe_gpu_bind_storage(gpu, BINDING_REFINED_PIXELS, pass->refined_pixels);
  }
  abbe_gpu_dispatch_list(gpu, pass->refract, pass->pixels, first, size, pass->pixel_threads);
  gpu->gl->MemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  if (refines(pass))
    abbe_gpu_dispatch_list(gpu, pass->refract_refined, pass->refined_pixels, 0, size,
                           pass->pixel_threads);
}

/* In strips of what has room to be refined; in more where somebody watches, who sees it go on. */
static abbe_result refract_pixels(abbe_refraction_pass *pass, abbe_error *error) {
  enum { WATCHED_STRIPS = 16 };
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const size_t *samples = pass->lighting->camera->samples, room = samples[0] * samples[1];
  const size_t count = gpu->progress != NULL ? abbe_gpu_read_count(gpu, pass->pixels) : room;
  size_t step = gpu->progress != NULL ? count / WATCHED_STRIPS + 1 : count;
  abbe_result result = ABBE_OK;
  if (refines(pass) && step > REFINE_ROOM) step = REFINE_ROOM;
  for (size_t first = 0; first < count && result == ABBE_OK; first += step) {
    const size_t size = count - first < step ? count - first : step;
    refract_strip(pass, first, size);
    result = abbe_gpu_tell(gpu, 0.5 + 0.5 * (double)(first + size) / (double)count, error);
  }
  gpu->gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                         GL_TEXTURE_UPDATE_BARRIER_BIT);
  return result;
}

static abbe_result clear_colour(abbe_refraction_pass *pass, abbe_error *error) {
  static const int flat = -1;
  static const GLfloat nothing[4] = {0, 0, 0, 0};
  const size_t *samples = pass->lighting->camera->samples;
  abbe_result result = abbe_gpu_set_target(scene_of(pass)->gpu, &pass->colour, &flat, 1, 0,
                                           samples[0], samples[1], error);
  if (result == ABBE_OK) scene_of(pass)->gpu->gl->ClearBufferfv(GL_COLOR, 0, nothing);
  return result;
}

abbe_result abbe_refraction_pass_run(abbe_refraction_pass *pass, abbe_error *error) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const bool seen = scene_of(pass)->plan->camera_sees_refractor;
  abbe_gpu_start_lap(gpu);
  abbe_result result = resolves(pass) ? clear_colour(pass, error) : ABBE_OK;
  if (result != ABBE_OK || !seen) return result;
  list_pixels(pass);
  if (refines(pass)) use(pass, pass->refract_refined);
  use(pass, pass->refract);
  gpu->gl->BindImageTexture(0, resolves(pass) ? pass->colour : pass->receivers->colour, 0, GL_FALSE,
                            0, GL_READ_WRITE, GL_RGBA32F);
  result = refract_pixels(pass, error);
  abbe_gpu_book_lap(gpu, ABBE_PASS_EYE_REFRACTION);
  return result;
}
