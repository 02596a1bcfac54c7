#include "gl/volume/volume_pages.h"

#include "scenes/volume/exits/exit_pages.h"

#include <stdlib.h>
#include <string.h>

enum { MAP_TEXELS = 4, LEAST_SIDE = 16 }; /* of the spectral map, a side, for one of a page */

/* No more texels than rays start: finer ones would hold nothing more. */
static size_t side_of(const abbe_plan *plan) {
  const abbe_light_exits *exits = &plan->desc.volume->exits;
  const size_t most = plan->desc.map_size / MAP_TEXELS;
  size_t side = LEAST_SIDE;
  while (side * side < exits->points * exits->symmetry.count) side *= 2;
  if (side > most) side = most < LEAST_SIDE ? LEAST_SIDE : most;
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

/* Each the mean of 2 x 2 texels of the one before, down to a few. */
static size_t count_levels(size_t side) {
  size_t levels = 1;
  while (side % 2 == 0 && side > LEAST_SIDE) {
    side /= 2;
    levels++;
  }
  return levels;
}

/* The two maps of a page, level by level; half: room for a quarter of a map. */
static void hand_over_page(const float (*value)[4], size_t side, size_t layer, float (*half)[4],
                           const abbe_gl *gl) {
  float(*level[2])[4] = {half, half + side * side / 4};
  const size_t levels = count_levels(side);
  for (size_t fine = 0; fine < 2; fine++, value += side * side) {
    const float(*from)[4] = value;
    size_t texels = side;
    for (size_t k = 0; k < levels; k++, texels /= 2) {
      gl->TexSubImage3D(GL_TEXTURE_2D_ARRAY, (GLint)k, 0, 0, (GLint)(layer + fine), (GLsizei)texels,
                        (GLsizei)texels, 1, GL_RGBA, GL_FLOAT, from);
      if (k + 1 == levels) break;
      abbe_exit_pages_halve(from, texels, level[k % 2]);
      from = (const float(*)[4])level[k % 2];
    }
  }
}

static bool hand_over(const abbe_volume_pages *v, size_t light, const abbe_exit_pages *pages) {
  const abbe_gl *gl = v->scene->gpu->gl;
  const size_t texels = pages->side * pages->side;
  float(*half)[4] = malloc((texels / 2 + 1) * sizeof *half);
  if (half == NULL) return false;
  memcpy(v->window + light * v->count, pages->window, v->count * sizeof *v->window);
  gl->BindTexture(GL_TEXTURE_2D_ARRAY, v->texture);
  for (size_t i = 0; i < v->count; i++)
    if (pages->window[i][2] > 0) /* else the shader asks for none */
      hand_over_page((const float(*)[4])pages->value + 2 * i * texels, pages->side,
                     2 * (light * v->count + i), half, gl);
  free(half);
  return true;
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
  const bool handed = hand_over(v, light, &pages);
  abbe_exit_pages_free(&pages);
  if (!handed) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for pages");
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
    result = abbe_gpu_make_levels(scene->gpu, GL_RGBA32F, side, 2 * lights * out->count,
                                  count_levels(side), &out->texture, error);
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
