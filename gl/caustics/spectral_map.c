#include "gl/caustics/spectral_map.h"

#include "colorimetry/rgb_space.h"
#include "gl/device/bindings.h"
#include "gl/photons/photon_ledger.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static abbe_result copy(const float *texel, size_t side, const char *const *names, abbe_image *out,
                        abbe_error *error) {
  ABBE_TRY(abbe_image_make(side, side, 3, names, out, error));
  for (size_t y = 0; y < side; y++)
    for (size_t x = 0; x < side; x++)
      for (size_t c = 0; c < 3; c++)
        out->data[(y * side + x) * 3 + c] = texel[((side - 1 - y) * side + x) * 4 + c];
  return ABBE_OK;
}

abbe_result abbe_map_picture_flux(const float *texel, size_t side, const abbe_map_layout *layout,
                                  double power, abbe_image *out, abbe_error *error) {
  static const char *const names[] = {"X", "Y", "Z"};
  ABBE_TRY(copy(texel, side, names, out, error));
  for (size_t y = 0; y < side; y++) {
    const double height = power * abbe_map_layout_texel_size(layout, 1, side, side - 1 - y);
    for (size_t x = 0; x < side; x++)
      for (size_t c = 0; c < 3; c++)
        out->data[(y * side + x) * 3 + c] *=
            (float)(height * abbe_map_layout_texel_size(layout, 0, side, x));
  }
  abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_XYZ, out->xy);
  return ABBE_OK;
}

abbe_result abbe_map_picture_colour(const float *texel, size_t side, abbe_image *out,
                                    abbe_error *error) {
  static const char *const names[] = {"R", "G", "B"};
  ABBE_TRY(copy(texel, side, names, out, error));
  abbe_rgb_space_chromaticities(ABBE_RGB_SPACE_REC709, out->xy);
  return ABBE_OK;
}

/* Turned a little against the axes, so that four places have four columns and four rows. */
static const double places[ABBE_RENDER_MAX_HISTORY][2] = {
    {-0.375, 0.125}, {0.375, -0.125}, {0.125, 0.375}, {-0.125, -0.375}};

static bool keeps(const abbe_map_history *h) {
  return h->frames > 1;
}

static void forget(abbe_map_history *h) {
  for (size_t i = 0; i < ABBE_SCENE_MAX_LIGHTS; i++)
    h->light[i].frames = h->light[i].tiles_frames = 0;
}

static void drop(abbe_map_history *h) {
  if (h->gpu != NULL) abbe_gpu_drop_textures(h->gpu, ABBE_RENDER_MAX_HISTORY, h->kept);
  h->side = h->layers = 0;
  forget(h);
}

void abbe_map_history_change(abbe_map_history *h, size_t frames, const double origin[3]) {
  for (size_t i = 0; i < ABBE_SCENE_MAX_LIGHTS; i++)
    for (int k = 0; k < 3; k++) h->light[i].layout.view.origin[k] += h->origin[k] - origin[k];
  memcpy(h->origin, origin, sizeof h->origin);
  h->fresh = 0;
  if (h->frames == frames) return;
  drop(h);
  for (size_t i = 0; i < ABBE_SCENE_MAX_LIGHTS; i++) h->light[i].known = false;
  h->frames = frames;
  h->frame = 0;
}

void abbe_map_history_free(abbe_map_history *h) {
  drop(h);
  *h = (abbe_map_history){0};
}

bool abbe_map_history_layout(const abbe_map_history *h, size_t light, abbe_map_layout *out) {
  if (!keeps(h) || !h->light[light].known) return false;
  *out = h->light[light].layout;
  return true;
}

/* Makes capacity for maps of so many layers; with another capacity nothing is kept in it. */
static abbe_result map_history_make(abbe_map_history *h, abbe_gpu *gpu, size_t side, size_t layers,
                                    abbe_error *error) {
  h->gpu = gpu;
  if (!keeps(h)) return ABBE_OK;
  abbe_result result = abbe_gpu_compute(gpu, "map_history.comp", NULL, &h->program, error);
  if (h->side == side && h->layers == layers) return result;
  drop(h);
  for (size_t i = 0; i < h->frames && result == ABBE_OK; i++)
    result = abbe_gpu_make_texture(gpu, GL_RGBA32F, side, side, layers, false, &h->kept[i], error);
  h->side = side;
  h->layers = layers;
  if (result != ABBE_OK) drop(h);
  return result;
}

static bool same_tiles(const abbe_receiver_tiles *a, const abbe_receiver_tiles *b) {
  bool same = a->count == b->count && a->rows == b->rows;
  for (size_t i = 0; same && i < a->count; i++) {
    const abbe_receiver_tile *x = &a->tile[i], *y = &b->tile[i];
    same = x->chart_side == y->chart_side && memcmp(x->rect, y->rect, sizeof x->rect) == 0 &&
           memcmp(x->window, y->window, sizeof x->window) == 0;
  }
  return same;
}

void abbe_map_history_lay_out(abbe_map_history *h, size_t light, const abbe_map_layout *layout,
                              const abbe_receiver_tiles *tiles) {
  abbe_map_past *past = &h->light[light];
  if (!keeps(h)) return;
  if (!past->known || !abbe_map_layout_same(&past->layout, layout)) past->frames = 0;
  if (!past->known || !same_tiles(&past->tiles, tiles)) past->tiles_frames = 0;
  past->known = true;
  past->layout = *layout;
  past->tiles = *tiles;
}

void abbe_map_history_shift(const abbe_map_history *h, const double own[2], double out[2]) {
  for (int k = 0; k < 2; k++) {
    out[k] = own[k] + (keeps(h) ? places[h->frame % h->frames][k] : 0);
    if (out[k] > 0.5) out[k] -= 1; /* the same grid */
    if (out[k] < -0.5) out[k] += 1;
  }
}

/* The texture of the frame so many before this one. */
static GLuint kept_before(const abbe_map_history *h, size_t age) {
  return h->kept[(h->frame + h->frames - age) % h->frames];
}

/* Keeps level 0 of a layer of the map, the light's or its tiles', and puts the mean in its place;
 * so many rows are used. */
static void map_history_blend(abbe_map_history *h, GLuint map, size_t light, size_t layer,
                              size_t rows) {
  static const char *const names[ABBE_RENDER_MAX_HISTORY] = {"kept[0]", "kept[1]", "kept[2]",
                                                             "kept[3]"};
  abbe_map_past *past = &h->light[light];
  if (!keeps(h)) return;
  const abbe_gl *gl = h->gpu->gl;
  const size_t before = layer == light ? past->frames : past->tiles_frames;
  past->blended = true;
  gl->CopyImageSubData(map, GL_TEXTURE_2D_ARRAY, 0, 0, 0, (GLint)layer, kept_before(h, 0),
                       GL_TEXTURE_2D_ARRAY, 0, 0, 0, (GLint)layer, (GLsizei)h->side, (GLsizei)rows,
                       1);
  if (before == 0) return;
  gl->UseProgram(h->program);
  for (size_t age = 0; age <= before; age++)
    abbe_gpu_bind_array(h->gpu, h->program, names[age], (int)age, kept_before(h, age));
  abbe_gpu_set_int(h->gpu, h->program, "layer", (int)layer);
  abbe_gpu_set_int(h->gpu, h->program, "map_size", (int)h->side);
  abbe_gpu_set_int(h->gpu, h->program, "rows", (int)rows);
  abbe_gpu_set_int(h->gpu, h->program, "before", (int)before);
  abbe_gpu_set_int(h->gpu, h->program, "fresh", (int)h->fresh);
  gl->BindImageTexture(0, map, 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA32F);
  abbe_gpu_dispatch_2d(h->gpu, h->program, h->side, rows);
  gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT |
                    GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

void abbe_map_history_next(abbe_map_history *h) {
  if (!keeps(h)) return;
  for (size_t i = 0; i < ABBE_SCENE_MAX_LIGHTS; i++) {
    abbe_map_past *past = &h->light[i];
    const size_t most = h->frames - 1;
    past->frames = !past->blended ? 0 : past->frames < most ? past->frames + 1 : most;
    past->tiles_frames = !past->blended              ? 0
                         : past->tiles_frames < most ? past->tiles_frames + 1
                                                     : most;
    past->blended = false;
  }
  h->frame++;
  h->fresh++;
}

bool abbe_map_history_settled(const abbe_map_history *h) {
  return !keeps(h) || h->fresh >= h->frames;
}

static const abbe_gpu_scene *scene_of(const abbe_spectral_map *map) {
  return map->views->scene;
}

static abbe_result make_texture(abbe_spectral_map *map, abbe_error *error) {
  static const float black[4] = {0, 0, 0, 0};
  const abbe_gl *gl = scene_of(map)->gpu->gl;
  const bool caustics = scene_of(map)->plan->caustics;
  const size_t side = caustics ? scene_of(map)->plan->desc.map_size : 1;
  ABBE_TRY(abbe_gpu_make_levels(scene_of(map)->gpu, GL_RGBA32F, side, map->layers,
                                map->views->map_levels, &map->texture, error));
  for (size_t i = 0; i < map->layers && !caustics; i++)
    gl->TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, (GLint)i, 1, 1, 1, GL_RGBA, GL_FLOAT, black);
  return abbe_gl_check(gl, "the allocation of the map", error);
}

abbe_result abbe_spectral_map_make(const abbe_photon_lights *views,
                                   const abbe_receiver_atlas *atlas,
                                   const abbe_shader_variant *variant, abbe_spectral_map *out,
                                   abbe_error *error) {
  abbe_gpu *gpu = views->scene->gpu;
  out->views = views;
  out->atlas = atlas;
  out->layers = abbe_receiver_atlas_layers(atlas);
  ABBE_TRY(make_texture(out, error));
  if (!views->scene->plan->caustics) return ABBE_OK;
  const size_t texels = (atlas->used ? 2 : 1) * views->map_texels;
  ABBE_TRY(abbe_gpu_make_buffer(gpu, texels * abbe_photon_lights_map_words(views) * 4, NULL,
                                &out->sums, error));
  if ((!gpu->software || atlas->used))
    ABBE_TRY(
        abbe_shader_variant_compute(variant, gpu, "map_resolve.comp", NULL, &out->resolve, error));
  ABBE_TRY(abbe_gpu_compute(gpu, "map_mip.comp", NULL, &out->mip, error));
  return map_history_make(out->history, gpu, views->scene->plan->desc.map_size, out->layers, error);
}

void abbe_spectral_map_free(abbe_spectral_map *map) {
  if (map->views == NULL) return;
  abbe_gpu_drop_textures(scene_of(map)->gpu, 1, &map->texture);
  abbe_gpu_drop_buffers(scene_of(map)->gpu, 1, &map->sums);
}

void abbe_spectral_map_clear(abbe_spectral_map *map) {
  abbe_gpu_clear_buffer(scene_of(map)->gpu, map->sums);
}

void abbe_spectral_map_set(const abbe_spectral_map *map, GLuint program) {
  abbe_gpu_bind_array(scene_of(map)->gpu, program, "spectral_map", 0, map->texture);
}

static void use(abbe_spectral_map *map, GLuint program, const char *sampler, size_t light,
                size_t layer) {
  abbe_gpu *gpu = scene_of(map)->gpu;
  gpu->gl->UseProgram(program);
  abbe_gpu_set_int(gpu, program, "light", (int)light);
  abbe_gpu_set_int(gpu, program, "layer", (int)layer);
  abbe_gpu_set_int(gpu, program, "map_size", (int)scene_of(map)->plan->desc.map_size);
  abbe_gpu_bind_storage(gpu, BINDING_TEXEL_SIZES, map->views->texel_sizes);
  abbe_gpu_bind_array(gpu, program, sampler, 0, map->texture);
}

static void write_level(abbe_spectral_map *map, GLuint program, size_t level, size_t rows) {
  abbe_gpu *gpu = scene_of(map)->gpu;
  abbe_gpu_set_int(gpu, program, "level", (int)level);
  gpu->gl->BindImageTexture(0, map->texture, (GLint)level, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA32F);
  abbe_gpu_dispatch_2d(gpu, program, scene_of(map)->plan->desc.map_size >> level, rows >> level);
  gpu->gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT |
                         GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

/* Coarse to fine: each level takes over what the coarser ones hold; so many rows of a layer. */
static void resolve_layer(abbe_spectral_map *map, size_t light, size_t layer, size_t rows) {
  abbe_gpu *gpu = scene_of(map)->gpu;
  abbe_gpu_scene_bind(scene_of(map));
  abbe_photon_lights_bind(map->views);
  abbe_receiver_atlas_bind(map->atlas);
  abbe_gpu_forget_samplers(scene_of(map)->gpu);
  use(map, map->resolve, "coarser_map", light, layer);
  abbe_gpu_set_uint(gpu, map->resolve, "map_texels", map->views->map_texels);
  abbe_gpu_set_int(gpu, map->resolve, "levels", (int)map->views->map_levels);
  abbe_gpu_bind_storage(gpu, BINDING_MAP_SUMS, map->sums);
  for (size_t level = map->views->map_levels; level-- > 0;)
    write_level(map, map->resolve, level, rows);
}

/* Flux of a texel's X, Y or Z in units of the sums. */
static inline float units_at(const GLuint *sum, size_t i, bool wide) {
  return wide ? (float)sum[2 * i + 1] * 4294967296.0f + (float)sum[2 * i] : (float)sum[i];
}

/* One level, as map_resolve.comp makes it, of those of side n; above: the coarser level, of rows of
 * n / 2 texels. size: widths, heights, and 1 over what each spreads its light over. */
static void resolve_level(const GLuint *sum, bool wide, float unit, size_t n, const float *size[4],
                          const float *above, bool finest, float *out) {
#pragma omp parallel for
  for (size_t y = 0; y < n; y++) {
    const size_t half = n / 2, nearer = y / 2;
    const size_t other = y % 2 == 0 ? nearer - (y > 0) : nearer + (nearer + 1 < half);
    for (size_t x = 0; x < n; x++) {
      const size_t i = x / 2, k = x % 2 == 0 ? i - (x > 0) : i + (i + 1 < half);
      const float area = size[0][x] * size[1][y];
      const float scale = finest ? 1 / area : size[2][x] * size[3][y];
      const float *a = above + 4 * (nearer * half), *b = above + 4 * (other * half);
      float *to = out + 4 * (y * n + x);
      for (size_t c = 0; c < 3; c++) {
        float flux = units_at(sum, 3 * (y * n + x) + c, wide) * unit;
        if (above != NULL)
          flux += area * (0.75f * (0.75f * a[4 * i + c] + 0.25f * a[4 * k + c]) +
                          0.25f * (0.75f * b[4 * i + c] + 0.25f * b[4 * k + c]));
        to[c] = flux * scale;
      }
      to[3] = 1;
    }
  }
}

/* The finest level of a light's own map, on the processor's own threads, whose stores in images are
 * pixel by pixel. */
static abbe_result resolve_here(abbe_spectral_map *map, size_t light, abbe_error *error) {
  const abbe_photon_lights *views = map->views;
  const abbe_gl *gl = scene_of(map)->gpu->gl;
  const size_t side = scene_of(map)->plan->desc.map_size;
  const size_t words = abbe_photon_lights_map_words(views);
  const float unit = (float)abbe_photon_lights_map_unit(views, light);
  float *level_of[2] = {malloc(side * side * 16), malloc(side * side * 4 + 16)};
  gl->BindBuffer(GL_COPY_READ_BUFFER, map->sums);
  gl->BindBuffer(GL_COPY_WRITE_BUFFER, views->texel_sizes);
  const GLuint *sum = gl->MapBufferRange(
      GL_COPY_READ_BUFFER, 0, (GLsizeiptr)(views->map_texels * words * 4), GL_MAP_READ_BIT);
  const float *sizes = gl->MapBufferRange(GL_COPY_WRITE_BUFFER, (GLintptr)(light * side * 32),
                                          (GLsizeiptr)(side * 32), GL_MAP_READ_BIT);
  const bool whole = level_of[0] != NULL && level_of[1] != NULL;
  const float *above = NULL;
  size_t end = views->map_texels;
  for (size_t level = views->map_levels; level-- > 0 && whole && sum != NULL && sizes != NULL;) {
    const size_t n = side >> level;
    const float *size[4];
    for (size_t k = 0; k < 4; k++) size[k] = sizes + 2 * (k * side + side - n);
    end -= n * n;
    resolve_level(sum + end * words, views->wide, unit, n, size, above, level == 0,
                  level_of[level % 2]);
    above = level_of[level % 2];
  }
  if (sum != NULL) gl->UnmapBuffer(GL_COPY_READ_BUFFER);
  if (sizes != NULL) gl->UnmapBuffer(GL_COPY_WRITE_BUFFER);
  gl->BindTexture(GL_TEXTURE_2D_ARRAY, map->texture);
  if (above != NULL)
    gl->TexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, (GLint)light, (GLsizei)side, (GLsizei)side, 1,
                      GL_RGBA, GL_FLOAT, above);
  for (int i = 0; i < 2; i++) free(level_of[i]);
  return whole ? abbe_gl_check(gl, "the resolving of a map", error)
               : abbe_error_set(error, ABBE_NO_MEMORY, "no memory to resolve the map");
}

/* What the camera sees of the map where its samples are farther apart than texels. */
static void make_mips(abbe_spectral_map *map, size_t light, size_t layer, size_t rows) {
  use(map, map->mip, "map_levels", light, layer);
  for (size_t level = 1; level < map->views->map_levels; level++)
    write_level(map, map->mip, level, rows);
}

abbe_result abbe_spectral_map_resolve(abbe_spectral_map *map, size_t light, abbe_error *error) {
  const size_t side = scene_of(map)->plan->desc.map_size;
  const abbe_receiver_tiles *tiles = &map->atlas->tiles[light];
  abbe_result result = ABBE_OK;
  if (scene_of(map)->gpu->software)
    result = resolve_here(map, light, error);
  else
    resolve_layer(map, light, light, side);
  map_history_blend(map->history, map->texture, light, light, side);
  make_mips(map, light, light, side);
  if (result != ABBE_OK || tiles->count == 0) return result;
  const size_t layer = map->atlas->layer[light];
  resolve_layer(map, light, layer, tiles->rows);
  map_history_blend(map->history, map->texture, light, layer, tiles->rows);
  make_mips(map, light, layer, tiles->rows);
  return ABBE_OK;
}

abbe_result abbe_spectral_map_read_ledger(const abbe_spectral_map *map, size_t light,
                                          abbe_ledger *out, abbe_error *error) {
  const abbe_gl *gl = scene_of(map)->gpu->gl;
  const size_t layer = map->views->map_texels, texels = layer * (map->atlas->used ? 2 : 1);
  const size_t words = abbe_photon_lights_map_words(map->views);
  const size_t size = texels * words * sizeof(GLuint);
  double deposited[2] = {0, 0};
  GLuint *sum = malloc(size);
  if (sum == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to read the map");
  gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, map->sums);
  gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)size, sum);
  for (size_t i = 0; i < texels; i++)
    deposited[i / layer] +=
        map->views->wide ? abbe_photon_ledger_wide(sum + 6 * i + 2) : sum[3 * i + 1];
  free(sum);
  const double unit = abbe_photon_lights_map_unit(map->views, light);
  out->deposited += (deposited[0] + deposited[1]) * unit;
  out->on_tiles += deposited[1] * unit;
  return abbe_gl_check(gl, "the reading of the ledger", error);
}

abbe_result abbe_spectral_map_read(const abbe_spectral_map *map, size_t light, double unit,
                                   abbe_image *out, abbe_error *error) {
  const abbe_plan *plan = scene_of(map)->plan;
  const size_t side = plan->desc.map_size, layer = side * side * 4;
  ABBE_FREED float *data = malloc(map->layers * layer * sizeof *data);
  if (data == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to read the map");
  scene_of(map)->gpu->gl->BindTexture(GL_TEXTURE_2D_ARRAY, map->texture);
  scene_of(map)->gpu->gl->GetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA, GL_FLOAT, data);
  for (size_t i = 0; i < plan->light_view_count; i++) {
    if (i == light || plan->light_view[i].light != light) continue;
    for (size_t k = 0; k < layer; k++) data[light * layer + k] += data[i * layer + k];
  }
  return abbe_map_picture_flux(data + light * layer, side, &map->views->light[light].map,
                               unit * scene_of(map)->local->light[light].power, out, error);
}
