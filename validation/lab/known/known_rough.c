/* Rough faces of an index of 1.5: what their first facet alone sends on, and how a face that is
 * hardly rough meets a smooth one. */
#include "base/number.h"
#include "validation/lab/known/forms/closed_form.h"
#include "validation/lab/known/known_light.h"
#include "validation/trace/transport/double_refraction.h"

#include <math.h>

static const double n_glass = 1.5;
static const char reason[] = "as improbable as four standard errors of a share";

/* Share of facets that is seen from an angle to the upright. */
static double seen(double alpha, double angle) {
  const double tangent = tan(angle);
  return angle < ABBE_PI / 2 ? 2 / (1 + sqrt(1 + alpha * alpha * tangent * tangent)) : 0;
}

/* Straight on, from one index to another: facets of squared slope t are alpha^2 / (alpha^2 + t)^2
 * of what is met, and the light that one sends on is lost where another hides it. [Walter2007] */
static double first_facet(double alpha, double n, bool reflected) {
  enum { PARTS = 200000 };
  double sum = 0;
  for (int i = 0; i < PARTS; i++) {
    const double s = (i + 0.5) / PARTS; /* share of facets that are less tilted */
    const double tilt = atan(alpha * sqrt(s / (1 - s))), sine = sin(tilt) / n;
    const double fresnel = sine < 1 ? abbe_closed_form_fresnel(tilt, n) : 1;
    const double part = reflected ? fresnel * seen(alpha, 2 * tilt)
                                  : (1 - fresnel) * seen(alpha, fabs(tilt - asin(fmin(sine, 1))));
    sum += part / PARTS;
  }
  return sum;
}

/* Of light at an angle to the face, the share that is reflected or passed, by its first facet alone
 * or by all. */
static double traced(double alpha, bool inside, double angle, bool first, bool reflected,
                     uint32_t count, uint32_t seed) {
  float n[2] = {(float)n_glass, (float)n_glass};
  uint32_t stuff = 0, found = 0;
  const abbe_media media = {.refractors = 1, .steps = 1, .n = n, .stuff = &stuff};
  const abbe_wave_face face = {.from = inside ? 0 : -1,
                               .to = inside ? -1 : 0,
                               .film = -1,
                               .entering = !inside,
                               .n = {0, 0, 1},
                               .d = {(float)sin(angle), 0, -(float)cos(angle)},
                               .rough = (float)alpha};
  for (uint32_t i = 0; i < count; i++) {
    const uint32_t key[4] = {i, 0, 0, seed};
    abbe_wave_way way;
    const uint32_t facets = abbe_media_roughen(&media, &face, 0, 0, key, NULL, 0, &way);
    found += way.reflected == reflected && way.share > 0 && (!first || facets == 1);
  }
  return (double)found / count;
}

static abbe_result add(abbe_known_run *run, double alpha, bool inside, bool reflected,
                       abbe_error *error) {
  enum { PHOTONS = 1 << 20 };
  const bool smooth = alpha <= 0.001;
  const double angle = smooth ? ABBE_PI / 6 : 0, n = inside ? 1 / n_glass : n_glass;
  abbe_known_answer row = {.unit = "share", .useful = 2e-3, .reason = reason};
  const double fresnel = abbe_closed_form_fresnel(angle, n);
  row.exact = !smooth ? first_facet(alpha, n, reflected) : reflected ? fresnel : 1 - fresnel;
  row.traced =
      traced(alpha, inside, angle, !smooth, reflected, PHOTONS, (uint32_t)run->options->seed);
  row.standard_error = sqrt(row.exact * (1 - row.exact) / PHOTONS);
  row.tolerance = ABBE_KNOWN_SIGMAS * row.standard_error;
  abbe_number_format(
      row.quantity, sizeof row.quantity, "a face of roughness %.3g, %s from %s, %s%s", alpha,
      smooth ? "at 30 degrees" : "straight on", inside ? "inside" : "outside",
      reflected ? "reflected" : "passed", smooth ? ", as a smooth one" : " by its first facet");
  return abbe_known_add(run, row, error);
}

abbe_result abbe_known_rough(abbe_known_run *run, abbe_error *error) {
  static const double alpha[] = {0.001, 0.1, 0.3, 0.5, 1};
  for (int i = 0; i < 20; i++) ABBE_TRY(add(run, alpha[i / 4], i % 4 > 1, i % 2 == 0, error));
  return ABBE_OK;
}
