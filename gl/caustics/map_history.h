/* map_history.h: the light of the last frames in the texels of maps, for frames that follow one
 * another: a map is the mean of the last few, of photons that start elsewhere in their cells.
 * Internal to gl/.
 *
 * Of the frames since the last change the mean is plain, so a still scene comes to the mean of so
 * many passes, and stays. Of older frames no texel counts for less than the least or more than the
 * most that this one has nearby (map_history.comp): where this frame leaves a neighbourhood dark
 * nothing of them is seen, whatever has moved, and after as many frames as are kept none of them
 * counts. Texels must stay where they are for that: a layout is kept as long as it serves.
 */
#ifndef ABBE_GL_CAUSTICS_MAP_HISTORY_H
#define ABBE_GL_CAUSTICS_MAP_HISTORY_H

#include "gl/device/gpu.h"
#include "gl/scene/receiver_tiles.h"
#include "scenes/scene.h"
#include "scenes/view/map_layout.h"

#include <stdbool.h>
#include <stddef.h>

/* Of one light. */
typedef struct abbe_map_past {
  bool known; /* its layout, of the last frame, in the local scene */
  abbe_map_layout layout;
  abbe_receiver_tiles tiles;
  bool blended;                /* in this frame */
  size_t frames, tiles_frames; /* before this one that are of these */
} abbe_map_past;

typedef struct abbe_map_history {
  abbe_gpu *gpu;
  size_t frames; /* that a map is the mean of; below 2: nothing is kept */
  size_t side, layers;
  GLuint kept[ABBE_RENDER_MAX_HISTORY]; /* level 0 of the map in the last frames, in turn */
  GLuint program;
  size_t frame; /* of the sequence, this one */
  size_t fresh; /* frames since the last change, before this one */
  double origin[3];
  abbe_map_past light[ABBE_SCENE_MAX_LIGHTS];
} abbe_map_history;

/* Before light is made or drawn anew, for maps that are the mean of so many frames, in a local
 * scene of that origin: what was drawn is old. */
void abbe_map_history_change(abbe_map_history *history, size_t frames, const double origin[3]);
void abbe_map_history_free(abbe_map_history *history);

/* The layout of the light's last map; false: none is kept. */
bool abbe_map_history_layout(const abbe_map_history *history, size_t light, abbe_map_layout *out);
/* Room for maps of so many layers; where there was other room, nothing is kept in it. */
abbe_result abbe_map_history_make(abbe_map_history *history, abbe_gpu *gpu, size_t side,
                                  size_t layers, abbe_error *error);
/* How the light's map is laid out now: where that differs, frames before do not count. */
void abbe_map_history_lay_out(abbe_map_history *history, size_t light,
                              const abbe_map_layout *layout, const abbe_receiver_tiles *tiles);

/* By which part of a cell this frame's photons are shifted, where the request shifts them by
 * `own`. */
void abbe_map_history_shift(const abbe_map_history *history, const double own[2], double out[2]);
/* Keeps level 0 of a layer of the map, the light's or its tiles', and puts the mean in its place;
 * so many rows are used. */
void abbe_map_history_blend(abbe_map_history *history, GLuint map, size_t light, size_t layer,
                            size_t rows);
/* The frame is whole. */
void abbe_map_history_next(abbe_map_history *history);
/* Another frame would be as the last one. */
bool abbe_map_history_settled(const abbe_map_history *history);

#endif
