/* sweep.h: `abbe sweep`, and one sweep by several processes, as cli/mpi starts them.
 * Internal to cli/. */
#ifndef ABBE_CLI_SWEEP_SWEEP_H
#define ABBE_CLI_SWEEP_SWEEP_H

#include "cli/base/rank_job.h"

/* Each rank measures rows of its own (validation/sweep/ranks); rank 0 writes the table and shows
 * it. Gives the exit code. */
int abbe_sweep_by_ranks(int argc, char **argv, abbe_rank_job *job);

#endif
