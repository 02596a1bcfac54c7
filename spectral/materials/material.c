#include "spectral/materials/material.h"

#include "base/text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void abbe_material_free(abbe_material *material) {
  if (material == NULL) return;
  free(material->name);
  free(material->description);
  free(material->source);
  free(material->warning);
  free(material->comment);
  free(material->catalogue.code);
  free(material->catalogue.status);
  abbe_dispersion_free(&material->dispersion);
  abbe_dispersion_free(&material->extraordinary);
  for (int i = 0; i < 2; i++) abbe_dispersion_free(&material->outer[i]);
  abbe_spectrum_free(material->attenuation);
  for (int i = 0; i < 2; i++) abbe_spectrum_free(material->attenuation_yz[i]);
  abbe_fluorescence_free(&material->fluorescence);
  *material = (abbe_material){0};
}

/* ---- whether a table may hold it ---- */

const double abbe_material_expansion_range_k[4] = {243, 343, 373, 573};

/* 1 where the value was none from low to high, and is now `otherwise`. */
static size_t bound(double *value, double low, double high, double otherwise) {
  if (*value >= low && *value <= high) return 0;
  *value = otherwise;
  return 1;
}

size_t abbe_material_catalogue_bound(abbe_material_catalogue *c) {
  const double most = ABBE_MATERIAL_CATALOGUE_MOST;
  size_t count = bound(&c->melt_frequency, 0, ABBE_MATERIAL_MELT_MOST, 0) +
                 bound(&c->density_g_cm3, 0, ABBE_MATERIAL_DENSITY_MOST, 0) +
                 bound(&c->dpgf, -ABBE_MATERIAL_DPGF_MOST, ABBE_MATERIAL_DPGF_MOST, 0);
  for (int i = 0; i < 2; i++) count += bound(&c->expansion_per_k[i], -most, most, 0);
  for (int i = 0; i < 4; i++) count += bound(&c->expansion_range_k[i], 0, most, 0);
  for (int i = 0; i < 6; i++) count += bound(&c->thermal[i], -most, most, 0);
  for (int i = 0; i < 6; i++) count += bound(&c->ratings[i], -most, most, -1);
  return count;
}

abbe_result abbe_material_check_name(const char *name, abbe_error *error) {
  size_t length = name == NULL ? 0 : strlen(name);
  bool good =
      length > 0 && length <= ABBE_MATERIAL_MAX_NAME && name[0] != ' ' && name[length - 1] != ' ';
  char shown[ABBE_MATERIAL_MAX_NAME + 1];
  if (good) abbe_utf8_printable(name, length, false, shown, sizeof shown);
  good = good && strcmp(name, shown) == 0;
  if (good) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "'%.100s' is not a name; up to %d printable characters, no space at the "
                        "ends",
                        name == NULL ? "" : name, ABBE_MATERIAL_MAX_NAME);
}

/* The points of a tabulated index cover the range. */
static abbe_result check_points(const abbe_material *m, const abbe_spectrum *table,
                                const char *which, abbe_error *error) {
  if (table == NULL) return ABBE_OK;
  const double *lambda_nm = abbe_spectrum_lambda_nm(table);
  double low = lambda_nm[0], high = lambda_nm[abbe_spectrum_count(table) - 1];
  if (m->min_nm >= low && m->max_nm <= high) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s: its range of %g to %g nm is wider than %s, which reach from %g to "
                        "%g nm",
                        m->name, m->min_nm, m->max_nm, which, low, high);
}

static abbe_result check_range(const abbe_material *m, abbe_error *error) {
  bool ascends = m->min_nm >= ABBE_SPECTRUM_LOW_NM && m->max_nm <= ABBE_SPECTRUM_HIGH_NM &&
                 m->min_nm < m->max_nm;
  const abbe_spectrum *table = m->dispersion.table;
  if (table != NULL && abbe_spectrum_count(table) < 2)
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "%s: it has an index at a single wavelength; give it two points or more%s", m->name,
        abbe_material_is_conductor(m) ? "" : ", or the model constant");
  if (!ascends)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: its range of %g to %g nm does not ascend between %g and %g", m->name,
                          m->min_nm, m->max_nm, ABBE_SPECTRUM_LOW_NM, ABBE_SPECTRUM_HIGH_NM);
  ABBE_TRY(check_points(m, table, "its points", error));
  for (int i = 0; i < 2; i++)
    ABBE_TRY(check_points(m, m->outer[i].table,
                          i == 0 ? "those of its index alpha" : "those of its index gamma", error));
  return check_points(m, m->extraordinary.table, "those of its extraordinary index", error);
}

/* The material's real indices, in the order in which those of a crystal ascend; returns how many.
 */
static int indices_of(const abbe_material *m, const abbe_dispersion *d[3], const char *which[3]) {
  const bool three = abbe_material_is_biaxial(m);
  d[0] = three ? &m->outer[0] : &m->dispersion;
  which[0] = three ? "alpha's " : "";
  d[1] = three ? &m->dispersion : &m->extraordinary;
  which[1] = three ? "" : "extraordinary ";
  d[2] = &m->outer[1];
  which[2] = "gamma's ";
  return three ? 3 : abbe_material_is_uniaxial(m) ? 2 : 1;
}

/* A formula that has a pole or no root inside its own range was copied wrongly, most often with
 * coefficients in another unit. Indices of a crystal are such as stones have, and three ascend at
 * every wavelength, which is judged where `stones`. */
static abbe_result check_curves(const abbe_material *m, double from, double to, bool stones,
                                abbe_error *error) {
  enum { STEPS = 1000 };
  const abbe_dispersion *d[3];
  const char *which[3];
  const int count = indices_of(m, d, which);
  for (int i = 0; i <= STEPS; i++) {
    const double nm = from + (to - from) * i / STEPS;
    double n[3] = {0};
    for (int k = 0; k < count; k++) {
      n[k] = abbe_dispersion_n(d[k], nm);
      if (isnan(n[k]))
        return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                              "%s: its %s%s formula has no real index at %g nm, inside its range; "
                              "check the coefficients (wavelengths in micrometres)",
                              m->name, which[k], abbe_dispersion_model_name(d[k]->model), nm);
    }
    if (!stones) continue;
    if (count == 3 && (n[0] > n[1] || n[1] > n[2]))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s: its indices are to ascend, alpha <= beta <= gamma; at %g nm they "
                            "are %.6g, %.6g, %.6g",
                            m->name, nm, n[0], n[1], n[2]);
    const double last = n[count - 1];
    if (!(n[0] > 0 && last > 0 && n[0] <= 10 && last <= 10))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s: an index of a crystal is above 0 and at most 10; at %g nm they "
                            "are %.6g and %.6g",
                            m->name, nm, n[0], last);
  }
  return ABBE_OK;
}

/* A crystal's record without a range is judged where light may be traced, for a formula of Cauchy
 * has no end at 0. */
static abbe_result check_index(const abbe_material *m, abbe_error *error) {
  const bool crystal = abbe_material_is_crystal(m);
  const double low = fmax(m->min_nm, fmin(m->max_nm, 100)), high = fmax(low, fmin(m->max_nm, 1e4));
  if (abbe_material_is_conductor(m)) return ABBE_OK;
  if (!crystal || low > m->min_nm || high < m->max_nm)
    ABBE_TRY(check_curves(m, m->min_nm, m->max_nm, false, error));
  return crystal ? check_curves(m, low, high, true, error) : ABBE_OK;
}

/* All of three indices are there and real, and there is no second of another kind. */
static abbe_result check_outer(const abbe_material *m, abbe_error *error) {
  abbe_error why;
  if (!abbe_material_is_biaxial(m)) return ABBE_OK;
  if (abbe_material_is_uniaxial(m))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: a crystal has two indices, with 'extraordinary', or three, with "
                          "'biaxial', and not both",
                          m->name);
  for (int i = 0; i < 2; i++) {
    if (m->outer[i].model == ABBE_DISPERSION_CONDUCTOR ||
        abbe_dispersion_check(&m->outer[i], &why) != ABBE_OK)
      return abbe_error_set(
          error, ABBE_INVALID_ARGUMENT, "%s: its index %s: %s", m->name, i == 0 ? "alpha" : "gamma",
          m->outer[i].model == ABBE_DISPERSION_CONDUCTOR ? "it has to be real" : why.text);
  }
  return ABBE_OK;
}

static abbe_result check_extraordinary(const abbe_material *m, abbe_error *error) {
  abbe_error why;
  if (!abbe_material_is_uniaxial(m)) return ABBE_OK;
  if (m->extraordinary.model == ABBE_DISPERSION_CONDUCTOR)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: its extraordinary index is of the model conductor, and has to be "
                          "real",
                          m->name);
  if (abbe_dispersion_check(&m->extraordinary, &why) == ABBE_OK) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: its extraordinary index: %s", m->name,
                        why.text);
}

/* By the field's direction absorb crystals alone; of a uniaxial one x and y are alike. */
abbe_result abbe_material_check_absorption(const abbe_material *m, abbe_error *error) {
  if (m->attenuation_yz[0] == NULL && m->attenuation_yz[1] == NULL) return ABBE_OK;
  if (!abbe_material_is_crystal(m))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: it absorbs by direction, and has one index in all directions; only "
                          "a crystal, with an 'extraordinary' index or 'biaxial' ones, is "
                          "pleochroic",
                          m->name);
  if (abbe_material_is_biaxial(m) && m->attenuation != NULL && m->attenuation_yz[1] != NULL)
    return ABBE_OK;
  if (m->attenuation != NULL && m->attenuation_yz[0] == NULL && m->attenuation_yz[1] != NULL)
    return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s: a uniaxial crystal absorbs alike along x and y: give 'ordinary' and "
                        "'extraordinary'",
                        m->name);
}

/* What would be of no effect, and could not be written. */
static abbe_result check_conductor(const abbe_material *m, abbe_error *error) {
  const char *idle = m->extrapolate                               ? "extrapolate"
                     : m->attenuation != NULL                     ? "absorption"
                     : m->fluorescence.yield != 0                 ? "fluorescence"
                     : m->fit[0].terms > 0 || m->fit[1].terms > 0 ? "fit"
                     : m->published_n_d != 0                      ? "n_d"
                     : m->published_v_d != 0                      ? "v_d"
                     : abbe_material_is_uniaxial(m)               ? "extraordinary"
                     : abbe_material_is_biaxial(m)                ? "biaxial"
                                                                  : NULL;
  if (!abbe_material_is_conductor(m) || idle == NULL) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: the model conductor has no use for '%s'",
                        m->name, idle);
}

abbe_result abbe_material_check_form(const abbe_material *material, abbe_error *error) {
  ABBE_TRY(abbe_material_check_name(material->name, error));
  if (material->source == NULL || material->source[0] == '\0')
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: it names no source; say where the numbers come from",
                          material->name);
  abbe_error why;
  if (abbe_dispersion_check(&material->dispersion, &why) != ABBE_OK)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: %s", material->name, why.text);
  ABBE_TRY(check_conductor(material, error));
  ABBE_TRY(check_extraordinary(material, error));
  ABBE_TRY(check_outer(material, error));
  ABBE_TRY(abbe_material_check_absorption(material, error));
  ABBE_TRY(abbe_material_check_fluorescence(material, error));
  return check_range(material, error);
}

abbe_result abbe_material_check(const abbe_material *material, abbe_error *error) {
  ABBE_TRY(abbe_material_check_form(material, error));
  return check_index(material, error);
}

/* ---- what it does to light ---- */

bool abbe_material_extrapolates(const abbe_material *material, double lambda_nm) {
  return lambda_nm < material->min_nm || lambda_nm > material->max_nm;
}

static abbe_result index_of(const abbe_material *material, const abbe_dispersion *dispersion,
                            double lambda_nm, double *n, abbe_error *error) {
  if (abbe_material_is_conductor(material))
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s is a conductor: it has n and k, and no real index", material->name);
  if (abbe_material_extrapolates(material, lambda_nm) && !material->extrapolate)
    return abbe_error_set(error, ABBE_OUT_OF_RANGE,
                          "%s has no index at %g nm: its data reach from %g to %g nm, and its "
                          "record does not say 'extrapolate: true'",
                          material->name, lambda_nm, material->min_nm, material->max_nm);
  double value = abbe_dispersion_n(dispersion, lambda_nm);
  if (isnan(value))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: its %s formula has no real index at %g nm", material->name,
                          abbe_dispersion_model_name(dispersion->model), lambda_nm);
  *n = value;
  return ABBE_OK;
}

abbe_result abbe_material_n(const abbe_material *material, double lambda_nm, double *n,
                            abbe_error *error) {
  return index_of(material, &material->dispersion, lambda_nm, n, error);
}

/* ---- at other conditions ---- */

bool abbe_material_has_thermal(const abbe_material *material) {
  for (int i = 0; i < 6; i++)
    if (material->catalogue.thermal[i] != 0) return true;
  return false;
}

static const double USUAL_C = 20; /* where a source is silent */

/* Pressure of the air that the record's index is relative to; where there is no air, vacuum. */
static double own_atm(const abbe_material *m) {
  return m->n_absolute || m->temperature_c < ABBE_AIR_LEAST_C ? 0 : 1;
}

/* NULL, or why the index is not known at another temperature than its measurement's. */
static const char *no_thermal(const abbe_material *m) {
  if (isnan(m->temperature_c)) return "its record does not say at what temperature its index is";
  if (!abbe_material_has_thermal(m))
    return "its record gives no dn/dT, which is not 0 for that; 'catalogue: thermal' takes six "
           "coefficients";
  if (abbe_material_is_crystal(m)) return "its record has one dn/dT for several indices";
  return m->catalogue.thermal[5] < 0
             ? "its lambda_tk is negative, of which programs square it and others do not"
             : NULL;
}

static bool is_air(const abbe_material *m) {
  return m->dispersion.model == ABBE_DISPERSION_CONSTANT && m->dispersion.c[0] == 1;
}

abbe_result abbe_material_place(abbe_material *material, const abbe_conditions *at,
                                abbe_error *error) {
  abbe_material *m = material;
  const double own_c = isnan(m->temperature_c) ? USUAL_C : m->temperature_c;
  abbe_index_shift shift = {.on = true,
                            .from_c = own_c,
                            .to_c = isnan(at->temperature_c) ? own_c : at->temperature_c,
                            .pressure_atm = isnan(at->pressure_atm) ? 1 : at->pressure_atm,
                            .from_atm = own_atm(m)};
  const double given_c = isnan(at->temperature_c) ? USUAL_C : at->temperature_c;
  if (!(given_c >= ABBE_CONDITIONS_LEAST_C && given_c <= ABBE_CONDITIONS_MOST_C) ||
      !(shift.pressure_atm >= 0 && shift.pressure_atm <= ABBE_CONDITIONS_MOST_ATM))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%g C and %g atm are no conditions from %g to %g C and 0 to %g atm",
                          shift.to_c, shift.pressure_atm, ABBE_CONDITIONS_LEAST_C,
                          ABBE_CONDITIONS_MOST_C, ABBE_CONDITIONS_MOST_ATM);
  if (abbe_material_is_conductor(m))
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s is a conductor: its n and k are known as they were measured alone",
                          m->name);
  const bool warmed = !isnan(at->temperature_c) && at->temperature_c != m->temperature_c;
  const char *why = warmed && !is_air(m) ? no_thermal(m) : NULL;
  if (why != NULL)
    return abbe_error_set(error, ABBE_UNSUPPORTED, "%s has no index at %g C: %s", m->name,
                          shift.to_c, why);
  memcpy(shift.thermal, m->catalogue.thermal, sizeof shift.thermal);
  m->dispersion.shift = shift;
  m->extraordinary.shift = m->outer[0].shift = m->outer[1].shift = shift;
  return ABBE_OK;
}

abbe_result abbe_material_n_absolute(const abbe_material *material, double lambda_nm, double *n,
                                     abbe_error *error) {
  const abbe_index_shift *s = &material->dispersion.shift;
  const double own_c = isnan(material->temperature_c) ? USUAL_C : material->temperature_c;
  ABBE_TRY(abbe_material_n(material, lambda_nm, n, error));
  *n *= s->on ? abbe_air_n(lambda_nm, s->to_c, s->pressure_atm)
              : abbe_air_n(lambda_nm, own_c, own_atm(material));
  return ABBE_OK;
}

static bool is_given(const abbe_dispersion *d) {
  return d->count > 0 || d->table != NULL;
}

bool abbe_material_is_uniaxial(const abbe_material *material) {
  return is_given(&material->extraordinary);
}

bool abbe_material_is_biaxial(const abbe_material *material) {
  return is_given(&material->outer[0]) || is_given(&material->outer[1]);
}

bool abbe_material_is_crystal(const abbe_material *material) {
  return abbe_material_is_uniaxial(material) || abbe_material_is_biaxial(material);
}

abbe_result abbe_material_n_along(const abbe_material *material, int axis, double lambda_nm,
                                  double *n, abbe_error *error) {
  const abbe_dispersion *d = &material->dispersion;
  if (axis != 1 && abbe_material_is_biaxial(material)) d = &material->outer[axis / 2];
  if (axis == 2 && abbe_material_is_uniaxial(material)) d = &material->extraordinary;
  return index_of(material, d, lambda_nm, n, error);
}

abbe_result abbe_material_n_extraordinary(const abbe_material *material, double lambda_nm,
                                          double *n, abbe_error *error) {
  const bool two = abbe_material_is_uniaxial(material);
  return index_of(material, two ? &material->extraordinary : &material->dispersion, lambda_nm, n,
                  error);
}

bool abbe_material_is_conductor(const abbe_material *material) {
  return material->dispersion.model == ABBE_DISPERSION_CONDUCTOR;
}

abbe_result abbe_material_nk(const abbe_material *material, double lambda_nm, double *n, double *k,
                             abbe_error *error) {
  if (!abbe_material_is_conductor(material))
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s is no conductor: it has a real index, and no k that goes with it",
                          material->name);
  if (!(lambda_nm >= material->min_nm && lambda_nm <= material->max_nm))
    return abbe_error_set(error, ABBE_OUT_OF_RANGE,
                          "%s has no n and k at %g nm: its data reach from %g to %g nm",
                          material->name, lambda_nm, material->min_nm, material->max_nm);
  if (abbe_dispersion_nk(&material->dispersion, lambda_nm, n, k)) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s has no points of n and k",
                        material->name);
}

static double attenuation_of(const abbe_spectrum *spectrum, double lambda_nm) {
  if (spectrum == NULL) return 0;
  double value = abbe_spectrum_at(spectrum, lambda_nm);
  return value > 0 ? value : 0; /* a spline may dip below its points */
}

bool abbe_material_is_pleochroic(const abbe_material *material) {
  return material->attenuation_yz[1] != NULL;
}

static double excitation_of(const abbe_material *m, double lambda_nm) {
  const abbe_spectrum *s = m->fluorescence.excitation;
  if (s == NULL) return 0;
  const double *nm = abbe_spectrum_lambda_nm(s);
  const bool within = lambda_nm >= nm[0] && lambda_nm <= nm[abbe_spectrum_count(s) - 1];
  return within ? attenuation_of(s, lambda_nm) : 0;
}

double abbe_material_attenuation_along(const abbe_material *material, int axis, double lambda_nm) {
  const abbe_spectrum *own = axis > 0 ? material->attenuation_yz[axis - 1] : NULL;
  return attenuation_of(own != NULL ? own : material->attenuation, lambda_nm) +
         excitation_of(material, lambda_nm);
}

double abbe_material_attenuation(const abbe_material *material, double lambda_nm) {
  if (!abbe_material_is_pleochroic(material))
    return abbe_material_attenuation_along(material, 0, lambda_nm);
  double sum = 0;
  for (int axis = 0; axis < 3; axis++)
    sum += abbe_material_attenuation_along(material, axis, lambda_nm);
  return sum / 3;
}

double abbe_material_excites(const abbe_material *material, double lambda_nm) {
  const abbe_fluorescence *f = &material->fluorescence;
  if (f->rows > 0) return lambda_nm >= f->row[0].nm && lambda_nm <= f->row[f->rows - 1].nm ? 1 : 0;
  if (f->yield == 0 || lambda_nm >= abbe_spectrum_lambda_nm(f->emission)[0]) return 0;
  if (f->excitation == NULL) return 1;
  const double own = excitation_of(material, lambda_nm);
  return own > 0 ? own / abbe_material_attenuation(material, lambda_nm) : 0;
}

bool abbe_material_is_opaque(const abbe_material *material, double min_nm, double max_nm) {
  enum { STEPS = 81 };
  if (abbe_material_is_conductor(material)) return true;
  size_t opaque = 0;
  for (size_t i = 0; i < STEPS; i++) {
    const double lambda_nm = min_nm + (max_nm - min_nm) * (double)i / (STEPS - 1);
    if (abbe_material_attenuation(material, lambda_nm) * lambda_nm * 1e-9 > 1) opaque++;
  }
  return 2 * opaque > STEPS;
}
