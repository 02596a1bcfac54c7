#include "spectral/materials/conductor.h"

#include "spectral/wavelengths.h"

#include <math.h>
#include <stdlib.h>

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
