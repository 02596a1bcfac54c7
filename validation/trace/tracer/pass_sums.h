/* pass_sums.h: which passes a tracer holds, and what it has summed over them, as whole numbers
 * alone: so they can be written to a file, and added to those of other passes.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRACER_PASS_SUMS_H
#define ABBE_VALIDATION_TRACE_TRACER_PASS_SUMS_H

#include "validation/trace/tracer/tracer_state.h"

typedef struct abbe_pass_counts {
  uint64_t first, end, step; /* passes first, first + step, ... below end */
  uint64_t whole;            /* passes that there are to be, of all parts; 0: not stated */
  uint64_t photons, light_rays, eye_rays, cuts;
} abbe_pass_counts;

/* Ledger; sums and squares of the picture; guides; sums and squares of the map. */
enum { ABBE_PASS_SUMS_PARTS = 6 };
typedef struct abbe_sum_span {
  abbe_whole_sum *sum;
  size_t count; /* may be 0 */
} abbe_sum_span;

void abbe_pass_sums_spans(abbe_tracer *tracer, abbe_sum_span out[ABBE_PASS_SUMS_PARTS]);

void abbe_pass_counts_get(const abbe_tracer *tracer, abbe_pass_counts *out);
void abbe_pass_counts_set(abbe_tracer *tracer, const abbe_pass_counts *counts);

/* Whether there are such passes: from 0 on, ascending, no more than there can be. */
bool abbe_pass_counts_hold(const abbe_pass_counts *counts);
size_t abbe_pass_counts_passes(const abbe_pass_counts *counts);

/* Whether so many passes can have summed that much; then sums of all passes there can be do not
 * overflow. */
bool abbe_pass_sums_hold(abbe_whole_sum sum, size_t passes);

/* No passes, and sums of 0. */
void abbe_pass_sums_clear(abbe_tracer *tracer);

#endif
