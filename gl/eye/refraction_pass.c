#include "gl/eye/refraction_pass.h"

#include "gl/device/bindings.h"
#include "gl/paths/camera_paths.h"
#include "gl/paths/mesh_walk.h"
#include "gl/scene/spectra/camera_bands.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* bands of a pixel, traced first, where they are more */
enum { COARSE_BANDS = 7 };
/* Pixels at a time whose bands may need all their samples. */
enum { REFINE_ROOM = 1 << 20 };
/* As sights.glsl has them: bytes of a place, words of a pixel before its chains; and what their
 * numbers and a buffer hold. */
enum { SIGHT_BYTES = 28, SIGHT_HEAD = 8, MOST_SIGHTS = 4793000, MOST_SHEETS = 127 };

static const abbe_gpu_scene *scene_of(const abbe_refraction_pass *pass) {
  return pass->lighting->scene;
}

/* One sample a pixel is the picture: refractors are written over receivers. */
static bool resolves(const abbe_refraction_pass *pass) {
  return scene_of(pass)->plan->desc.supersample > 1;
}

/* For a picture of what moves. */
static bool is_coarse(const abbe_refraction_pass *pass) {
  return scene_of(pass)->plan->desc.coarse != ABBE_COARSE_NONE;
}

static bool refines(const abbe_refraction_pass *pass) {
  return abbe_camera_bands_refine(scene_of(pass)->plan) && !is_coarse(pass);
}

/* Samples of a pixel whose glass spreads light by colour share the spectrum: four of them have four
 * times as many wavelengths between them. */
static bool shares_spectrum(const abbe_refraction_pass *pass) {
  const abbe_render_desc *desc = &scene_of(pass)->plan->desc;
  return (desc->supersample > 1 || desc->lens_turn > 0) && desc->wavelengths > 1 &&
         !is_coarse(pass);
}

static bool interleaves(const abbe_refraction_pass *pass) {
  return shares_spectrum(pass) && abbe_camera_bands_interleave(scene_of(pass)->plan);
}

/* They share the waves of crystals where as many may take each. */
static bool shares_waves(const abbe_refraction_pass *pass) {
  const abbe_plan *plan = scene_of(pass)->plan;
  return shares_spectrum(pass) && plan->crystals &&
         (plan->desc.supersample % 2 == 0 || plan->desc.lens_turn > 0);
}

/* Pixels a side for a sample of receivers; 1: both have as many. */
static size_t pixel_side(const abbe_refraction_pass *pass) {
  const abbe_render_desc *desc = &scene_of(pass)->plan->desc;
  return desc->receiver_samples < desc->supersample ? desc->supersample : 1;
}

/* Frames of a volume follow one another while lights move; places are on parallelograms. */
static bool keeps_sights(const abbe_refraction_pass *pass) {
  const abbe_plan *plan = scene_of(pass)->plan;
  return plan->volume && plan->camera_sees_refractor && resolves(pass) && !refines(pass) &&
         !plan->rough && !plan->hazy && !plan->desc.everything &&
         plan->receivers == ABBE_RECEIVER_EXACT && plan->parallelogram_count > 0 &&
         plan->parallelogram_count <= MOST_SHEETS;
}

/* What camera_paths.h follows, where a processor would run the shaders. */
static bool follows_here(const abbe_refraction_pass *pass, const abbe_shader_variant *v) {
  const bool empty = !v->haze && !v->haze_beyond && v->shafts == 0 && !v->environment;
  return abbe_walk_serves(scene_of(pass), v) && !pass->keeps && !is_coarse(pass) &&
         !refines(pass) && empty && v->receivers <= MOST_SHEETS;
}

/* Rays know how wide they are, and so where what receivers show to the camera will do. */
static bool shows_receivers(const abbe_refraction_pass *pass) {
  const abbe_gpu_scene *scene = scene_of(pass);
  return scene->environment.texture != 0 && !pass->keeps && !scene->plan->desc.everything;
}

/* The exits of a path, followed at the most, and the share of its light below which it ends. */
static size_t exits_of(const abbe_refraction_pass *pass) {
  const abbe_plan *plan = scene_of(pass)->plan;
  const bool fewer = is_coarse(pass) && plan->eye_exits > ABBE_COARSE_EXITS;
  return fewer ? ABBE_COARSE_EXITS : plan->eye_exits;
}

static double share_of(const abbe_refraction_pass *pass) {
  const abbe_plan *plan = scene_of(pass)->plan;
  const double least = plan->multi_refractor_paths ? ABBE_COARSE_MESH_SHARE : ABBE_COARSE_SHARE;
  return is_coarse(pass) ? fmax(plan->eye_share, least) : plan->eye_share;
}

static abbe_result make_list(abbe_refraction_pass *pass, const abbe_shader_variant *variant,
                             abbe_error *error) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  char side[64];
  if (pixel_side(pass) == 1)
    return abbe_gpu_compute(gpu, "refraction_list.comp", NULL, &pass->list, error);
  snprintf(side, sizeof side, "#define PIXEL_SIDE %zu\n", pixel_side(pass));
  return abbe_shader_variant_compute(variant, gpu, "refraction_list.comp", side, &pass->list,
                                     error);
}

static abbe_result make_programs(abbe_refraction_pass *pass, const abbe_shader_variant *variant,
                                 abbe_error *error) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  char facts[256], refined[256], shares[192];
  abbe_shader_variant camera = *variant;
  camera.exits = exits_of(pass);
  char shown[112];
  snprintf(shown, sizeof shown, "%s%s", shows_receivers(pass) ? "#define SHOWN_RECEIVERS\n" : "",
           abbe_shader_variant_waves(scene_of(pass)->plan));
  snprintf(shares, sizeof shares, "%s%s%s", shown,
           shares_spectrum(pass) ? "#define SHARES_SPECTRUM\n" : "",
           shares_waves(pass) ? "#define SHARES_WAVES\n" : "");
  if (refines(pass))
    snprintf(facts, sizeof facts, "%s#define REFINES\n#define COARSE_BANDS %d\n", shares,
             COARSE_BANDS);
  else
    snprintf(facts, sizeof facts, "%s%s%s", shares,
             interleaves(pass) ? "#define INTERLEAVES\n" : "",
             pass->keeps ? "#define KEEPS_SIGHTS\n" : "");
  if (is_coarse(pass)) snprintf(facts, sizeof facts, "%s#define COARSE_EYE\n", shown);
  snprintf(refined, sizeof refined, "%s#define REFINED\n", shares);
  camera.pixel_threads = pass->pixel_threads;
  if (!pass->here)
    ABBE_TRY(
        abbe_shader_variant_compute(&camera, gpu, "refraction.comp", facts, &pass->refract, error));
  if (refines(pass))
    ABBE_TRY(abbe_shader_variant_compute(&camera, gpu, "refraction.comp", refined,
                                         &pass->refract_refined, error));
  if ((pass->keeps || pass->here))
    ABBE_TRY(abbe_shader_variant_compute(&camera, gpu, "sights.comp", NULL, &pass->look_up, error));
  return make_list(pass, variant, error);
}

static abbe_result make_targets(abbe_refraction_pass *pass, abbe_error *error) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const abbe_plan *plan = scene_of(pass)->plan;
  const size_t w = pass->lighting->camera->room[0], h = pass->lighting->camera->room[1];
  const size_t room = w * h < REFINE_ROOM ? w * h : REFINE_ROOM;
  if (resolves(pass))
    ABBE_TRY(abbe_gpu_make_texture(gpu, GL_RGBA32F, w, h, 0, false, &pass->colour, error));
  if (!plan->camera_sees_refractor) return ABBE_OK;
  if (!resolves(pass) && shows_receivers(pass))
    ABBE_TRY(abbe_gpu_make_texture(gpu, GL_RGBA32F, w, h, 1, false, &pass->shown, error));
  ABBE_TRY(abbe_gpu_make_texture(gpu, GL_RGBA32F, w, h, plan->draw_back ? 2 : 1, false,
                                 &pass->layers, error));
  ABBE_TRY(abbe_gpu_make_texture(gpu, GL_R16UI, w, h, 0, false, &pass->owner, error));
  ABBE_TRY(abbe_gpu_make_texture(gpu, GL_DEPTH_COMPONENT32F, w, h, 0, false, &pass->depth, error));
  ABBE_TRY(abbe_gpu_make_buffer(gpu, ABBE_GPU_LIST_HEADER + 4 * w * h, NULL, &pass->pixels, error));
  if (pixel_side(pass) > 1)
    ABBE_TRY(
        abbe_gpu_make_buffer(gpu, ABBE_GPU_LIST_HEADER + 4 * w * h, NULL, &pass->merged, error));
  if (refines(pass))
    ABBE_TRY(abbe_gpu_make_buffer(gpu, ABBE_GPU_LIST_HEADER + 8 * room, NULL, &pass->refined_pixels,
                                  error));
  return ABBE_OK;
}

static void take_kept(abbe_refraction_pass *pass, abbe_refraction_kept *kept) {
  pass->layers = kept->layers;
  pass->owner = kept->owner;
  pass->depth = kept->depth;
  pass->pixels = kept->pixels;
  pass->merged = kept->merged;
  pass->colour = kept->colour;
  pass->sights = kept->sights;
  pass->sight_pixels = kept->sight_pixels;
  pass->sight_room = kept->sight_room;
  pass->sight_bytes = kept->sight_bytes;
  pass->whole = kept->whole;
  *kept = (abbe_refraction_kept){0};
}

void abbe_refraction_pass_leave(abbe_refraction_pass *pass, abbe_refraction_kept *out) {
  if (!pass->whole) return;
  *out = (abbe_refraction_kept){.whole = true,
                                .layers = pass->layers,
                                .owner = pass->owner,
                                .depth = pass->depth,
                                .pixels = pass->pixels,
                                .merged = pass->merged,
                                .colour = pass->colour,
                                .sights = pass->sights,
                                .sight_pixels = pass->sight_pixels,
                                .sight_room = pass->sight_room,
                                .sight_bytes = pass->sight_bytes};
  abbe_refraction_kept none = {0};
  take_kept(pass, &none);
}

void abbe_refraction_kept_free(abbe_gpu *gpu, abbe_refraction_kept *kept) {
  GLuint textures[] = {kept->layers, kept->owner, kept->depth, kept->colour};
  GLuint buffers[] = {kept->pixels, kept->merged, kept->sights, kept->sight_pixels};
  abbe_gpu_drop_textures(gpu, sizeof textures / sizeof *textures, textures);
  abbe_gpu_drop_buffers(gpu, sizeof buffers / sizeof *buffers, buffers);
  *kept = (abbe_refraction_kept){0};
}

abbe_result abbe_refraction_pass_make(const abbe_lighting *lighting,
                                      const abbe_refractor_faces *faces,
                                      const abbe_receivers_pass *receivers,
                                      const abbe_shader_variant *variant,
                                      abbe_refraction_kept *kept, abbe_refraction_pass *out,
                                      abbe_error *error) {
  *out = (abbe_refraction_pass){.lighting = lighting,
                                .faces = faces,
                                .receivers = receivers,
                                .pixel_threads = variant->pixel_threads};
  out->keeps = keeps_sights(out);
  out->here = follows_here(out, variant);
  if (out->here) out->pixel_threads = 1;
  out->eye_bands = variant->eye_bands;
  take_kept(out, kept);
  ABBE_TRY(out->whole ? ABBE_OK : make_targets(out, error));
  if (lighting->scene->plan->camera_sees_refractor) ABBE_TRY(make_programs(out, variant, error));
  return ABBE_OK;
}

void abbe_refraction_pass_free(abbe_refraction_pass *pass) {
  if (pass->lighting == NULL) return;
  abbe_gpu *gpu = scene_of(pass)->gpu;
  GLuint textures[] = {pass->layers, pass->owner, pass->depth, pass->colour, pass->shown};
  GLuint buffers[] = {pass->pixels, pass->refined_pixels, pass->merged, pass->sights,
                      pass->sight_pixels};
  abbe_gpu_drop_textures(gpu, sizeof textures / sizeof *textures, textures);
  abbe_gpu_drop_buffers(gpu, sizeof buffers / sizeof *buffers, buffers);
}

/* Front with its owner, and, where a mesh ends at its back layer, the back. */
abbe_result abbe_refraction_pass_draw(abbe_refraction_pass *pass, abbe_error *error) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  abbe_result result = ABBE_OK;
  if (!scene_of(pass)->plan->camera_sees_refractor || pass->whole) return ABBE_OK;
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
                                      .coarse =
                                          scene_of(pass)->plan->fewer_triangles != ABBE_COARSE_NONE,
                                      .both = scene_of(pass)->plan->eye_inside != 0,
                                      .meshes = pass->lighting->meshes};
    result = abbe_refractor_faces_draw(pass->faces, &target, false, error);
    abbe_gpu_book_lap(gpu, back ? ABBE_PASS_EYE_BACK : ABBE_PASS_EYE_FRONT);
  }
  return result;
}

static void list_pixels(abbe_refraction_pass *pass) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const size_t *samples = pass->lighting->camera->samples, side = pixel_side(pass);
  abbe_gpu_clear_list(gpu, pass->pixels);
  if (side > 1) {
    abbe_gpu_clear_list(gpu, pass->merged);
    abbe_lighting_use(pass->lighting, pass->list);
    abbe_gpu_bind_storage(gpu, BINDING_MERGED_PIXELS, pass->merged);
    gpu->gl->BindImageTexture(0, pass->colour, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32F);
  }
  abbe_gpu_bind_storage(gpu, BINDING_PIXELS, pass->pixels);
  gpu->gl->UseProgram(pass->list);
  gpu->gl->Uniform2f(gpu->gl->GetUniformLocation(pass->list, "eye_samples"), (GLfloat)samples[0],
                     (GLfloat)samples[1]);
  abbe_gpu_bind_array(gpu, pass->list, "eye_layers", 4, pass->layers);
  abbe_gpu_bind_array(gpu, pass->list, "eye_receivers", 5, pass->receivers->colour);
  abbe_gpu_bind_texture(gpu, pass->list, "eye_owner", 6, pass->owner);
  abbe_gpu_dispatch_2d(gpu, pass->list, samples[0] / side, samples[1] / side);
  gpu->gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT |
                         GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

static double pixel_angle(const abbe_camera_view *camera) {
  return (camera->view.window[3] - camera->view.window[2]) / (double)camera->samples[1];
}

static void use(abbe_refraction_pass *pass, GLuint program) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  abbe_lighting_use(pass->lighting, program);
  abbe_gpu_bind_array(gpu, program, "eye_layers", 4, pass->layers);
  abbe_gpu_bind_texture(gpu, program, "eye_owner", 6, pass->owner);
  abbe_gpu_bind_array(gpu, program, "eye_receivers", UNIT_SEEN_RECEIVERS,
                      pass->shown != 0 ? pass->shown : pass->receivers->colour);
  const GLint turn = (GLint)scene_of(pass)->plan->desc.lens_turn;
  gpu->gl->Uniform2i(gpu->gl->GetUniformLocation(program, "sample_turn"), turn, turn / 2);
  abbe_gpu_set_float(gpu, program, "share_limit", share_of(pass));
  abbe_gpu_set_float(gpu, program, "pixel_angle", pixel_angle(pass->lighting->camera));
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

/* In strips of what has the capacity to be refined; in more with a progress function, which is
 * called between them. */
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
  ABBE_TRY(abbe_gpu_set_target(scene_of(pass)->gpu, &pass->colour, &flat, 1, 0, samples[0],
                               samples[1], error));
  scene_of(pass)->gpu->gl->ClearBufferfv(GL_COLOR, 0, nothing);
  return ABBE_OK;
}

static void bind_sights(const abbe_refraction_pass *pass) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  abbe_gpu_bind_storage(gpu, BINDING_SIGHTS, pass->sights);
  abbe_gpu_bind_storage(gpu, BINDING_SIGHT_PIXELS, pass->sight_pixels);
}

/* Buffers of so much capacity and more, in steps, so that those of the next scene are like them. */
static abbe_result make_room(abbe_refraction_pass *pass, size_t places, size_t bytes,
                             abbe_error *error) {
  enum { STEP = 1 << 20 };
  abbe_gpu *gpu = scene_of(pass)->gpu;
  if (bytes > pass->sight_bytes) {
    abbe_gpu_drop_buffers(gpu, 1, &pass->sight_pixels);
    pass->sight_bytes = (bytes / STEP + 1) * STEP;
    ABBE_TRY(abbe_gpu_make_buffer(gpu, pass->sight_bytes, NULL, &pass->sight_pixels, error));
  }
  if (places <= pass->sight_room) return ABBE_OK;
  abbe_gpu_drop_buffers(gpu, 1, &pass->sights);
  pass->sight_room = (places / STEP + 1) * STEP;
  if (pass->sight_room > MOST_SIGHTS) pass->sight_room = MOST_SIGHTS;
  return abbe_gpu_make_buffer(gpu, ABBE_GPU_LIST_HEADER + SIGHT_BYTES * pass->sight_room, NULL,
                              &pass->sights, error);
}

/* Once more with as much capacity as they have turned out to take. */
static abbe_result find_sights(abbe_refraction_pass *pass, abbe_error *error) {
  enum { LIKELY = 12 };
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const size_t pixels = abbe_gpu_read_count(gpu, pass->pixels);
  size_t places = LIKELY * pixels + 1;
  for (;;) {
    ABBE_TRY(make_room(pass, places, 4 * (SIGHT_HEAD + pass->pixel_threads) * (pixels + 1), error));
    abbe_gpu_clear_list(gpu, pass->sights);
    use(pass, pass->refract);
    abbe_gpu_set_uint(gpu, pass->refract, "sight_room", pass->sight_room);
    bind_sights(pass);
    abbe_result result = refract_pixels(pass, error);
    gpu->gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    if (result != ABBE_OK || gpu->stopped) return result;
    places = abbe_gpu_read_count(gpu, pass->sights);
    if (places <= pass->sight_room) break;
    if (places > MOST_SIGHTS)
      return abbe_error_set(
          error, ABBE_UNSUPPORTED,
          "the camera's rays show receivers at %zu places, and a buffer holds %d: "
          "ask for fewer pixels, samples or exits, or --everything",
          places, MOST_SIGHTS);
  }
  pass->whole = true;
  return ABBE_OK;
}

/* The light of what so many listed pixels show. */
static void look_up(abbe_refraction_pass *pass, size_t first, size_t count) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  abbe_lighting_use(pass->lighting, pass->look_up);
  abbe_gpu_set_uint(gpu, pass->look_up, "pixel_first", first);
  abbe_gpu_set_uint(gpu, pass->look_up, "pixel_end", first + count);
  bind_sights(pass);
  abbe_gpu_bind_storage(gpu, BINDING_PIXELS, pass->pixels);
  gpu->gl->BindImageTexture(0, resolves(pass) ? pass->colour : pass->receivers->colour, 0, GL_FALSE,
                            0, GL_WRITE_ONLY, GL_RGBA32F);
  abbe_gpu_dispatch_list(gpu, pass->look_up, pass->pixels, first, count, 1);
  gpu->gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                         GL_TEXTURE_UPDATE_BARRIER_BIT);
}

/* What refraction.comp would be told. */
static void tell_paths(const abbe_refraction_pass *pass, abbe_camera_paths *p) {
  const abbe_gpu_scene *scene = scene_of(pass);
  const abbe_camera_view *camera = pass->lighting->camera;
  *p = (abbe_camera_paths){.scene = scene,
                           .eye_samples = {(float)camera->samples[0], (float)camera->samples[1]},
                           .share_limit = (float)share_of(pass),
                           .pixel_angle = (float)pixel_angle(camera),
                           .eye_bands = (int)pass->eye_bands,
                           .exits = (int)exits_of(pass),
                           .sample_turn = (int)scene->plan->desc.lens_turn,
                           .shares_spectrum = shares_spectrum(pass),
                           .interleaves = interleaves(pass)};
  abbe_view_pack(&camera->view, p->eye_view);
}

/* In strips, whose places wait for their light. */
static abbe_result refract_here(abbe_refraction_pass *pass, abbe_error *error) {
  enum { STRIP = 1 << 14, LIKELY = 12 };
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const size_t pixels = abbe_gpu_read_count(gpu, pass->pixels);
  abbe_camera_paths paths;
  tell_paths(pass, &paths);
  for (size_t first = 0; first < pixels; first += STRIP) {
    const size_t count = pixels - first < STRIP ? pixels - first : STRIP;
    size_t places = LIKELY * STRIP;
    do {
      ABBE_TRY(make_room(pass, places, 4 * ABBE_SIGHT_PIXEL_WORDS * STRIP, error));
      const abbe_sight_buffers to = {pass->pixels, pass->sights, pass->sight_pixels,
                                     pass->sight_room};
      places = abbe_camera_paths_follow(&paths, &to, first, count);
    } while (places > pass->sight_room);
    look_up(pass, first, count);
    ABBE_TRY(abbe_gpu_tell(gpu, 0.5 + 0.5 * (double)(first + count) / (double)pixels, error));
  }
  return abbe_gl_check(gpu->gl, "the camera's paths", error);
}

static abbe_result show_refractors(abbe_refraction_pass *pass, abbe_error *error) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const size_t *samples = pass->lighting->camera->samples;
  if (!pass->whole) list_pixels(pass);
  if (pass->keeps) {
    const abbe_result result = pass->whole ? ABBE_OK : find_sights(pass, error);
    if (result == ABBE_OK && !gpu->stopped) look_up(pass, 0, samples[0] * samples[1]);
    return result;
  }
  if (pass->here) return refract_here(pass, error);
  if (pass->shown != 0) /* what is looked up is not what is written over */
    gpu->gl->CopyImageSubData(pass->receivers->colour, GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, pass->shown,
                              GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, (GLsizei)samples[0],
                              (GLsizei)samples[1], 1);
  if (refines(pass)) use(pass, pass->refract_refined);
  use(pass, pass->refract);
  gpu->gl->BindImageTexture(0, resolves(pass) ? pass->colour : pass->receivers->colour, 0, GL_FALSE,
                            0, GL_READ_WRITE, GL_RGBA32F);
  return refract_pixels(pass, error);
}

abbe_result abbe_refraction_pass_run(abbe_refraction_pass *pass, abbe_error *error) {
  abbe_gpu *gpu = scene_of(pass)->gpu;
  const bool seen = scene_of(pass)->plan->camera_sees_refractor;
  abbe_gpu_start_lap(gpu);
  abbe_result result =
      resolves(pass) && pixel_side(pass) == 1 && !pass->whole ? clear_colour(pass, error) : ABBE_OK;
  if (result != ABBE_OK || !seen) return result;
  result = show_refractors(pass, error);
  abbe_gpu_book_lap(gpu, ABBE_PASS_EYE_REFRACTION);
  return result;
}
