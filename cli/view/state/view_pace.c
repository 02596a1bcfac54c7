#include "cli/view/state/view_pace.h"

#include <math.h>
#include <string.h>

static const double roomy = 0.82; /* of the time, for a finer picture */
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

/* The finest that is expected to take no longer; the light gives way first, for what the eye sees
 * sharp is what is looked at. False: none is. */
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

void abbe_view_pace_guess(abbe_view_pace *p, double drawn_ms) {
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
