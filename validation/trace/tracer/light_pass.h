/* light_pass.h: the photons of a pass, from the lights to the map, the picture and the camera's
 * gathers.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRACER_LIGHT_PASS_H
#define ABBE_VALIDATION_TRACE_TRACER_LIGHT_PASS_H

#include "scenes/view/map_layout.h"
#include "validation/trace/tracer/tracer_state.h"

#include <stddef.h>
#include <stdint.h>

/* Rays of the walks of all threads, trials too. */
uint64_t abbe_tracer_walk_rays(const abbe_tracer *tracer);

/* The photons of the pass; hits go to the map, to the picture, and to tracer->landed. */
abbe_result abbe_tracer_light_pass(abbe_tracer *tracer, const volatile int *stop,
                                   size_t *landed_count, abbe_error *error);
/* Photons of a pass shared out over the lights by the light that they send to refractors. */
abbe_result abbe_tracer_share_photons(abbe_tracer *tracer, abbe_error *error);
/* Chooses where paths are split, by a trial of each light's. */
abbe_result abbe_tracer_choose_splits(abbe_tracer *tracer, abbe_error *error);
/* Photons into the map of their light, if that is the one that is made. */
void abbe_tracer_add_to_map(abbe_tracer *tracer, size_t thread, size_t light,
                            const abbe_photon_hit *hit, size_t count);

/* The texels of a receiver map that places fall in, sixteen side by side.
 *
 * The arithmetic of abbe_map_layout_texel, step by step: the texels are the same ones. */

#define ABBE_MAP_TEXELS_LANES 16
#define ABBE_MAP_TEXELS_NONE SIZE_MAX

typedef struct abbe_map_texels {
  __attribute__((aligned(64))) double p[3][ABBE_MAP_TEXELS_LANES]; /* in: world */
  size_t at[ABBE_MAP_TEXELS_LANES]; /* out: row (0 at the top) x width + column, or
                                       ABBE_MAP_TEXELS_NONE: the map does not hold the place */
} abbe_map_texels;

/* Finds the texels of all lanes, which hold any numbers. */
void abbe_map_texels_find(const abbe_map_layout *layout, size_t width, size_t height,
                          abbe_map_texels *texels);

#endif
