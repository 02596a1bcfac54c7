/* glass_distance.h: which materials of a table are nearest to given numbers or to a given curve.
 *
 * Every distance is a difference of refractive index, root mean square over a range, so that those
 * of both ways can be compared. Not to be mistaken for nearest.h, which is about mistyped words.
 */
#ifndef ABBE_SPECTRAL_MATERIALS_GLASS_DISTANCE_H
#define ABBE_SPECTRAL_MATERIALS_GLASS_DISTANCE_H

#include "base/error.h"
#include "spectral/dispersion/dispersion.h"
#include "spectral/dispersion/index_points.h"
#include "spectral/materials/material_table.h"

#include <stddef.h>

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
