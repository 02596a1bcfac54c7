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
  *refine = (abbe_view_refine){.serial = 1, .scene = 1, .changed_s = -INFINITY};
}

void abbe_view_refine_forget(abbe_view_refine *refine, size_t worker) {
  abbe_view_hand *hand = &refine->hand[worker];
  hand->light = hand->rests = ABBE_VIEW_NONE;
}

void abbe_view_refine_change(abbe_view_refine *refine, abbe_view_change change, double now_s) {
  refine->serial++;
  if (change != ABBE_VIEW_MOVED_CAMERA) refine->scene = refine->serial;
  for (size_t i = 0; i < ABBE_VIEW_WORKERS && change != ABBE_VIEW_MOVED_CAMERA; i++) {
    abbe_view_refine_forget(refine, i);
    if (change != ABBE_VIEW_CHANGED_SCENE) continue;
    refine->hand[i].ready = 0;
    refine->hand[i].moved = ABBE_VIEW_NONE;
  }
  if (change == ABBE_VIEW_CHANGED_SCENE) refine->pace.lights = 0;
  refine->changed_s = now_s;
  refine->stage = ABBE_VIEW_NONE;
  refine->passes = 0;
  refine->refused = false;
}

void abbe_view_refine_hold(abbe_view_refine *refine, bool held, double now_s) {
  if (refine->held && !held) refine->changed_s = now_s;
  refine->held = held;
}

/* ---- which job ---- */

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

/* Whether it knows the programs of what moves in such light. */
static bool is_ready(const abbe_view_hand *hand, abbe_view_stage light) {
  return (hand->ready >> light & 1) != 0;
}

/* A job of a stage, with light that is there or the stage's own. */
static abbe_view_job job_of(const abbe_view_refine *refine, size_t worker, abbe_view_stage stage) {
  const abbe_view_hand *hand = &refine->hand[worker];
  abbe_view_job job = {.stage = stage, .serial = refine->serial, .pass = refine->passes};
  job.light = stage > ABBE_VIEW_ACCURATE ? ABBE_VIEW_ACCURATE : stage;
  job.light_step = refine->pace.light_step;
  if (hand->light >= job.light) { /* better light is there */
    job.light = hand->light;
    job.light_step = hand->light_step;
  }
  if (job.light != ABBE_VIEW_MOVING) job.light_step = 0;
  if (stage == ABBE_VIEW_MOVING) job.eye_step = refine->pace.eye_step;
  return job;
}

/* What the worker that shows may draw at rest: no light, and what it has drawn before. */
static abbe_view_stage stage_at_hand(const abbe_view_refine *refine) {
  const abbe_view_hand *hand = &refine->hand[refine->shows];
  return hand->light >= ABBE_VIEW_BALANCED && hand->rests == hand->light &&
                 hand->rests <= last_of(refine) && refine->stage < hand->rests
             ? hand->rests
             : ABBE_VIEW_NONE;
}

/* The other worker, which has shown until now, draws the change as it moves. */
static bool is_being_shown(const abbe_view_refine *refine) {
  const abbe_view_hand *other = &refine->hand[1 - refine->shows];
  return other->busy && other->job.stage == ABBE_VIEW_MOVING && !other->job.warms &&
         other->job.serial == refine->serial;
}

/* A change is seen as it moves first, however late: a stage takes longer. */
static bool next_shown(const abbe_view_refine *refine, bool resting, abbe_view_job *out) {
  const bool seen = refine->stage != ABBE_VIEW_NONE;
  const abbe_view_stage at_rest = resting && seen ? stage_at_hand(refine) : ABBE_VIEW_NONE;
  if (at_rest == ABBE_VIEW_NONE && (seen || is_being_shown(refine))) return false;
  *out = job_of(refine, refine->shows, at_rest != ABBE_VIEW_NONE ? at_rest : ABBE_VIEW_MOVING);
  return true;
}

static bool next_beside(const abbe_view_refine *refine, size_t worker, abbe_view_job *out) {
  const abbe_view_hand *hand = &refine->hand[worker];
  const abbe_view_stage light = refine->hand[refine->shows].light;
  const abbe_view_stage stage = stage_after(refine);
  if (refine->stage == ABBE_VIEW_NONE || last_of(refine) == ABBE_VIEW_MOVING) return false;
  const bool drafts = is_ready(hand, ABBE_VIEW_MOVING);
  if (!drafts || (hand->light > light && !is_ready(hand, hand->light))) {
    *out = job_of(refine, worker, ABBE_VIEW_MOVING);
    out->warms = true;
    if (!drafts) out->light = ABBE_VIEW_MOVING;
    return true;
  }
  if (stage == ABBE_VIEW_NONE || stage > last_of(refine)) return false;
  if (stage_at_hand(refine) != ABBE_VIEW_NONE) return false;
  *out = job_of(refine, worker, stage);
  return true;
}

bool abbe_view_refine_next(const abbe_view_refine *refine, size_t worker, double now_s,
                           abbe_view_job *out) {
  const bool resting = rests(refine, now_s);
  if (refine->refused) return false;
  if (worker == refine->shows) return next_shown(refine, resting, out);
  return resting && next_beside(refine, worker, out);
}

void abbe_view_refine_take(abbe_view_refine *refine, size_t worker, const abbe_view_job *job) {
  refine->hand[worker].busy = true;
  refine->hand[worker].job = *job;
}

double abbe_view_refine_wait(const abbe_view_refine *refine, double now_s) {
  abbe_view_job job;
  for (size_t i = 0; i < ABBE_VIEW_WORKERS; i++)
    if (!refine->hand[i].busy && abbe_view_refine_next(refine, i, now_s, &job)) return 0;
  if (refine->refused || refine->held) return -1;
  const double left = refine->changed_s + ABBE_VIEW_REST_S - now_s;
  return left > 0 ? left : -1;
}

bool abbe_view_refine_cancels(const abbe_view_refine *refine, size_t worker) {
  const abbe_view_job *job = &refine->hand[worker].job;
  if (!refine->hand[worker].busy || (job->stage <= ABBE_VIEW_MOVING && !job->warms)) return false;
  /* where only the camera moves, better light is wanted the more */
  if (job->warms && job->light > ABBE_VIEW_MOVING) return job->serial < refine->scene;
  if (job->serial != refine->serial) return true;
  return refine->spectrum && job->stage == ABBE_VIEW_MEAN && last_of(refine) == ABBE_VIEW_TRACED;
}

/* ---- what came of it ---- */

static void learn(abbe_view_refine *refine, abbe_view_hand *hand) {
  const abbe_view_job *job = &hand->job;
  hand->light = job->light;
  hand->light_step = job->light_step;
  if (job->stage == ABBE_VIEW_BALANCED || job->stage == ABBE_VIEW_ACCURATE) {
    hand->rests = job->stage;
    refine->made = (size_t)(hand - refine->hand);
  }
  if (job->stage == ABBE_VIEW_MOVING) hand->ready |= 1u << job->light;
}

/* The one with the better light, or with the programs of what moves where neither is better. */
static void choose_who_shows(abbe_view_refine *refine) {
  const size_t other = 1 - refine->shows;
  const abbe_view_hand *a = &refine->hand[other], *b = &refine->hand[refine->shows];
  if (a->busy || !is_ready(a, ABBE_VIEW_MOVING) || !is_ready(a, a->light)) return;
  if (a->light > b->light || (a->light == b->light && !is_ready(b, b->light)))
    refine->shows = other;
}

bool abbe_view_refine_end(abbe_view_refine *refine, size_t worker, abbe_view_outcome outcome,
                          double ms, double own_ms) {
  abbe_view_hand *hand = &refine->hand[worker];
  const abbe_view_job *job = &hand->job;
  const bool current = job->serial == refine->serial, is_of_scene = job->serial >= refine->scene;
  const bool lit = job->stage != ABBE_VIEW_TRACED &&
                   (hand->light != job->light || hand->light_step != job->light_step);
  hand->busy = false;
  /* of fewer photons it may be refused where it is not of all */
  const bool too_few = job->stage == ABBE_VIEW_MOVING && job->light_step > 0;
  if (outcome == ABBE_VIEW_REFUSED && too_few) {
    refine->pace.lights = job->light_step;
    refine->pace.light_step = job->light_step - 1;
  }
  if (outcome == ABBE_VIEW_REFUSED && current && !too_few) refine->refused = true;
  if (outcome != ABBE_VIEW_DONE) {
    if (outcome != ABBE_VIEW_CANCELLED || lit) abbe_view_refine_forget(refine, worker);
    return false;
  }
  /* the first one may have compiled, which does not last */
  if (job->stage == ABBE_VIEW_MOVING && !job->warms) {
    if (hand->moved == job->light)
      abbe_view_pace_take(&refine->pace, job->light_step, job->eye_step, lit, ms);
    else if (refine->pace.ms == 0)
      abbe_view_pace_guess(&refine->pace, ms - own_ms);
  }
  if (job->stage == ABBE_VIEW_MOVING) hand->moved = job->light;
  /* light of an older scene is no light for this one */
  if (is_of_scene && job->stage != ABBE_VIEW_TRACED)
    learn(refine, hand);
  else if (job->stage != ABBE_VIEW_TRACED)
    abbe_view_refine_forget(refine, worker);
  choose_who_shows(refine);
  if (job->warms || (!current && (job->stage != ABBE_VIEW_MOVING || job->serial <= refine->shown)))
    return false;
  refine->shown = job->serial;
  if (!current) return true;
  refine->stage = job->stage;
  if (job->stage == ABBE_VIEW_TRACED) refine->passes = job->pass + 1;
  return true;
}
