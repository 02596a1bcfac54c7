#include "spectral/dispersion/index_points.h"

#include <math.h>

abbe_result abbe_index_difference_of_points(const abbe_dispersion *a,
                                            const abbe_index_points *points, double min_nm,
                                            double max_nm, abbe_index_difference *out,
                                            abbe_error *error) {
  abbe_index_difference found = {.max = -1};
  size_t used = 0;
  for (size_t i = 0; i < points->count; i++) {
    double lambda_nm = points->lambda_nm[i];
    if (lambda_nm < min_nm || lambda_nm > max_nm) continue;
    double off = abbe_dispersion_n(a, lambda_nm) - points->n[i];
    if (isnan(off))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "the %s formula has no real index at %g nm",
                            abbe_dispersion_model_name(a->model), lambda_nm);
    found.rms += off * off;
    found.mean += off;
    if (fabs(off) > found.max) {
      found.max = fabs(off);
      found.max_nm = lambda_nm;
    }
    used++;
  }
  if (used == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "no point lies within %g:%g nm", min_nm,
                          max_nm);
  found.rms = sqrt(found.rms / (double)used);
  found.mean /= (double)used;
  *out = found;
  return ABBE_OK;
}

abbe_result abbe_index_difference_of_curves(const abbe_dispersion *a, const abbe_dispersion *b,
                                            double min_nm, double max_nm,
                                            abbe_index_difference *out, abbe_error *error) {
  abbe_index_points points;
  abbe_result result = abbe_index_points_sample(b, min_nm, max_nm, 401, 4001, &points, error);
  if (result == ABBE_OK)
    result = abbe_index_difference_of_points(a, &points, min_nm, max_nm, out, error);
  abbe_index_points_free(&points);
  return result;
}
