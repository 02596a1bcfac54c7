#include "colorimetry/weights.h"

#include "colorimetry/observer_integral.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

const double abbe_weights_thesis_lambda_nm[ABBE_WEIGHTS_THESIS_COUNT] = {380, 430, 480, 530,
                                                                         580, 630, 680};

/* [Blanchette2012, appendix A] */
const double abbe_weights_thesis_rgb[ABBE_WEIGHTS_THESIS_COUNT][3] = {
    {0.3, 0.0, 0.8}, {0.2, 0.2, 1.0}, {0.0, 0.9, 1.0}, {0.3, 1.0, 0.4},
    {0.8, 0.9, 0.3}, {0.9, 0.5, 0.0}, {1.0, 0.0, 0.0}};

void abbe_weights_range_make_by(abbe_observer observer, const abbe_illuminant *illuminant,
                                double min_nm, double max_nm, abbe_weights_range *out) {
  double white[3];
  abbe_observer_integral_by(observer, illuminant, min_nm, max_nm, white);
  *out = (abbe_weights_range){observer, illuminant, min_nm, max_nm, white[1]};
}

void abbe_weights_range_make(const abbe_illuminant *illuminant, double min_nm, double max_nm,
                             abbe_weights_range *out) {
  abbe_weights_range_make_by(ABBE_OBSERVER_CIE_1931, illuminant, min_nm, max_nm, out);
}

void abbe_weights_range_xyz(const abbe_weights_range *range, double from_nm, double to_nm,
                            double xyz[3]) {
  abbe_observer_integral_by(range->observer, range->illuminant, fmax(from_nm, range->min_nm),
                            fmin(to_nm, range->max_nm), xyz);
  for (int k = 0; k < 3; k++) xyz[k] = range->white_y > 0 ? xyz[k] / range->white_y : 0;
}

void abbe_weights_band_xyz(const abbe_illuminant *illuminant, double min_nm, double max_nm,
                           double from_nm, double to_nm, double xyz[3]) {
  abbe_weights_range range;
  abbe_weights_range_make(illuminant, min_nm, max_nm, &range);
  abbe_weights_range_xyz(&range, from_nm, to_nm, xyz);
}

void abbe_weights_white(abbe_observer observer, const abbe_illuminant *illuminant, double min_nm,
                        double max_nm, double xyz[3]) {
  abbe_weights_range range;
  abbe_weights_range_make_by(observer, illuminant, min_nm, max_nm, &range);
  abbe_weights_range_xyz(&range, min_nm, max_nm, xyz);
}

double abbe_weights_band_power(const abbe_illuminant *illuminant, double min_nm, double max_nm,
                               double from_nm, double to_nm) {
  double all = abbe_observer_integral_power(illuminant, min_nm, max_nm);
  double band =
      abbe_observer_integral_power(illuminant, fmax(from_nm, min_nm), fmin(to_nm, max_nm));
  return all > 0 ? band / all : 0;
}

static void sum_weights(abbe_weights *weights) {
  abbe_sum3 sum = {0};
  for (size_t i = 0; i < weights->count; i++) abbe_sum3_add(&sum, weights->weight[i]);
  abbe_sum3_get(&sum, weights->sum);
}

abbe_result abbe_weights_make_by(abbe_observer observer, const abbe_wavelengths *wavelengths,
                                 const abbe_illuminant *illuminant, abbe_rgb_space space,
                                 abbe_weights *out, abbe_error *error) {
  assert(wavelengths->count > 0);
  *out = (abbe_weights){0};
  abbe_weights weights = {.count = wavelengths->count};
  weights.weight = calloc(weights.count, sizeof *weights.weight);
  if (weights.weight == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for %zu weights",
                          weights.count);
  for (size_t i = 0; i < weights.count; i++)
    abbe_observer_integral_by(observer, illuminant, wavelengths->edge_nm[i],
                              wavelengths->edge_nm[i + 1], weights.weight[i]);
  sum_weights(&weights);
  double white_y = weights.sum[1];
  if (!(white_y > 0 && isfinite(white_y))) {
    abbe_weights_free(&weights);
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the range %g to %g nm holds no light that the eye sees under the "
                          "illuminant %s; the eye sees %g to %g nm",
                          wavelengths->edge_nm[0], wavelengths->edge_nm[wavelengths->count],
                          abbe_illuminant_name(illuminant), ABBE_OBSERVER_MIN_NM,
                          ABBE_OBSERVER_MAX_NM);
  }
  double matrix[9];
  abbe_rgb_space_from_xyz(space, matrix);
  for (size_t i = 0; i < weights.count; i++) {
    for (int k = 0; k < 3; k++) weights.weight[i][k] /= white_y;
    abbe_rgb_space_apply(matrix, weights.weight[i], weights.weight[i]);
  }
  sum_weights(&weights);
  *out = weights;
  return ABBE_OK;
}

abbe_result abbe_weights_make(const abbe_wavelengths *wavelengths,
                              const abbe_illuminant *illuminant, abbe_rgb_space space,
                              abbe_weights *out, abbe_error *error) {
  return abbe_weights_make_by(ABBE_OBSERVER_CIE_1931, wavelengths, illuminant, space, out, error);
}

void abbe_weights_free(abbe_weights *weights) {
  if (weights == NULL) return;
  free(weights->weight);
  *weights = (abbe_weights){0};
}
