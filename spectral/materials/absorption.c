#include "spectral/materials/absorption.h"

#include "base/maths.h"

#include <math.h>

/* Dominant wavelengths of the Rec.709 primaries, blue to red. */
static const double PRIMARY_NM[3] = {464.2, 549.1, 611.4};

double abbe_absorption_from_transmittance(double transmittance, double thickness_m) {
  double share = fmax(transmittance, ABBE_ABSORPTION_LEAST_TRANSMITTANCE);
  return fabs(fmin(0, log(share))) / thickness_m;
}

double abbe_absorption_transmittance(double attenuation_per_m, double thickness_m) {
  return exp(-attenuation_per_m * thickness_m);
}

double abbe_absorption_from_k(double k, double lambda_nm) {
  return 4 * ABBE_PI * k / (lambda_nm * 1e-9);
}

double abbe_absorption_k(double attenuation_per_m, double lambda_nm) {
  return attenuation_per_m * (lambda_nm * 1e-9) / (4 * ABBE_PI);
}

/* Copies the points, each value through `convert`; parameter is the thickness where it needs one.
 */
static abbe_result converted(const abbe_points *from, double (*convert)(abbe_point, double),
                             double parameter, abbe_spectrum **out, abbe_error *error) {
  abbe_points list = {0};
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < from->count && result == ABBE_OK; i++) {
    abbe_point p = from->point[i];
    p.value = convert(p, parameter);
    result = abbe_points_add(&list, p, error);
  }
  if (result == ABBE_OK)
    result = abbe_points_spectrum(&list, ABBE_INTERPOLATION_LINEAR, out, error);
  abbe_points_free(&list);
  return result;
}

static double of_transmittance(abbe_point p, double thickness_m) {
  return abbe_absorption_from_transmittance(p.value, thickness_m);
}

static double of_k(abbe_point p, double unused) {
  (void)unused;
  return abbe_absorption_from_k(p.value, p.lambda_nm);
}

abbe_result abbe_absorption_spectrum_of_transmittance(const abbe_points *transmittance,
                                                      double thickness_m, abbe_spectrum **out,
                                                      abbe_error *error) {
  if (!(thickness_m > 0) || !isfinite(thickness_m))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the thickness of a transmittance is %g m; it must be above 0",
                          thickness_m);
  for (size_t i = 0; i < transmittance->count; i++) {
    abbe_point p = transmittance->point[i];
    if (p.value >= 0 && p.value <= 1) continue;
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the internal transmittance at %g nm is %g; it is a share from 0 to 1",
                          p.lambda_nm, p.value);
  }
  return converted(transmittance, of_transmittance, thickness_m, out, error);
}

abbe_result abbe_absorption_spectrum_of_k(const abbe_points *k, abbe_spectrum **out,
                                          abbe_error *error) {
  for (size_t i = 0; i < k->count; i++) {
    abbe_point p = k->point[i];
    if (p.value >= 0 && isfinite(p.value)) continue;
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "k at %g nm is %g; an extinction coefficient is 0 or more", p.lambda_nm,
                          p.value);
  }
  return converted(k, of_k, 0, out, error);
}

abbe_result abbe_absorption_spectrum_of_colour(const double colour[3], double distance_m,
                                               abbe_spectrum **out, abbe_error *error) {
  double attenuation[3];
  if (!(distance_m > 0) || !isfinite(distance_m))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the distance of a colour is %g m; it must be above 0", distance_m);
  for (int i = 0; i < 3; i++) {
    double share = colour[2 - i];
    if (!(share >= 1e-6 && share <= 1))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "a share of a colour is %g; each is from 0.000001 to 1", share);
    attenuation[i] = fabs(log(share)) / distance_m;
  }
  return abbe_spectrum_make(PRIMARY_NM, attenuation, 3, ABBE_INTERPOLATION_LINEAR, out, error);
}

void abbe_absorption_colour(const abbe_spectrum *attenuation, double distance_m, double colour[3]) {
  for (int i = 0; i < 3; i++)
    colour[2 - i] =
        abbe_absorption_transmittance(abbe_spectrum_at(attenuation, PRIMARY_NM[i]), distance_m);
}
