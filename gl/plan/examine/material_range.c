#include "gl/plan/examine/material_range.h"

#include <math.h>

enum { STEPS = 81 };

abbe_result abbe_material_range_make(const abbe_material *material, double min_nm, double max_nm,
                                     abbe_material_range *out, abbe_error *error) {
  const double middle_nm = 0.5 * (min_nm + max_nm);
  *out = (abbe_material_range){.least_n = INFINITY,
                               .most_n = -INFINITY,
                               .least_per_m = INFINITY,
                               .most_per_m = -INFINITY,
                               .middle_per_m = abbe_material_attenuation(material, middle_nm)};
  for (int i = 0; i < STEPS; i++) {
    const double lambda_nm = min_nm + (max_nm - min_nm) * i / (STEPS - 1);
    double n = 0;
    abbe_result result = abbe_material_n(material, lambda_nm, &n, error);
    if (result != ABBE_OK) return result;
    const double per_m = abbe_material_attenuation(material, lambda_nm);
    out->least_n = fmin(out->least_n, n);
    out->most_n = fmax(out->most_n, n);
    out->least_per_m = fmin(out->least_per_m, per_m);
    out->most_per_m = fmax(out->most_per_m, per_m);
  }
  return abbe_material_n(material, middle_nm, &out->middle_n, error);
}
