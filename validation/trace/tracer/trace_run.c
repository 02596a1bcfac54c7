#include "validation/trace/tracer/trace_run.h"

#include "base/clock.h"
#include "validation/trace/tracer/checkpoint.h"
#include "validation/trace/tracer/tracer_state.h"

#include <math.h>
#include <time.h>

/* How far the run is by what ends it first. Errors fall as one over the root of the passes. */
static double progress_made(const abbe_trace_run_desc *d, size_t passes, double spent,
                            double error) {
  double done = d->passes > 0 ? (double)passes / (double)d->passes : 0;
  if (d->seconds > 0) done = fmax(done, spent / d->seconds);
  if (d->error > 0 && isfinite(error)) done = fmax(done, pow(d->error / error, 2));
  return fmin(done, 1);
}

static bool is_finished(const abbe_trace_run_desc *d, size_t passes, double spent, double error) {
  if (d->passes > 0 && passes >= d->passes) return true;
  if (d->seconds > 0 && spent >= d->seconds && passes >= 2) return true;
  return d->error > 0 && passes >= 4 && error <= d->error;
}

abbe_result abbe_trace_keep(const abbe_tracer *tracer, const abbe_trace_run_desc *d,
                            abbe_error *error) {
  if (d->checkpoint == NULL || abbe_tracer_passes(tracer) == 0) return ABBE_OK;
  return abbe_checkpoint_save(tracer, d->checkpoint, error);
}

abbe_result abbe_trace_run(abbe_tracer *tracer, const abbe_trace_run_desc *d, abbe_error *error) {
  double start = abbe_clock_seconds(), saved = start, estimate = INFINITY;
  tracer->whole = d->whole;
  for (;;) {
    size_t passes = abbe_tracer_passes(tracer);
    double spent = abbe_clock_seconds() - start;
    if (d->error > 0) estimate = abbe_tracer_error(tracer);
    bool goes_on =
        d->progress == NULL || d->progress(d->user, progress_made(d, passes, spent, estimate));
    if (is_finished(d, passes, spent, estimate)) return ABBE_OK;
    if (!goes_on && d->passes > 0)
      return abbe_error_set(error, ABBE_CANCELLED, "stopped after %zu of %zu passes", passes,
                            d->passes);
    if (!goes_on) return abbe_error_set(error, ABBE_CANCELLED, "stopped after %zu passes", passes);
    abbe_result result = abbe_tracer_pass(tracer, d->stop, error);
    if (result == ABBE_OK && abbe_clock_seconds() - saved >= d->checkpoint_s) {
      result = abbe_trace_keep(tracer, d, error);
      saved = abbe_clock_seconds();
    }
    if (result != ABBE_OK) return result;
  }
}
