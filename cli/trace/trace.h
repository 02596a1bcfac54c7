/* trace.h: `abbe trace`, and the same by several processes, as cli/mpi starts them.
 * Internal to cli/. */
#ifndef ABBE_CLI_TRACE_TRACE_H
#define ABBE_CLI_TRACE_TRACE_H

#include "cli/base/rank_job.h"

/* Rank 0 alone writes and says what came of it. Gives the exit code. */
int abbe_trace_by_ranks(int argc, char **argv, abbe_rank_job *job);

#endif
