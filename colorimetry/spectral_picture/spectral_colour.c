#include "colorimetry/spectral_picture/spectral_colour.h"

#include "colorimetry/observer_integral.h"
#include "colorimetry/rgb_space.h"

#include <math.h>

static const abbe_illuminant d65 = {.kind = ABBE_ILLUMINANT_D65};
static const abbe_illuminant even = {.kind = ABBE_ILLUMINANT_E}; /* with power 100 */

static const abbe_illuminant *seen_light(const abbe_spectral_channels *c,
                                         const abbe_spectral_view *view) {
  if (view->to != NULL) return view->to;
  return c->kind == ABBE_SPECTRAL_EMISSIVE && view->from != NULL ? view->from : &d65;
}

static void whole(const abbe_spectral_channels *c, abbe_observer observer,
                  const abbe_illuminant *light, double xyz[3]) {
  abbe_observer_integral_by(observer, light, c->edge_nm[0], c->edge_nm[c->count], xyz);
}

void abbe_spectral_colour_white(const abbe_spectral_channels *c, const abbe_spectral_view *view,
                                double xyz[3]) {
  whole(c, view->observer, seen_light(c, view), xyz);
  const double y = xyz[1];
  for (int k = 0; k < 3; k++) xyz[k] /= y;
}

static abbe_result check(const abbe_spectral_channels *c, const abbe_spectral_view *view,
                         const char *name, abbe_error *error) {
  if (c->count < 2)
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "%s: it has %s, of which nothing tells how wide it is; a colour needs two "
        "or more",
        name, c->count == 1 ? "one channel of a spectrum" : "no bands");
  if (c->kind == ABBE_SPECTRAL_EMISSIVE && view->to != NULL && view->from == NULL)
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "%s: it does not say which light it was made with, so there is no telling "
        "what it would be under another",
        name);
  double white[3];
  whole(c, view->observer, seen_light(c, view), white);
  if (white[1] > 0 && isfinite(white[1])) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s: its bands, %g to %g nm, hold no light that the eye sees", name,
                        c->edge_nm[0], c->edge_nm[c->count]);
}

abbe_result abbe_spectral_colour_weights(const abbe_spectral_channels *c,
                                         const abbe_spectral_view *view, const char *name,
                                         double (*weight)[3], abbe_error *error) {
  abbe_result result = check(c, view, name, error);
  if (result != ABBE_OK) return result;
  const bool reflective = c->kind == ABBE_SPECTRAL_REFLECTIVE;
  const bool absolute = !reflective && view->from == NULL;
  const abbe_illuminant *light = absolute ? &even : seen_light(c, view);
  double white[3];
  whole(c, view->observer, light, white);
  const double power =
      absolute || reflective
          ? 1
          : abbe_observer_integral_power(view->from, c->edge_nm[0], c->edge_nm[c->count]);
  for (size_t i = 0; i < c->count; i++) {
    const double from = c->edge_nm[i], to = c->edge_nm[i + 1];
    abbe_observer_integral_by(view->observer, light, from, to, weight[i]);
    double factor = 1 / white[1];
    if (absolute) factor = ABBE_SPECTRAL_COLOUR_KM / 100;
    if (!absolute && !reflective) {
      /* the band of a light of one watt has this, a nm */
      const double mean = abbe_observer_integral_power(view->from, from, to) / (to - from) / power;
      factor = mean > 0 ? factor / mean : 0;
    }
    if (!reflective) factor *= c->unit.factor;
    for (int k = 0; k < 3; k++) weight[i][k] *= factor;
  }
  return ABBE_OK;
}
