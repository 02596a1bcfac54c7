/* light_pass.h: the photons of a pass, from the lights to the map, the picture and the camera's
 * gathers.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACER_LIGHT_PASS_H
#define ABBE_VALIDATION_TRACER_LIGHT_PASS_H

#include "validation/tracer/tracer_state.h"

/* Rays of the walks of all threads, trials too. */
uint64_t abbe_tracer_walk_rays(const abbe_tracer *tracer);

/* The photons of the pass; what lands goes to the map, to the picture, and to tracer->landed. */
abbe_result abbe_tracer_light_pass(abbe_tracer *tracer, const volatile int *stop,
                                   size_t *landed_count, abbe_error *error);
/* Photons of a pass shared out over the lights by the light that they send to refractors. */
abbe_result abbe_tracer_share_photons(abbe_tracer *tracer, abbe_error *error);
/* Chooses where paths are split, by a trial of each light's. */
abbe_result abbe_tracer_choose_splits(abbe_tracer *tracer, abbe_error *error);
/* Photons into the map of their light, if that is the one that is made. */
void abbe_tracer_add_to_map(abbe_tracer *tracer, size_t thread, size_t light,
                            const abbe_photon_hit *hit, size_t count);

#endif
