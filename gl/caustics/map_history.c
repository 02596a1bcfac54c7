#include "gl/caustics/map_history.h"

#include <math.h>
#include <string.h>

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

abbe_result abbe_map_history_make(abbe_map_history *h, abbe_gpu *gpu, size_t side, size_t layers,
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

void abbe_map_history_blend(abbe_map_history *h, GLuint map, size_t light, size_t layer,
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
