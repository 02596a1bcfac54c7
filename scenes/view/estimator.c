#include "scenes/view/estimator.h"

#include "base/maths.h"

#include <math.h>
#include <string.h>

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

static void along(const search *s, double d, double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = s->origin[k] + d * s->direction[k];
}

static bool look(search *s, double d) {
  double at[3];
  along(s, d, at);
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
  along(s, d, at);
  if (!look(s, d)) return NAN;
  if (view->orthographic) {
    abbe_vector_subtract(at, s->seen, between);
    return abbe_vector_dot(between, view->forward);
  }
  const double here = distance(at, view->origin), there = distance(s->seen, view->origin);
  return ratio ? here / there - 1 : here - there;
}

static double start_of(search *s) {
  if (s->desc->printed) return ABBE_ESTIMATOR_START_M;
  look(s, 0);
  return distance(s->seen, s->origin);
}

static double fixed_point(search *s, bool axis) {
  const double *a = s->desc->view->forward, along_axis = abbe_vector_dot(s->direction, a);
  double d = start_of(s);
  for (size_t i = 0; i < s->desc->iterations && look(s, d); i++) {
    double between[3];
    abbe_vector_subtract(s->seen, s->origin, between);
    d = axis ? abbe_vector_dot(between, a) / along_axis : abbe_vector_length(between);
  }
  look(s, d);
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
    if (!look(s, 0)) return 0;
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
  return look(s, 0) ? distance(s->seen, s->origin) : 0;
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

abbe_estimate abbe_estimator_run(const abbe_estimator_desc *desc, const double origin[3],
                                 const double direction[3]) {
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
    along(&s, out.distance, out.at);
  return out;
}

double abbe_estimator_rate(bool axis, const double r[3], const double s[3], const double n[3],
                           const double a[3]) {
  const double nr = abbe_vector_dot(n, r), ns = abbe_vector_dot(n, s);
  if (!axis) return 1 - abbe_vector_dot(r, s) * nr / ns;
  return 1 - nr * abbe_vector_dot(a, s) / (ns * abbe_vector_dot(a, r));
}

const char *abbe_estimator_name(abbe_estimator estimator) {
#define ABBE_NAME_OF(code, name) name,
  static const char *const names[] = {ABBE_ESTIMATORS(ABBE_NAME_OF)};
#undef ABBE_NAME_OF
  return (int)estimator >= 0 && estimator < ABBE_ESTIMATOR_COUNT ? names[estimator] : "unknown";
}
