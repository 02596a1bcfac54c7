/* trace.h: `abbe trace`, and the same by several processes, as cli/mpi starts them. */
#ifndef ABBE_CLI_TRACE_TRACE_H
#define ABBE_CLI_TRACE_TRACE_H

#include "validation/tracer/ranked_run.h"

#include <stdbool.h>

typedef struct abbe_trace_ranks {
  abbe_ranks ranks;
  void (*ready)(void); /* called once the arguments are understood, before any of ranks' */
  bool alone;          /* receives: it failed where the others may go on, and wait for it in vain */
} abbe_trace_ranks;

/* Rank 0 alone writes and says what came of it. Gives the exit code. */
int abbe_trace_by_ranks(int argc, char **argv, abbe_trace_ranks *ranks);

#endif
