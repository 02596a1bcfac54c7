#include "spectral/material.h"

#include <math.h>
#include <stdlib.h>

void abbe_material_free(abbe_material *material) {
  free(material->name);
  free(material->description);
  free(material->source);
  free(material->warning);
  abbe_dispersion_free(&material->dispersion);
  abbe_spectrum_free(material->attenuation);
  *material = (abbe_material){0};
}

bool abbe_material_extrapolates(const abbe_material *material, double lambda_nm) {
  return lambda_nm < material->min_nm || lambda_nm > material->max_nm;
}

abbe_result abbe_material_n(const abbe_material *material, double lambda_nm, double *n,
                            abbe_error *error) {
  if (abbe_material_extrapolates(material, lambda_nm) && !material->extrapolate)
    return abbe_error_set(error, ABBE_OUT_OF_RANGE,
                          "%s has no index at %g nm: its data reach from %g to %g nm, and its "
                          "record does not say 'extrapolate: true'",
                          material->name, lambda_nm, material->min_nm, material->max_nm);
  double value = abbe_dispersion_n(&material->dispersion, lambda_nm);
  if (isnan(value))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: its %s formula has no real index at %g nm", material->name,
                          abbe_dispersion_model_name(material->dispersion.model), lambda_nm);
  *n = value;
  return ABBE_OK;
}

double abbe_material_attenuation(const abbe_material *material, double lambda_nm) {
  if (material->attenuation == NULL) return 0;
  double value = abbe_spectrum_at(material->attenuation, lambda_nm);
  return value > 0 ? value : 0; /* a spline may dip below its points */
}
