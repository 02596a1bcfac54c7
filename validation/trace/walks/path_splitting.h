/* path_splitting.h: at which of their first interfaces the paths of photons should be split.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_WALKS_PATH_SPLITTING_H
#define ABBE_VALIDATION_TRACE_WALKS_PATH_SPLITTING_H

#include "validation/trace/walks/photon.h"

#include <stddef.h>

/* The interfaces to split at (bit 0: the first), by the hits of a trial without: those that make
 * the least of the mean square of a hit's light, times the number of rays. */
unsigned abbe_path_splitting_best(const abbe_photon_hit *hit, size_t count);

#endif
