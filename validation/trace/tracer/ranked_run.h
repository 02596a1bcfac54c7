/* ranked_run.h: one trace by several processes, "ranks", each with a tracer of its own.
 *
 * Rank r of R traces the passes r, r + R, ...; their sums are added once, at the end. Those are
 * whole numbers, so any number of ranks gives the bits of one. How ranks speak to each other is the
 * caller's (cli/mpi).
 */
#ifndef ABBE_VALIDATION_TRACE_TRACER_RANKED_RUN_H
#define ABBE_VALIDATION_TRACE_TRACER_RANKED_RUN_H

#include "validation/trace/tracer/accumulator.h"
#include "validation/trace/tracer/trace_run.h"

/* Every rank calls each of these as often as the others, in the same order. */
typedef struct abbe_ranks {
  size_t rank, count; /* 0 to count - 1 */
  /* Adds up what all ranks have there, into rank 0's. */
  void (*sum)(abbe_whole_sum *values, size_t count);
  /* Gives all ranks what rank 0 has there. */
  void (*spread)(void *data, size_t size);
  /* The largest of the ranks' values, to all of them. */
  uint64_t (*most)(uint64_t value);
} abbe_ranks;

/* Whether all ranks can go on, each with a result of its own. If not, the first of those that
 * cannot has its own back, and all others ABBE_CANCELLED, which names it. */
abbe_result abbe_ranks_agree(const abbe_ranks *ranks, abbe_result own, abbe_error *error);

/* ABBE_INVALID_ARGUMENT, at every rank, unless all trace the same scene, request and instructions
 * (abbe_checkpoint_describe). */
abbe_result abbe_ranks_compare(const abbe_ranks *ranks, const abbe_tracer *tracer,
                               abbe_error *error);

/* At how many passes in all the error is looked at, the first such number above `passes`: 4, 5, 6,
 * 7, 8, 10, 12, 14, 16, 20, ..., whatever the number of ranks. */
size_t abbe_ranked_run_next_look(size_t passes);

/* Each rank's tracer has none of its passes, or the first of them. Then that of rank 0 has them
 * all: desc->passes (0: as many as it takes), or as many as are enough by the others.
 * - error: is looked at at abbe_ranked_run_next_look alone, so that where a trace ends does not
 *   depend on the number of ranks.
 * - seconds: rank 0's clock counts, once every rank has done a pass more.
 * - checkpoint: each rank's own file. progress is of this rank's passes.
 * ABBE_CANCELLED, at every rank, where one was stopped: each tracer has its own passes, and they
 * are in its checkpoint. Errors of abbe_tracer_pass and abbe_checkpoint_save come from one rank
 * alone: the caller ends the others. */
abbe_result abbe_ranked_run(const abbe_ranks *ranks, abbe_tracer *tracer,
                            const abbe_trace_run_desc *desc, abbe_error *error);

#endif
