/* render.h: `abbe render`, and its frames by several processes, as cli/mpi starts them.
 * Internal to cli/. */
#ifndef ABBE_CLI_RENDER_RENDER_H
#define ABBE_CLI_RENDER_RENDER_H

#include "cli/base/rank_job.h"

/* --turntable or --frames A:B: each rank draws frames of its own, rank 0 makes the PNG that moves.
 * Gives the exit code. */
int abbe_render_by_ranks(int argc, char **argv, abbe_rank_job *job);

#endif
