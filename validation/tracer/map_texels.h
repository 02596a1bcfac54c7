/* map_texels.h: the texels of a receiver map that places fall in, sixteen side by side.
 *
 * The arithmetic of abbe_map_layout_texel, step by step: the texels are the same ones.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACER_MAP_TEXELS_H
#define ABBE_VALIDATION_TRACER_MAP_TEXELS_H

#include "scenes/view/map_layout.h"

#include <stddef.h>
#include <stdint.h>

#define ABBE_MAP_TEXELS_LANES 16
#define ABBE_MAP_TEXELS_NONE SIZE_MAX

typedef struct abbe_map_texels {
  __attribute__((aligned(64))) double p[3][ABBE_MAP_TEXELS_LANES]; /* in: world */
  size_t at[ABBE_MAP_TEXELS_LANES]; /* out: row (0 at the top) x width + column, or
                                       ABBE_MAP_TEXELS_NONE: the map does not hold the place */
} abbe_map_texels;

/* Of all lanes, which hold any numbers. */
void abbe_map_texels_find(const abbe_map_layout *layout, size_t width, size_t height,
                          abbe_map_texels *texels);

#endif
