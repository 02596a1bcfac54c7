/* spectral_map.h: where light lies that refractors have bent: X, Y, Z flux over window area, of
 * unit power of the light; a layer a light, and a layer of tiles for each that has any; summed in
 * whole units, in levels. Internal to gl/.
 */
#ifndef ABBE_GL_CAUSTICS_SPECTRAL_MAP_H
#define ABBE_GL_CAUSTICS_SPECTRAL_MAP_H

#include "colorimetry/image/image.h"
#include "gl/caustics/map_history.h"
#include "gl/device/statistics.h"
#include "gl/light/receiver_atlas.h"

#include <stdbool.h>
#include <stddef.h>

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
/* The light's sums to its layers' texels, in all levels, with the history's. */
void abbe_spectral_map_resolve(abbe_spectral_map *map, size_t light);
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

#endif
