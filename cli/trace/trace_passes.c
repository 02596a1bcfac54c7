#include "cli/trace/trace_request.h"

#include "cli/base/progress.h"

#include "validation/trace/tracer/checkpoint.h"

#include <unistd.h>

abbe_result abbe_trace_passes(const abbe_trace_request *q, const abbe_trace_run_desc *run,
                              abbe_tracer *tracer, abbe_error *error) {
  abbe_progress progress;
  abbe_trace_run_desc own = *run;
  own.progress = abbe_progress_update;
  own.user = &progress;
  own.stop = abbe_progress_stopped();
  abbe_progress_begin(&progress, "trace", q->quiet);
  abbe_result result = q->ranks != NULL ? abbe_ranked_run(q->ranks, tracer, &own, error)
                                        : abbe_trace_run(tracer, &own, error);
  abbe_progress_end(&progress);
  return result;
}

/* A rank's own passes, which it may have begun with as many ranks as there are now. */
static abbe_result resume_rank(const abbe_trace_request *q, abbe_tracer *tracer,
                               abbe_error *error) {
  const abbe_ranks *r = q->ranks;
  if (!q->work.resume || q->checkpoint_path == NULL || access(q->checkpoint_path, F_OK) != 0)
    return abbe_tracer_begin_at(tracer, r->rank, r->count, error);
  abbe_result result = abbe_checkpoint_load(tracer, q->checkpoint_path, error);
  if (result != ABBE_OK) return result;
  const size_t first = abbe_tracer_first_pass(tracer), step = abbe_tracer_step(tracer);
  if (first == r->rank && step == r->count) return ABBE_OK;
  return abbe_error_set(
      error, ABBE_INVALID_ARGUMENT,
      "%s holds pass %zu and each %zu behind it, the part of one of %zu ranks, and "
      "there are %zu: run as many, or start anew without --resume",
      q->checkpoint_path, first, step, step, r->count);
}

/* All ranks end alike, unless one fails alone. The files go once the results are there. */
static abbe_result trace_ranks(abbe_trace_request *q, abbe_tracer *tracer, abbe_error *error) {
  const abbe_trace_run_desc run = {.passes = q->passes,
                                   .whole = q->whole,
                                   .seconds = q->seconds,
                                   .error = q->until,
                                   .checkpoint = q->checkpoint_path,
                                   .checkpoint_s = q->work.every_s};
  abbe_result result = abbe_trace_passes(q, &run, tracer, error);
  if (result != ABBE_OK) return result;
  if (q->ranks->rank == 0) {
    result = abbe_trace_write(q, tracer, error);
    if (result == ABBE_OK && q->checkpoint != NULL)
      result = abbe_checkpoint_save(tracer, q->checkpoint, error);
    if (result == ABBE_OK) abbe_trace_summarise(q, tracer);
  }
  result = abbe_ranks_agree(q->ranks, result, error);
  if (result == ABBE_OK && q->checkpoint_path != NULL) unlink(q->checkpoint_path);
  return result;
}

abbe_result abbe_trace_together(abbe_trace_request *q, abbe_result made, abbe_tracer *tracer,
                                abbe_error *error) {
  abbe_result result = made == ABBE_OK ? resume_rank(q, tracer, error) : made;
  result = abbe_ranks_agree(q->ranks, result, error);
  if (result == ABBE_OK) result = abbe_ranks_compare(q->ranks, tracer, error);
  if (result == ABBE_OK) result = trace_ranks(q, tracer, error);
  return result;
}
