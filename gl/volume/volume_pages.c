#include "gl/volume/volume_pages.h"

#include "scenes/volume/exit_pages.h"

#include <stdlib.h>
#include <string.h>

enum { MAP_TEXELS = 4, LEAST_SIDE = 16 }; /* of the spectral map, a side, for one of a page */

static size_t side_of(const abbe_plan *plan) {
  const size_t side = plan->desc.map_size / MAP_TEXELS;
  if (side < LEAST_SIDE) return LEAST_SIDE;
  return side < ABBE_EXIT_PAGES_MOST_SIDE ? side : ABBE_EXIT_PAGES_MOST_SIDE;
}

double (*abbe_volume_pages_sheets(const abbe_gpu_scene *scene))[9] {
  const abbe_plan *plan = scene->plan;
  double(*all)[9] = calloc(plan->parallelogram_count + 1, sizeof *all);
  size_t count = 0;
  for (size_t i = 0; all != NULL && i < plan->receiver_count; i++) {
    const abbe_exact *exact = &scene->local->object[plan->receiver_object[i]].exact;
    memcpy(all + count, exact->parallelogram, exact->count * sizeof *all);
    count += exact->count;
  }
  return all;
}

static void hand_over(const abbe_volume_pages *v, size_t light, const abbe_exit_pages *pages) {
  const abbe_gl *gl = v->scene->gpu->gl;
  memcpy(v->window + light * v->count, pages->window, v->count * sizeof *v->window);
  gl->BindTexture(GL_TEXTURE_2D_ARRAY, v->texture);
  for (size_t i = 0; i < v->count; i++)
    if (pages->window[i][2] > 0) /* else the shader asks for none */
      gl->TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, (GLint)(2 * (light * v->count + i)),
                        (GLsizei)pages->side, (GLsizei)pages->side, 2, GL_RGBA, GL_FLOAT,
                        pages->value + 2 * i * pages->side * pages->side);
}

static abbe_result light_pages(const abbe_volume_pages *v, const abbe_volume_place *place,
                               size_t light, const double (*all)[9], abbe_error *error) {
  const abbe_gpu_scene *scene = v->scene;
  const abbe_plan *plan = scene->plan;
  const abbe_exit_light_desc desc = {.light = &scene->local->light[light],
                                     .object = &scene->local->object[plan->refractor_object[0]],
                                     .place = place,
                                     .observer = plan->desc.observer,
                                     .min_nm = plan->desc.min_nm,
                                     .max_nm = plan->desc.max_nm};
  abbe_exit_pages pages;
  abbe_result result = abbe_exit_pages_make(
      plan->desc.volume, &desc, all, plan->parallelogram_count, side_of(plan), &pages, error);
  if (result != ABBE_OK) return result;
  hand_over(v, light, &pages);
  abbe_exit_pages_free(&pages);
  return abbe_gl_check(scene->gpu->gl, "the upload of a volume's pages", error);
}

abbe_result abbe_volume_pages_make(const abbe_gpu_scene *scene, const abbe_volume_place *place,
                                   abbe_volume_pages *out, abbe_error *error) {
  const abbe_plan *plan = scene->plan;
  const size_t lights = plan->light_view_count, side = side_of(plan);
  *out = (abbe_volume_pages){.count = plan->volume_pages};
  if (plan->volume_pages == 0) return ABBE_OK;
  out->scene = scene;
  out->window = calloc(lights * out->count + 1, sizeof *out->window);
  double(*all)[9] = abbe_volume_pages_sheets(scene);
  abbe_result result = all != NULL && out->window != NULL
                           ? ABBE_OK
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for pages");
  if (result == ABBE_OK)
    result = abbe_gpu_make_texture(scene->gpu, GL_RGBA32F, side, side, 2 * lights * out->count,
                                   true, &out->texture, error);
  for (size_t i = 0; i < lights && result == ABBE_OK; i++)
    result = light_pages(out, place, i, (const double(*)[9])all, error);
  free(all);
  return result;
}

void abbe_volume_pages_free(abbe_volume_pages *pages) {
  if (pages->scene != NULL) abbe_gpu_drop_textures(pages->scene->gpu, 1, &pages->texture);
  free(pages->window);
  *pages = (abbe_volume_pages){0};
}

void abbe_volume_pages_set(const abbe_volume_pages *pages, GLuint program, int unit) {
  if (pages->scene == NULL) return;
  const abbe_gpu *gpu = pages->scene->gpu;
  const size_t all = pages->count * pages->scene->plan->light_view_count;
  abbe_gpu_bind_array(pages->scene->gpu, program, "volume_pages", unit, pages->texture);
  gpu->gl->Uniform4fv(gpu->gl->GetUniformLocation(program, "volume_window"), (GLsizei)all,
                      &pages->window[0][0]);
}
