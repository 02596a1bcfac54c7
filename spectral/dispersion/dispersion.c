#include "spectral/dispersion/dispersion.h"

#include <math.h>
#include <string.h>

void abbe_dispersion_free(abbe_dispersion *dispersion) {
  if (dispersion == NULL) return;
  abbe_spectrum_free(dispersion->table);
  abbe_spectrum_free(dispersion->k);
  *dispersion = (abbe_dispersion){0};
}

/* ---- n(lambda) ---- */

static double cauchy(const double *c, size_t count, double L) {
  double x = 1 / (L * L), sum = 0;
  for (size_t k = count; k-- > 0;) sum = sum * x + c[k];
  return sum;
}

/* The pole of each term is the square of its coefficient, or the coefficient itself. */
static double sellmeier(const double *c, size_t count, double L, bool pole_squared) {
  double sum = 1 + (count > 0 ? c[0] : 0);
  for (size_t k = 1; k + 1 < count; k += 2) {
    double pole = pole_squared ? c[k + 1] * c[k + 1] : c[k + 1];
    if (c[k] != 0) sum += c[k] * L * L / (L * L - pole);
  }
  return sum;
}

static double powers(const double *c, size_t first, size_t count, double L) {
  double sum = 0;
  for (size_t k = first; k + 1 < count; k += 2)
    if (c[k] != 0) sum += c[k] * pow(L, c[k + 1]);
  return sum;
}

static double rii4(const double *c, size_t count, double L) {
  double sum = count > 0 ? c[0] : 0;
  for (size_t k = 1; k + 3 < count && k <= 5; k += 4)
    if (c[k] != 0) sum += c[k] * pow(L, c[k + 1]) / (L * L - pow(c[k + 2], c[k + 3]));
  return sum + powers(c, 9, count, L);
}

static double herzberger(const double *c, size_t count, double L) {
  if (count < 6) return NAN;
  double x = L * L, K = 1 / (x - 0.028);
  return c[0] + K * (c[1] + K * c[2]) + x * (c[3] + x * (c[4] + x * c[5]));
}

static double gas(const double *c, size_t count, double L) {
  double sum = 1 + (count > 0 ? c[0] : 0), x = 1 / (L * L);
  for (size_t k = 1; k + 1 < count; k += 2)
    if (c[k] != 0) sum += c[k] / (c[k + 1] - x);
  return sum;
}

/* n^2 from the share (n^2 - 1) / (n^2 + 2). */
static double retro(const double *c, size_t count, double L) {
  if (count < 4) return NAN;
  double x = L * L, share = c[0] + c[3] * x;
  if (c[1] != 0) share += c[1] * x / (x - c[2]);
  return (1 + 2 * share) / (1 - share);
}

static double exotic(const double *c, size_t count, double L) {
  if (count < 6) return NAN;
  double sum = c[0], u = L - c[4];
  if (c[1] != 0) sum += c[1] / (L * L - c[2]);
  if (c[3] != 0) sum += c[3] * u / (u * u + c[5]);
  return sum;
}

/* n, or NaN where it is not a positive, finite number. */
static double physical(double n) {
  return isfinite(n) && n > 0 ? n : NAN;
}

static double index_of_source(const abbe_dispersion *dispersion, double lambda_nm) {
  if (!(lambda_nm > 0) || !isfinite(lambda_nm)) return NAN;
  const double *c = dispersion->c;
  size_t count = dispersion->count;
  double L = lambda_nm / 1000;
  switch (dispersion->model) {
  case ABBE_DISPERSION_CONSTANT:
    return physical(count > 0 ? c[0] : NAN);
  case ABBE_DISPERSION_CAUCHY:
    return physical(cauchy(c, count, L));
  case ABBE_DISPERSION_SELLMEIER:
    return physical(sqrt(sellmeier(c, count, L, true)));
  case ABBE_DISPERSION_SELLMEIER2:
    return physical(sqrt(sellmeier(c, count, L, false)));
  case ABBE_DISPERSION_POLYNOMIAL:
    return physical(sqrt((count > 0 ? c[0] : 0) + powers(c, 1, count, L)));
  case ABBE_DISPERSION_RII4:
    return physical(sqrt(rii4(c, count, L)));
  case ABBE_DISPERSION_POWERS:
    return physical((count > 0 ? c[0] : 0) + powers(c, 1, count, L));
  case ABBE_DISPERSION_HERZBERGER:
    return physical(herzberger(c, count, L));
  case ABBE_DISPERSION_RII6:
    return physical(gas(c, count, L));
  case ABBE_DISPERSION_RII8:
    return physical(sqrt(retro(c, count, L)));
  case ABBE_DISPERSION_RII9:
    return physical(sqrt(exotic(c, count, L)));
  case ABBE_DISPERSION_TABULATED:
    return dispersion->table != NULL ? physical(abbe_spectrum_at(dispersion->table, lambda_nm))
                                     : NAN;
  case ABBE_DISPERSION_CONDUCTOR:
  case ABBE_DISPERSION_MODEL_COUNT:
    break;
  }
  return NAN;
}

/* A catalogue's n relative to the air that is there; infinite at lambda_tk. Exactly 1 is the air's
 * own and stays. */
static double index_shift_n(const abbe_index_shift *shift, double n, double lambda_nm) {
  if (n == 1) return 1;
  const double *t = shift->thermal, d = shift->to_c - shift->from_c, L = lambda_nm / 1000;
  double absolute = n * abbe_air_n(lambda_nm, shift->from_c, shift->from_atm);
  if (d != 0)
    absolute += (absolute - 1 / absolute) / 2 * d *
                (t[0] + d * (t[1] + d * t[2]) + (t[3] + d * t[4]) / (L * L - t[5] * t[5]));
  return absolute / abbe_air_n(lambda_nm, shift->to_c, shift->pressure_atm);
}

double abbe_dispersion_n(const abbe_dispersion *dispersion, double lambda_nm) {
  const double n = index_of_source(dispersion, lambda_nm);
  return dispersion->shift.on ? physical(index_shift_n(&dispersion->shift, n, lambda_nm)) : n;
}

bool abbe_dispersion_nk(const abbe_dispersion *dispersion, double lambda_nm, double *n, double *k) {
  const abbe_dispersion *d = dispersion;
  if (d->model != ABBE_DISPERSION_CONDUCTOR || d->table == NULL || d->k == NULL) return false;
  *n = abbe_spectrum_at(d->table, lambda_nm);
  *k = abbe_spectrum_at(d->k, lambda_nm);
  return true;
}

abbe_dispersion_numbers abbe_dispersion_describe(const abbe_dispersion *dispersion) {
  abbe_dispersion_numbers numbers = {
      .n_d = abbe_dispersion_n(dispersion, ABBE_LINE_D_NM),
      .n_F = abbe_dispersion_n(dispersion, ABBE_LINE_F_NM),
      .n_C = abbe_dispersion_n(dispersion, ABBE_LINE_C_NM),
      .b_g = abbe_dispersion_n(dispersion, ABBE_LINE_G_NM) -
             abbe_dispersion_n(dispersion, ABBE_LINE_B_NM),
  };
  double spread = numbers.n_F - numbers.n_C;
  numbers.v_d = spread == 0 ? INFINITY : (numbers.n_d - 1) / spread;
  return numbers;
}

/* ---- names, and what a model's coefficients must be ---- */

static const struct {
  const char *name, *formula;
} models[] = {
#define ABBE_DISPERSION_ROW(code, name, formula) {name, formula},
    ABBE_DISPERSION_MODELS(ABBE_DISPERSION_ROW)
#undef ABBE_DISPERSION_ROW
};

static bool known(abbe_dispersion_model model) {
  return (int)model >= 0 && model < ABBE_DISPERSION_MODEL_COUNT;
}

const char *abbe_dispersion_model_name(abbe_dispersion_model model) {
  return known(model) ? models[model].name : "unknown";
}

const char *abbe_dispersion_model_formula(abbe_dispersion_model model) {
  return known(model) ? models[model].formula : "unknown";
}

/* NULL where the count fits the model, else the counts that would. */
static const char *wanted_count(abbe_dispersion_model model, size_t count) {
  switch (model) {
  case ABBE_DISPERSION_CONSTANT:
    return count == 1 ? NULL : "1";
  case ABBE_DISPERSION_CAUCHY:
    return count >= 1 ? NULL : "1 or more";
  case ABBE_DISPERSION_SELLMEIER:
  case ABBE_DISPERSION_SELLMEIER2:
  case ABBE_DISPERSION_POLYNOMIAL:
  case ABBE_DISPERSION_POWERS:
  case ABBE_DISPERSION_RII6:
    return count % 2 == 1 ? NULL : "an odd number (c0, then pairs)";
  case ABBE_DISPERSION_RII4:
    return count == 1 || count == 5 || (count >= 9 && count % 2 == 1)
               ? NULL
               : "1, 5, 9, or 9 and further pairs";
  case ABBE_DISPERSION_HERZBERGER:
  case ABBE_DISPERSION_RII9:
    return count == 6 ? NULL : "6";
  case ABBE_DISPERSION_RII8:
    return count == 4 ? NULL : "4";
  default:
    return count == 0 ? NULL : "none";
  }
}

/* NULL, or what is wrong with the points of a conductor. */
static const char *wrong_conductor(const abbe_dispersion *d) {
  if (d->table == NULL || d->k == NULL) return "the model conductor wants points of n and of k";
  size_t count = abbe_spectrum_count(d->table);
  if (count != abbe_spectrum_count(d->k) ||
      memcmp(abbe_spectrum_lambda_nm(d->table), abbe_spectrum_lambda_nm(d->k),
             count * sizeof(double)) != 0)
    return "n and k of a conductor stand at different wavelengths";
  if (abbe_spectrum_interpolation(d->table) != ABBE_INTERPOLATION_LINEAR ||
      abbe_spectrum_interpolation(d->k) != ABBE_INTERPOLATION_LINEAR)
    return "n and k of a conductor run straight between their points";
  const double *n = abbe_spectrum_value(d->table), *k = abbe_spectrum_value(d->k);
  for (size_t i = 0; i < count; i++)
    if (!(n[i] >= 0 && n[i] <= 1e3 && k[i] >= 0 && k[i] <= 1e3))
      return "n and k of a conductor lie from 0 to 1000";
  return NULL;
}

abbe_result abbe_dispersion_check(const abbe_dispersion *dispersion, abbe_error *error) {
  if (!known(dispersion->model))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "there is no dispersion model %d",
                          (int)dispersion->model);
  const char *name = models[dispersion->model].name;
  if (dispersion->count > ABBE_DISPERSION_MAX_COEFFICIENTS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the model %s has %zu coefficients; at most %d are possible", name,
                          dispersion->count, ABBE_DISPERSION_MAX_COEFFICIENTS);
  const char *wanted = wanted_count(dispersion->model, dispersion->count);
  if (wanted != NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the model %s wants %s of coefficients, not %zu", name, wanted,
                          dispersion->count);
  for (size_t i = 0; i < dispersion->count; i++)
    if (!isfinite(dispersion->c[i]))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "coefficient %zu of the model %s is %g",
                            i, name, dispersion->c[i]);
  if (dispersion->model == ABBE_DISPERSION_TABULATED && dispersion->table == NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the model tabulated has no points");
  if (dispersion->model != ABBE_DISPERSION_CONDUCTOR) return ABBE_OK;
  const char *wrong = wrong_conductor(dispersion);
  if (wrong != NULL) return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s", wrong);
  return ABBE_OK;
}

bool abbe_conditions_given(const abbe_conditions *at) {
  return !isnan(at->temperature_c) || !isnan(at->pressure_atm);
}

double abbe_air_n(double lambda_nm, double temperature_c, double pressure_atm) {
  const double x = lambda_nm * lambda_nm / 1e6, t = fmax(temperature_c, ABBE_AIR_LEAST_C);
  const double at_15_c = 6432.8 + 2949810 * x / (146 * x - 1) + 25540 * x / (41 * x - 1);
  return 1 + 1e-8 * at_15_c * pressure_atm / (1 + 3.4785e-3 * (t - 15));
}
