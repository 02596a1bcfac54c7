#include "gl/light/light_layers.h"

#include <string.h>

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
  abbe_result result =
      abbe_gpu_make_texture(gpu, GL_RGBA32F, side, side, 2 * lights, false, &out->layers, error);
  if (result == ABBE_OK)
    result = abbe_gpu_make_texture(gpu, GL_R16UI, side, side, lights, false, &out->owner, error);
  if (result == ABBE_OK)
    result =
        abbe_gpu_make_texture(gpu, GL_DEPTH_COMPONENT32F, side, side, 0, false, &out->depth, error);
  return result;
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
  /* So near to exact surfaces their triangles tell too little of what they cover. */
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
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < plan->light_view_count && result == ABBE_OK; i++)
    if (plan->reaches[i]) result = abbe_light_layers_draw(layers, i, error);
  return result;
}

void abbe_light_layers_set(const abbe_light_layers *layers, GLuint program) {
  abbe_gpu *gpu = layers->views->scene->gpu;
  abbe_gpu_bind_array(gpu, program, "light_layers", 2, layers->layers);
  abbe_gpu_bind_array(gpu, program, "layer_owner", 4, layers->owner);
}
