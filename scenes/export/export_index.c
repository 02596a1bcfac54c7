#include "scenes/export/scene_export.h"

#include "spectral/wavelengths.h"

#include <math.h>
#include <string.h>

#define LINE_D_NM 587.5618
#define LINE_F_NM 486.1327
#define LINE_C_NM 656.2725

static const double primary_nm[3] = {611.4, 549.1, 464.2};

#define ABBE_EXPORT_FORM_NAME(code, name, text) name,
static const char *const names[] = {ABBE_EXPORT_FORMS(ABBE_EXPORT_FORM_NAME)};

const char *abbe_export_form_name(abbe_export_form form) {
  return (int)form >= 0 && form < ABBE_EXPORT_FORM_COUNT ? names[form] : "unknown";
}

/* Per um^2. */
static double inverse_square(double lambda_nm) {
  return 1e6 / (lambda_nm * lambda_nm);
}

static double table_at(const double *table, double lambda_nm) {
  const double at = (lambda_nm - ABBE_EXPORT_TABLE_FIRST_NM) / ABBE_EXPORT_TABLE_STEP_NM;
  if (!(at > 0)) return table[0];
  if (at >= ABBE_EXPORT_TABLE_COUNT - 1) return table[ABBE_EXPORT_TABLE_COUNT - 1];
  const size_t i = (size_t)at;
  return table[i] + (at - (double)i) * (table[i + 1] - table[i]);
}

double abbe_export_index_at(const abbe_export_index *index, double lambda_nm) {
  const double *v = index->value;
  switch (index->form) {
  case ABBE_EXPORT_FORM_TABLE:
    return table_at(index->table, lambda_nm);
  case ABBE_EXPORT_FORM_ABBE: /* n_F - n_C = (n_d - 1) / V_d, straight in 1 / lambda^2 */
    return v[0] + (v[0] - 1) * v[1] / 20 * (inverse_square(lambda_nm) - inverse_square(LINE_D_NM)) /
                      (inverse_square(LINE_F_NM) - inverse_square(LINE_C_NM));
  default: /* THREE */
    return lambda_nm > 0.5 * (primary_nm[0] + primary_nm[1])   ? v[0]
           : lambda_nm > 0.5 * (primary_nm[1] + primary_nm[2]) ? v[1]
                                                               : v[2];
  }
}

/* The index, held where the record ends. */
static abbe_result index_held(const abbe_material *m, double lambda_nm, double *n,
                              abbe_error *error) {
  const bool hold = !m->extrapolate && m->dispersion.model != ABBE_DISPERSION_CONSTANT;
  const double at = hold ? fmin(fmax(lambda_nm, m->min_nm), m->max_nm) : lambda_nm;
  abbe_result result = abbe_material_n(m, at, n, error);
  if (result == ABBE_INVALID_ARGUMENT && at != fmin(fmax(at, m->min_nm), m->max_nm))
    result = abbe_material_n(m, fmin(fmax(at, m->min_nm), m->max_nm), n, error);
  return result;
}

static abbe_result fit_abbe(const abbe_material *m, double value[3], abbe_error *error) {
  double n_f = 0, n_c = 0;
  ABBE_TRY(index_held(m, LINE_D_NM, &value[0], error));
  ABBE_TRY(index_held(m, LINE_F_NM, &n_f, error));
  ABBE_TRY(index_held(m, LINE_C_NM, &n_c, error));
  value[1] = value[0] > 1 && n_f > n_c ? 20 * (n_f - n_c) / (value[0] - 1) : 0;
  return ABBE_OK;
}

static abbe_result fit(const abbe_material *m, abbe_export_index *out, abbe_error *error) {
  abbe_result result = ABBE_OK;
  switch (out->form) {
  case ABBE_EXPORT_FORM_TABLE:
    for (int i = 0; i < ABBE_EXPORT_TABLE_COUNT && result == ABBE_OK; i++)
      result = index_held(m, ABBE_EXPORT_TABLE_FIRST_NM + i * ABBE_EXPORT_TABLE_STEP_NM,
                          &out->table[i], error);
    return result;
  case ABBE_EXPORT_FORM_ABBE:
    return fit_abbe(m, out->value, error);
  default: /* THREE */
    for (int c = 0; c < 3 && result == ABBE_OK; c++)
      result = index_held(m, primary_nm[c], &out->value[c], error);
    return result;
  }
}

static abbe_result measure(const abbe_material *m, abbe_export_index *out, abbe_error *error) {
  double sum = 0;
  int count = 0;
  for (double nm = ABBE_WAVELENGTH_MIN_NM; nm <= ABBE_WAVELENGTH_MAX_NM; nm += 1) {
    double n = 0;
    if (abbe_material_n(m, nm, &n, NULL) != ABBE_OK) continue;
    const double off = fabs(abbe_export_index_at(out, nm) - n);
    sum += off * off;
    if (count++ > 0 && off <= out->worst) continue;
    out->worst = off;
    out->worst_nm = nm;
  }
  if (count == 0)
    return abbe_error_set(error, ABBE_OUT_OF_RANGE,
                          "the material '%s' has no index between %g and %g nm", m->name,
                          ABBE_WAVELENGTH_MIN_NM, ABBE_WAVELENGTH_MAX_NM);
  out->rms = sqrt(sum / count);
  return ABBE_OK;
}

abbe_result abbe_export_index_make(const abbe_material *material, abbe_export_form form,
                                   abbe_export_index *out, abbe_error *error) {
  const double last_nm =
      ABBE_EXPORT_TABLE_FIRST_NM + (ABBE_EXPORT_TABLE_COUNT - 1) * ABBE_EXPORT_TABLE_STEP_NM;
  double ignored;
  memset(out, 0, sizeof *out);
  out->form = form;
  if (abbe_material_is_conductor(material))
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the material '%s' is a conductor: it has no index that refracts",
                          material->name);
  out->held =
      abbe_material_n(material,
                      form == ABBE_EXPORT_FORM_TABLE ? ABBE_EXPORT_TABLE_FIRST_NM
                                                     : ABBE_WAVELENGTH_MIN_NM,
                      &ignored, NULL) != ABBE_OK ||
      abbe_material_n(material, form == ABBE_EXPORT_FORM_TABLE ? last_nm : ABBE_WAVELENGTH_MAX_NM,
                      &ignored, NULL) != ABBE_OK;
  ABBE_TRY(fit(material, out, error));
  return measure(material, out, error);
}
