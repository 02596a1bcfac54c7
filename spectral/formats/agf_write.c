#include "spectral/formats/material_write.h"

#include "base/number.h"
#include "base/report.h"
#include "spectral/formats/agf_formula.h"
#include "spectral/materials/absorption.h"
#include "spectral/materials/material_query.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdbool.h>
#include <strings.h>

/* What a catalogue has no place for, and what it takes in another dress. */
typedef enum loss {
  DESCRIPTION,
  WARNING,
  FITS,
  EXTRAORDINARY,
  PLEOCHROISM,
  FLUORESCENCE,
  EXTRAPOLATE,
  ABSOLUTE,
  EXPANSION,
  INTERPOLATION,
  REWRITTEN,
  SOURCE,
  COMPUTED,
  NAME,
  LOSSES
} loss;

static const abbe_summary_row losses[LOSSES] = {
    [DESCRIPTION] = {ABBE_NOTE_LOST, "AGF has no place for a description"},
    [WARNING] = {ABBE_NOTE_LOST, "AGF has no place for a warning"},
    [FITS] = {ABBE_NOTE_LOST, "AGF has no place for recorded fits"},
    [EXTRAORDINARY] = {ABBE_NOTE_LOST, "AGF has one index a glass: the ordinary or middle one"},
    [PLEOCHROISM] = {ABBE_NOTE_LOST, "AGF has one transmittance a glass: that along x"},
    [FLUORESCENCE] = {ABBE_NOTE_LOST, "AGF has no place for fluorescence and for what excites it"},
    [EXTRAPOLATE] = {ABBE_NOTE_LOST, "AGF cannot allow use outside the range"},
    [ABSOLUTE] = {ABBE_NOTE_LOST, "AGF's indices are relative to air, and this one is to vacuum"},
    [EXPANSION] = {ABBE_NOTE_LOST, "AGF has no place for the temperatures of expansions"},
    [INTERPOLATION] = {ABBE_NOTE_LOST, "AGF does not say how attenuation runs between points"},
    [REWRITTEN] = {ABBE_NOTE_CHANGED, "the formula is written as another one with the same n"},
    [SOURCE] = {ABBE_NOTE_CHANGED, "the source stands in the GC line"},
    [COMPUTED] = {ABBE_NOTE_ASSUMED, "no published n_d and V_d; the formula's are written"},
    [NAME] = {ABBE_NOTE_CHANGED, "blanks and a comma at the end of a name become '_'"},
};

static void put(FILE *to, double value) {
  char text[ABBE_NUMBER_TEXT_SIZE];
  fprintf(to, " %s", abbe_number_text(value, text));
}

/* One line of text: what would end it becomes a blank. */
static void put_line(FILE *to, const char *text) {
  for (; *text != '\0'; text++) fputc((unsigned char)*text < 0x20 ? ' ' : *text, to);
}

static void write_name(const abbe_material *m, abbe_summary *t, FILE *to) {
  bool changed = false;
  for (const char *c = m->name; *c != '\0'; c++) {
    bool parts = *c == ' ' || (*c == ',' && c[1] == '\0');
    changed = changed || parts;
    fputc(parts ? '_' : *c, to);
  }
  if (changed) abbe_summary_add(t, NAME, m->name);
}

static int status_number(const char *status) {
  static const char *const names[] = {"standard", "preferred", "obsolete", "special", "melt"};
  for (int i = 0; status != NULL && i < 5; i++)
    if (strcasecmp(status, names[i]) == 0) return i;
  return -1;
}

static void write_nm(const abbe_material *m, int formula, abbe_summary *t, FILE *to) {
  const abbe_material_catalogue *c = &m->catalogue;
  abbe_dispersion_numbers d = abbe_dispersion_describe(&m->dispersion);
  abbe_material_published printed; /* also where only the text of the source has it */
  abbe_material_published_make(m, &printed);
  double n_d = isnan(printed.n_d) ? 0 : printed.n_d, v_d = isnan(printed.v_d) ? 0 : printed.v_d;
  bool inside = !abbe_material_extrapolates(m, ABBE_LINE_F_NM) &&
                !abbe_material_extrapolates(m, ABBE_LINE_C_NM);
  if (n_d == 0 && v_d == 0 && inside && isfinite(d.n_d) && fabs(d.v_d) < 1000) {
    n_d = round(d.n_d * 1e6) / 1e6;
    v_d = round(d.v_d * 1e6) / 1e6;
    abbe_summary_add(t, COMPUTED, m->name);
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

/* ---- transmittances ---- */

/* The thicknesses, mm, at which catalogues measure, the usual one first. */
static const double thicknesses_mm[] = {10, 25, 5, 1, 2, 3, 50, 20, 100};
enum { THICKNESSES = sizeof thicknesses_mm / sizeof thicknesses_mm[0] };

/* The attenuation that is read from such a line. */
static bool reads_as(double share, double thickness_mm, double attenuation) {
  return abbe_absorption_from_transmittance(share, thickness_mm / 1000) == attenuation;
}

/* The digits of the share at that thickness where ten decimals give the attenuation to its last
 * bit, which a number that was not read from them does once in a million times; 0 where they do
 * not. */
static int printed_digits(double attenuation, double thickness_mm, double *share) {
  double decimals = round(abbe_absorption_transmittance(attenuation, thickness_mm / 1000) * 1e10);
  int digits = 0;
  *share = decimals / 1e10;
  if (*share == 0 || !reads_as(*share, thickness_mm, attenuation)) return 0;
  while (fmod(decimals, 10) == 0) decimals /= 10;
  for (; decimals >= 1; decimals /= 10) digits++;
  return digits;
}

/* Where the share has the fewest digits: 0.9 through 1 mm is 0.3487 through 10 mm, and was printed
 * so. The usual thickness is taken for two digits less than it has. */
static int find_printed(double attenuation, double usual_mm, double *thickness_mm) {
  double share;
  int digits = printed_digits(attenuation, *thickness_mm = usual_mm, &share);
  int fewest = digits > 2 ? digits - 2 : digits > 0;
  for (int i = 0; i < THICKNESSES && fewest != 1; i++) {
    digits = printed_digits(attenuation, thicknesses_mm[i], &share);
    if (digits == 0 || (fewest > 0 && digits >= fewest)) continue;
    fewest = digits;
    *thickness_mm = thicknesses_mm[i];
  }
  for (int tenths = 1; tenths < 1000 && fewest == 0; tenths++)
    fewest = printed_digits(attenuation, *thickness_mm = tenths / 10.0, &share);
  return fewest;
}

/* Where most of the points were measured; 10 mm where none were. */
static double usual_thickness(const double *attenuation, size_t count) {
  double usual_mm = thicknesses_mm[0], found_mm, share;
  size_t most = 0;
  for (size_t i = 0; i < count; i++) {
    size_t met = 0;
    if (attenuation[i] == 0 || (most > 0 && printed_digits(attenuation[i], usual_mm, &share) > 0))
      continue;
    if (find_printed(attenuation[i], usual_mm, &found_mm) == 0) continue;
    for (size_t k = 0; k < count; k++)
      met += attenuation[k] != 0 && printed_digits(attenuation[k], found_mm, &share) > 0;
    if (met > most) most = met, usual_mm = found_mm;
  }
  return usual_mm;
}

/* A share that gives the attenuation to its last bit, among the neighbours of the rounded one. */
static bool find_exact(double attenuation, double thickness_mm, double *share) {
  double rounded = abbe_absorption_transmittance(attenuation, thickness_mm / 1000);
  double up = rounded, down = rounded;
  for (int i = 0; i < 4; i++) {
    if (reads_as(*share = up, thickness_mm, attenuation)) return true;
    if (reads_as(*share = down, thickness_mm, attenuation)) return true;
    up = nextafter(up, 2);
    down = nextafter(down, 0);
  }
  *share = rounded;
  return false;
}

/* Through so much, or so little, that between 1e-6 and a half of the light remains: nearer to 1 a
 * share has too few digits left. */
static bool find_thickness(double attenuation, double *thickness_mm, double *share) {
  double decade_mm = pow(10, floor(log10(1000 / attenuation)));
  for (int digits = 1; digits < 140; digits++) {
    *thickness_mm = abbe_number_tidy(digits * decade_mm);
    double depth = attenuation * *thickness_mm / 1000;
    if (*thickness_mm < 1e-5 || *thickness_mm > 1e11 || depth < 0.7 || depth > 13.8) continue;
    if (find_exact(attenuation, *thickness_mm, share)) return true;
  }
  return false;
}

/* As it was printed; or at 10 mm, or another thickness, to the last bit; or as near as can be. */
static void put_share(double attenuation, double usual_mm, FILE *to) {
  double thickness_mm = usual_mm, share = 1;
  bool found = attenuation == 0;
  if (!found && find_printed(attenuation, usual_mm, &thickness_mm) > 0)
    found = printed_digits(attenuation, thickness_mm, &share) > 0;
  if (!found) found = find_exact(attenuation, thickness_mm = 10, &share);
  if (!found) found = find_thickness(attenuation, &thickness_mm, &share);
  if (!found) {
    for (thickness_mm = 10; attenuation * thickness_mm / 1000 > 13 && thickness_mm > 1e-5;)
      thickness_mm /= 10;
    share = abbe_absorption_transmittance(attenuation, thickness_mm / 1000);
  }
  put(to, share);
  put(to, abbe_number_tidy(thickness_mm));
}

static void write_it(const abbe_material *m, abbe_summary *t, FILE *to) {
  if (m->attenuation == NULL) return;
  if (abbe_spectrum_interpolation(m->attenuation) != ABBE_INTERPOLATION_LINEAR)
    abbe_summary_add(t, INTERPOLATION, m->name);
  const double *lambda_nm = abbe_spectrum_lambda_nm(m->attenuation);
  const double *a = abbe_spectrum_value(m->attenuation);
  size_t count = abbe_spectrum_count(m->attenuation);
  double usual_mm = usual_thickness(a, count);
  for (size_t i = 0; i < count; i++) {
    fputs("IT", to);
    put(to, abbe_number_tidy(lambda_nm[i] / 1000));
    put_share(a[i], usual_mm, to);
    fputc('\n', to);
  }
}

static void count_losses(const abbe_material *m, abbe_summary *t) {
  if (m->description != NULL) abbe_summary_add(t, DESCRIPTION, m->name);
  if (m->warning != NULL) abbe_summary_add(t, WARNING, m->name);
  if (m->fit[0].terms > 0 || m->fit[1].terms > 0) abbe_summary_add(t, FITS, m->name);
  if (abbe_material_is_crystal(m)) abbe_summary_add(t, EXTRAORDINARY, m->name);
  if (abbe_material_is_pleochroic(m)) abbe_summary_add(t, PLEOCHROISM, m->name);
  if (abbe_material_is_fluorescent(m)) abbe_summary_add(t, FLUORESCENCE, m->name);
  if (m->extrapolate) abbe_summary_add(t, EXTRAPOLATE, m->name);
  if (m->n_absolute) abbe_summary_add(t, ABSOLUTE, m->name);
  for (int i = 0; i < 2; i++)
    if (m->catalogue.expansion_range_k[2 * i + 1] > 0) {
      abbe_summary_add(t, EXPANSION, m->name);
      break;
    }
  abbe_summary_add(t, SOURCE, m->name);
}

/* The visible part of the range is what a fit should serve; where it has none, all of it. */
static void fit_range(const abbe_material *m, double *low_nm, double *high_nm) {
  *low_nm = fmax(m->min_nm, ABBE_WAVELENGTH_MIN_NM);
  *high_nm = fmin(m->max_nm, ABBE_WAVELENGTH_MAX_NM);
  if (*high_nm - *low_nm >= 50) return;
  *low_nm = m->min_nm;
  *high_nm = m->max_nm;
}

static abbe_result write_glass(const abbe_material *m, abbe_summary *t, abbe_report *report,
                               FILE *to, abbe_error *error) {
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
  if (fidelity == ABBE_AGF_REWRITTEN) abbe_summary_add(t, REWRITTEN, m->name);
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
  abbe_summary t = {0};
  fputs("CC ", to);
  put_line(to, table->description != NULL ? table->description : "written by Abbe");
  fputc('\n', to);
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < table->count && result == ABBE_OK; i++) {
    abbe_error why;
    if (abbe_material_check(&table->material[i], &why) != ABBE_OK)
      abbe_report_add(report, ABBE_NOTE_SKIPPED, table->material[i].line, NULL, "%s", why.text);
    else if (abbe_material_is_conductor(&table->material[i]))
      abbe_report_add(report, ABBE_NOTE_SKIPPED, table->material[i].line, table->material[i].name,
                      "it is a conductor, and a catalogue of glasses has no place for one");
    else
      result = write_glass(&table->material[i], &t, report, to, error);
  }
  abbe_summary_report(&t, losses, LOSSES, report);
  if (result != ABBE_OK) return result;
  if (fflush(to) == 0 && !ferror(to)) return ABBE_OK;
  return abbe_error_set(error, ABBE_IO, "the catalogue could not be written");
}
