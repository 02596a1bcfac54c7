#include "spectral/formats/material_write.h"

#include "base/number.h"
#include "base/yaml/yaml_edit_text.h"
#include "spectral/materials/absorption.h"
#include "spectral/wavelengths.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 100 };

/* ---- text ---- */

static void write_text(const char *key, const char *text, FILE *to) {
  if (text == NULL || text[0] == '\0') return;
  fprintf(to, "%s: ", key);
  abbe_yaml_quote_write(text, to);
  fputc('\n', to);
}

/* ---- numbers ---- */

static void write_number(const char *key, double value, FILE *to) {
  char text[ABBE_NUMBER_TEXT_SIZE];
  fprintf(to, "%s: %s\n", key, abbe_number_text(value, text));
}

/* [a, b, …], folded to the width; column is where it begins, indent where its next lines do. */
static void write_list(const double *value, size_t count, int column, int indent, FILE *to) {
  char text[ABBE_NUMBER_TEXT_SIZE];
  fputc('[', to);
  column++;
  for (size_t i = 0; i < count; i++) {
    const char *number = abbe_number_text(value[i], text);
    int length = (int)strlen(number) + 2;
    if (i > 0 && column + length > WIDTH) {
      fprintf(to, ",\n%*s", indent, "");
      column = indent;
    } else if (i > 0) {
      fputs(", ", to);
    }
    fputs(number, to);
    column += length;
  }
  fputc(']', to);
}

/* third is a conductor's k, else NULL. */
static void write_points(const abbe_spectrum *spectrum, const abbe_spectrum *third, int indent,
                         FILE *to) {
  const double *lambda_nm = abbe_spectrum_lambda_nm(spectrum);
  const double *value = abbe_spectrum_value(spectrum);
  char a[ABBE_NUMBER_TEXT_SIZE], b[ABBE_NUMBER_TEXT_SIZE], c[ABBE_NUMBER_TEXT_SIZE] = "";
  int column = WIDTH;
  fputc('[', to);
  for (size_t i = 0; i < abbe_spectrum_count(spectrum); i++) {
    abbe_number_text(lambda_nm[i], a);
    abbe_number_text(value[i], b);
    if (third != NULL) abbe_number_text(abbe_spectrum_value(third)[i], c);
    int length = (int)(strlen(a) + strlen(b) + strlen(c)) + (third != NULL ? 8 : 6);
    if (i > 0) fputc(',', to);
    if (column + length > WIDTH) {
      fprintf(to, "\n%*s", indent, "");
      column = indent;
    } else {
      fputc(' ', to);
    }
    fprintf(to, "[%s, %s%s%s]", a, b, third != NULL ? ", " : "", c);
    column += length;
  }
  fprintf(to, "\n%*s]\n", indent - 2, "");
}

/* ---- parts of a record ---- */

/* Model and numbers, each line indented by so many spaces. */
static void write_curve(const abbe_dispersion *d, int indent, FILE *to) {
  fprintf(to, "%*smodel: %s\n", indent, "", abbe_dispersion_model_name(d->model));
  if (d->model == ABBE_DISPERSION_TABULATED) {
    fprintf(to, "%*sinterpolation: %s\n%*spoints: ", indent, "",
            abbe_interpolation_name(abbe_spectrum_interpolation(d->table)), indent, "");
    write_points(d->table, NULL, indent + 2, to);
  } else if (d->model == ABBE_DISPERSION_CONDUCTOR) {
    fprintf(to, "%*spoints: ", indent, "");
    write_points(d->table, d->k, indent + 2, to);
  } else {
    fprintf(to, "%*scoefficients: ", indent, "");
    write_list(d->c, d->count, indent + 14, indent + 2, to);
    fputc('\n', to);
  }
}

static void write_dispersion(const abbe_material *m, FILE *to) {
  const abbe_dispersion *d = &m->dispersion;
  char low[ABBE_NUMBER_TEXT_SIZE], high[ABBE_NUMBER_TEXT_SIZE];
  write_curve(d, 4, to);
  bool all = m->min_nm == ABBE_SPECTRUM_LOW_NM && m->max_nm == ABBE_SPECTRUM_HIGH_NM;
  if (d->model != ABBE_DISPERSION_CONSTANT || !all)
    fprintf(to, "    range_nm: [%s, %s]\n", abbe_number_text(m->min_nm, low),
            abbe_number_text(m->max_nm, high));
  if (abbe_material_is_uniaxial(m)) {
    fputs("    extraordinary:\n", to);
    write_curve(&m->extraordinary, 6, to);
  }
  if (abbe_material_is_biaxial(m)) {
    fputs("    biaxial:\n      alpha:\n", to);
    write_curve(&m->outer[0], 8, to);
    fputs("      gamma:\n", to);
    write_curve(&m->outer[1], 8, to);
  }
  if (m->extrapolate) fputs("    extrapolate: true\n", to);
  if (!isnan(m->temperature_c)) write_number("    temperature_c", m->temperature_c, to);
  if (m->n_absolute) fputs("    n_absolute: true\n", to);
}

static void write_attenuation(const abbe_spectrum *attenuation, int indent, FILE *to) {
  abbe_interpolation interpolation = abbe_spectrum_interpolation(attenuation);
  if (interpolation != ABBE_INTERPOLATION_LINEAR)
    fprintf(to, "%*sinterpolation: %s\n", indent, "", abbe_interpolation_name(interpolation));
  fprintf(to, "%*sattenuation_per_m: ", indent, "");
  write_points(attenuation, NULL, indent + 2, to);
}

static void write_absorption(const abbe_material *m, FILE *to) {
  if (m->attenuation == NULL) return;
  fputs("    absorption:\n", to);
  if (!abbe_material_is_pleochroic(m)) {
    write_attenuation(m->attenuation, 6, to);
    return;
  }
  static const char *const axes[] = {"x", "y", "z"}, *const waves[] = {"ordinary", "",
                                                                       "extraordinary"};
  const bool three = abbe_material_is_biaxial(m);
  for (int axis = 0; axis < 3; axis += three ? 1 : 2) {
    const abbe_spectrum *own = axis > 0 ? m->attenuation_yz[axis - 1] : NULL;
    fprintf(to, "      %s:\n", three ? axes[axis] : waves[axis]);
    write_attenuation(own != NULL ? own : m->attenuation, 8, to);
  }
}

static void write_fluorescence(const abbe_fluorescence *f, FILE *to) {
  if (f->yield == 0) return;
  fputs("    fluorescence:\n", to);
  if (f->rows > 0) fputs("      matrix:\n", to);
  for (size_t i = 0; i < f->rows; i++) {
    write_number("      - nm", f->row[i].nm, to);
    fputs("        emission: ", to);
    write_points(f->row[i].emission, NULL, 10, to);
  }
  if (f->rows > 0) return;
  write_number("      yield", f->yield, to);
  fputs("      emission: ", to);
  write_points(f->emission, NULL, 8, to);
  if (f->excitation == NULL) return;
  fputs("      excitation_per_m: ", to);
  write_points(f->excitation, NULL, 8, to);
}

static bool any(const double *value, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (value[i] != 0) return true;
  return false;
}

static void write_numbers(const char *key, const double *value, size_t count, FILE *to) {
  fprintf(to, "      %s: ", key);
  write_list(value, count, (int)strlen(key) + 8, 8, to);
  fputc('\n', to);
}

static void write_catalogue(const abbe_material_catalogue *c, FILE *to) {
  bool something = c->code != NULL || c->status != NULL || c->melt_frequency != 0 ||
                   any(c->expansion_per_k, 2) || any(c->expansion_range_k, 4) || c->dpgf != 0 ||
                   any(c->thermal, 6) || c->rating_count > 0;
  if (!something) return;
  fputs("    catalogue:\n", to);
  if (c->code != NULL) {
    /* in quotes: digits are text here */
    fputs("      code: '", to);
    for (const char *d = c->code; *d != '\0'; d++)
      if (isalnum((unsigned char)*d) || strchr(" .-/", *d) != NULL) fputc(*d, to);
    fputs("'\n", to);
  }
  write_text("      status", c->status, to);
  if (c->melt_frequency != 0) write_number("      melt_frequency", c->melt_frequency, to);
  if (any(c->expansion_per_k, 2)) write_numbers("expansion_per_k", c->expansion_per_k, 2, to);
  if (any(c->expansion_range_k, 4)) write_numbers("expansion_range_k", c->expansion_range_k, 4, to);
  if (c->dpgf != 0) write_number("      dpgf", c->dpgf, to);
  if (any(c->thermal, 6)) write_numbers("thermal", c->thermal, 6, to);
  if (c->rating_count == 6) write_numbers("ratings", c->ratings, 6, to);
}

static void write_fits(const abbe_material *m, FILE *to) {
  static const char *const keys[] = {"cauchy2", "cauchy3"};
  if (m->fit[0].terms == 0 && m->fit[1].terms == 0) return;
  fputs("    fit:\n", to);
  for (int i = 0; i < 2; i++) {
    const abbe_material_fit *fit = &m->fit[i];
    char error[ABBE_NUMBER_TEXT_SIZE], low[ABBE_NUMBER_TEXT_SIZE], high[ABBE_NUMBER_TEXT_SIZE];
    if (fit->terms == 0) continue;
    fprintf(to, "      %s: {coefficients: ", keys[i]);
    write_list(fit->c, fit->terms, 0, 8, to);
    fprintf(to, ", max_error: %s, range_nm: [%s, %s]}\n", abbe_number_text(fit->max_error, error),
            abbe_number_text(fit->min_nm, low), abbe_number_text(fit->max_nm, high));
  }
}

/* ---- records and tables ---- */

abbe_result abbe_material_write(const abbe_material *material, FILE *to, abbe_error *error) {
  const abbe_material *m = material;
  ABBE_TRY(abbe_material_check(m, error));
  write_text("  - name", m->name, to);
  write_text("    description", m->description, to);
  write_dispersion(m, to);
  if (m->catalogue.density_g_cm3 != 0)
    write_number("    density_g_cm3", m->catalogue.density_g_cm3, to);
  if (m->published_n_d != 0) write_number("    n_d", m->published_n_d, to);
  if (m->published_v_d != 0) write_number("    v_d", m->published_v_d, to);
  write_text("    source", m->source, to);
  write_text("    comment", m->comment, to);
  write_text("    warning", m->warning, to);
  write_absorption(m, to);
  write_fluorescence(&m->fluorescence, to);
  write_catalogue(&m->catalogue, to);
  write_fits(m, to);
  if (!ferror(to)) return ABBE_OK;
  return abbe_error_set(error, ABBE_IO, "%s: its record could not be written", m->name);
}

static abbe_result write_table(const abbe_material_table *table, FILE *to, abbe_error *error) {
  write_text("description", table->description, to);
  fputs(table->description != NULL ? "\nmaterials:\n" : "materials:\n", to);
  for (size_t i = 0; i < table->count; i++) {
    if (i > 0) fputc('\n', to);
    ABBE_TRY(abbe_material_write(&table->material[i], to, error));
  }
  return ABBE_OK;
}

/* A value takes a byte at least, so that a short text has not too many of them. */
static abbe_result check_readable(const char *text, size_t size, size_t count, abbe_error *error) {
  enum { SURELY_READ = 1000000 };
  abbe_material_table table;
  abbe_error why = {0};
  if (size <= SURELY_READ) return ABBE_OK;
  abbe_result result = abbe_material_table_parse(text, size, "the table", &table, &why);
  abbe_material_table_free(&table);
  if (result == ABBE_OK) return ABBE_OK;
  if (result == ABBE_NO_MEMORY) return abbe_error_set(error, result, "%s", why.text);
  return abbe_error_set(
      error, ABBE_INVALID_ARGUMENT,
      "%zu materials are %.3g MB of YAML, which no command would read again (%s); "
      "write a store of them, to a file that ends in .sqlite",
      count, (double)size / 1e6, why.text);
}

abbe_result abbe_material_table_write(const abbe_material_table *table, FILE *to,
                                      abbe_error *error) {
  char *text = NULL;
  size_t size = 0;
  FILE *memory = open_memstream(&text, &size);
  if (memory == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a table");
  abbe_result result = write_table(table, memory, error);
  if (fclose(memory) != 0 && result == ABBE_OK)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a table");
  if (result == ABBE_OK) result = check_readable(text, size, table->count, error);
  if (result == ABBE_OK) fwrite(text, 1, size, to);
  free(text);
  if (result != ABBE_OK || (fflush(to) == 0 && !ferror(to))) return result;
  return abbe_error_set(error, ABBE_IO, "the table could not be written");
}

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
  ABBE_TRY(plan(m, asked, &s, error));
  ABBE_TRY(abbe_material_n(m, s.min_nm, &n, error));
  ABBE_TRY(abbe_material_n(m, s.max_nm, &n, error));
  for (size_t i = 0;; i++) {
    double lambda_nm = abbe_number_tidy(fmin(s.min_nm + (double)i * s.step_nm, s.max_nm));
    ABBE_TRY(abbe_material_n(m, lambda_nm, &n, error));
    write_row(m, lambda_nm, n, to);
    /* halfway between two points a straight line is worst */
    if (i > 0 && abbe_material_n(m, (last_nm + lambda_nm) / 2, &middle, NULL) == ABBE_OK)
      worst = fmax(worst, fabs((n + before) / 2 - middle));
    before = n;
    last_nm = lambda_nm;
    if (lambda_nm >= s.max_nm) break;
  }
  abbe_report_add(report, ABBE_NOTE_LOST, m->line, m->name,
                  "the formula is sampled every %g nm from %g to %g nm; straight lines between "
                  "the points are off by up to %.2g",
                  s.step_nm, s.min_nm, s.max_nm, worst);
  return ABBE_OK;
}

static void note_losses(const abbe_material *m, abbe_report *report) {
  bool more = m->description != NULL || m->warning != NULL || m->comment != NULL ||
              m->catalogue.code != NULL || m->catalogue.density_g_cm3 != 0 || m->fit[0].terms > 0 ||
              m->published_n_d != 0 || abbe_material_is_fluorescent(m);
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
  ABBE_TRY(abbe_material_check(m, error));
  fprintf(to, "# %s; source: ", m->name);
  for (const char *c = m->source; *c != '\0'; c++) fputc((unsigned char)*c < 0x20 ? ' ' : *c, to);
  const bool metal = abbe_material_is_conductor(m);
  fputs(metal || m->attenuation != NULL ? "\nwavelength_nm,n,k\n" : "\nwavelength_nm,n\n", to);
  const abbe_spectrum *table = m->dispersion.table;
  if (metal) write_conductor(&m->dispersion, to);
  for (size_t i = 0; !metal && table != NULL && i < abbe_spectrum_count(table); i++)
    write_row(m, abbe_spectrum_lambda_nm(table)[i], abbe_spectrum_value(table)[i], to);
  if (table == NULL) ABBE_TRY(write_formula(m, sampling, to, report, error));
  note_losses(m, report);
  if (fflush(to) == 0 && !ferror(to)) return ABBE_OK;
  return abbe_error_set(error, ABBE_IO, "%s: its points could not be written", m->name);
}
