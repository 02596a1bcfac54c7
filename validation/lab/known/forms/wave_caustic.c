#include "validation/lab/known/forms/closed_form.h"

#include "base/maths.h"

#include <math.h>

double abbe_wave_caustic_landing(const abbe_wave_caustic *w, double x, double *passed) {
  const double k = 2 * ABBE_PI / w->wavelength, below = w->depth + w->amplitude * cos(k * x);
  const double tilt = atan(-w->amplitude * k * sin(k * x));
  const double turn = tilt - asin(sin(tilt) / w->index); /* off the vertical */
  if (passed != NULL)
    *passed = (1 - abbe_closed_form_fresnel(fabs(tilt), w->index)) *
              exp(-w->attenuation_per_m * below / cos(turn));
  return x + below * tan(turn);
}

double abbe_wave_caustic_focus(const abbe_wave_caustic *w) {
  const double k = 2 * ABBE_PI / w->wavelength;
  return w->index / ((w->index - 1) * w->amplitude * k * k);
}

/* Light that meets the bottom between `from` and `to` enters within this of them, for no slope is
 * steeper. */
static double reach(const abbe_wave_caustic *w) {
  const double tilt = atan(w->amplitude * 2 * ABBE_PI / w->wavelength);
  return (w->depth + w->amplitude) * tan(tilt - asin(sin(tilt) / w->index));
}

double abbe_wave_caustic_mean(const abbe_wave_caustic *w, double from, double to, size_t rays) {
  const double first = from - reach(w), step = (to + reach(w) - first) / (double)rays;
  double sum = 0;
  for (size_t i = 0; i < rays; i++) {
    double passed;
    const double at = abbe_wave_caustic_landing(w, first + ((double)i + 0.5) * step, &passed);
    if (at >= from && at < to) sum += passed;
  }
  return sum * step / (to - from);
}

size_t abbe_wave_caustic_branches(const abbe_wave_caustic *w, double x, size_t rays) {
  const double first = x - 1.001 * reach(w) - 1e-12, step = 2 * (x - first) / (double)rays;
  size_t count = 0;
  double before = abbe_wave_caustic_landing(w, first, NULL);
  for (size_t i = 1; i <= rays; i++) {
    const double at = abbe_wave_caustic_landing(w, first + (double)i * step, NULL);
    count += (before < x) != (at < x);
    before = at;
  }
  return count;
}
