/* material_range.h: between what a material's index and attenuation lie over a range of
 * wavelengths.
 *
 * Where the plan reads n(lambda) and attenuation, and nowhere else: whether something varies,
 * whether light notices it at all, and one value that stands for all of it.
 * Internal to gl/plan/examine/.
 */
#ifndef ABBE_GL_PLAN_EXAMINE_MATERIAL_RANGE_H
#define ABBE_GL_PLAN_EXAMINE_MATERIAL_RANGE_H

#include "base/error.h"
#include "spectral/materials/material.h"

typedef struct abbe_material_range {
  double least_n, most_n;
  double least_per_m, most_per_m; /* attenuation */
  double middle_n, middle_per_m;  /* at the range's middle */
} abbe_material_range;

/* At 81 wavelengths from min_nm to max_nm, and at their mean. ABBE_OUT_OF_RANGE where the index is
 * not known. */
abbe_result abbe_material_range_make(const abbe_material *material, double min_nm, double max_nm,
                                     abbe_material_range *out, abbe_error *error);

#endif
