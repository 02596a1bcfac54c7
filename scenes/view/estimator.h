/* estimator.h: where a ray meets receivers, found by looking up what a light sees.
 *
 * A light's picture of the receivers holds, for each direction from the light, the place that it
 * sees there. A ray that leaves a refractor or a mirror is brought to a receiver by a few lookups
 * of it, each at a place on the ray [ShahKonttinenPattanaik2007, SzirmayKalos2005,
 * DowellJarratt1971]: which ways there are. image_search.glsl goes them.
 */
#ifndef ABBE_SCENES_VIEW_ESTIMATOR_H
#define ABBE_SCENES_VIEW_ESTIMATOR_H

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

static inline const char *abbe_estimator_name(abbe_estimator estimator) {
#define ABBE_NAME_OF(code, name) name,
  static const char *const names[] = {ABBE_ESTIMATORS(ABBE_NAME_OF)};
#undef ABBE_NAME_OF
  return (int)estimator >= 0 && estimator < ABBE_ESTIMATOR_COUNT ? names[estimator] : "unknown";
}

#endif
