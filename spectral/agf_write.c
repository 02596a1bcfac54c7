#include "spectral/agf_write.h"

#include "spectral/absorption.h"
#include "spectral/agf_formula.h"
#include "spectral/material_numbers.h"
#include "spectral/number.h"
#include "spectral/tally.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>
#include <strings.h>

/* What a catalogue has no place for, and what it takes in another dress. */
typedef enum loss {
  DESCRIPTION,
  WARNING,
  FITS,
  EXTRAPOLATE,
  INTERPOLATION,
  REWRITTEN,
  SOURCE,
  COMPUTED,
  NAME,
  LOSSES
} loss;

static const abbe_tally_row losses[LOSSES] = {
    [DESCRIPTION] = {ABBE_NOTE_LOST, "AGF has no place for a description"},
    [WARNING] = {ABBE_NOTE_LOST, "AGF has no place for a warning"},
    [FITS] = {ABBE_NOTE_LOST, "AGF has no place for recorded fits"},
    [EXTRAPOLATE] = {ABBE_NOTE_LOST, "AGF cannot allow use outside the range"},
    [INTERPOLATION] = {ABBE_NOTE_LOST, "AGF does not say how attenuation runs between points"},
    [REWRITTEN] = {ABBE_NOTE_CHANGED, "the formula is written as another one with the same n"},
    [SOURCE] = {ABBE_NOTE_CHANGED, "the source stands in the GC line"},
    [COMPUTED] = {ABBE_NOTE_ASSUMED, "no published n_d and V_d; the formula's are written"},
    [NAME] = {ABBE_NOTE_CHANGED, "blanks and commas in the name become '_'"},
};

static void put(FILE *to, double value) {
  char text[ABBE_NUMBER_TEXT_SIZE];
  fprintf(to, " %s", abbe_number_text(value, text));
}

/* One line of text: what would end it becomes a blank. */
static void put_line(FILE *to, const char *text) {
  for (; *text != '\0'; text++) fputc((unsigned char)*text < 0x20 ? ' ' : *text, to);
}

static void write_name(const abbe_material *m, abbe_tally *t, FILE *to) {
  bool changed = false;
  for (const char *c = m->name; *c != '\0'; c++) {
    bool parts = *c == ' ' || *c == ',' || *c == '\t';
    changed = changed || parts;
    fputc(parts ? '_' : *c, to);
  }
  if (changed) abbe_tally_add(t, NAME, m->name);
}

static int status_number(const char *status) {
  static const char *const names[] = {"standard", "preferred", "obsolete", "special", "melt"};
  for (int i = 0; status != NULL && i < 5; i++)
    if (strcasecmp(status, names[i]) == 0) return i;
  return -1;
}

static void write_nm(const abbe_material *m, int formula, abbe_tally *t, FILE *to) {
  const abbe_material_catalogue *c = &m->catalogue;
  abbe_dispersion_numbers d = abbe_dispersion_describe(&m->dispersion);
  abbe_material_published printed; /* also where only the words of the source say it */
  abbe_material_published_make(m, &printed);
  double n_d = isnan(printed.n_d) ? 0 : printed.n_d, v_d = isnan(printed.v_d) ? 0 : printed.v_d;
  bool inside = !abbe_material_extrapolates(m, ABBE_LINE_F_NM) &&
                !abbe_material_extrapolates(m, ABBE_LINE_C_NM);
  if (n_d == 0 && v_d == 0 && inside && isfinite(d.n_d) && fabs(d.v_d) < 1000) {
    n_d = round(d.n_d * 1e6) / 1e6;
    v_d = round(d.v_d * 1e6) / 1e6;
    abbe_tally_add(t, COMPUTED, m->name);
  }
  fputs("NM ", to);
  write_name(m, t, to);
  fprintf(to, " %d %s", formula, c->code != NULL ? c->code : "0");
  put(to, n_d != 0 ? n_d : 1);
  put(to, v_d);
  int status = status_number(c->status);
  if (status >= 0)
    fprintf(to, " 0 %d", status);
  else if (c->melt_frequency != 0)
    fputs(" 0 -", to);
  if (c->melt_frequency != 0) put(to, c->melt_frequency);
  fputc('\n', to);
}

static void write_gc(const abbe_material *m, FILE *to) {
  fputs("GC ", to);
  if (m->comment != NULL) put_line(to, m->comment);
  fputs(m->comment != NULL ? "; source: " : "source: ", to);
  put_line(to, m->source);
  fputc('\n', to);
}

static void write_lines(const abbe_material *m, const double *cd, double low_nm, double high_nm,
                        FILE *to) {
  const abbe_material_catalogue *c = &m->catalogue;
  bool thermal = false;
  fputs("ED", to);
  for (int i = 0; i < 2; i++) put(to, abbe_number_tidy(c->expansion_per_k[i] * 1e6));
  put(to, c->density_g_cm3);
  put(to, c->dpgf);
  fputs(" 0\nCD", to);
  for (int i = 0; i < ABBE_AGF_COEFFICIENTS; i++) put(to, cd[i]);
  fputs("\nTD", to);
  for (int i = 0; i < 6; i++) thermal = thermal || c->thermal[i] != 0;
  if (thermal || !isnan(m->temperature_c)) {
    for (int i = 0; i < 6; i++) put(to, c->thermal[i]);
    if (isnan(m->temperature_c))
      fputs(" -", to);
    else
      put(to, m->temperature_c);
  }
  fputs("\nOD", to);
  for (size_t i = 0; i < 6; i++) put(to, c->rating_count == 6 ? c->ratings[i] : -1);
  fputs("\nLD", to);
  put(to, abbe_number_tidy(low_nm / 1000));
  put(to, abbe_number_tidy(high_nm / 1000));
  fputc('\n', to);
}

/* At 10 mm, or so much less that the darkest share can still be written. */
static void write_it(const abbe_material *m, abbe_tally *t, FILE *to) {
  if (m->attenuation == NULL) return;
  if (abbe_spectrum_interpolation(m->attenuation) != ABBE_INTERPOLATION_LINEAR)
    abbe_tally_add(t, INTERPOLATION, m->name);
  const double *lambda_nm = abbe_spectrum_lambda_nm(m->attenuation);
  const double *a = abbe_spectrum_value(m->attenuation);
  for (size_t i = 0; i < abbe_spectrum_count(m->attenuation); i++) {
    double thickness_mm = 10;
    while (a[i] * thickness_mm / 1000 > 13 && thickness_mm > 1e-5) thickness_mm /= 10;
    fputs("IT", to);
    put(to, abbe_number_tidy(lambda_nm[i] / 1000));
    put(to, abbe_number_tidy(abbe_absorption_transmittance(a[i], thickness_mm / 1000)));
    put(to, abbe_number_tidy(thickness_mm));
    fputc('\n', to);
  }
}

static void count_losses(const abbe_material *m, abbe_tally *t) {
  if (m->description != NULL) abbe_tally_add(t, DESCRIPTION, m->name);
  if (m->warning != NULL) abbe_tally_add(t, WARNING, m->name);
  if (m->fit[0].terms > 0 || m->fit[1].terms > 0) abbe_tally_add(t, FITS, m->name);
  if (m->extrapolate) abbe_tally_add(t, EXTRAPOLATE, m->name);
  abbe_tally_add(t, SOURCE, m->name);
}

/* The visible part of the range is what a fit should serve; where it has none, all of it. */
static void fit_range(const abbe_material *m, double *low_nm, double *high_nm) {
  *low_nm = fmax(m->min_nm, ABBE_WAVELENGTH_MIN_NM);
  *high_nm = fmin(m->max_nm, ABBE_WAVELENGTH_MAX_NM);
  if (*high_nm - *low_nm >= 50) return;
  *low_nm = m->min_nm;
  *high_nm = m->max_nm;
}

static abbe_result write_glass(const abbe_material *m, abbe_tally *t, abbe_report *report, FILE *to,
                               abbe_error *error) {
  abbe_agf_formula formula;
  abbe_agf_fidelity fidelity;
  abbe_error why = {0};
  double low_nm, high_nm, max_error = 0;
  fit_range(m, &low_nm, &high_nm);
  abbe_result result = abbe_agf_formula_write(&m->dispersion, low_nm, high_nm, &formula, &fidelity,
                                              &max_error, &why);
  if (result == ABBE_NO_MEMORY) return abbe_error_set(error, result, "%s: %s", m->name, why.text);
  if (result != ABBE_OK) {
    abbe_report_add(report, ABBE_NOTE_SKIPPED, m->line, m->name,
                    "no formula of a catalogue computes its %s, and it cannot be fitted: %s",
                    abbe_dispersion_model_name(m->dispersion.model), why.text);
    return ABBE_OK;
  }
  if (fidelity == ABBE_AGF_REWRITTEN) abbe_tally_add(t, REWRITTEN, m->name);
  if (fidelity == ABBE_AGF_FITTED)
    abbe_report_add(report, ABBE_NOTE_LOST, m->line, m->name,
                    "no formula of a catalogue computes its %s; a polynomial fitted over %g to %g "
                    "nm is written, whose largest error there is %.2g",
                    abbe_dispersion_model_name(m->dispersion.model), low_nm, high_nm, max_error);
  bool fitted = fidelity == ABBE_AGF_FITTED;
  count_losses(m, t);
  write_nm(m, formula.number, t, to);
  write_gc(m, to);
  write_lines(m, formula.c, fitted ? low_nm : m->min_nm, fitted ? high_nm : m->max_nm, to);
  write_it(m, t, to);
  return ABBE_OK;
}

abbe_result abbe_agf_write(const abbe_material_table *table, FILE *to, abbe_report *report,
                           abbe_error *error) {
  abbe_tally t = {0};
  fputs("CC ", to);
  put_line(to, table->description != NULL ? table->description : "written by Abbe");
  fputc('\n', to);
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < table->count && result == ABBE_OK; i++) {
    abbe_error why;
    if (abbe_material_check(&table->material[i], &why) != ABBE_OK)
      abbe_report_add(report, ABBE_NOTE_SKIPPED, table->material[i].line, NULL, "%s", why.text);
    else
      result = write_glass(&table->material[i], &t, report, to, error);
  }
  abbe_tally_report(&t, losses, LOSSES, report);
  if (result != ABBE_OK) return result;
  if (fflush(to) == 0 && !ferror(to)) return ABBE_OK;
  return abbe_error_set(error, ABBE_IO, "the catalogue could not be written");
}
