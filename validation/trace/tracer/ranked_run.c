#include "validation/trace/tracer/ranked_run.h"

#include "base/clock.h"
#include "validation/trace/tracer/checkpoint.h"
#include "validation/trace/tracer/pass_sums.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

abbe_result abbe_ranks_agree(const abbe_ranks *r, abbe_result own, abbe_error *error) {
  assert(r->most);
  const uint64_t failed = own == ABBE_OK ? 0 : r->count - r->rank, worst = r->most(failed);
  if (failed == worst) return own;
  return abbe_error_set(error, ABBE_CANCELLED, "rank %zu cannot go on", r->count - (size_t)worst);
}

abbe_result abbe_ranks_compare(const abbe_ranks *r, const abbe_tracer *tracer, abbe_error *error) {
  assert(r->spread);
  char theirs[ABBE_CHECKPOINT_TEXT];
  abbe_checkpoint_describe(tracer, theirs);
  r->spread(theirs, sizeof theirs);
  return abbe_ranks_agree(r, abbe_checkpoint_compare(tracer, "rank 0's part", theirs, error),
                          error);
}

size_t abbe_ranked_run_next_look(size_t passes) {
  size_t step = 1;
  if (passes < 4) return 4;
  while (8 * step <= passes) step *= 2;
  return passes + step - passes % step;
}

/* ---- the work ---- */

typedef struct work {
  const abbe_ranks *ranks;
  abbe_tracer *tracer;
  const abbe_trace_run_desc *desc;
  double start, saved;
  double whole; /* passes that there will be, as far as is known */
} work;

/* How many of the passes below `end` are this rank's. */
static size_t share(const abbe_ranks *r, size_t end) {
  return end > r->rank ? (end - r->rank - 1) / r->count + 1 : 0;
}

static bool goes_on(const work *w) {
  const abbe_trace_run_desc *d = w->desc;
  if (d->progress == NULL) return d->stop == NULL || *d->stop == 0;
  const double all = w->whole / (double)w->ranks->count;
  double done = all > 0 ? (double)abbe_tracer_passes(w->tracer) / all : 0;
  if (d->seconds > 0) done = fmax(done, (abbe_clock_seconds() - w->start) / d->seconds);
  return d->progress(d->user, fmin(done, 1));
}

static abbe_result one_pass(work *w, abbe_error *error) {
  abbe_result result = abbe_tracer_pass(w->tracer, w->desc->stop, error);
  if (result == ABBE_OK && abbe_clock_seconds() - w->saved >= w->desc->checkpoint_s) {
    result = abbe_trace_keep(w->tracer, w->desc, error);
    w->saved = abbe_clock_seconds();
  }
  return result;
}

/* Whether a rank was stopped; then each has its passes on the disk, at once, for whoever stops them
 * may not wait long. */
static abbe_result meet(work *w, bool stopped, abbe_error *error) {
  abbe_result result = stopped ? abbe_trace_keep(w->tracer, w->desc, error) : ABBE_OK;
  if (result != ABBE_OK || w->ranks->most(stopped) == 0) return result;
  if (!stopped) result = abbe_trace_keep(w->tracer, w->desc, error);
  if (result != ABBE_OK) return result;
  return abbe_error_set(error, ABBE_CANCELLED,
                        "stopped; what each rank has done is saved, and the same command with "
                        "--resume goes on");
}

/* While the others go on, a rank that has done its share may be stopped for good. */
static abbe_result keep_share(work *w, abbe_error *error) {
  const double now = abbe_clock_seconds();
  if (w->desc->seconds > 0 || now - w->start < w->desc->checkpoint_s) return ABBE_OK;
  w->saved = now;
  return abbe_trace_keep(w->tracer, w->desc, error);
}

/* This rank's passes below `end`, then all meet. */
static abbe_result passes_below(work *w, size_t end, abbe_error *error) {
  const size_t own = share(w->ranks, end);
  bool stopped = false;
  while (!stopped && abbe_tracer_passes(w->tracer) < own) {
    stopped = !goes_on(w);
    const abbe_result result = stopped ? ABBE_OK : one_pass(w, error);
    stopped = stopped || result == ABBE_CANCELLED;
    if (result != ABBE_OK && !stopped) return result;
  }
  const abbe_result kept = stopped ? ABBE_OK : keep_share(w, error);
  return kept == ABBE_OK ? meet(w, stopped, error) : kept;
}

/* The sums of all ranks into rank 0's tracer, which then has the passes 0 to end - 1. */
static void put_together(const work *w, size_t end) {
  abbe_pass_counts c;
  abbe_pass_counts_get(w->tracer, &c);
  abbe_whole_sum rays[] = {c.photons, c.light_rays, c.eye_rays, c.cuts};
  w->ranks->sum(rays, sizeof rays / sizeof *rays);
  abbe_sum_span span[ABBE_PASS_SUMS_PARTS];
  abbe_pass_sums_spans(w->tracer, span);
  for (int i = 0; i < ABBE_PASS_SUMS_PARTS; i++)
    if (span[i].count > 0) w->ranks->sum(span[i].sum, span[i].count);
  if (w->ranks->rank > 0) return;
  abbe_pass_counts_set(w->tracer, &(abbe_pass_counts){.end = end,
                                                      .whole = c.whole,
                                                      .step = 1,
                                                      .photons = (uint64_t)rays[0],
                                                      .light_rays = (uint64_t)rays[1],
                                                      .eye_rays = (uint64_t)rays[2],
                                                      .cuts = (uint64_t)rays[3]});
}

/* ---- what a rank has alone, put aside while the whole is looked at ---- */

typedef struct aside {
  abbe_pass_counts counts;
  abbe_whole_sum *sum[ABBE_PASS_SUMS_PARTS];
} aside;

static void forget(aside *a) {
  for (int i = 0; i < ABBE_PASS_SUMS_PARTS; i++) free(a->sum[i]);
}

static abbe_result put_aside(abbe_tracer *t, aside *out, abbe_error *error) {
  abbe_sum_span span[ABBE_PASS_SUMS_PARTS];
  bool complete = true;
  *out = (aside){0};
  abbe_pass_counts_get(t, &out->counts);
  abbe_pass_sums_spans(t, span);
  for (int i = 0; i < ABBE_PASS_SUMS_PARTS && complete; i++) {
    const size_t size = span[i].count * sizeof *span[i].sum;
    out->sum[i] = malloc(size + 1);
    complete = out->sum[i] != NULL;
    if (complete && size > 0) memcpy(out->sum[i], span[i].sum, size);
  }
  if (complete) return ABBE_OK;
  forget(out);
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the sums of rank 0");
}

static void take_back(abbe_tracer *t, aside *a) {
  abbe_sum_span span[ABBE_PASS_SUMS_PARTS];
  abbe_pass_sums_spans(t, span);
  for (int i = 0; i < ABBE_PASS_SUMS_PARTS; i++)
    if (span[i].count > 0) memcpy(span[i].sum, a->sum[i], span[i].count * sizeof *span[i].sum);
  abbe_pass_counts_set(t, &a->counts);
  forget(a);
}

/* Whether the passes 0 to end - 1, which are done, are enough; rank 0 has them all then. */
static abbe_result look(work *w, size_t end, bool last, bool *enough, abbe_error *error) {
  const bool first = w->ranks->rank == 0;
  aside own;
  unsigned char ends = last;
  *enough = false;
  if (first && !last) {
    const abbe_result result = put_aside(w->tracer, &own, error);
    if (result != ABBE_OK) return result;
  }
  put_together(w, end);
  if (first && !last) {
    const double estimate = abbe_tracer_error(w->tracer);
    ends = estimate <= w->desc->error;
    w->whole = fmin(w->whole, (double)end * pow(estimate / w->desc->error, 2));
    if (ends)
      forget(&own);
    else
      take_back(w->tracer, &own);
  }
  w->ranks->spread(&ends, sizeof ends);
  *enough = ends != 0;
  return ABBE_OK;
}

/* ---- the ways to end ---- */

static bool time_is_up(const work *w, size_t done) {
  unsigned char up =
      w->desc->seconds > 0 && done >= 2 && abbe_clock_seconds() - w->start >= w->desc->seconds;
  w->ranks->spread(&up, sizeof up);
  return up != 0;
}

/* Behind the last pass that any rank has. */
static size_t begun(const work *w) {
  const size_t passes = abbe_tracer_passes(w->tracer);
  return (size_t)w->ranks->most(passes > 0 ? w->ranks->rank + (passes - 1) * w->ranks->count + 1
                                           : 0);
}

static size_t next_look(const work *w, size_t done, size_t most) {
  const size_t next = w->desc->error > 0 ? abbe_ranked_run_next_look(done) : most;
  return next < most ? next : most;
}

/* From round to round: where time counts, a pass of each rank; up to the next look at the error, or
 * to the end. What is taken up lies before the end of the first round. */
static abbe_result run_rounds(work *w, size_t most, abbe_error *error) {
  const bool timed = w->desc->seconds > 0;
  const size_t count = w->ranks->count, taken_up = begun(w);
  if (taken_up > most)
    return abbe_ranks_agree(
        w->ranks,
        abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                       "a rank's checkpoint holds pass %zu, beyond the %zu that are asked for: ask "
                       "for as many, or start anew without --resume",
                       taken_up - 1, most),
        error);
  size_t done = taken_up > 0 ? (taken_up - 1) / count * count : 0, next = next_look(w, 0, most);
  while (next < taken_up) next = next_look(w, next, most);
  for (;;) {
    const size_t end = timed && done + count < next ? done + count : next;
    abbe_result result = passes_below(w, end, error);
    if (result != ABBE_OK) return result;
    done = end;
    const bool last = time_is_up(w, done) || done == most;
    if (!last && done < next) continue;
    bool enough;
    result = look(w, done, last, &enough, error);
    if (result != ABBE_OK || enough) return result;
    next = next_look(w, done, most);
  }
}

abbe_result abbe_ranked_run(const abbe_ranks *ranks, abbe_tracer *tracer,
                            const abbe_trace_run_desc *desc, abbe_error *error) {
  assert(ranks->sum && ranks->most);
  const double now = abbe_clock_seconds();
  tracer->whole = desc->whole;
  const size_t most = desc->passes > 0 ? desc->passes : ABBE_WHOLE_SUM_MOST_PASSES;
  work w = {ranks, tracer, desc, now, now, (double)most};
  return run_rounds(&w, most, error);
}
