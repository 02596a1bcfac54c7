/* index_difference.h: how far two dispersion curves lie apart over a range. */
#ifndef ABBE_SPECTRAL_DISPERSION_INDEX_DIFFERENCE_H
#define ABBE_SPECTRAL_DISPERSION_INDEX_DIFFERENCE_H

#include "base/error.h"
#include "spectral/dispersion/dispersion.h"
#include "spectral/dispersion/index_points.h"

typedef struct abbe_index_difference {
  double rms;    /* root of the mean square of n_a - n_b */
  double mean;   /* mean of n_a - n_b: what a shift of the whole curve would take away */
  double max;    /* largest |n_a - n_b| */
  double max_nm; /* where that is */
} abbe_index_difference;

/* a - b over [min_nm, max_nm] at steps of 1 nm (401 to 4001 of them, evenly, on shorter or longer
 * ranges). ABBE_INVALID_ARGUMENT where the range is not one or a formula has no real index. */
abbe_result abbe_index_difference_of_curves(const abbe_dispersion *a, const abbe_dispersion *b,
                                            double min_nm, double max_nm,
                                            abbe_index_difference *out, abbe_error *error);

/* a - the points' n, at those of the points that lie within [min_nm, max_nm]; an infinite end is
 * no limit. ABBE_INVALID_ARGUMENT where there are none, or a has no real index at one. */
abbe_result abbe_index_difference_of_points(const abbe_dispersion *a,
                                            const abbe_index_points *points, double min_nm,
                                            double max_nm, abbe_index_difference *out,
                                            abbe_error *error);

#endif
