#include "gl/methods/volume/volume_light.h"

#include "base/maths.h"
#include "scenes/volume/exits/exit_pages.h"
#include "scenes/volume/half.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  MAP_TEXELS = 4,
  LEAST_SIDE = 16
}; /* texels of the spectral map, a side, for one of a tile */

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

/* The two maps of a tile, level by level; half: space for a quarter of a map. */
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
    if (pages->window[i][2] > 0) /* else the shader reads none */
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
  ABBE_TRY(abbe_exit_pages_make(plan->desc.volume, &desc, all, plan->parallelogram_count,
                                side_of(plan), &pages, error));
  const bool handed = hand_over(v, light, &pages);
  abbe_exit_pages_free(&pages);
  if (!handed) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for pages");
  return abbe_gl_check(scene->gpu->gl, "the upload of a volume's pages", error);
}

/* For the lights and the object where they are now. ABBE_GL, ABBE_NO_MEMORY. */
static abbe_result volume_pages_make(const abbe_gpu_scene *scene, const abbe_volume_place *place,
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

static void volume_pages_free(abbe_volume_pages *pages) {
  if (pages->scene != NULL) abbe_gpu_drop_textures(pages->scene->gpu, 1, &pages->texture);
  free(pages->window);
  *pages = (abbe_volume_pages){0};
}

/* Into the program that is in use, at that unit (volume_pages.glsl). */
static void volume_pages_set(const abbe_volume_pages *pages, GLuint program, int unit) {
  if (pages->scene == NULL) return;
  const abbe_gpu *gpu = pages->scene->gpu;
  const size_t all = pages->count * pages->scene->plan->light_view_count;
  abbe_gpu_bind_array(pages->scene->gpu, program, "volume_pages", unit, pages->texture);
  gpu->gl->Uniform4fv(gpu->gl->GetUniformLocation(program, "volume_window"), (GLsizei)all,
                      &pages->window[0][0]);
}

enum { UNIT = 3 }; /* that no pass of the camera's has */

/* Words of a cell: nine halves and a spare one; three bytes and a spare one. */
static size_t words_of(const abbe_caustic_volume *v) {
  return v->kind == ABBE_VOLUME_PRINTED ? 1 : 5;
}

static void pack_node(const abbe_caustic_volume *v, size_t node, uint32_t *out) {
  const size_t channels = abbe_caustic_volume_channels(v), words = words_of(v);
  const uint16_t *value = v->value + node * v->region.cells * channels;
  for (size_t i = 0; i < v->region.cells; i++, value += channels, out += words) {
    memset(out, 0, words * sizeof *out);
    for (size_t c = 0; c < channels; c++)
      if (v->kind == ABBE_VOLUME_PRINTED)
        out[0] |= (uint32_t)abbe_half_value(value[c]) << 8 * c;
      else
        out[c / 2] |= (uint32_t)value[c] << 16 * (c % 2);
  }
}

static void pack_floats(const float *value, size_t cells, uint32_t *out) {
  for (size_t i = 0; i < cells; i++, out += 5) {
    memset(out, 0, 5 * sizeof *out);
    for (size_t c = 0; c < 9; c++)
      out[c / 2] |= (uint32_t)abbe_half_of_float(value[9 * i + c]) << 16 * (c % 2);
  }
}

/* Packs rays that leave the object in that light, as halves. */
static abbe_result pack_exits(const abbe_volume_light *v, const abbe_caustic_volume *volume,
                              const abbe_volume_place *place, size_t light, uint32_t *out,
                              abbe_error *error) {
  const abbe_plan *plan = v->scene->plan;
  double(*sheet)[9] = abbe_volume_pages_sheets(v->scene);
  if (sheet == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for receivers");
  const abbe_exit_light_desc desc = {.light = &v->scene->local->light[light],
                                     .object = &v->scene->local->object[plan->refractor_object[0]],
                                     .place = place,
                                     .sheet = (const double(*)[9])sheet,
                                     .sheets = plan->parallelogram_count,
                                     .observer = plan->desc.observer,
                                     .min_nm = plan->desc.min_nm,
                                     .max_nm = plan->desc.max_nm};
  const size_t cells = volume->region.cells;
  float *value = malloc(9 * cells * sizeof *value);
  const abbe_result result =
      value != NULL ? abbe_exit_light_fill(volume, &desc, value, error)
                    : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu cells", cells);
  if (result == ABBE_OK) pack_floats(value, cells, out);
  free(value);
  free(sheet);
  return result;
}

/* Turned into the body's coordinates, and there into the node's light. */
static void join_turns(const abbe_volume_place *place, const double turn[9], float out[9]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      double sum = 0;
      for (int k = 0; k < 3; k++) sum += turn[3 * i + k] * place->turn[3 * j + k];
      out[3 * j + i] = (float)sum;
    }
}

/* Towards the light, in the world; what unit power brings to the centre, across the beam. */
static double look_at_light(const abbe_light *light, const double centre[3], double to_light[3]) {
  double distance = 1;
  if (light->kind == ABBE_LIGHT_DIRECTIONAL) {
    for (int k = 0; k < 3; k++) to_light[k] = -light->direction[k];
  } else {
    abbe_vector_subtract(light->position, centre, to_light);
    distance = abbe_vector_length(to_light);
  }
  abbe_vector_normalise(to_light);
  const double away[3] = {-to_light[0], -to_light[1], -to_light[2]};
  return abbe_light_profile(light, away) / (distance * distance);
}

/* One block, of that light alone. */
static abbe_result sight_exits(abbe_volume_light *v, const abbe_caustic_volume *volume,
                               const abbe_volume_place *place, size_t light, uint32_t *values,
                               abbe_error *error) {
  static const double as_it_is[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  v->strength[light] = 1; /* the rays have the light's */
  v->weight[3 * light] = 1;
  join_turns(place, as_it_is, v->turn[3 * light]);
  return pack_exits(v, volume, place, light,
                    values + 3 * light * volume->region.cells * words_of(volume), error);
}

static void sight_light(abbe_volume_light *v, const abbe_caustic_volume *volume,
                        const abbe_volume_place *place, size_t light, uint32_t *values) {
  const abbe_plan *plan = v->scene->plan;
  double to_light[3], own[3];
  abbe_volume_sight sight;
  v->strength[light] =
      (float)look_at_light(&v->scene->local->light[light], place->centre, to_light);
  for (int k = 0; k < 3; k++)
    own[k] = place->turn[k] * to_light[0] + place->turn[3 + k] * to_light[1] +
             place->turn[6 + k] * to_light[2];
  abbe_caustic_volume_look(volume, plan->desc.lookup, own, &sight);
  const size_t block = volume->region.cells * words_of(volume);
  for (size_t k = 0; k < sight.count; k++) {
    v->weight[3 * light + k] = (float)sight.weight[k];
    join_turns(place, sight.turn[k], v->turn[3 * light + k]);
    pack_node(volume, sight.node[k], values + (3 * light + k) * block);
  }
}

abbe_result abbe_volume_light_make(const abbe_gpu_scene *scene, abbe_volume_light *out,
                                   abbe_error *error) {
  const abbe_plan *plan = scene->plan;
  *out = (abbe_volume_light){0};
  if (!plan->volume) return ABBE_OK;
  const abbe_caustic_volume *volume = plan->desc.volume;
  const size_t block = volume->region.cells * words_of(volume), lights = plan->light_view_count;
  const bool table = volume->region.desc.kind == ABBE_REGION_GEODESIC;
  const size_t side = table ? volume->region.mesh.table_side : 0;
  const size_t count = 3 * lights * block + side * side;
  abbe_volume_place place;
  abbe_result result = abbe_volume_body_find(
      &volume->body, &scene->local->object[plan->refractor_object[0]], &place, error);
  if (result != ABBE_OK) return result;
  out->scene = scene;
  if (plan->volume_pages > 0) return volume_pages_make(scene, &place, &out->pages, error);
  uint32_t *values = calloc(count, sizeof *values);
  if (values == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a volume's nodes");
  for (int k = 0; k < 3; k++) out->centre[k] = (float)place.centre[k];
  for (size_t i = 0; i < lights && result == ABBE_OK; i++)
    if (volume->kind == ABBE_VOLUME_EXITS)
      result = sight_exits(out, volume, &place, i, values, error);
    else
      sight_light(out, volume, &place, i, values);
  if (table)
    memcpy(values + 3 * lights * block, volume->region.mesh.table, side * side * sizeof *values);
  if (result == ABBE_OK)
    result = abbe_gpu_make_buffer(scene->gpu, count * sizeof *values, values, &out->cells, error);
  free(values);
  return result;
}

void abbe_volume_light_free(abbe_volume_light *v) {
  if (v->scene == NULL) return;
  volume_pages_free(&v->pages);
  abbe_gpu_drop_buffers(v->scene->gpu, 1, &v->cells);
  *v = (abbe_volume_light){0};
}

void abbe_volume_light_set(const abbe_volume_light *v, GLuint program) {
  if (v->scene == NULL) return;
  if (v->pages.scene != NULL) {
    volume_pages_set(&v->pages, program, UNIT);
    return;
  }
  abbe_gpu *gpu = v->scene->gpu;
  const abbe_gl *gl = gpu->gl;
  const abbe_plan *plan = v->scene->plan;
  const abbe_caustic_volume *volume = plan->desc.volume;
  const abbe_volume_region *r = &volume->region;
  const GLsizei lights = (GLsizei)plan->light_view_count;
  const bool shells = r->desc.kind != ABBE_REGION_GRID;
  abbe_gpu_bind_texels(gpu, program, "volume_cells", UNIT, GL_R32UI, v->cells);
  gl->UniformMatrix3fv(gl->GetUniformLocation(program, "volume_turn"), 3 * lights, GL_FALSE,
                       &v->turn[0][0]);
  gl->Uniform1fv(gl->GetUniformLocation(program, "volume_weight"), 3 * lights, v->weight);
  gl->Uniform1fv(gl->GetUniformLocation(program, "volume_strength"), lights, v->strength);
  gl->Uniform3f(gl->GetUniformLocation(program, "volume_centre"), v->centre[0], v->centre[1],
                v->centre[2]);
  abbe_gpu_set_float(gpu, program, "volume_inner", r->desc.inner);
  abbe_gpu_set_float(gpu, program, "volume_outer", r->desc.outer);
  abbe_gpu_set_float(gpu, program, "volume_shells",
                     shells ? (double)r->rows / log(r->desc.outer / r->desc.inner) : 0);
  abbe_gpu_set_float(gpu, program, "volume_byte", 255 * volume->byte);
  abbe_gpu_set_int(gpu, program, "volume_side", (int)r->desc.side);
  abbe_gpu_set_int(gpu, program, "volume_row", (int)r->row);
  abbe_gpu_set_int(gpu, program, "volume_rows", (int)r->rows);
  abbe_gpu_set_int(gpu, program, "volume_table", (int)r->mesh.table_side);
}
