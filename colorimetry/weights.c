#include "colorimetry/weights.h"

#include "colorimetry/observer.h"

#include <math.h>
#include <stdlib.h>

const double abbe_weights_thesis_lambda_nm[ABBE_WEIGHTS_THESIS_COUNT] = {380, 430, 480, 530,
                                                                         580, 630, 680};

/* [Blanchette2012, appendix A] */
const double abbe_weights_thesis_rgb[ABBE_WEIGHTS_THESIS_COUNT][3] = {
    {0.3, 0.0, 0.8}, {0.2, 0.2, 1.0}, {0.0, 0.9, 1.0}, {0.3, 1.0, 0.4},
    {0.8, 0.9, 0.3}, {0.9, 0.5, 0.0}, {1.0, 0.0, 0.0}};

/* [Blanchette2012, table 2] */
const double abbe_weights_thesis_table2[ABBE_WEIGHTS_THESIS_COUNT][3] = {
    {77, 0, 204},     {51, 51, 255},   {0, 229.5, 255}, {76.5, 255, 102},
    {204, 229.5, 77}, {229.5, 128, 0}, {255, 0, 0}};

/* Six-point Gauss-Legendre rule on [-1, 1]: exact to degree 11. Between knots the observer is a
 * cubic and a tabulated light at most one too; the Planckian A is smooth over 5 nm. */
enum { RULE_COUNT = 6 };
static const double rule_x[RULE_COUNT] = {-0.9324695142031521, -0.6612093864662645,
                                          -0.2386191860831969, 0.2386191860831969,
                                          0.6612093864662645,  0.9324695142031521};
static const double rule_w[RULE_COUNT] = {0.1713244923791704, 0.3607615730481386,
                                          0.4679139345726910, 0.4679139345726910,
                                          0.3607615730481386, 0.1713244923791704};

/* Neumaier's compensated sum: thousands of bands add up to the last bit or so. */
typedef struct sum3 {
  double value[3], lost[3];
} sum3;

static void sum_add(sum3 *sum, const double x[3]) {
  for (int k = 0; k < 3; k++) {
    double total = sum->value[k] + x[k];
    sum->lost[k] += fabs(sum->value[k]) >= fabs(x[k]) ? (sum->value[k] - total) + x[k]
                                                      : (x[k] - total) + sum->value[k];
    sum->value[k] = total;
  }
}

static void sum_get(const sum3 *sum, double out[3]) {
  for (int k = 0; k < 3; k++) out[k] = sum->value[k] + sum->lost[k];
}

/* The first knot of the light's own table above lambda_nm; infinity where there is none. */
static double table_knot_above(const abbe_illuminant *illuminant, double lambda_nm) {
  if (illuminant->kind != ABBE_ILLUMINANT_TABULATED) return INFINITY;
  const double *nm = abbe_spectrum_lambda_nm(illuminant->spectrum);
  size_t low = 0, high = abbe_spectrum_count(illuminant->spectrum);
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (nm[middle] > lambda_nm)
      high = middle;
    else
      low = middle + 1;
  }
  return low < abbe_spectrum_count(illuminant->spectrum) ? nm[low] : INFINITY;
}

/* The CIE's tables have their knots at multiples of 5 nm. */
static double cie_knot_above(double lambda_nm) {
  return 5 * floor(lambda_nm / 5) + 5;
}

static void add_piece(const abbe_illuminant *illuminant, double from, double to, sum3 *sum) {
  double half = (to - from) / 2, middle = from + half, piece[3] = {0};
  for (int i = 0; i < RULE_COUNT; i++) {
    double lambda_nm = middle + half * rule_x[i], xyz[3];
    abbe_observer_xyz(lambda_nm, xyz);
    double factor = half * rule_w[i] * abbe_illuminant_power(illuminant, lambda_nm);
    for (int k = 0; k < 3; k++) piece[k] += factor * xyz[k];
  }
  sum_add(sum, piece);
}

/* Observer x illuminant over [from, to], cut where either has a knot. */
static void integrate(const abbe_illuminant *illuminant, double from, double to, double xyz[3]) {
  from = fmax(from, ABBE_OBSERVER_MIN_NM);
  to = fmin(to, ABBE_OBSERVER_MAX_NM);
  sum3 sum = {0};
  while (from < to) {
    double knot = fmin(cie_knot_above(from), table_knot_above(illuminant, from));
    double next = fmin(knot, to);
    add_piece(illuminant, from, next, &sum);
    from = next;
  }
  sum_get(&sum, xyz);
}

void abbe_weights_range_make(const abbe_illuminant *illuminant, double min_nm, double max_nm,
                             abbe_weights_range *out) {
  double white[3];
  integrate(illuminant, min_nm, max_nm, white);
  *out = (abbe_weights_range){illuminant, min_nm, max_nm, white[1]};
}

void abbe_weights_range_xyz(const abbe_weights_range *range, double from_nm, double to_nm,
                            double xyz[3]) {
  integrate(range->illuminant, fmax(from_nm, range->min_nm), fmin(to_nm, range->max_nm), xyz);
  for (int k = 0; k < 3; k++) xyz[k] = range->white_y > 0 ? xyz[k] / range->white_y : 0;
}

void abbe_weights_band_xyz(const abbe_illuminant *illuminant, double min_nm, double max_nm,
                           double from_nm, double to_nm, double xyz[3]) {
  abbe_weights_range range;
  abbe_weights_range_make(illuminant, min_nm, max_nm, &range);
  abbe_weights_range_xyz(&range, from_nm, to_nm, xyz);
}

/* The illuminant's power over [from, to], relative, cut where its table has a knot. */
static double integrate_power(const abbe_illuminant *illuminant, double from, double to) {
  double sum = 0;
  while (from < to) {
    double next = fmin(fmin(cie_knot_above(from), table_knot_above(illuminant, from)), to);
    double half = (next - from) / 2, middle = from + half;
    for (int i = 0; i < RULE_COUNT; i++)
      sum += half * rule_w[i] * abbe_illuminant_power(illuminant, middle + half * rule_x[i]);
    from = next;
  }
  return sum;
}

double abbe_weights_band_power(const abbe_illuminant *illuminant, double min_nm, double max_nm,
                               double from_nm, double to_nm) {
  double all = integrate_power(illuminant, min_nm, max_nm);
  double band = integrate_power(illuminant, fmax(from_nm, min_nm), fmin(to_nm, max_nm));
  return all > 0 ? band / all : 0;
}

static void sum_weights(abbe_weights *weights) {
  sum3 sum = {0};
  for (size_t i = 0; i < weights->count; i++) sum_add(&sum, weights->weight[i]);
  sum_get(&sum, weights->sum);
}

abbe_result abbe_weights_make(const abbe_wavelengths *wavelengths,
                              const abbe_illuminant *illuminant, abbe_rgb_space space,
                              abbe_weights *out, abbe_error *error) {
  ABBE_REQUIRE(wavelengths && wavelengths->count > 0 && illuminant && out, error);
  *out = (abbe_weights){0};
  abbe_weights weights = {.count = wavelengths->count};
  weights.weight = calloc(weights.count, sizeof *weights.weight);
  if (weights.weight == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for %zu weights",
                          weights.count);
  for (size_t i = 0; i < weights.count; i++)
    integrate(illuminant, wavelengths->edge_nm[i], wavelengths->edge_nm[i + 1], weights.weight[i]);
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

void abbe_weights_free(abbe_weights *weights) {
  if (weights == NULL) return;
  free(weights->weight);
  *weights = (abbe_weights){0};
}
