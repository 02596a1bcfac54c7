/* estimator.h: where a ray meets receivers, found by looking up what a light sees.
 *
 * A light's picture of the receivers holds, for each direction from the light, the place that it
 * sees there. A ray that leaves a refractor or a mirror is brought to a receiver by a few lookups
 * of it, each at a place on the ray [ShahKonttinenPattanaik2007, SzirmayKalos2005,
 * DowellJarratt1971]. It knows no scene: the lookup is the caller's, a texture or a formula.
 * Lengths in metres.
 */
#ifndef ABBE_SCENES_VIEW_ESTIMATOR_H
#define ABBE_SCENES_VIEW_ESTIMATOR_H

#include "scenes/view/view.h"

#include <stdbool.h>
#include <stddef.h>

/* With x(d) = origin + d direction, p(d) the place that the light sees in the direction of x(d),
 * and g(d) how far x(d) lies behind p(d), negative before it:
 *
 * shah: d <- |p(d) - origin|, from the start; the answer is the place looked up last.
 * axis: the same along the view's axis: d <- (p(d) - origin) . axis / direction . axis.
 * newton: d <- d - f h / (f(d + h) - f(d)), with f = g; as printed f = |g|, h = 0.1 from d = 0.1,
 *   and where it goes to and fro, halves between its last two places.
 * secant, false-position, illinois, bisection: of g; the last three in a bracket, from 0 to |p(0) -
 *   origin|, doubled until g is positive.
 * march: in equal steps; the answer is the middle of the step on which g becomes positive.
 * impostor: false position of the ratio |x| / |p| as seen from the light, and before there is a
 *   bracket by the plane through the place that is seen far along the ray.
 * ratio: illinois of g over |p - light|, which is linear in d wherever p lies on a plane.
 * exact: no lookups; rays meet the surfaces themselves.
 * auto: the default of the profile. */
#define ABBE_ESTIMATORS(X)                                                                         \
  X(AUTO, "auto")                                                                                  \
  X(SHAH, "shah")                                                                                  \
  X(AXIS, "axis")                                                                                  \
  X(NEWTON, "newton")                                                                              \
  X(SECANT, "secant")                                                                              \
  X(FALSE_POSITION, "false-position")                                                              \
  X(ILLINOIS, "illinois")                                                                          \
  X(BISECTION, "bisection")                                                                        \
  X(MARCH, "march")                                                                                \
  X(IMPOSTOR, "impostor")                                                                          \
  X(RATIO, "ratio")                                                                                \
  X(EXACT, "exact")
typedef enum abbe_estimator {
#define ABBE_ESTIMATOR_ENUM(code, name) ABBE_ESTIMATOR_##code,
  ABBE_ESTIMATORS(ABBE_ESTIMATOR_ENUM)
#undef ABBE_ESTIMATOR_ENUM
      ABBE_ESTIMATOR_COUNT
} abbe_estimator;

#define ABBE_ESTIMATOR_MAX_ITERATIONS 64
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

/* Direction is unit. */
abbe_estimate abbe_estimator_run(const abbe_estimator_desc *desc, const double origin[3],
                                 const double direction[3]);

/* What an iteration of shah (axis false) or axis makes of a small error, where the light comes
 * along `light` onto a surface of that normal, all unit: 1 - (r.s)(n.r)/(n.s), or with a for the
 * view's axis 1 - (n.r)(a.s)/((n.s)(a.r)). It converges where this is below 1 in size. */
double abbe_estimator_rate(bool axis, const double direction[3], const double light[3],
                           const double normal[3], const double forward[3]);

const char *abbe_estimator_name(abbe_estimator estimator);

#endif
