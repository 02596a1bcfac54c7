/* ranked_sweep.h: one sweep (sweep/sweep_run.h) by several processes, "ranks"
 * (tracer/ranked_run.h): rank 0 traces the references, then each rank measures settings of its own
 * into a table of its own, and rank 0 makes one of them. A rank that is killed costs the row that
 * it was at.
 *
 * Errors of rows are those of one process; times are each rank's own, so ranks belong on machines
 * that are alike and have nothing else to do.
 */
#ifndef ABBE_VALIDATION_SWEEP_RANKS_RANKED_SWEEP_H
#define ABBE_VALIDATION_SWEEP_RANKS_RANKED_SWEEP_H

#include "validation/sweep/sweep_run.h"
#include "validation/tracer/ranked_run.h"

/* Every rank calls it alike. Rows of the table, and of tables that ranks left beside it
 * (ranks/rank_files.h), are not measured again, whatever number of ranks there was. out: the whole
 * table at rank 0, rows that are new in the settings' order, saved, and the ranks' removed; an
 * empty one at the others. ABBE_CANCELLED, at all ranks but those that failed, where one was
 * stopped or failed: what is done is kept. request has neither trace_only nor run. Errors of
 * abbe_sweep_run. */
abbe_result abbe_ranked_sweep(const abbe_ranks *ranks, abbe_context *context,
                              const abbe_scene *scene, const abbe_sweep_request *request,
                              abbe_sweep_table *out, abbe_error *error);

#endif
