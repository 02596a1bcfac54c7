/* spectral_map.h: where light lies that refractors have bent: X, Y, Z flux over window area, of
 * unit power of the light; a layer a light, and a layer of tiles for each that has any; summed in
 * whole units, in levels. Internal to gl/.
 */
#ifndef ABBE_GL_CAUSTICS_SPECTRAL_MAP_H
#define ABBE_GL_CAUSTICS_SPECTRAL_MAP_H

#include "colorimetry/image/image.h"
#include "gl/device/gpu.h"
#include "gl/device/statistics.h"
#include "gl/light/receiver_atlas.h"
#include "gl/scene/receiver_tiles.h"
#include "scenes/scene.h"
#include "scenes/view/map_layout.h"

#include <stdbool.h>
#include <stddef.h>

/* The light of the last frames in the texels of maps, for frames that follow one another: a map is
 * the mean of the last few, of photons that start elsewhere in their cells.
 *
 * Of the frames since the last change the mean is plain, so a still scene comes to the mean of so
 * many passes, and stays. Of older frames no texel counts for less than the least or more than the
 * most that this one has nearby (map_history.comp): where this frame leaves a neighbourhood dark
 * nothing of them is seen, whatever has moved, and after as many frames as are kept none of them
 * counts. Texels must stay where they are for that: a layout is kept as long as it serves. */

/* The past maps of one light. */
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
  size_t frame; /* number of this frame in the sequence */
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
/* How the light's map is laid out now: where that differs, frames before do not count. */
void abbe_map_history_lay_out(abbe_map_history *history, size_t light,
                              const abbe_map_layout *layout, const abbe_receiver_tiles *tiles);

/* By which part of a cell this frame's photons are shifted, where the request shifts them by
 * `own`. */
void abbe_map_history_shift(const abbe_map_history *history, const double own[2], double out[2]);
/* The frame is whole. */
void abbe_map_history_next(abbe_map_history *history);
/* Another frame would be as the last one. */
bool abbe_map_history_settled(const abbe_map_history *history);

typedef struct abbe_spectral_map {
  const abbe_photon_lights *views;
  const abbe_receiver_atlas *atlas;
  abbe_map_history
      *history; /* whose light maps hold beside this frame's; set by whoever makes it */
  GLuint texture, sums;
  GLuint resolve, mip; /* programs */
  size_t layers;
} abbe_spectral_map;

/* Black, of one texel a layer, where the plan has no caustics; then it has no sums and is never
 * cleared or resolved. */
abbe_result abbe_spectral_map_make(const abbe_photon_lights *views,
                                   const abbe_receiver_atlas *atlas,
                                   const abbe_shader_variant *variant, abbe_spectral_map *out,
                                   abbe_error *error);
void abbe_spectral_map_free(abbe_spectral_map *map);

void abbe_spectral_map_clear(abbe_spectral_map *map);
/* The light's sums to its layers' texels, in all levels, with the history's. ABBE_GL,
 * ABBE_NO_MEMORY. */
abbe_result abbe_spectral_map_resolve(abbe_spectral_map *map, size_t light, abbe_error *error);
/* The texture, into the program that is in use. */
void abbe_spectral_map_set(const abbe_spectral_map *map, GLuint program);

/* Waits for the device: adds what lies in the sums, weighted by ybar, of unit power, to the
 * ledger.
 * ABBE_NO_MEMORY.
 */
abbe_result abbe_spectral_map_read_ledger(const abbe_spectral_map *map, size_t light,
                                          abbe_ledger *out, abbe_error *error);

/* Waits for the device: X, Y, Z, W times `unit` a texel, as of abbe_renderer_read_map; faces of a
 * cube that share a layout add up. ABBE_NO_MEMORY. */
abbe_result abbe_spectral_map_read(const abbe_spectral_map *map, size_t light, double unit,
                                   abbe_image *out, abbe_error *error);

/* Texels of a map as it lies on the device, as a picture. */

/* X, Y, Z, W a texel, of flux over window area for unit power; texel: [side][side][4], rows
 * upwards. ABBE_NO_MEMORY. */
abbe_result abbe_map_picture_flux(const float *texel, size_t side, const abbe_map_layout *layout,
                                  double power, abbe_image *out, abbe_error *error);
/* R, G, B in Rec.709 as they are. */
abbe_result abbe_map_picture_colour(const float *texel, size_t side, abbe_image *out,
                                    abbe_error *error);

#endif
