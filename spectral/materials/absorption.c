#include "spectral/materials/absorption.h"

#include "base/maths.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdlib.h>

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
  ABBE_OWNED(abbe_points, list) = {0};
  for (size_t i = 0; i < from->count; i++) {
    abbe_point p = from->point[i];
    p.value = convert(p, parameter);
    ABBE_TRY(abbe_points_add(&list, p, error));
  }
  return abbe_points_spectrum(&list, ABBE_INTERPOLATION_LINEAR, out, error);
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

abbe_result abbe_conductor_make(const double *lambda_nm, const double *n, const double *k,
                                size_t count, abbe_dispersion *out, abbe_error *error) {
  abbe_dispersion made = {.model = ABBE_DISPERSION_CONDUCTOR};
  *out = (abbe_dispersion){0};
  abbe_result result =
      abbe_spectrum_make(lambda_nm, n, count, ABBE_INTERPOLATION_LINEAR, &made.table, error);
  if (result == ABBE_OK)
    result = abbe_spectrum_make(lambda_nm, k, count, ABBE_INTERPOLATION_LINEAR, &made.k, error);
  if (result == ABBE_OK) result = abbe_dispersion_check(&made, error);
  if (result == ABBE_OK)
    *out = made;
  else
    abbe_dispersion_free(&made);
  return result;
}

static bool is_metal(const abbe_points *n, const abbe_points *k, const abbe_material *m) {
  const double low = fmax(m->min_nm, ABBE_WAVELENGTH_MIN_NM);
  const double high = fmin(m->max_nm, ABBE_WAVELENGTH_MAX_NM);
  if (n->count != k->count || !(low < high) || !abbe_material_is_opaque(m, low, high)) return false;
  for (size_t i = 0; i < n->count; i++)
    if (n->point[i].lambda_nm != k->point[i].lambda_nm) return false;
  return true;
}

abbe_result abbe_conductor_of_metal(const abbe_points *n, const abbe_points *k,
                                    abbe_material *material, bool *made, abbe_error *error) {
  *made = false;
  if (!is_metal(n, k, material)) return ABBE_OK;
  double *column = malloc(3 * n->count * sizeof *column);
  if (column == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for points");
  for (size_t i = 0; i < n->count; i++) {
    column[i] = n->point[i].lambda_nm;
    column[n->count + i] = n->point[i].value;
    column[2 * n->count + i] = k->point[i].value;
  }
  abbe_dispersion metal;
  abbe_result result = abbe_conductor_make(column, column + n->count, column + 2 * n->count,
                                           n->count, &metal, error);
  free(column);
  if (result != ABBE_OK) return result;
  abbe_dispersion_free(&material->dispersion);
  abbe_spectrum_free(material->attenuation);
  material->dispersion = metal;
  material->attenuation = NULL;
  material->published_n_d = material->published_v_d = 0;
  *made = true;
  return ABBE_OK;
}
