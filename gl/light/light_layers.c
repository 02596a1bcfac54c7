#include "gl/light/light_layers.h"

#include "gl/device/bindings.h"

#include <math.h>
#include <string.h>

enum { SIDE = 1024, TURNS = 4, COARSE = 32 };

/* Rays of a part of the lattice that reach refractors, into the box that was found. */
static void ask(const abbe_light_fit *fit, int left, int bottom, int width, int height,
                int spacing) {
  const abbe_gl *gl = fit->views->scene->gpu->gl;
  abbe_gpu *gpu = fit->views->scene->gpu;
  if (width <= 0 || height <= 0) return;
  gl->Uniform2i(gl->GetUniformLocation(fit->program, "first"), left, bottom);
  gl->Uniform2i(gl->GetUniformLocation(fit->program, "count"), width, height);
  abbe_gpu_set_int(gpu, fit->program, "spacing", spacing);
  abbe_gpu_dispatch_2d(gpu, fit->program, (size_t)width, (size_t)height);
}

static void read_box(const abbe_light_fit *fit, GLuint found[4]) {
  const abbe_gl *gl = fit->views->scene->gpu->gl;
  gl->MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
  gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, 4 * sizeof *found, found);
}

/* The window of lit rays, in whole rays: least and greatest column, then row. */
static void find_lit(const abbe_light_fit *fit, size_t light, GLuint found[4]) {
  static const GLuint none[4] = {SIDE, 0, SIDE, 0};
  const abbe_gpu_scene *scene = fit->views->scene;
  const abbe_gl *gl = scene->gpu->gl;
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, fit->found);
  gl->BufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof none, none);
  abbe_gpu_scene_bind(scene);
  abbe_photon_lights_bind(fit->views);
  gl->UseProgram(fit->program);
  abbe_gpu_scene_set(scene, fit->program);
  abbe_light_layers_set(fit->layers, fit->program);
  abbe_gpu_set_int(scene->gpu, fit->program, "light", (int)light);
  abbe_gpu_set_int(scene->gpu, fit->program, "side", SIDE);
  abbe_gpu_bind_storage(scene->gpu, BINDING_FOUND_BOX, fit->found);
  /* What lies within the box of a few rays makes it no larger: only the rays around are asked. */
  ask(fit, COARSE / 2, COARSE / 2, SIDE / COARSE, SIDE / COARSE, COARSE);
  read_box(fit, found);
  if (found[0] > found[1]) {
    ask(fit, 0, 0, SIDE, SIDE, 1);
  } else {
    const int left = (int)found[0], right = (int)found[1] + 1;
    const int bottom = (int)found[2], top = (int)found[3] + 1;
    ask(fit, 0, 0, left, SIDE, 1);
    ask(fit, right, 0, SIDE - right, SIDE, 1);
    ask(fit, left, 0, right - left, bottom, 1);
    ask(fit, left, top, right - left, SIDE - top, 1);
  }
  read_box(fit, found);
}

/* Each turn sees as finely as the last one left the view, and leaves a ray's width on every side.
 */
static abbe_result fit_near_view(const abbe_light_fit *fit, size_t light, abbe_error *error) {
  double *window = fit->views->light[light].near_view.window;
  for (int turn = 0; turn < TURNS; turn++) {
    GLuint found[4] = {0};
    /* What rays meet of meshes is read from the front layer of the view as it is now. */
    ABBE_TRY(fit->views->scene->plan->bvh ? abbe_light_layers_draw(fit->layers, light, error)
                                          : ABBE_OK);
    find_lit(fit, light, found);
    if (found[0] > found[1]) break; /* nothing is lit */
    bool shrinks = false;
    double box[4];
    for (int axis = 0; axis < 2; axis++)
      shrinks = shrinks || found[2 * axis + 1] - found[2 * axis] < 9 * SIDE / 10;
    for (int axis = 0; axis < 2; axis++) {
      double low = window[2 * axis], ray = (window[2 * axis + 1] - low) / SIDE;
      /* The edge lies half a ray to either side of where the last lit ray's place begins. */
      double room = shrinks ? 0.5 : 0;
      box[2 * axis] = low + ray * fmax((double)found[2 * axis] - room, 0);
      box[2 * axis + 1] = low + ray * fmin((double)found[2 * axis + 1] + 1 + room, SIDE);
    }
    if (turn == 0 && !shrinks) break; /* nothing to speak of is cut off */
    memcpy(window, box, sizeof box);
    abbe_photon_lights_upload(fit->views);
    if (!shrinks) break;
  }
  return ABBE_OK;
}

abbe_result abbe_light_fit_run(abbe_photon_lights *views, abbe_light_layers *layers,
                               const abbe_shader_variant *variant, abbe_error *error) {
  abbe_gpu *gpu = views->scene->gpu;
  const abbe_plan *plan = views->scene->plan;
  abbe_light_fit fit = {.views = views, .layers = layers};
  if (plan->layers) return ABBE_OK; /* a mesh's inside is what the near view sees of it */
  abbe_result result =
      abbe_shader_variant_compute(variant, gpu, "light_fit.comp", NULL, &fit.program, error);
  if (result == ABBE_OK) result = abbe_gpu_make_buffer(gpu, 4 * 4, NULL, &fit.found, error);
  for (size_t i = 0; i < plan->light_view_count && result == ABBE_OK; i++)
    if (plan->reaches[i]) result = fit_near_view(&fit, i, error);
  abbe_gpu_drop_buffers(gpu, 1, &fit.found);
  return result != ABBE_OK ? result : abbe_gl_check(gpu->gl, "the fit of the light's view", error);
}

/* Texels: few photons need no more than four a cell, whose shadows are as coarse. */
enum { MIN_LAYER_SIDE = 128, USUAL_LAYER_SIDE = 256, MAX_LAYER_SIDE = 2048 };

static size_t side_for(size_t photons) {
  const size_t side = 4 * photons < USUAL_LAYER_SIDE ? 4 * photons
                      : photons < USUAL_LAYER_SIDE   ? USUAL_LAYER_SIDE
                                                     : photons;
  return side < MIN_LAYER_SIDE ? MIN_LAYER_SIDE : side > MAX_LAYER_SIDE ? MAX_LAYER_SIDE : side;
}

abbe_result abbe_light_layers_make(const abbe_photon_lights *views,
                                   const abbe_refractor_faces *faces, abbe_light_layers *out,
                                   abbe_error *error) {
  abbe_gpu *gpu = views->scene->gpu;
  const size_t views_there = views->scene->plan->light_view_count;
  const size_t lights = views_there > 0 ? views_there : 1; /* no array is empty */
  const size_t side = side_for(views->scene->plan->desc.photons);
  out->views = views;
  out->faces = faces;
  out->side = side;
  ABBE_TRY(
      abbe_gpu_make_texture(gpu, GL_RGBA32F, side, side, 2 * lights, false, &out->layers, error));
  ABBE_TRY(abbe_gpu_make_texture(gpu, GL_R16UI, side, side, lights, false, &out->owner, error));
  return abbe_gpu_make_texture(gpu, GL_DEPTH_COMPONENT32F, side, side, 0, false, &out->depth,
                               error);
}

void abbe_light_layers_free(abbe_light_layers *layers) {
  if (layers->views == NULL) return;
  GLuint textures[] = {layers->layers, layers->owner, layers->depth};
  abbe_gpu_drop_textures(layers->views->scene->gpu, sizeof textures / sizeof *textures, textures);
}

static abbe_drawn_view key_of(const abbe_view *view) {
  abbe_drawn_view key;
  abbe_view_reversed_matrix(view, key.matrix);
  memcpy(key.from, view->origin, sizeof key.from);
  memcpy(key.forward, view->forward, sizeof key.forward);
  return key;
}

abbe_result abbe_light_layers_draw(abbe_light_layers *layers, size_t light, abbe_error *error) {
  const abbe_plan *plan = layers->views->scene->plan;
  abbe_gpu *gpu = layers->views->scene->gpu;
  /* So near to exact surfaces their triangles show too little of what they cover. */
  const bool all = abbe_photon_lights_is_face(layers->views, light) && !plan->layers && !plan->bvh;
  const abbe_drawn_view key = key_of(&layers->views->light[light].near_view);
  abbe_result result = ABBE_OK;
  if (gpu->statistics == NULL && memcmp(&key, &layers->drawn[light], sizeof key) == 0)
    return ABBE_OK;
  abbe_refractor_faces_use(layers->faces, &layers->views->light[light].near_view);
  for (int back = 0; back <= (plan->draw_back ? 1 : 0) && result == ABBE_OK; back++) {
    const abbe_faces_target target = {.layers = layers->layers,
                                      .owner = layers->owner,
                                      .depth = layers->depth,
                                      .layer = 2 * (int)light + back,
                                      .owner_layer = (int)light,
                                      .width = layers->side,
                                      .height = layers->side,
                                      .distance = all ? 1 : 0,
                                      .back = back != 0,
                                      .coarse = plan->fewer_triangles == ABBE_COARSE_ALL};
    abbe_gpu_start_lap(gpu);
    result = abbe_refractor_faces_draw(layers->faces, &target, all, error);
    abbe_gpu_book_lap(gpu, back ? ABBE_PASS_LIGHT_BACK : ABBE_PASS_LIGHT_FRONT);
  }
  layers->drawn[light] = result == ABBE_OK ? key : (abbe_drawn_view){0};
  return result;
}

abbe_result abbe_light_layers_run(abbe_light_layers *layers, abbe_error *error) {
  const abbe_plan *plan = layers->views->scene->plan;
  for (size_t i = 0; i < plan->light_view_count; i++)
    if (plan->reaches[i]) ABBE_TRY(abbe_light_layers_draw(layers, i, error));
  return ABBE_OK;
}

void abbe_light_layers_set(const abbe_light_layers *layers, GLuint program) {
  abbe_gpu *gpu = layers->views->scene->gpu;
  abbe_gpu_bind_array(gpu, program, "light_layers", 2, layers->layers);
  abbe_gpu_bind_array(gpu, program, "layer_owner", 4, layers->owner);
}
