#include "spectral/materials/material.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double first_of(const abbe_spectrum *s) {
  return abbe_spectrum_lambda_nm(s)[0];
}

static double last_of(const abbe_spectrum *s) {
  return abbe_spectrum_lambda_nm(s)[abbe_spectrum_count(s) - 1];
}

static double all_of(const abbe_spectrum *s) {
  return abbe_spectrum_integral(s, first_of(s), last_of(s));
}

/* Dark outside its points. */
static double value_of(const abbe_spectrum *s, double nm) {
  return nm >= first_of(s) && nm <= last_of(s) ? abbe_spectrum_at(s, nm) : 0;
}

void abbe_fluorescence_free(abbe_fluorescence *f) {
  for (size_t i = 0; i < f->rows; i++) abbe_spectrum_free(f->row[i].emission);
  free(f->row);
  abbe_spectrum_free(f->excitation);
  abbe_spectrum_free(f->emission);
  *f = (abbe_fluorescence){0};
}

/* ---- a matrix ---- */

abbe_result abbe_fluorescence_add_row(abbe_fluorescence *f, double nm, abbe_spectrum *emission,
                                      abbe_error *error) {
  abbe_reradiation_row *more = realloc(f->row, (f->rows + 1) * sizeof *more);
  if (more == NULL) {
    abbe_spectrum_free(emission);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a re-radiation matrix");
  }
  f->row = more;
  f->row[f->rows++] = (abbe_reradiation_row){nm, emission, all_of(emission)};
  return ABBE_OK;
}

static int compare(const void *a, const void *b) {
  const double *x = a, *y = b;
  return (*x > *y) - (*x < *y);
}

abbe_result abbe_fluorescence_sum_rows(abbe_fluorescence *f, abbe_error *error) {
  size_t count = 0, kept = 0;
  for (size_t i = 0; i < f->rows; i++) count += abbe_spectrum_count(f->row[i].emission);
  double *nm = calloc(2 * count + 1, sizeof *nm), *sum = nm != NULL ? nm + count : NULL;
  if (nm == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a re-radiation matrix");
  count = 0;
  for (size_t i = 0; i < f->rows; i++) {
    const size_t points = abbe_spectrum_count(f->row[i].emission);
    memcpy(nm + count, abbe_spectrum_lambda_nm(f->row[i].emission), points * sizeof *nm);
    count += points;
    f->yield = fmax(f->yield, f->row[i].yield);
  }
  qsort(nm, count, sizeof *nm, compare);
  for (size_t i = 0; i < count; i++)
    if (kept == 0 || nm[i] > nm[kept - 1]) nm[kept++] = nm[i];
  for (size_t k = 0; k < kept; k++)
    for (size_t i = 0; i < f->rows; i++) sum[k] += value_of(f->row[i].emission, nm[k]);
  const abbe_result result =
      abbe_spectrum_make(nm, sum, kept, ABBE_INTERPOLATION_LINEAR, &f->emission, error);
  free(nm);
  return result;
}

/* Where a row's light begins: the last dark point before it, or its first point. */
static double begins(const abbe_spectrum *s) {
  const double *value = abbe_spectrum_value(s);
  size_t i = 0;
  while (i + 1 < abbe_spectrum_count(s) && !(value[i] > 0) && !(value[i + 1] > 0)) i++;
  return abbe_spectrum_lambda_nm(s)[i];
}

static abbe_result check_rows(const abbe_material *m, abbe_error *error) {
  const abbe_fluorescence *f = &m->fluorescence;
  if (f->rows < 2)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: its re-radiation matrix has one row; give it two or more, for it is "
                          "straight between them and dark outside",
                          m->name);
  for (size_t i = 0; i < f->rows; i++) {
    const abbe_reradiation_row *row = &f->row[i];
    const double next = f->row[i + 1 < f->rows ? i + 1 : i].nm;
    if (i > 0 && !(row->nm > f->row[i - 1].nm))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s: rows of its re-radiation matrix ascend; %g nm follows %g nm",
                            m->name, row->nm, f->row[i - 1].nm);
    if (!(row->yield <= 1 + 1e-6))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s: of a photon of %g nm its re-radiation matrix gives %.4g back; at "
                            "most 1 can come back",
                            m->name, row->nm, row->yield);
    if (row->yield > 0 && begins(row->emission) < next)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s: excited by %g nm it emits from %g nm, and is excited alike up to "
                            "the matrix's row at %g nm: no photon is emitted at a shorter "
                            "wavelength than the one that excites; let it emit from %g nm on",
                            m->name, row->nm, begins(row->emission), next, next);
  }
  return ABBE_OK;
}

/* ---- whether a table may hold it ---- */

abbe_result abbe_material_check_fluorescence(const abbe_material *m, abbe_error *error) {
  const abbe_fluorescence *f = &m->fluorescence;
  if (f->yield == 0 && f->excitation == NULL && f->emission == NULL) return ABBE_OK;
  if (f->rows == 0 && !(f->yield > 0 && f->yield <= 1))
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "%s: the 'yield' of its fluorescence is %g; a photon that excites it gives "
        "above 0 and at most 1",
        m->name, f->yield);
  if (f->emission == NULL || !(all_of(f->emission) > 0))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: its fluorescence wants an 'emission', photons by nm at two "
                          "wavelengths or more, some above 0",
                          m->name);
  const bool dark = f->excitation != NULL && !(all_of(f->excitation) > 0);
  if (dark || (f->excitation == NULL && m->attenuation == NULL))
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "%s: it absorbs nothing that could make it glow: give its fluorescence an "
        "'excitation_per_m', or the material an 'absorption'",
        m->name);
  if (f->excitation != NULL && m->attenuation_yz[1] != NULL)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: it absorbs by direction, and all of that excites it: leave "
                          "'excitation_per_m' out",
                          m->name);
  if (f->rows > 0) return check_rows(m, error);
  if (f->excitation == NULL || last_of(f->excitation) <= first_of(f->emission)) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s: it emits from %g nm and is excited up to %g nm: no photon is emitted "
                        "at a shorter wavelength than the one that excites; end 'excitation_per_m' "
                        "where 'emission' begins",
                        m->name, first_of(f->emission), last_of(f->excitation));
}

/* ---- what it does ---- */

bool abbe_material_is_fluorescent(const abbe_material *material) {
  return material->fluorescence.yield > 0;
}

size_t abbe_material_glow_rows(const abbe_material *material) {
  const abbe_fluorescence *f = &material->fluorescence;
  return f->rows > 0 ? f->rows : f->yield > 0 ? 1 : 0;
}

double abbe_material_row_yield(const abbe_material *material, size_t row, double lambda_nm) {
  const abbe_fluorescence *f = &material->fluorescence;
  if (f->rows == 0) return f->yield;
  const abbe_reradiation_row *at = &f->row[row];
  if (lambda_nm == at->nm) return at->yield;
  const bool below = lambda_nm < at->nm;
  if (below ? row == 0 : row + 1 == f->rows) return 0;
  const double span = fabs(f->row[below ? row - 1 : row + 1].nm - at->nm);
  return at->yield * fmax(1 - fabs(lambda_nm - at->nm) / span, 0);
}

double abbe_material_yield(const abbe_material *material, double lambda_nm) {
  double sum = 0;
  for (size_t i = 0; i < abbe_material_glow_rows(material); i++)
    sum += abbe_material_row_yield(material, i, lambda_nm);
  return sum;
}

static double share_of(const abbe_spectrum *s, double from_nm, double to_nm) {
  const double low = first_of(s), high = last_of(s), all = all_of(s);
  const double from = fmin(fmax(from_nm, low), high), to = fmin(fmax(to_nm, from), high);
  return all > 0 ? abbe_spectrum_integral(s, from, to) / all : 0;
}

double abbe_material_row_emission(const abbe_material *material, size_t row, double from_nm,
                                  double to_nm) {
  const abbe_fluorescence *f = &material->fluorescence;
  return share_of(f->rows > 0 ? f->row[row].emission : f->emission, from_nm, to_nm);
}

double abbe_material_emission(const abbe_material *material, double from_nm, double to_nm) {
  if (!abbe_material_is_fluorescent(material)) return 0;
  return share_of(material->fluorescence.emission, from_nm, to_nm);
}

double abbe_material_reradiates(const abbe_material *material, double from_nm, double to_nm) {
  const abbe_fluorescence *f = &material->fluorescence;
  double sum = 0;
  for (size_t i = 0; i < abbe_material_glow_rows(material); i++) {
    const abbe_spectrum *s = f->rows > 0 ? f->row[i].emission : f->emission;
    const double all = all_of(s);
    if (all > 0) sum += abbe_material_row_yield(material, i, from_nm) * value_of(s, to_nm) / all;
  }
  return sum;
}
