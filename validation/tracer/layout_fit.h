/* layout_fit.h: the layout of a receiver map for which none is given: as large as where a trial's
 * photons land.
 *
 * Internal to validation/: it is not installed.
 */
#ifndef ABBE_VALIDATION_TRACER_LAYOUT_FIT_H
#define ABBE_VALIDATION_TRACER_LAYOUT_FIT_H

#include "validation/tracer/tracer_state.h"

/* A view from the map's light around where its light lands, into t->layout. */
abbe_result abbe_tracer_fit_layout(abbe_tracer *t, abbe_error *error);

#endif
