#include "spectral/formats/material_write.h"

#include "base/number.h"
#include "spectral/materials/absorption.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdbool.h>

static void put(FILE *to, double value) {
  char text[ABBE_NUMBER_TEXT_SIZE];
  fputs(abbe_number_text(value, text), to);
}

static void write_row(const abbe_material *m, double lambda_nm, double n, FILE *to) {
  put(to, lambda_nm);
  fputc(',', to);
  put(to, n);
  if (m->attenuation != NULL) {
    fputc(',', to);
    put(to, abbe_number_tidy(
                abbe_absorption_k(abbe_material_attenuation_along(m, 0, lambda_nm), lambda_nm)));
  }
  fputc('\n', to);
}

/* nm, n and k of a conductor. */
static void write_conductor(const abbe_dispersion *d, FILE *to) {
  for (size_t i = 0; i < abbe_spectrum_count(d->table); i++) {
    put(to, abbe_spectrum_lambda_nm(d->table)[i]);
    fputc(',', to);
    put(to, abbe_spectrum_value(d->table)[i]);
    fputc(',', to);
    put(to, abbe_spectrum_value(d->k)[i]);
    fputc('\n', to);
  }
}

static abbe_result plan(const abbe_material *m, const abbe_csv_sampling *asked,
                        abbe_csv_sampling *s, abbe_error *error) {
  *s = asked != NULL ? *asked : (abbe_csv_sampling){0};
  if (s->step_nm == 0) s->step_nm = 5;
  bool visible = m->min_nm < ABBE_WAVELENGTH_MAX_NM && m->max_nm > ABBE_WAVELENGTH_MIN_NM;
  if (s->min_nm == 0) s->min_nm = visible ? fmax(m->min_nm, ABBE_WAVELENGTH_MIN_NM) : m->min_nm;
  if (s->max_nm == 0) s->max_nm = visible ? fmin(m->max_nm, ABBE_WAVELENGTH_MAX_NM) : m->max_nm;
  bool good = s->step_nm > 0 && s->min_nm >= ABBE_SPECTRUM_LOW_NM && s->min_nm < s->max_nm &&
              s->max_nm <= ABBE_SPECTRUM_HIGH_NM &&
              (s->max_nm - s->min_nm) / s->step_nm < ABBE_SPECTRUM_MAX_COUNT - 1;
  if (good) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s: %g to %g nm in steps of %g nm is no range of at most %d points",
                        m->name, s->min_nm, s->max_nm, s->step_nm, ABBE_SPECTRUM_MAX_COUNT);
}

static abbe_result write_formula(const abbe_material *m, const abbe_csv_sampling *asked, FILE *to,
                                 abbe_report *report, abbe_error *error) {
  abbe_csv_sampling s;
  double n = 0, middle = 0, worst = 0, before = NAN, last_nm = NAN;
  abbe_result result = plan(m, asked, &s, error);
  if (result == ABBE_OK) result = abbe_material_n(m, s.min_nm, &n, error);
  if (result == ABBE_OK) result = abbe_material_n(m, s.max_nm, &n, error);
  for (size_t i = 0; result == ABBE_OK; i++) {
    double lambda_nm = abbe_number_tidy(fmin(s.min_nm + (double)i * s.step_nm, s.max_nm));
    result = abbe_material_n(m, lambda_nm, &n, error);
    if (result != ABBE_OK) return result;
    write_row(m, lambda_nm, n, to);
    /* halfway between two points a straight line is worst */
    if (i > 0 && abbe_material_n(m, (last_nm + lambda_nm) / 2, &middle, NULL) == ABBE_OK)
      worst = fmax(worst, fabs((n + before) / 2 - middle));
    before = n;
    last_nm = lambda_nm;
    if (lambda_nm >= s.max_nm) break;
  }
  if (result == ABBE_OK)
    abbe_report_add(report, ABBE_NOTE_LOST, m->line, m->name,
                    "the formula is sampled every %g nm from %g to %g nm; straight lines between "
                    "the points are off by up to %.2g",
                    s.step_nm, s.min_nm, s.max_nm, worst);
  return result;
}

static void note_losses(const abbe_material *m, abbe_report *report) {
  bool more = m->description != NULL || m->warning != NULL || m->comment != NULL ||
              m->catalogue.code != NULL || m->catalogue.density_g_cm3 != 0 || m->fit[0].terms > 0 ||
              m->published_n_d != 0;
  abbe_report_add(report, ABBE_NOTE_LOST, m->line, m->name,
                  "a table of points has no place for its name and source%s, but in a comment",
                  more ? ", nor for the rest of the record" : "");
  if (abbe_material_is_crystal(m))
    abbe_report_add(report, ABBE_NOTE_LOST, m->line, m->name,
                    "a table of points has one index: the %s one%s",
                    abbe_material_is_biaxial(m) ? "middle" : "ordinary",
                    abbe_material_is_pleochroic(m) ? ", and one k: that along x" : "");
  if (m->attenuation != NULL)
    abbe_report_add(report, ABBE_NOTE_LOST, m->line, m->name,
                    "absorption is written as k at the wavelengths of n alone");
}

abbe_result abbe_csv_write(const abbe_material *material, const abbe_csv_sampling *sampling,
                           FILE *to, abbe_report *report, abbe_error *error) {
  const abbe_material *m = material;
  abbe_result result = abbe_material_check(m, error);
  if (result != ABBE_OK) return result;
  fprintf(to, "# %s; source: ", m->name);
  for (const char *c = m->source; *c != '\0'; c++) fputc((unsigned char)*c < 0x20 ? ' ' : *c, to);
  const bool metal = abbe_material_is_conductor(m);
  fputs(metal || m->attenuation != NULL ? "\nwavelength_nm,n,k\n" : "\nwavelength_nm,n\n", to);
  const abbe_spectrum *table = m->dispersion.table;
  if (metal) write_conductor(&m->dispersion, to);
  for (size_t i = 0; !metal && table != NULL && i < abbe_spectrum_count(table); i++)
    write_row(m, abbe_spectrum_lambda_nm(table)[i], abbe_spectrum_value(table)[i], to);
  if (table == NULL) result = write_formula(m, sampling, to, report, error);
  if (result != ABBE_OK) return result;
  note_losses(m, report);
  if (fflush(to) == 0 && !ferror(to)) return ABBE_OK;
  return abbe_error_set(error, ABBE_IO, "%s: its points could not be written", m->name);
}
