/* partners.h: which glasses make an achromat with a glass, and how good a one.
 *
 * Thin lenses in contact, of power 1 together at d: two with F and C in one focus, or three with F,
 * C and g in one. It designs no shapes, and knows no spherical aberration.
 */
#ifndef ABBE_SPECTRAL_MATERIALS_PARTNERS_H
#define ABBE_SPECTRAL_MATERIALS_PARTNERS_H

#include "base/error.h"
#include "spectral/materials/material_numbers.h"
#include "spectral/materials/material_table.h"

typedef struct abbe_glass_partner {
  const abbe_material *material;
  abbe_material_numbers numbers;
  double power[3];  /* powers of the glass, of the partner, of the third or 0; their sum is 1 */
  double power_sum; /* sum of their sizes */
  double secondary; /* what is left, in units of f: of two f_g - f_F, of three f_d - f_F */
  size_t doubles; /* number of materials of the same index under other names, which are left out */
} abbe_glass_partner;

typedef struct abbe_glass_partners {
  size_t count;
  size_t skipped; /* without an index at d, F, C and g, or of two, or of Cauchy's first
                     two terms, which say nothing of P_gF */
  abbe_glass_partner *partner;
} abbe_glass_partners;

/* Those of the table with a sum of powers up to most_power, the least secondary spectrum first; of
 * equals the least sum. third may be NULL. Conductors are not counted. ABBE_OUT_OF_RANGE where the
 * glass or the third is such a one. */
abbe_result abbe_glass_partners_find(const abbe_material_table *table, const abbe_material *glass,
                                     const abbe_material *third, double most_power,
                                     abbe_glass_partners *out, abbe_error *error);
void abbe_glass_partners_free(abbe_glass_partners *partners);

#endif
