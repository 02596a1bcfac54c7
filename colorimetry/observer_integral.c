#include "colorimetry/observer_integral.h"

/* Six-point Gauss-Legendre rule on [-1, 1]: exact to degree 11. Between knots the observer is a
 * cubic, a tabulated light at most one too, and a function of the caller's; the Planckian A is
 * smooth over 5 nm. */
enum { RULE_COUNT = 6 };
static const double rule_x[RULE_COUNT] = {-0.9324695142031521, -0.6612093864662645,
                                          -0.2386191860831969, 0.2386191860831969,
                                          0.6612093864662645,  0.9324695142031521};
static const double rule_w[RULE_COUNT] = {0.1713244923791704, 0.3607615730481386,
                                          0.4679139345726910, 0.4679139345726910,
                                          0.3607615730481386, 0.1713244923791704};

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
static double knot_above(const abbe_illuminant *illuminant, double lambda_nm) {
  return fmin(5 * floor(lambda_nm / 5) + 5, table_knot_above(illuminant, lambda_nm));
}

static void one(double lambda_nm, double value[3]) {
  (void)lambda_nm;
  value[0] = 1;
  value[1] = value[2] = 0;
}

/* Adds one smooth piece to the sums, one a function. */
static void add_piece(abbe_observer observer, const abbe_illuminant *illuminant, double from,
                      double to, int count, void (*functions)(double lambda_nm, double value[3]),
                      abbe_sum3 *sum) {
  const double half = (to - from) / 2, middle = from + half;
  double piece[3][3] = {{0}};
  for (int i = 0; i < RULE_COUNT; i++) {
    const double lambda_nm = middle + half * rule_x[i];
    double xyz[3], value[3];
    abbe_observer_xyz_of(observer, lambda_nm, xyz);
    functions(lambda_nm, value);
    const double factor = half * rule_w[i] * abbe_illuminant_power(illuminant, lambda_nm);
    for (int j = 0; j < count; j++)
      for (int k = 0; k < 3; k++) piece[j][k] += factor * xyz[k] * value[j];
  }
  for (int j = 0; j < count; j++) abbe_sum3_add(&sum[j], piece[j]);
}

static void integrate(abbe_observer observer, const abbe_illuminant *illuminant, double from,
                      double to, int count, void (*functions)(double lambda_nm, double value[3]),
                      abbe_sum3 *sum) {
  from = fmax(from, ABBE_OBSERVER_MIN_NM);
  to = fmin(to, ABBE_OBSERVER_MAX_NM);
  while (from < to) {
    const double next = fmin(knot_above(illuminant, from), to);
    add_piece(observer, illuminant, from, next, count, functions, sum);
    from = next;
  }
}

void abbe_observer_integral_by(abbe_observer observer, const abbe_illuminant *illuminant,
                               double from_nm, double to_nm, double xyz[3]) {
  abbe_sum3 sum = {0};
  integrate(observer, illuminant, from_nm, to_nm, 1, one, &sum);
  abbe_sum3_get(&sum, xyz);
}

void abbe_observer_integral(const abbe_illuminant *illuminant, double from_nm, double to_nm,
                            double xyz[3]) {
  abbe_observer_integral_by(ABBE_OBSERVER_CIE_1931, illuminant, from_nm, to_nm, xyz);
}

void abbe_observer_integral_of(abbe_observer observer, const abbe_illuminant *illuminant,
                               double from_nm, double to_nm,
                               void (*functions)(double lambda_nm, double value[3]),
                               double matrix[9]) {
  abbe_sum3 sum[3] = {{{0}, {0}}};
  integrate(observer, illuminant, from_nm, to_nm, 3, functions, sum);
  for (int j = 0; j < 3; j++) {
    double xyz[3];
    abbe_sum3_get(&sum[j], xyz);
    for (int k = 0; k < 3; k++) matrix[3 * k + j] = xyz[k];
  }
}

double abbe_observer_integral_power(const abbe_illuminant *illuminant, double from_nm,
                                    double to_nm) {
  double sum = 0;
  while (from_nm < to_nm) {
    const double next = fmin(knot_above(illuminant, from_nm), to_nm);
    const double half = (next - from_nm) / 2, middle = from_nm + half;
    for (int i = 0; i < RULE_COUNT; i++)
      sum += half * rule_w[i] * abbe_illuminant_power(illuminant, middle + half * rule_x[i]);
    from_nm = next;
  }
  return sum;
}
