#include "gl/light/receiver_atlas.h"

#include "gl/device/bindings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The shaders' ON_A_TILE. */
static const GLuint on_a_tile = 0x40000000u;

/* A tile costs as much as a map: what lands beside the map is given up below so many times the
 * share below which paths end. */
static const double least_share = 1.5;

/* The texels of a block: rectangles of tiles are of whole ones, in all levels. */
static size_t block_side(const abbe_receiver_atlas *atlas) {
  return (size_t)1 << (atlas->views->map_levels - 1);
}

static abbe_result upload(abbe_receiver_atlas *atlas, int table, GLenum format, size_t size,
                          const void *data, abbe_error *error) {
  GLint most = 0;
  atlas->views->scene->gpu->gl->GetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  if (size / 4 > (size_t)most)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the receivers' %zu faces and %zu flat parts are more than this OpenGL "
                          "reads in a buffer; use smaller meshes",
                          atlas->views->scene->charts.face_count,
                          atlas->views->scene->charts.count);
  return abbe_gpu_make_texels(atlas->views->scene->gpu, format, size, data, UNIT_TILE_ROWS + table,
                              &atlas->table[table], &atlas->texture[table], error);
}

/* Writes the index of one light, as receiver_atlas.glsl reads it: its layer, blocks of texels,
 * sides of charts. */
static void write_index(const abbe_receiver_atlas *atlas, size_t light, size_t blocks,
                        GLint *index) {
  const abbe_receiver_tiles *tiles = &atlas->tiles[light];
  const size_t align = block_side(atlas), sides = 2 * atlas->views->scene->charts.count;
  GLint *of_block = index + 1, *of_side = of_block + blocks * blocks;
  index[0] = (GLint)atlas->layer[light];
  for (size_t i = 0; i < blocks * blocks + sides; i++) of_block[i] = -1;
  for (size_t k = 0; k < tiles->count; k++) {
    const abbe_receiver_tile *tile = &tiles->tile[k];
    of_side[tile->chart_side] = (GLint)k;
    for (size_t y = tile->rect[2] / align; y < tile->rect[3] / align; y++)
      for (size_t x = tile->rect[0] / align; x < tile->rect[1] / align; x++)
        of_block[y * blocks + x] = (GLint)k;
  }
}

/* The shaders' tables and the definitions for them: the same however many tiles a light has, so
 * that what is compiled before these are chosen need not be compiled again. */
static abbe_result tell_shaders(abbe_receiver_atlas *atlas, abbe_shader_variant *variant,
                                abbe_error *error) {
  enum { MOST = ABBE_RECEIVER_TILES };
  const size_t lights = atlas->views->scene->plan->light_view_count,
               sides = 2 * atlas->views->scene->charts.count;
  const size_t blocks = atlas->views->scene->plan->desc.map_size / block_side(atlas);
  const size_t words = 1 + blocks * blocks + sides;
  float(*row)[ABBE_TILE_FLOATS] = calloc(lights * MOST, sizeof *row);
  GLint *index = calloc(lights * words, sizeof *index);
  abbe_result result = row != NULL && index != NULL
                           ? ABBE_OK
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for tiles");
  for (size_t i = 0; i < lights && result == ABBE_OK; i++) {
    const abbe_receiver_tiles *tiles = &atlas->tiles[i];
    for (size_t k = 0; k < tiles->count; k++)
      abbe_receiver_tile_pack(
          &tiles->tile[k], atlas->views->scene->charts.parallelogram[tiles->tile[k].chart_side / 2],
          row[i * MOST + k]);
    write_index(atlas, i, blocks, index + i * words);
  }
  if (result == ABBE_OK)
    result = upload(atlas, ABBE_TILE_ROWS, GL_RGBA32F, lights * MOST * sizeof *row, row, error);
  if (result == ABBE_OK)
    result = upload(atlas, ABBE_TILE_INDEX, GL_R32I, lights * words * sizeof *index, index, error);
  free(row);
  free(index);
  variant->tiles = MOST;
  variant->tile_blocks = blocks;
  variant->chart_sides = sides;
  return result;
}

/* From a place to a chart's u, then v: a tile of one texel of all of it. */
static abbe_result upload_charts(abbe_receiver_atlas *atlas, abbe_error *error) {
  static const abbe_receiver_tile whole = {.window = {0, 1, 0, 1}, .rect = {0, 1, 0, 1}};
  float(*row)[8] = calloc(atlas->views->scene->charts.count + 1, sizeof *row);
  if (row == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for charts");
  for (size_t i = 0; i < atlas->views->scene->charts.count; i++) {
    float packed[ABBE_TILE_FLOATS];
    abbe_receiver_tile_pack(&whole, atlas->views->scene->charts.parallelogram[i], packed);
    memcpy(row[i], packed, sizeof row[i]);
  }
  abbe_result result = upload(atlas, ABBE_CHART_ROWS, GL_RGBA32F,
                              atlas->views->scene->charts.count * sizeof *row, row, error);
  free(row);
  if (result != ABBE_OK) return result;
  return upload(atlas, ABBE_SIDE_OF_FACE, GL_R32I,
                atlas->views->scene->charts.face_count *
                    sizeof *atlas->views->scene->charts.face_side,
                atlas->views->scene->charts.face_side, error);
}

/* As outgoing_segment.glsl packs it. */
static size_t tile_of_interface(float word) {
  GLuint bits = 0;
  memcpy(&bits, &word, sizeof bits);
  const GLuint exponent = bits >> 23 & 255u;
  return exponent > 0 ? (exponent - 1) % 80 - 1 : SIZE_MAX;
}

void abbe_receiver_atlas_place(const abbe_receiver_atlas *atlas, size_t light, float *hit,
                               const GLuint *signature, size_t words, size_t count) {
  const abbe_receiver_tiles *tiles = &atlas->tiles[light];
  for (size_t i = 0; i < count; i++) {
    const float *from = hit + ABBE_HIT_BYTES / sizeof *hit * i;
    float at[4] = {from[0], from[1], from[2], from[3]}, packed[ABBE_TILE_FLOATS];
    const size_t k = tile_of_interface(from[7]);
    if (!atlas->fits && abbe_receiver_atlas_holds(atlas, signature[words * i]) &&
        k < tiles->count) {
      const abbe_receiver_tile *tile = &tiles->tile[k];
      abbe_receiver_tile_pack(tile, atlas->views->scene->charts.parallelogram[tile->chart_side / 2],
                              packed);
      for (int axis = 0; axis < 2; axis++) {
        const float *to = packed + 4 * axis;
        at[axis] = to[0] * from[0] + to[1] * from[1] + to[2] * from[2] + to[3];
      }
      at[2] = (float)k;
    }
    memcpy(hit + 4 * i, at, sizeof at);
  }
}

bool abbe_receiver_atlas_holds(const abbe_receiver_atlas *atlas, GLuint path) {
  return atlas->used && (path & on_a_tile) != 0;
}

abbe_result abbe_receiver_atlas_sort(const abbe_receiver_atlas *atlas, const float *hit,
                                     const GLuint *path, size_t count, double part,
                                     abbe_tile_light **light, abbe_error *error) {
  for (size_t i = 0; i < count; i++) {
    const float *at = hit + 4 * i;
    if (!(at[3] > 0) || !abbe_receiver_atlas_holds(atlas, path[i])) continue;
    const size_t side = (size_t)fmax(at[2], 0);
    if (side >= 2 * atlas->views->scene->charts.count) continue;
    if (light[side] == NULL) light[side] = calloc(1, sizeof **light);
    if (light[side] == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to fit tiles");
    abbe_tile_light_add(light[side], at[0], at[1], rint((double)at[3] / part));
  }
  return ABBE_OK;
}

static bool has_tile(const abbe_receiver_tiles *tiles, size_t side) {
  for (size_t k = 0; k < tiles->count; k++)
    if (tiles->tile[k].chart_side == side) return true;
  return false;
}

abbe_result abbe_receiver_atlas_choose(abbe_receiver_atlas *atlas, size_t light,
                                       abbe_tile_light *const *found, double held,
                                       abbe_error *error) {
  const size_t sides = 2 * atlas->views->scene->charts.count;
  abbe_receiver_tiles *tiles = &atlas->tiles[light];
  double beside = 0, left = 0, most = 0;
  size_t worst = 0;
  if (!atlas->used) return ABBE_OK;
  for (size_t i = 0; i < sides; i++) beside += found[i] != NULL ? found[i]->flux : 0;
  const double total = held + beside,
               enough = least_share * atlas->views->scene->plan->desc.energy_share * total;
  if (!(beside > 0) || beside < enough) return ABBE_OK;
  abbe_receiver_tiles_lay_out(found, (const double(*)[9])atlas->views->scene->charts.parallelogram,
                              sides, total, atlas->views->scene->plan->desc.map_size,
                              block_side(atlas), tiles);
  for (size_t i = 0; i < sides; i++) {
    if (found[i] == NULL || has_tile(tiles, i)) continue;
    left += found[i]->flux;
    if (found[i]->flux > most) worst = i;
    most = fmax(most, found[i]->flux);
  }
  if (left < enough || left < 1e-3 * total) return ABBE_OK;
  return abbe_error_set(
      error, ABBE_UNSUPPORTED,
      "%.2g %% of the light that '%.40s' sends through refractors falls where it does not shine "
      "itself, on more parts of receivers than the %zu that maps are kept for, most of it on "
      "'%.40s'; give that a smoother mesh, ask for a larger --map, or allow a larger --share",
      100 * left / total,
      atlas->views->scene->local->light[atlas->views->scene->plan->light_view[light].light].name,
      tiles->count,
      atlas->views->scene->local->object[atlas->views->scene->charts.object[worst / 2]].name);
}

void abbe_receiver_atlas_world(const abbe_receiver_atlas *atlas, size_t light, const float *hit,
                               double out[3]) {
  const abbe_receiver_tiles *tiles = &atlas->tiles[light];
  const size_t k = (size_t)fmin(fmax(hit[2], 0), ABBE_RECEIVER_TILES - 1);
  const abbe_receiver_tile *tile = &tiles->tile[k];
  abbe_receiver_tile_place(tile, atlas->views->scene->charts.parallelogram[tile->chart_side / 2],
                           hit[0], hit[1], out);
}

abbe_result abbe_receiver_atlas_make(const abbe_photon_lights *views, abbe_shader_variant *variant,
                                     abbe_receiver_atlas *out, abbe_error *error) {
  out->views = views;
  if (!views->scene->plan->tiles) return ABBE_OK;
  out->used = out->fits = true;
  ABBE_TRY(upload_charts(out, error));
  return tell_shaders(out, variant, error);
}

void abbe_receiver_atlas_free(abbe_receiver_atlas *atlas) {
  if (atlas->views == NULL) return;
  atlas->views->scene->gpu->gl->DeleteTextures(ABBE_TILE_TABLES, atlas->texture);
  abbe_gpu_drop_buffers(atlas->views->scene->gpu, ABBE_TILE_TABLES, atlas->table);
}

void abbe_receiver_atlas_bind(const abbe_receiver_atlas *atlas) {
  if (atlas->views == NULL) return;
  const abbe_gl *gl = atlas->views->scene->gpu->gl;
  for (GLenum k = 0; k < ABBE_TILE_TABLES; k++) {
    if (atlas->texture[k] == 0) continue;
    gl->ActiveTexture(GL_TEXTURE0 + UNIT_TILE_ROWS + k);
    gl->BindTexture(GL_TEXTURE_BUFFER, atlas->texture[k]);
  }
}

abbe_result abbe_receiver_atlas_keep(abbe_receiver_atlas *atlas, abbe_shader_variant *variant,
                                     abbe_error *error) {
  const size_t lights = atlas->views->scene->plan->light_view_count;
  size_t layer = lights;
  for (size_t i = 0; i < lights; i++) {
    if (atlas->tiles[i].count > 0) atlas->layer[i] = layer++;
  }
  atlas->fits = false;
  atlas->used = layer > lights;
  if (atlas->used) return tell_shaders(atlas, variant, error);
  variant->tiles = 0;
  return ABBE_OK;
}

size_t abbe_receiver_atlas_layers(const abbe_receiver_atlas *atlas) {
  const size_t lights = atlas->views->scene->plan->light_view_count;
  size_t layers = lights > 0 ? lights : 1;
  for (size_t i = 0; i < lights; i++)
    if (atlas->tiles[i].count > 0) layers++;
  return layers;
}
