/* emission.h: the photons that a light sends to the refractors in one pass: how many each cell of
 * its projection map gets, and where, whereto and at which wavelength each of them starts.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRACER_EMISSION_H
#define ABBE_VALIDATION_TRACE_TRACER_EMISSION_H

#include "validation/trace/tracer/tracer_state.h"

/* Cell after cell: cell i has the photons from first[i] on. */
typedef struct abbe_emission {
  const abbe_tracer *t;
  size_t light, count;
  uint32_t *first; /* [cells + 1] */
  uint32_t pass, seed;
} abbe_emission;

/* `count` photons of the light, shared out over the cells; none where it reaches no refractor. */
abbe_result abbe_emission_make(const abbe_tracer *t, size_t light, size_t count, uint32_t pass,
                               uint32_t seed, abbe_emission *e, abbe_error *error);
void abbe_emission_free(abbe_emission *e);

/* Photons [from, to), at most ABBE_LIGHT_WALK_BATCH of them; how many those are. */
size_t abbe_emission_batch(const abbe_emission *e, uint32_t from, uint32_t to, abbe_photon *photon);

/* Finds out whether paths are polarised; then lights and the picture are dimmed by polarisers, each
 * of which passes half. ABBE_INVALID_ARGUMENT with matched physics. */
abbe_result abbe_tracer_polarise(abbe_tracer *t, abbe_error *error);

#endif
