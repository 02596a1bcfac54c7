/* estimator_run.h: image_search.glsl in doubles, for any lookup, a texture or a formula: where a
 * ray meets receivers, by what a view sees of them. It knows no scene. Lengths in metres. */
#ifndef ABBE_TESTS_SCENES_VIEW_ESTIMATOR_RUN_H
#define ABBE_TESTS_SCENES_VIEW_ESTIMATOR_RUN_H

#include "base/maths.h"
#include "scenes/view/estimator.h"
#include "scenes/view/view.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

/* As printed: the first place of shah and axis and the step of newton. */
#define ABBE_ESTIMATOR_START_M 1.0
#define ABBE_ESTIMATOR_STEP_M 0.1
/* So far behind its origin a ray may land, of the view's far end: what it leaves may stand on the
 * receiver. */
#define ABBE_ESTIMATOR_BEHIND 1e-3
/* Else, of |p(0) - origin|. */
#define ABBE_ESTIMATOR_STEP_SHARE 0.015625
#define ABBE_ESTIMATOR_DOUBLINGS 8

/* The place on a receiver that the light sees in the direction of `at`; false where it sees none.
 */
typedef bool (*abbe_estimator_lookup)(void *user, const double at[3], double seen[3]);

typedef struct abbe_estimator_desc {
  abbe_estimator kind; /* not AUTO, not EXACT */
  size_t iterations;   /* 1 to ABBE_ESTIMATOR_MAX_ITERATIONS; steps of a march */
  bool printed;        /* starts, steps and f as printed; else by |p(0) - origin| */
  double step;         /* newton's h, not printed: m; 0: a share of |p(0) - origin| */
  double range;        /* length of a march, m; 0: four times |p(0) - origin| */
  const abbe_view *view;
  abbe_estimator_lookup lookup;
  void *user;
} abbe_estimator_desc;

typedef struct abbe_estimate {
  bool found;      /* false: a lookup that it could not do without saw nothing */
  double distance; /* along the ray, m */
  double at[3];    /* m; of shah and axis on a receiver, of the others on the ray */
  size_t lookups;
} abbe_estimate;

typedef struct search {
  const abbe_estimator_desc *desc;
  const double *origin, *direction;
  double seen[3]; /* what was looked up last */
  size_t lookups;
  bool found; /* whether that was anything */
} search;

/* A place on the ray and how far it lies behind what is seen. */
typedef struct place {
  double d, g;
} place;

static void place_along(const search *s, double d, double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = s->origin[k] + d * s->direction[k];
}

static bool look_from(search *s, double d) {
  double at[3];
  place_along(s, d, at);
  s->lookups++;
  s->found = s->desc->lookup(s->desc->user, at, s->seen);
  return s->found;
}

static double distance(const double a[3], const double b[3]) {
  double between[3];
  abbe_vector_subtract(a, b, between);
  return abbe_vector_length(between);
}

/* g at d, or of a ratio g over the distance from the light; nothing seen: NaN. */
static double behind(search *s, double d, bool ratio) {
  const abbe_view *view = s->desc->view;
  double at[3], between[3];
  place_along(s, d, at);
  if (!look_from(s, d)) return NAN;
  if (view->orthographic) {
    abbe_vector_subtract(at, s->seen, between);
    return abbe_vector_dot(between, view->forward);
  }
  const double here = distance(at, view->origin), there = distance(s->seen, view->origin);
  return ratio ? here / there - 1 : here - there;
}

static double start_of(search *s) {
  if (s->desc->printed) return ABBE_ESTIMATOR_START_M;
  look_from(s, 0);
  return distance(s->seen, s->origin);
}

static double fixed_point(search *s, bool axis) {
  const double *a = s->desc->view->forward, along_axis = abbe_vector_dot(s->direction, a);
  double d = start_of(s);
  for (size_t i = 0; i < s->desc->iterations && look_from(s, d); i++) {
    double between[3];
    abbe_vector_subtract(s->seen, s->origin, between);
    d = axis ? abbe_vector_dot(between, a) / along_axis : abbe_vector_length(between);
  }
  look_from(s, d);
  return d;
}

/* Halves between two places on the ray, by the sign of g. */
static double halve(search *s, double a, double b, size_t iterations) {
  double low = fmin(a, b), high = fmax(a, b);
  for (size_t i = 1; i < iterations; i++) {
    const double middle = 0.5 * (low + high), g = behind(s, middle, false);
    if (g < 0)
      low = middle;
    else
      high = middle;
  }
  return 0.5 * (low + high);
}

static double newton(search *s) {
  const abbe_estimator_desc *desc = s->desc;
  double d = desc->printed ? ABBE_ESTIMATOR_STEP_M : 0, h = ABBE_ESTIMATOR_STEP_M, before = d;
  for (size_t i = 0; i < desc->iterations; i++) {
    double f = behind(s, d, false);
    if (i == 0 && !desc->printed)
      h = desc->step > 0 ? desc->step : ABBE_ESTIMATOR_STEP_SHARE * distance(s->seen, s->origin);
    double next = behind(s, d + h, false);
    if (desc->printed) {
      f = fabs(f);
      next = fabs(next);
    }
    const double to = d - f * h / (next - f);
    if (f == 0 || next == f || !isfinite(to)) break;
    if (desc->printed && i > 0 && fabs(to - before) < 0.25 * fabs(to - d))
      return halve(s, d, to, desc->iterations - i);
    before = d;
    d = to;
  }
  return d;
}

/* From 0 to where the ray is behind what is seen. False where that is never. */
static bool bracket(search *s, bool ratio, place *low, place *high) {
  *low = (place){0, behind(s, 0, ratio)};
  if (!s->found) return false;
  double to = distance(s->seen, s->origin);
  for (int i = 0; i <= ABBE_ESTIMATOR_DOUBLINGS; i++) {
    *high = (place){to, behind(s, to, ratio)};
    if (high->g >= 0) return true;
    if (s->found) *low = *high;
    to = s->found ? 2 * to : 0.5 * (low->d + to);
  }
  return false;
}

static double cut(place a, place b) {
  return b.g == a.g ? b.d : b.d - b.g * (b.d - a.d) / (b.g - a.g);
}

static double bracketed(search *s, abbe_estimator kind) {
  const bool ratio = kind == ABBE_ESTIMATOR_RATIO,
             illinois = ratio || kind == ABBE_ESTIMATOR_ILLINOIS;
  place low = {0, 0}, high = {0, 0};
  int side = 0;
  if (!bracket(s, ratio, &low, &high)) {
    s->found = false;
    return high.d;
  }
  for (size_t i = 1;; i++) {
    const double d = kind == ABBE_ESTIMATOR_BISECTION ? 0.5 * (low.d + high.d) : cut(low, high);
    if (i == s->desc->iterations) return d;
    const double g = behind(s, d, ratio);
    if (g == 0) return d;
    if (g < 0) {
      low = (place){d, g};
      if (illinois && side < 0) high.g *= 0.5;
      side = -1;
    } else { /* nothing seen is as far as too far */
      high = (place){d, s->found ? g : high.g};
      if (illinois && side > 0) low.g *= 0.5;
      side = 1;
    }
    s->found = true;
  }
}

static double secant(search *s) {
  place a = {0, behind(s, 0, false)}, b = {distance(s->seen, s->origin), 0};
  if (!s->found) return 0;
  b.g = behind(s, b.d, false);
  for (size_t i = 1; s->found && b.g != 0; i++) {
    const double d = cut(a, b);
    if (i == s->desc->iterations || d == b.d) return d;
    a = b;
    b = (place){d, behind(s, d, false)};
  }
  return b.d;
}

static double march(search *s) {
  double range = s->desc->range;
  if (range <= 0) {
    if (!look_from(s, 0)) return 0;
    range = 4 * distance(s->seen, s->origin);
  }
  const double step = range / (double)s->desc->iterations;
  for (size_t i = 1; i <= s->desc->iterations; i++)
    if (behind(s, step * (double)i, false) >= 0) return step * ((double)i - 0.5);
  s->found = false;
  return range;
}

/* What is seen along the ray's own direction, far away; in a parallel view, behind the origin. */
static double far_seen(search *s) {
  const abbe_view *view = s->desc->view;
  double at[3];
  s->lookups++;
  for (int k = 0; k < 3; k++) at[k] = view->origin[k] + s->direction[k];
  s->found = !view->orthographic && abbe_vector_dot(s->direction, view->forward) > 0 &&
             s->desc->lookup(s->desc->user, at, s->seen);
  if (s->found) return distance(s->seen, view->origin);
  return look_from(s, 0) ? distance(s->seen, s->origin) : 0;
}

static double impostor(search *s) {
  const double far = far_seen(s), start = behind(s, 0, true);
  place low = {0, start}, high = {0, 0};
  if (!s->found || !(far > 0)) return 0;
  const double scale = s->desc->view->orthographic ? 1 : far;
  double d = -scale * start;
  for (size_t i = 1; i < s->desc->iterations; i++) {
    const place here = {d, behind(s, d, true)};
    if (!s->found || here.g == 0) return d;
    if (here.g < 0)
      low = here;
    else
      high = here;
    d = high.d > 0 ? cut(low, high) : d - scale * here.g;
  }
  return d;
}

/* Direction is unit. */
static inline abbe_estimate abbe_estimator_run(const abbe_estimator_desc *desc,
                                               const double origin[3], const double direction[3]) {
  search s = {.desc = desc, .origin = origin, .direction = direction, .found = true};
  abbe_estimate out = {0};
  switch (desc->kind) {
  case ABBE_ESTIMATOR_SHAH:
  case ABBE_ESTIMATOR_AXIS:
    out.distance = fixed_point(&s, desc->kind == ABBE_ESTIMATOR_AXIS);
    break;
  case ABBE_ESTIMATOR_NEWTON:
    out.distance = newton(&s);
    break;
  case ABBE_ESTIMATOR_SECANT:
    out.distance = secant(&s);
    break;
  case ABBE_ESTIMATOR_MARCH:
    out.distance = march(&s);
    break;
  case ABBE_ESTIMATOR_IMPOSTOR:
    out.distance = impostor(&s);
    break;
  default:
    out.distance = bracketed(&s, desc->kind);
    break;
  }
  out.found =
      s.found && isfinite(out.distance) && out.distance >= -ABBE_ESTIMATOR_BEHIND * desc->view->far;
  out.lookups = s.lookups;
  if (desc->kind == ABBE_ESTIMATOR_SHAH || desc->kind == ABBE_ESTIMATOR_AXIS)
    memcpy(out.at, s.seen, sizeof out.at);
  else
    place_along(&s, out.distance, out.at);
  return out;
}

/* What an iteration of shah (axis false) or axis makes of a small error, where the light comes
 * along `light` onto a surface of that normal, all unit: 1 - (r.s)(n.r)/(n.s), or with a for the
 * view's axis 1 - (n.r)(a.s)/((n.s)(a.r)). It converges where this is below 1 in size. */
static inline double abbe_estimator_rate(bool axis, const double r[3], const double s[3],
                                         const double n[3], const double a[3]) {
  const double nr = abbe_vector_dot(n, r), ns = abbe_vector_dot(n, s);
  if (!axis) return 1 - abbe_vector_dot(r, s) * nr / ns;
  return 1 - nr * abbe_vector_dot(a, s) / (ns * abbe_vector_dot(a, r));
}

#endif
