#include "cli/base/command.h"
#include "cli/base/output.h"
#include "cli/base/rank_job.h"

#include "colorimetry/image/display_ocio.h"

#include <argp.h>
#include <mpi.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#ifndef ABBE_VERSION
#error "the build defines ABBE_VERSION"
#endif

const char *argp_program_version = "abbe-mpi " ABBE_VERSION;

/* Sums at once: 16 MB. */
enum { BLOCK = 1 << 20 };

static MPI_Datatype sum_type;
static MPI_Op sum_op;
static int own_rank;
static bool is_ready, has_failed;

static void add(void *more, void *to, int *count, MPI_Datatype *type) {
  const abbe_whole_sum *a = more;
  abbe_whole_sum *b = to;
  (void)type;
  for (int i = 0; i < *count; i++) b[i] += a[i];
}

static void sum(abbe_whole_sum *values, size_t count) {
  for (size_t at = 0; at < count; at += BLOCK) {
    const int block = (int)(count - at < BLOCK ? count - at : BLOCK);
    MPI_Reduce(own_rank == 0 ? MPI_IN_PLACE : values + at, values + at, block, sum_type, sum_op, 0,
               MPI_COMM_WORLD);
  }
}

static void spread(void *data, size_t size) {
  MPI_Bcast(data, (int)size, MPI_BYTE, 0, MPI_COMM_WORLD);
}

static uint64_t most(uint64_t value) {
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_UINT64_T, MPI_MAX, MPI_COMM_WORLD);
  return value;
}

/* Wrong use, and help, are answered by rank 0 alone: the others wait until it has understood its
 * arguments, which are theirs too. */
static void tell_ready(bool ready) {
  unsigned char is = ready;
  spread(&is, 1);
  is_ready = is != 0;
}

static void ready(void) {
  if (own_rank == 0) tell_ready(true);
}

static void end_all(void) {
  if (own_rank == 0 && !is_ready) tell_ready(false);
  if (!has_failed) MPI_Finalize();
  if (own_rank == 0 && abbe_command_output_failed()) _exit(ABBE_EXIT_FAILED);
}

static void say(const char *message) {
  fputs(message, stderr);
}

static int help(FILE *to) {
  if (own_rank == 0)
    fputs("abbe-mpi " ABBE_VERSION
          ": a trace by the ranks of an MPI job, which share its passes\n\n"
          "usage: mpirun abbe-mpi trace [OPTION…] FILE\n\n"
          "Options are those of abbe trace.\n\n"
          "  mpirun -n 4 abbe-mpi trace scenes/gem.yaml -o gem.exr --spp 256 --resume\n\n"
          "Exit codes: 0 done, 1 failed, 2 used wrongly.\n",
          to);
  return to == stdout ? ABBE_EXIT_DONE : ABBE_EXIT_USAGE;
}

static int run(int argc, char **argv) {
  int count;
  MPI_Comm_size(MPI_COMM_WORLD, &count);
  MPI_Type_contiguous(sizeof(abbe_whole_sum), MPI_BYTE, &sum_type);
  MPI_Type_commit(&sum_type);
  MPI_Op_create(add, 1, &sum_op);
  abbe_rank_job job = {.ranks = {(size_t)own_rank, (size_t)count, sum, spread, most},
                       .ready = ready};
  if (own_rank > 0) tell_ready(true);
  if (!is_ready && own_rank > 0) return ABBE_EXIT_USAGE;
  argv[1] = (char[]){"abbe-mpi trace"};
  const int code = abbe_trace_by_ranks(argc - 1, argv + 1, &job);
  if (job.alone && count > 1) {
    has_failed = true;
    fflush(NULL);
    MPI_Abort(MPI_COMM_WORLD, code);
  }
  MPI_Op_free(&sum_op);
  MPI_Type_free(&sum_type);
  return code;
}

int main(int argc, char **argv) {
  int threads;
  abbe_output_begin();
  abbe_display_set_log(say);
  argp_err_exit_status = ABBE_EXIT_USAGE;
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &threads);
  MPI_Comm_rank(MPI_COMM_WORLD, &own_rank);
  is_ready = true; /* unless there is work, all answer alike */
  atexit(end_all);
  if (argc == 2 && strcmp(argv[1], "--version") == 0)
    return own_rank == 0 && printf("%s\n", argp_program_version) < 0;
  if (argc == 2 && strcmp(argv[1], "--help") == 0) return help(stdout);
  if (argc < 2 || strcmp(argv[1], "trace") != 0) return help(stderr);
  is_ready = false;
  return run(argc, argv);
}
