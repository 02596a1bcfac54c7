#include "colorimetry/colour_temperature.h"

#include "base/number.h"
#include "colorimetry/chromaticity.h"
#include "colorimetry/observer_tables.h"

#include <math.h>

double abbe_colour_temperature_planck(double kelvin, double lambda_nm) {
  const double c2 = 1.4388e7;
  if (!(kelvin > 0 && lambda_nm > 0)) return 0;
  /* as exponentials below 1: nothing overflows in the cold */
  const double at = c2 / (kelvin * lambda_nm), at_560 = c2 / (kelvin * 560);
  return 100 * pow(560 / lambda_nm, 5) * exp(at_560 - at) * expm1(-at_560) / expm1(-at);
}

void abbe_colour_temperature_planck_xy(double kelvin, double xy[2]) {
  const abbe_observer_table *t = &abbe_observer_tables[ABBE_OBSERVER_CIE_1931];
  double xyz[3] = {0};
  for (int i = 0; i < t->count; i++) {
    const double power =
        abbe_colour_temperature_planck(kelvin, t->first_nm + ABBE_OBSERVER_STEP_NM * i);
    for (int k = 0; k < 3; k++) xyz[k] += power * t->xyz[i][k];
  }
  if (!abbe_chromaticity_xy(xyz, xy)) xy[0] = xy[1] = NAN;
}

bool abbe_colour_temperature_daylight_xy(double kelvin, double xy[2]) {
  if (!(kelvin >= 4000 && kelvin <= 25000)) return false;
  const double r = 1e3 / kelvin;
  const double x = kelvin <= 7000 ? 0.244063 + r * (0.09911 + r * (2.9678 - r * 4.6070))
                                  : 0.237040 + r * (0.24748 + r * (1.9018 - r * 2.0064));
  xy[0] = x;
  xy[1] = -3 * x * x + 2.870 * x - 0.275;
  return true;
}

/* CIE 1960: u is u', v is 2/3 v'. */
static void to_1960(const double xy[2], double uv[2]) {
  abbe_chromaticity_uv_of_xy(xy, uv);
  uv[1] *= 2.0 / 3;
}

/* Along the locus by mired = 1e6 / K, in which equal steps look about equal. */
static double distance(const double uv[2], double mired, double way[2]) {
  double xy[2], at[2];
  abbe_colour_temperature_planck_xy(1e6 / mired, xy);
  to_1960(xy, at);
  way[0] = uv[0] - at[0];
  way[1] = uv[1] - at[1];
  return hypot(way[0], way[1]);
}

/* Golden section between two mired with one minimum between them. */
static double nearest_between(const double uv[2], double low, double high) {
  const double ratio = (sqrt(5) - 1) / 2;
  double way[2];
  double a = high - ratio * (high - low), b = low + ratio * (high - low);
  double at_a = distance(uv, a, way), at_b = distance(uv, b, way);
  while (high - low > 1e-7 * high) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - ratio * (high - low);
      at_a = distance(uv, a, way);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + ratio * (high - low);
      at_b = distance(uv, b, way);
    }
  }
  return (low + high) / 2;
}

bool abbe_colour_temperature_find(const double xy[2], double *kelvin, double *duv) {
  enum { STEPS = 100 };
  const double min = 1e6 / ABBE_COLOUR_TEMPERATURE_MAX, max = 1e6 / ABBE_COLOUR_TEMPERATURE_MIN;
  double uv[2], way[2], least = INFINITY;
  int nearest = 0;
  *kelvin = *duv = NAN;
  to_1960(xy, uv);
  if (!(isfinite(uv[0]) && isfinite(uv[1]))) return false;
  for (int i = 0; i <= STEPS; i++) {
    const double d = distance(uv, min + (max - min) * i / STEPS, way);
    if (d < least) {
      least = d;
      nearest = i;
    }
  }
  const double step = (max - min) / STEPS, mired = min + step * nearest;
  const double best = nearest_between(uv, fmax(min, mired - step), fmin(max, mired + step));
  const double away = distance(uv, best, way);
  const double edge = 1e-5; /* near the ends, where the nearest one lies beyond */
  if (away > ABBE_COLOUR_TEMPERATURE_MAX_DUV || best < min * (1 + edge) || best > max * (1 - edge))
    return false;
  *kelvin = 1e6 / best;
  *duv = way[1] < 0 ? -away : away;
  return true;
}

bool abbe_colour_temperature_read_white(const char *text, double xy[2]) {
  const char *end = NULL;
  double first, second;
  if (!abbe_number_read(text, &end, &first)) return false;
  if (*end == ',') {
    if (!abbe_number_read(end + 1, &end, &second) || *end != '\0') return false;
    if (!(first > 0 && second > 0.01 && first + second < 1)) return false;
    xy[0] = first;
    xy[1] = second;
    return true;
  }
  if (*end != '\0' ||
      !(first >= ABBE_COLOUR_TEMPERATURE_MIN && first <= ABBE_COLOUR_TEMPERATURE_MAX_DAYLIGHT))
    return false;
  if (!abbe_colour_temperature_daylight_xy(first, xy)) abbe_colour_temperature_planck_xy(first, xy);
  return true;
}
