#include "spectral/dispersion/conditions.h"

#include <math.h>

bool abbe_conditions_given(const abbe_conditions *at) {
  return !isnan(at->temperature_c) || !isnan(at->pressure_atm);
}

double abbe_air_n(double lambda_nm, double temperature_c, double pressure_atm) {
  const double x = lambda_nm * lambda_nm / 1e6, t = fmax(temperature_c, ABBE_AIR_LEAST_C);
  const double at_15_c = 6432.8 + 2949810 * x / (146 * x - 1) + 25540 * x / (41 * x - 1);
  return 1 + 1e-8 * at_15_c * pressure_atm / (1 + 3.4785e-3 * (t - 15));
}

double abbe_index_shift_n(const abbe_index_shift *shift, double n, double lambda_nm) {
  if (n == 1) return 1;
  const double *t = shift->thermal, d = shift->to_c - shift->from_c, L = lambda_nm / 1000;
  double absolute = n * abbe_air_n(lambda_nm, shift->from_c, shift->from_atm);
  if (d != 0)
    absolute += (absolute - 1 / absolute) / 2 * d *
                (t[0] + d * (t[1] + d * t[2]) + (t[3] + d * t[4]) / (L * L - t[5] * t[5]));
  return absolute / abbe_air_n(lambda_nm, shift->to_c, shift->pressure_atm);
}
