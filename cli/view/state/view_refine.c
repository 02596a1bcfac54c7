#include "cli/view/state/view_state.h"

#include <math.h>
#include <string.h>

static const double roomy = 0.82; /* share of the time, for a finer picture */
static const double alike = 1.15; /* no time is saved by that */

/* Fewer samples or photons by a step are this share of the work. */
static double eye_share(size_t step) {
  return 1 / (double)((step + 1) * (step + 1));
}

static double light_share(size_t step) {
  return 1 / (double)(1u << step);
}

static double work_of(bool lit, size_t light, size_t eye) {
  return lit ? 0.5 * (light_share(light) + eye_share(eye)) : eye_share(eye);
}

/* Those that come into question. */
static size_t lights_of(const abbe_view_pace *p, bool lit) {
  return !lit ? 1 : p->lights > 0 ? p->lights : ABBE_VIEW_LIGHT_STEPS;
}

static double known(const abbe_view_pace *p, bool lit, size_t light, size_t eye) {
  return lit ? p->lit_ms[light][eye] : p->kept_ms[eye];
}

/* By two pictures that differ from this one in the light's step alone: time is linear in its share.
 * 0: there are no two. */
static double by_light(const abbe_view_pace *p, size_t light, size_t eye) {
  size_t found = 0, step[ABBE_VIEW_LIGHT_STEPS];
  for (size_t i = 0; i < ABBE_VIEW_LIGHT_STEPS; i++)
    if (p->lit_ms[i][eye] > 0) step[found++] = i;
  if (found < 2) return 0;
  const double a = p->lit_ms[step[0]][eye], b = p->lit_ms[step[found - 1]][eye];
  const double at = light_share(step[0]), to = light_share(step[found - 1]);
  return a + (b - a) * (light_share(light) - at) / (to - at);
}

/* By what the present picture of these steps took: half of it for its light, where it was drawn. */
static double by_share(bool lit, const size_t now[2], double ms, size_t light, size_t eye) {
  const double eye_times = eye_share(eye) / eye_share(now[1]);
  if (!lit) return ms * eye_times;
  return ms * 0.5 * (light_share(light) / light_share(now[0]) + eye_times);
}

/* By the two pictures that differ most: time is linear in the share of all work. Infinite: there
 * are no two, or none from which a time follows. */
static double by_work(const abbe_view_pace *p, bool lit, size_t light, size_t eye) {
  double least = INFINITY, most = 0, least_ms = 0, most_ms = 0;
  for (size_t e = 0; e < ABBE_VIEW_EYE_STEPS; e++)
    for (size_t l = 0; l < (lit ? ABBE_VIEW_LIGHT_STEPS : 1); l++) {
      const double ms = known(p, lit, l, e), work = work_of(lit, l, e);
      if (ms > 0 && work < least) {
        least = work;
        least_ms = ms;
      }
      if (ms > 0 && work > most) {
        most = work;
        most_ms = ms;
      }
    }
  if (!(most > least) || !(most_ms > least_ms)) return INFINITY;
  const double ms =
      least_ms + (most_ms - least_ms) * (work_of(lit, light, eye) - least) / (most - least);
  return ms > 0 ? ms : INFINITY;
}

/* What a picture took last, or a guess, which lies between those of coarser and finer ones. */
static double expected(const abbe_view_pace *p, bool lit, const size_t now[2], double ms,
                       size_t light, size_t eye) {
  double guess = known(p, lit, light, eye);
  if (guess > 0) return guess;
  if (lit) guess = by_light(p, light, eye);
  if (!(guess > 0)) guess = fmin(by_work(p, lit, light, eye), by_share(lit, now, ms, light, eye));
  for (size_t e = 0; e < ABBE_VIEW_EYE_STEPS; e++)
    for (size_t l = 0; l < (lit ? ABBE_VIEW_LIGHT_STEPS : 1); l++) {
      const double other = known(p, lit, l, e);
      if (other > 0 && l >= light && e >= eye) guess = fmax(guess, other);
      if (other > 0 && l <= light && e <= eye) guess = fmin(guess, other);
    }
  return guess;
}

/* The finest that is expected to take no longer; the light gives way first, for sharp surfaces are
 * what people look at. False: none is. */
static bool find_finest(const abbe_view_pace *p, bool lit, const size_t now[2], double ms,
                        double most, size_t out[2]) {
  const size_t lights = lights_of(p, lit);
  for (size_t eye = 0; eye < ABBE_VIEW_EYE_STEPS; eye++)
    for (size_t light = 0; light < lights; light++) {
      if (expected(p, lit, now, ms, light, eye) > most) continue;
      out[0] = light;
      out[1] = eye;
      return true;
    }
  return false;
}

static double find_fastest(const abbe_view_pace *p, bool lit, const size_t now[2], double ms) {
  const size_t lights = lights_of(p, lit);
  double least = INFINITY;
  for (size_t eye = 0; eye < ABBE_VIEW_EYE_STEPS; eye++)
    for (size_t light = 0; light < lights; light++)
      least = fmin(least, expected(p, lit, now, ms, light, eye));
  return least;
}

static bool is_finer(const size_t a[2], const size_t b[2]) {
  return a[1] < b[1] || (a[1] == b[1] && a[0] < b[0]);
}

/* Into the table. Where a time is not as it was, nothing that was known holds; nor, for ever, what
 * is known of pictures that are too slow, while there is time. */
static double keep(abbe_view_pace *p, bool lit, const size_t now[2], double ms) {
  enum { FOR_SO_LONG = 24 };
  double *own = lit ? &p->lit_ms[now[0]][now[1]] : &p->kept_ms[now[1]];
  const double before = *own;
  p->in_time = ms <= ABBE_VIEW_MOVING_MS ? p->in_time + 1 : 0;
  const bool other = before > 0 && (ms > 1.5 * before || ms < before / 1.5);
  if (other || p->in_time == FOR_SO_LONG) {
    memset(p->lit_ms, 0, sizeof p->lit_ms);
    memset(p->kept_ms, 0, sizeof p->kept_ms);
    p->in_time = 0;
  }
  *own = *own > 0 ? 0.5 * (before + ms) : ms;
  return *own;
}

/* The first picture of all took so long to be drawn, as far as that is known: coarser ones, of the
 * same programs, have their share. */
static void view_pace_guess(abbe_view_pace *p, double drawn_ms) {
  p->eye_step = 1; /* what is too coarse is not so for long */
  while (p->eye_step + 1 < ABBE_VIEW_EYE_STEPS &&
         drawn_ms * eye_share(p->eye_step) > roomy * ABBE_VIEW_MOVING_MS)
    p->eye_step++;
}

void abbe_view_pace_take(abbe_view_pace *p, size_t light_step, size_t eye_step, bool lit,
                         double ms) {
  const size_t now[2] = {lit ? light_step : 0, eye_step};
  size_t next[2] = {now[0], now[1]};
  p->strange = p->ms > 0 && !p->strange && ms > 4 * p->ms && ms > 4 * ABBE_VIEW_MOVING_MS;
  if (p->strange) return;
  p->ms = ms;
  const double own = keep(p, lit, now, ms);
  if (own <= ABBE_VIEW_MOVING_MS) {
    if (find_finest(p, lit, now, own, roomy * ABBE_VIEW_MOVING_MS, next) && !is_finer(next, now))
      memcpy(next, now, sizeof next);
  } else if (!find_finest(p, lit, now, own, ABBE_VIEW_MOVING_MS, next)) {
    find_finest(p, lit, now, own, alike * find_fastest(p, lit, now, own), next);
  }
  if (lit) p->light_step = next[0];
  p->eye_step = next[1];
}

#define NAME(code, name, word) name,
#define WORD(code, name, word) word,
const char *abbe_view_stage_name(abbe_view_stage stage) {
  static const char *const names[] = {ABBE_VIEW_STAGES(NAME)};
  return stage < ABBE_VIEW_STAGE_COUNT ? names[stage] : "unknown";
}

const char *abbe_view_stage_word(abbe_view_stage stage) {
  static const char *const words[] = {ABBE_VIEW_STAGES(WORD)};
  return stage < ABBE_VIEW_STAGE_COUNT ? words[stage] : "unknown";
}
#undef NAME
#undef WORD

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
  /* with fewer photons it may be refused where it is not with all */
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
      view_pace_guess(&refine->pace, ms - own_ms);
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
