/* rank_job.h: what a command knows where it is one of several processes, "ranks", that share its
 * work, as cli/mpi starts them. Internal to cli/. */
#ifndef ABBE_CLI_BASE_RANK_JOB_H
#define ABBE_CLI_BASE_RANK_JOB_H

#include "base/error.h"
#include "cli/base/command.h"
#include "validation/trace/tracer/ranked_run.h"

#include <stdbool.h>

typedef struct abbe_rank_job {
  abbe_ranks ranks;
  void (*ready)(void); /* called once the arguments are understood, before any of ranks' */
  bool alone;          /* receives: it failed where the others may go on, and wait for it in vain */
} abbe_rank_job;

/* Each of these takes NULL for one process alone. */

/* Whether it is a rank that leaves it to rank 0 to write and to say what came of it. */
bool abbe_rank_job_is_silent(const abbe_rank_job *job);
/* abbe_ranks_agree; own for one process. */
abbe_result abbe_rank_job_agree(const abbe_rank_job *job, abbe_result own, abbe_error *error);
/* abbe_command_end, but only one rank reports why all end. */
int abbe_rank_job_end(const abbe_rank_job *job, const char *program, abbe_result result,
                      abbe_error *error);

/* `abbe trace`, and the same by several processes, as cli/mpi starts them. */

/* Rank 0 alone writes and says what came of it. Gives the exit code. */
int abbe_trace_by_ranks(int argc, char **argv, abbe_rank_job *job);

#endif
