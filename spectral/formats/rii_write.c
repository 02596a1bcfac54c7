#include "spectral/formats/material_write.h"

#include "base/foreign_text.h"
#include "base/number.h"
#include "base/yaml/yaml_edit_text.h"
#include "spectral/materials/absorption.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

static void put(FILE *to, double value) {
  char text[ABBE_NUMBER_TEXT_SIZE];
  fprintf(to, " %s", abbe_number_text(value, text));
}

static void line(FILE *to, const char *key, double value) {
  fprintf(to, "    %s:", key);
  put(to, value);
  fputc('\n', to);
}

static bool write_text(FILE *to, const char *key, const char *text) {
  if (text == NULL || text[0] == '\0') return true;
  char *html = abbe_html_escape(text);
  if (html == NULL) return false;
  fprintf(to, "%s: ", key);
  abbe_yaml_quote_write(html, to);
  fputc('\n', to);
  free(html);
  return true;
}

/* ---- the index ---- */

static int formula_of(abbe_dispersion_model model) {
  switch (model) {
  case ABBE_DISPERSION_SELLMEIER:
    return 1;
  case ABBE_DISPERSION_SELLMEIER2:
    return 2;
  case ABBE_DISPERSION_POLYNOMIAL:
    return 3;
  case ABBE_DISPERSION_RII4:
    return 4;
  case ABBE_DISPERSION_RII6:
    return 6;
  case ABBE_DISPERSION_HERZBERGER:
    return 7;
  case ABBE_DISPERSION_RII8:
    return 8;
  case ABBE_DISPERSION_RII9:
    return 9;
  default:
    return 5; /* constant, Cauchy and powers */
  }
}

static void write_formula(const abbe_material *m, FILE *to) {
  const abbe_dispersion *d = &m->dispersion;
  fprintf(to, "  - type: formula %d\n    wavelength_range:", formula_of(d->model));
  put(to, abbe_number_tidy(m->min_nm / 1000));
  put(to, abbe_number_tidy(m->max_nm / 1000));
  fputs("\n    coefficients:", to);
  for (size_t i = 0; i < d->count; i++) {
    put(to, d->c[i]);
    if (d->model == ABBE_DISPERSION_CAUCHY && i > 0) put(to, -2.0 * (double)i);
  }
  fputc('\n', to);
}

static void write_points(const char *type, const abbe_spectrum *spectrum, bool as_k, FILE *to) {
  const double *lambda_nm = abbe_spectrum_lambda_nm(spectrum);
  const double *value = abbe_spectrum_value(spectrum);
  fprintf(to, "  - type: tabulated %s\n    data: |\n", type);
  for (size_t i = 0; i < abbe_spectrum_count(spectrum); i++) {
    fputs("       ", to);
    put(to, abbe_number_tidy(lambda_nm[i] / 1000));
    put(to, as_k ? abbe_number_tidy(abbe_absorption_k(value[i], lambda_nm[i])) : value[i]);
    fputc('\n', to);
  }
}

static void write_conductor(const abbe_dispersion *d, FILE *to) {
  fputs("  - type: tabulated nk\n    data: |\n", to);
  for (size_t i = 0; i < abbe_spectrum_count(d->table); i++) {
    fputs("       ", to);
    put(to, abbe_number_tidy(abbe_spectrum_lambda_nm(d->table)[i] / 1000));
    put(to, abbe_spectrum_value(d->table)[i]);
    put(to, abbe_spectrum_value(d->k)[i]);
    fputc('\n', to);
  }
}

/* ---- what the catalogue prints ---- */

static bool any(const double *value, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (value[i] != 0) return true;
  return false;
}

static void write_expansion(const abbe_material_catalogue *c, FILE *to) {
  fputs("    thermal_expansion:\n", to);
  for (int i = 0; i < 2; i++) {
    const double *said = c->expansion_range_k + 2 * i;
    const double *kelvin = said[1] > 0 ? said : abbe_material_expansion_range_k + 2 * i;
    if (c->expansion_per_k[i] == 0) continue;
    fputs("      - temperature_range:", to);
    put(to, kelvin[0]);
    put(to, kelvin[1]);
    fputs("\n        value:", to);
    put(to, c->expansion_per_k[i]);
    fputc('\n', to);
  }
}

static void write_properties(const abbe_material *m, FILE *to) {
  static const char *const resistance[] = {"climatic", "stain", "acid", "alkali", "phosphate"};
  const abbe_material_catalogue *c = &m->catalogue;
  bool something = m->published_n_d != 0 || m->published_v_d != 0 || c->code != NULL ||
                   c->status != NULL || c->density_g_cm3 != 0 || any(c->expansion_per_k, 2) ||
                   c->dpgf != 0 || any(c->thermal, 6) || c->rating_count > 0;
  if (!something) return;
  fputs("PROPERTIES:\n", to);
  if (any(c->thermal, 6)) {
    fputs("    thermal_dispersion:\n      - type: formula A\n        coefficients:", to);
    for (int i = 0; i < 6; i++) put(to, c->thermal[i]);
    fputc('\n', to);
  }
  if (m->published_n_d != 0) line(to, "nd", m->published_n_d);
  if (m->published_v_d != 0) line(to, "Vd", m->published_v_d);
  write_text(to, "    glass_code", c->code);
  write_text(to, "    glass_status", c->status);
  if (c->density_g_cm3 != 0) {
    fputs("    density:\n      - value:", to);
    put(to, abbe_number_tidy(c->density_g_cm3 * 1000));
    fputc('\n', to);
  }
  if (any(c->expansion_per_k, 2)) write_expansion(c, to);
  if (c->dpgf != 0) line(to, "dPgF", c->dpgf);
  if (c->rating_count == 6) fputs("    resistance:\n", to);
  for (int i = 0; c->rating_count == 6 && i < 5; i++) {
    fprintf(to, "        %s:", resistance[i]);
    put(to, c->ratings[i + 1]);
    fputc('\n', to);
  }
}

static void note_losses(const abbe_material *m, abbe_report *report) {
  const abbe_material_catalogue *c = &m->catalogue;
  const abbe_spectrum *table = m->dispersion.table;
  const struct {
    bool met;
    const char *sentence;
  } losses[] = {
      {m->description != NULL, "the database has no place for a description"},
      {m->warning != NULL, "the database has no place for a warning"},
      {m->fit[0].terms > 0 || m->fit[1].terms > 0, "the database has no place for recorded fits"},
      {abbe_material_is_biaxial(m), "a file of the database has one index: the middle one"},
      {abbe_material_is_uniaxial(m), "a file of the database has one index: the ordinary one"},
      {abbe_material_is_pleochroic(m), "a file of the database has one k: that along x"},
      {abbe_material_is_fluorescent(m),
       "the database has no place for fluorescence and for what excites it"},
      {m->extrapolate, "the database cannot allow use outside the range"},
      {table != NULL && m->dispersion.k == NULL &&
           abbe_spectrum_interpolation(table) != ABBE_INTERPOLATION_MONOTONE,
       "the database does not say how n runs between its points"},
      {table != NULL &&
           (m->min_nm != abbe_spectrum_lambda_nm(table)[0] ||
            m->max_nm != abbe_spectrum_lambda_nm(table)[abbe_spectrum_count(table) - 1]),
       "a table's range is that of its points"},
      {m->attenuation != NULL &&
           abbe_spectrum_interpolation(m->attenuation) != ABBE_INTERPOLATION_LINEAR,
       "the database does not say how k runs between its points"},
      {c->melt_frequency != 0, "the database has no place for how often a glass is molten"},
      {c->rating_count == 6 && c->ratings[0] >= 0, "the database has no place for a glass's cost"},
  };
  for (size_t i = 0; i < sizeof losses / sizeof losses[0]; i++)
    if (losses[i].met)
      abbe_report_add(report, ABBE_NOTE_LOST, m->line, m->name, "%s", losses[i].sentence);
}

abbe_result abbe_rii_write(const abbe_material *material, FILE *to, abbe_report *report,
                           abbe_error *error) {
  const abbe_material *m = material;
  ABBE_TRY(abbe_material_check(m, error));
  bool good = write_text(to, "REFERENCES", m->source) && write_text(to, "COMMENTS", m->comment);
  if (!good) return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for a text", m->name);
  fputs("DATA:\n", to);
  if (abbe_material_is_conductor(m))
    write_conductor(&m->dispersion, to);
  else if (m->dispersion.table != NULL)
    write_points("n", m->dispersion.table, false, to);
  else
    write_formula(m, to);
  if (m->attenuation != NULL) write_points("k", m->attenuation, true, to);
  if (m->n_absolute || !isnan(m->temperature_c)) fputs("CONDITIONS:\n", to);
  if (m->n_absolute) fputs("    n_absolute: true\n", to);
  if (!isnan(m->temperature_c))
    line(to, "temperature", abbe_number_tidy(m->temperature_c + 273.15));
  write_properties(m, to);
  note_losses(m, report);
  if (fflush(to) == 0 && !ferror(to)) return ABBE_OK;
  return abbe_error_set(error, ABBE_IO, "%s: it could not be written", m->name);
}
