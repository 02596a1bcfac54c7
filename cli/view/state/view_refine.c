#include "cli/view/state/view_refine.h"

#include <math.h>

const char *abbe_view_stage_name(abbe_view_stage stage) {
  static const char *const names[] = {
#define ABBE_VIEW_NAME(code, name) name,
      ABBE_VIEW_STAGES(ABBE_VIEW_NAME)
#undef ABBE_VIEW_NAME
  };
  return stage < ABBE_VIEW_STAGE_COUNT ? names[stage] : "unknown";
}

void abbe_view_refine_begin(abbe_view_refine *refine) {
  *refine = (abbe_view_refine){.serial = 1, .changed_s = -INFINITY};
}

void abbe_view_refine_change(abbe_view_refine *refine, abbe_view_change change, double now_s) {
  refine->camera_only =
      change == ABBE_VIEW_MOVED_CAMERA && (refine->camera_only || refine->shown == refine->serial);
  if (change == ABBE_VIEW_CHANGED_SCENE) {
    refine->light = ABBE_VIEW_NONE;
    refine->compiled = false;
  }
  refine->serial++;
  refine->changed_s = now_s;
  refine->stage = ABBE_VIEW_NONE;
  refine->passes = 0;
  refine->refused = false;
}

void abbe_view_refine_hold(abbe_view_refine *refine, bool held, double now_s) {
  if (refine->held && !held) refine->changed_s = now_s;
  refine->held = held;
}

static bool rests(const abbe_view_refine *refine, double now_s) {
  return !refine->held && now_s - refine->changed_s >= ABBE_VIEW_REST_S;
}

static abbe_view_stage last_of(const abbe_view_refine *refine) {
  return refine->last == ABBE_VIEW_NONE ? ABBE_VIEW_TRACED : refine->last;
}

static abbe_view_stage stage_after(const abbe_view_refine *refine) {
  const bool traces = refine->stage == ABBE_VIEW_TRACED && refine->passes < ABBE_VIEW_TRACED_PASSES;
  if (traces) return ABBE_VIEW_TRACED;
  if (refine->stage == ABBE_VIEW_ACCURATE &&
      (refine->single || (refine->spectrum && last_of(refine) == ABBE_VIEW_TRACED)))
    return ABBE_VIEW_TRACED;
  return refine->stage == ABBE_VIEW_TRACED ? ABBE_VIEW_NONE : (abbe_view_stage)(refine->stage + 1);
}

bool abbe_view_refine_next(const abbe_view_refine *refine, double now_s, abbe_view_job *out) {
  abbe_view_job job = {.serial = refine->serial, .pass = refine->passes};
  const bool resting = rests(refine, now_s);
  if (refine->refused) return false;
  job.stage = stage_after(refine);
  if (job.stage == ABBE_VIEW_NONE || job.stage > last_of(refine)) return false;
  if (job.stage > ABBE_VIEW_MOVING && (!resting || refine->compiling)) return false;
  /* what rests before it was drawn once is drawn well at once, if there is light for it */
  if (job.stage == ABBE_VIEW_MOVING && resting && refine->light >= ABBE_VIEW_BALANCED &&
      last_of(refine) >= ABBE_VIEW_BALANCED)
    job.stage = refine->compiling ? ABBE_VIEW_MOVING : ABBE_VIEW_BALANCED;
  job.compiles = job.stage == ABBE_VIEW_MOVING || refine->compiled || !refine->ahead;
  job.light = job.stage > ABBE_VIEW_ACCURATE ? ABBE_VIEW_ACCURATE : job.stage;
  job.light_step = refine->pace.light_step;
  if (job.stage == ABBE_VIEW_MOVING) job.eye_step = refine->pace.eye_step;
  if (refine->light >= job.light) { /* better light is there */
    job.light = refine->light;
    job.light_step = refine->drawn_light_step;
  }
  if (job.light != ABBE_VIEW_MOVING) job.light_step = 0;
  *out = job;
  return true;
}

double abbe_view_refine_wait(const abbe_view_refine *refine, double now_s) {
  abbe_view_job job;
  if (abbe_view_refine_next(refine, now_s, &job)) return 0;
  if (refine->refused || refine->held || refine->compiling) return -1;
  const double left = refine->changed_s + ABBE_VIEW_REST_S - now_s;
  return left > 0 ? left : -1;
}

bool abbe_view_refine_cancels(const abbe_view_refine *refine, const abbe_view_job *job) {
  if (job->stage <= ABBE_VIEW_MOVING) return false;
  if (job->serial != refine->serial) return true;
  return refine->spectrum && job->stage == ABBE_VIEW_MEAN && last_of(refine) == ABBE_VIEW_TRACED;
}

void abbe_view_refine_compiled(abbe_view_refine *refine, bool ahead) {
  refine->compiling = false;
  refine->compiled = true;
  refine->ahead = ahead;
}

void abbe_view_refine_end(abbe_view_refine *refine, const abbe_view_job *job,
                          abbe_view_outcome outcome, double ms, double now_s) {
  (void)now_s;
  const bool lit = refine->light != job->light || refine->drawn_light_step != job->light_step;
  if (outcome == ABBE_VIEW_REFUSED && job->serial == refine->serial) refine->refused = true;
  if (outcome == ABBE_VIEW_UNCOMPILED && job->serial == refine->serial) refine->compiling = true;
  /* what the renderer had it has given up for the light that did not come */
  if (outcome == ABBE_VIEW_UNCOMPILED || (lit && outcome == ABBE_VIEW_CANCELLED))
    refine->light = ABBE_VIEW_NONE;
  if (outcome != ABBE_VIEW_DONE) return;
  if (job->stage == ABBE_VIEW_MOVING)
    abbe_view_pace_take(&refine->pace, job->light_step, job->eye_step, lit, ms);
  /* light that was drawn for an older state of the scene is no light for this one, unless only the
   * camera has moved since */
  const bool current = job->serial == refine->serial;
  refine->shown = job->serial;
  if (current || refine->camera_only) {
    refine->light = job->light;
    refine->drawn_light_step = job->light_step;
  }
  if (!current) return;
  refine->camera_only = false;
  refine->stage = job->stage;
  if (job->stage > ABBE_VIEW_MOVING) refine->compiled = false;
  if (job->stage == ABBE_VIEW_TRACED) refine->passes = job->pass + 1;
}
