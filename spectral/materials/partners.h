/* partners.h: which glasses make an achromat with a glass, and how good a one.
 *
 * Thin lenses in contact, of power 1 together at d: two with F and C in one focus, or three with F,
 * C and g in one. It designs no shapes, and knows no spherical aberration.
 */
#ifndef ABBE_SPECTRAL_MATERIALS_PARTNERS_H
#define ABBE_SPECTRAL_MATERIALS_PARTNERS_H

#include "base/error.h"
#include "spectral/dispersion/dispersion.h"
#include "spectral/dispersion/index_points.h"
#include "spectral/materials/material_query.h"
#include "spectral/materials/material_table.h"

#include <stddef.h>

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

/* Which materials of a table are nearest to given numbers or to a given curve.
 *
 * Every distance is a difference of refractive index, root mean square over a range, so that those
 * of both ways can be compared. Mistyped words are abbe_nearest_word's. */

typedef struct abbe_glass_distance {
  size_t index;       /* the material's index in its table */
  double rms;         /* root mean square difference of n over the range: the distance */
  double max, max_nm; /* largest difference and where; NaN by numbers */
  double n_d, v_d;    /* the material's, NaN where its record does not cover the lines */
} abbe_glass_distance;

typedef struct abbe_glass_distances {
  size_t count;                 /* at most the number asked for */
  size_t skipped;               /* materials without data in the range, or at the lines d, F, C;
                                   conductors, which are no glasses, are not counted */
  abbe_glass_distance *nearest; /* [count], nearest first; equals in the table's order */
} abbe_glass_distances;

/* By n_d > 1 and V_d > 0: the difference over 380 to 780 nm of the two-term Cauchy curves that the
 * two pairs of numbers imply, so that n_d and V_d weigh as they do in the index. At most `wanted`
 * (0: all). ABBE_INVALID_ARGUMENT for numbers that are none; ABBE_NO_MEMORY. */
abbe_result abbe_glass_distance_to_numbers(const abbe_material_table *table, double n_d, double v_d,
                                           size_t wanted, abbe_glass_distances *out,
                                           abbe_error *error);

/* By the whole curve, at the points; materials whose data do not reach from the first point to the
 * last are skipped unless they extrapolate. */
abbe_result abbe_glass_distance_to_points(const abbe_material_table *table,
                                          const abbe_index_points *points, size_t wanted,
                                          abbe_glass_distances *out, abbe_error *error);

/* By the whole curve, of a formula over [min_nm, max_nm]. */
abbe_result abbe_glass_distance_to_curve(const abbe_material_table *table,
                                         const abbe_dispersion *curve, double min_nm, double max_nm,
                                         size_t wanted, abbe_glass_distances *out,
                                         abbe_error *error);

void abbe_glass_distances_free(abbe_glass_distances *distances);

#endif
