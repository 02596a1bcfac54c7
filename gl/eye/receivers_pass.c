#include "gl/eye/receivers_pass.h"

#include "base/clock.h"
#include "gl/plan/examine/examine.h"

#include <stdlib.h>

static const abbe_program_stage stages[] = {{GL_VERTEX_SHADER, "surface.vert"},
                                            {GL_FRAGMENT_SHADER, "receivers.frag"}};
static const abbe_program_stage area_lights[] = {{GL_VERTEX_SHADER, "area_lights.vert"},
                                                 {GL_FRAGMENT_SHADER, "area_lights.frag"}};
static const abbe_program_stage behind[] = {{GL_VERTEX_SHADER, "screen.vert"},
                                            {GL_FRAGMENT_SHADER, "surroundings.frag"}};

/* Views that hold all that the light may reach, straight and through refractors; 0: no such are
 * known.
 */
static size_t views_of_light(const abbe_receivers_pass *pass, size_t light, abbe_view out[2]) {
  const abbe_gpu_scene *scene = pass->lighting->scene;
  if (scene->plan->cubes || scene->plan->volume || pass->lighting->atlas->used ||
      !abbe_lit_window_cone(&scene->local->light[light], &out[0]))
    return 0;
  out[1] = pass->lighting->views->light[light].map.view;
  return scene->plan->reaches[light] ? 2 : 1;
}

/* Around what the view holds of the object. */
static bool bound_object(const abbe_receivers_pass *pass, const abbe_view *view,
                         const abbe_exact *exact, int out[4]) {
  const size_t w = pass->lighting->camera->receiver_samples[0],
               h = pass->lighting->camera->receiver_samples[1];
  bool any = false;
  for (size_t i = 0; i < exact->count; i++) {
    int part[4];
    if (!abbe_lit_window(view, &pass->lighting->camera->view, exact->parallelogram[i], w, h, part))
      continue;
    for (int k = 0; k < 4; k++) {
      const bool further = k < 2 ? part[k] < out[k] : part[k] > out[k];
      if (!any || further) out[k] = part[k];
    }
    any = true;
  }
  return any;
}

/* At least half of the picture's samples must be drawn without light for it to pay that the others
 * are drawn once more. */
static bool pays(const abbe_receivers_pass *pass) {
  double area = 0, samples = (double)pass->lighting->camera->receiver_samples[0] *
                             (double)pass->lighting->camera->receiver_samples[1];
  for (size_t i = 0; i < pass->part_count; i++) {
    const int *rect = pass->part[i].rect;
    area += (double)(rect[2] - rect[0]) * (double)(rect[3] - rect[1]);
  }
  return area < 0.5 * samples;
}

/* Where the picture is mostly dark, receivers are drawn without any light, and what a light may
 * reach once more: a software rasteriser skips no part of a shader that nobody needs. */
static abbe_result make_unlit(abbe_receivers_pass *pass, const abbe_shader_variant *variant,
                              abbe_error *error) {
  const abbe_gpu_scene *scene = pass->lighting->scene;
  const abbe_plan *plan = scene->plan;
  if (plan->desc.everything || plan->receivers != ABBE_RECEIVER_EXACT) return ABBE_OK;
  pass->part = calloc(2 * plan->light_view_count * plan->receiver_count + 1, sizeof *pass->part);
  if (pass->part == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for receivers");
  for (size_t light = 0; light < plan->light_view_count; light++) {
    abbe_view view[2];
    const size_t views = views_of_light(pass, light, view);
    if (views == 0) return ABBE_OK;
    for (size_t k = 0; k < views * plan->receiver_count; k++) {
      abbe_lit_part *part = &pass->part[pass->part_count];
      part->receiver = k / views;
      const size_t object = plan->receiver_object[part->receiver];
      if (bound_object(pass, &view[k % views], &scene->local->object[object].exact, part->rect))
        pass->part_count++;
    }
  }
  if (!pays(pass)) return ABBE_OK;
  return abbe_shader_variant_program(variant, scene->gpu, stages, 2, "#define UNLIT\n",
                                     &pass->unlit, error);
}

static void draw_receiver(abbe_receivers_pass *pass, GLuint program, size_t receiver) {
  const abbe_gpu_scene *scene = pass->lighting->scene;
  abbe_gpu_set_int(scene->gpu, program, "surface", (int)receiver);
  const GLint numbers = scene->gpu->gl->GetUniformLocation(program, "face_first");
  const size_t object = scene->plan->receiver_object[receiver];
  if (scene->charts.face_first != NULL && numbers >= 0)
    abbe_seen_meshes_draw_numbered(pass->lighting->meshes, object, numbers,
                                   scene->charts.face_first[receiver]);
  else
    abbe_seen_meshes_draw(pass->lighting->meshes, object);
}

/* Over what is drawn unlit, within left, right, bottom and top. Of equal depths the first receiver
 * has won there, and so it does here. */
static void draw_lit_parts(abbe_receivers_pass *pass, const int within[4]) {
  const abbe_gl *gl = pass->lighting->scene->gpu->gl;
  abbe_lighting_use(pass->lighting, pass->lit);
  gl->DepthFunc(GL_EQUAL);
  for (size_t i = pass->part_count; i-- > 0;) {
    const int *rect = pass->part[i].rect;
    const int left = rect[0] > within[0] ? rect[0] : within[0];
    const int right = rect[2] < within[1] ? rect[2] : within[1];
    const int low = rect[1] > within[2] ? rect[1] : within[2];
    const int high = rect[3] < within[3] ? rect[3] : within[3];
    if (left >= right || low >= high) continue;
    gl->Scissor(left, low, right - left, high - low);
    draw_receiver(pass, pass->lit, pass->part[i].receiver);
  }
  gl->DepthFunc(GL_GREATER);
}

static void draw_surroundings(abbe_receivers_pass *pass) {
  const abbe_gpu_scene *scene = pass->lighting->scene;
  abbe_lighting_use(pass->lighting, pass->surroundings);
  abbe_gpu_draw_screen(scene->gpu);
}

static void draw_within(abbe_receivers_pass *pass, const int within[4]) {
  const abbe_gpu_scene *scene = pass->lighting->scene;
  const GLuint whole = pass->unlit != 0 ? pass->unlit : pass->lit;
  abbe_lighting_use(pass->lighting, whole);
  scene->gpu->gl->Scissor(within[0], within[2], within[1] - within[0], within[3] - within[2]);
  for (size_t i = 0; i < scene->plan->receiver_count; i++) draw_receiver(pass, whole, i);
  if (pass->unlit != 0) draw_lit_parts(pass, within);
}

/* Tiles of the rasteriser's from number `at` on, row by row: some of a row, or whole rows. How many
 * they are. */
enum { TILE = 64, MOST_PARTS = 64 };

static size_t tiles_from(const size_t size[2], size_t at, size_t most, int within[4]) {
  const size_t across = (size[0] + TILE - 1) / TILE, down = (size[1] + TILE - 1) / TILE;
  const size_t row = at / across, column = at % across;
  const size_t whole = column == 0 ? most / across : 0;
  const size_t rows = whole > down - row ? down - row : whole > 0 ? whole : 1;
  const size_t columns = whole > 0 ? across : most < across - column ? most : across - column;
  const size_t right = TILE * (column + columns), top = TILE * (row + rows);
  within[0] = (int)(TILE * column);
  within[1] = (int)(right < size[0] ? right : size[0]);
  within[2] = (int)(TILE * row);
  within[3] = (int)(top < size[1] ? top : size[1]);
  return rows * columns;
}

/* All at once, or some tiles at a time where somebody watches or a GPU draws. */
static void draw_receivers(abbe_receivers_pass *pass) {
  abbe_gpu *gpu = pass->lighting->scene->gpu;
  const size_t *size = pass->lighting->camera->receiver_samples;
  const size_t all = ((size[0] + TILE - 1) / TILE) * ((size[1] + TILE - 1) / TILE);
  const size_t least = (all + MOST_PARTS - 1) / MOST_PARTS; /* all vertices are run for each */
  const size_t most = abbe_gpu_most_threads(gpu) / (TILE * TILE);
  size_t part = gpu->progress != NULL ? 2 * least : most > least ? most : least;
  gpu->gl->Enable(GL_SCISSOR_TEST);
  for (size_t at = 0; at < all && abbe_gpu_ask(gpu);) {
    const double start_ms = 1e3 * abbe_clock_seconds();
    int within[4];
    const size_t count = tiles_from(size, at, part, within);
    draw_within(pass, within);
    at += count;
    if (gpu->progress == NULL) {
      if (at < all) gpu->gl->Flush();
      continue;
    }
    gpu->gl->Finish();
    part = abbe_gpu_next_part(count, 1e3 * abbe_clock_seconds() - start_ms);
    if (part < least) part = least;
  }
  gpu->gl->Disable(GL_SCISSOR_TEST);
}

/* Before or behind what is drawn. */
static void draw_area_lights(abbe_receivers_pass *pass) {
  const abbe_gpu_scene *scene = pass->lighting->scene;
  const abbe_gl *gl = scene->gpu->gl;
  abbe_lighting_use(pass->lighting, pass->area_lights);
  gl->BindVertexArray(scene->gpu->empty_array);
  gl->DrawArrays(GL_TRIANGLES, 0, 6 * (GLsizei)abbe_gpu_area_lights_count(scene));
}

/* A ray a sample, in place of all triangles. */
static void follow_rays(abbe_receivers_pass *pass) {
  abbe_gpu *gpu = pass->lighting->scene->gpu;
  const GLuint picture[3] = {pass->colour, pass->direct, pass->caustic};
  const size_t *samples = pass->lighting->camera->receiver_samples;
  abbe_lighting_use(pass->lighting, pass->rays);
  for (GLuint k = 0; k < (pass->lighting->scene->plan->desc.aovs ? 3u : 1u); k++)
    gpu->gl->BindImageTexture(k, picture[k], 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32F);
  abbe_gpu_dispatch_2d(gpu, pass->rays, samples[0], samples[1]);
  gpu->gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                         GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

abbe_result abbe_receivers_pass_run(abbe_receivers_pass *pass, abbe_error *error) {
  const abbe_gpu_scene *scene = pass->lighting->scene;
  const abbe_gl *gl = scene->gpu->gl;
  const size_t w = pass->lighting->camera->receiver_samples[0],
               h = pass->lighting->camera->receiver_samples[1];
  GLuint target[3] = {pass->colour, pass->direct, pass->caustic};
  static const int flat[3] = {0, -1, -1};
  static const GLfloat nothing[4] = {0, 0, 0, 0};
  abbe_gpu_start_lap(scene->gpu);
  ABBE_TRY(abbe_gpu_set_target(scene->gpu, target, flat, scene->plan->desc.aovs ? 3 : 1,
                               pass->depth, w, h, error));
  const bool behind_seen = !scene->local->transparent;
  const GLfloat b = behind_seen ? (GLfloat)scene->local->background : 0;
  const GLfloat background[4] = {b, b, b, 0};
  gl->ClearBufferfv(GL_COLOR, 0, background);
  for (GLint k = 1; k < 3 && scene->plan->desc.aovs; k++) gl->ClearBufferfv(GL_COLOR, k, nothing);
  if (pass->surroundings != 0 && behind_seen) {
    ABBE_TRY(abbe_gpu_set_target(scene->gpu, target, flat, 1, 0, w, h, error));
    draw_surroundings(pass);
    ABBE_TRY(abbe_gpu_set_target(scene->gpu, target, flat, scene->plan->desc.aovs ? 3 : 1,
                                 pass->depth, w, h, error));
  }
  if (pass->rays != 0) {
    follow_rays(pass);
  } else {
    abbe_gpu_begin_depths(scene->gpu, true);
    draw_receivers(pass);
    if (pass->area_lights != 0) draw_area_lights(pass);
    abbe_gpu_end_depths(scene->gpu);
  }
  abbe_gpu_book_lap(scene->gpu, ABBE_PASS_EYE_RECEIVERS);
  return ABBE_OK;
}

static abbe_result make_targets(abbe_receivers_pass *pass, abbe_error *error) {
  const abbe_gpu_scene *scene = pass->lighting->scene;
  const abbe_render_desc *desc = &scene->plan->desc;
  const size_t w = pass->lighting->camera->receiver_room[0],
               h = pass->lighting->camera->receiver_room[1];
  GLint most = 0;
  scene->gpu->gl->GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
  if (w > (size_t)most || h > (size_t)most)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%zu x %zu pixels with %zu samples a side are %zu x %zu; this OpenGL "
                          "draws at most %d a side: use fewer samples or a smaller picture",
                          desc->width, desc->height, desc->supersample, w, h, most);
  ABBE_TRY(abbe_gpu_make_texture(scene->gpu, GL_RGBA32F, w, h, 1, false, &pass->colour, error));
  if (desc->aovs)
    ABBE_TRY(abbe_gpu_make_texture(scene->gpu, GL_RGBA32F, w, h, 0, false, &pass->direct, error));
  if (desc->aovs)
    ABBE_TRY(abbe_gpu_make_texture(scene->gpu, GL_RGBA32F, w, h, 0, false, &pass->caustic, error));
  return abbe_gpu_make_texture(scene->gpu, GL_DEPTH_COMPONENT32F, w, h, 0, false, &pass->depth,
                               error);
}

/* Rays pay in a picture of what moves, where triangles are so many that to draw them takes
 * longer. */
static bool takes_rays(const abbe_gpu_scene *scene) {
  enum { MANY_FACES = 8000 };
  const abbe_plan *plan = scene->plan;
  size_t faces = 0;
  for (size_t i = 0; i < plan->receiver_count; i++)
    faces += scene->local->object[plan->receiver_object[i]].mesh.face_count;
  return plan->desc.coarse != ABBE_COARSE_NONE && plan->receivers == ABBE_RECEIVER_BVH &&
         faces >= MANY_FACES;
}

abbe_result abbe_receivers_pass_make(const abbe_lighting *lighting,
                                     const abbe_shader_variant *variant, abbe_receivers_pass *out,
                                     abbe_error *error) {
  out->lighting = lighting;
  ABBE_TRY(make_targets(out, error));
  if (takes_rays(lighting->scene))
    ABBE_TRY(abbe_shader_variant_compute(variant, lighting->scene->gpu, "receiver_rays.comp", NULL,
                                         &out->rays, error));
  else
    ABBE_TRY(abbe_shader_variant_program(variant, lighting->scene->gpu, stages, 2, NULL, &out->lit,
                                         error));
  if (variant->area_lights > 0 && out->rays == 0)
    ABBE_TRY(abbe_shader_variant_program(variant, lighting->scene->gpu, area_lights, 2, NULL,
                                         &out->area_lights, error));
  if (variant->environment)
    ABBE_TRY(abbe_shader_variant_program(variant, lighting->scene->gpu, behind, 2, NULL,
                                         &out->surroundings, error));
  return out->rays == 0 ? make_unlit(out, variant, error) : ABBE_OK;
}

void abbe_receivers_pass_free(abbe_receivers_pass *pass) {
  if (pass->lighting == NULL) return;
  GLuint textures[] = {pass->colour, pass->direct, pass->caustic, pass->depth};
  abbe_gpu_drop_textures(pass->lighting->scene->gpu, sizeof textures / sizeof *textures, textures);
  free(pass->part);
}
