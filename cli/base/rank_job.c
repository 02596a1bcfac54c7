#include "cli/base/rank_job.h"

bool abbe_rank_job_is_silent(const abbe_rank_job *job) {
  return job != NULL && job->ranks.rank > 0;
}

abbe_result abbe_rank_job_agree(const abbe_rank_job *job, abbe_result own, abbe_error *error) {
  return job == NULL ? own : abbe_ranks_agree(&job->ranks, own, error);
}

int abbe_rank_job_end(const abbe_rank_job *job, const char *program, abbe_result result,
                      abbe_error *error) {
  if (abbe_rank_job_is_silent(job) && result == ABBE_CANCELLED) return ABBE_EXIT_FAILED;
  return abbe_command_end(program, result, error);
}
