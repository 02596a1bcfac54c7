#include "spectral/formats/material_import.h"

#include "base/file.h"
#include "base/foreign_text.h"
#include "base/number.h"
#include "base/text.h"
#include "spectral/dispersion/points.h"
#include "spectral/formats/agf_formula.h"
#include "spectral/materials/absorption.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MAX_BYTES = 64 << 20, MAX_TEXT = 1000, MAX_TITLE = 60 };

/* Range where a catalogue states none: what every glass is measured over. */
static const double ASSUMED_LOW_NM = 404.66, ASSUMED_HIGH_NM = 656.27;

typedef struct glass {
  bool open;
  size_t line, cd_line;
  char name[ABBE_MATERIAL_MAX_NAME + 16];
  char formula[24], code[24];
  abbe_agf_numbers nm; /* what follows the code: n_d, V_d, exclude, status, melt frequency */
  abbe_agf_numbers ed, cd, td, od, ld;
  char *comment;
  abbe_points transmittance; /* nm, attenuation in 1/m */
  size_t opaque, clear, odd; /* IT lines with T = 0, with T >= 1, that could not be used */
} glass;

typedef struct reader {
  const char *file; /* its last part */
  abbe_material_table *table;
  abbe_report *report;
  abbe_error *error;
  size_t line, glasses;
  size_t noted; /* notes of others before ours */
  glass glass;
  abbe_agf_numbers *open; /* which a line that begins with a number continues */
  char *remark;           /* the first CC line */
} reader;

static abbe_result keep_text(reader *r, const char *text, char **out) {
  text = abbe_agf_skip(text);
  size_t length = strlen(text);
  while (length > 0 && abbe_agf_is_blank(text[length - 1])) length--;
  if (length == 0 || *out != NULL) return ABBE_OK;
  if (length > MAX_TEXT) length = MAX_TEXT;
  while (((unsigned char)text[length] & 0xc0) == 0x80) length--; /* a whole letter */
  *out = malloc(length + 1);
  if (*out == NULL) return abbe_error_set(r->error, ABBE_NO_MEMORY, "%s: no memory", r->file);
  memcpy(*out, text, length);
  (*out)[length] = '\0';
  for (char *c = *out; *c != '\0'; c++)
    if (*c == '\t') *c = ' ';
  return ABBE_OK;
}

/* ---- a glass from what its lines hold ---- */

/* What of the catalogue's first remark goes with every glass; the description has it all. */
static void title_of(const char *remark, char title[MAX_TITLE + 8]) {
  size_t length = strlen(remark);
  snprintf(title, MAX_TITLE + 8, "; %.*s", MAX_TITLE, remark);
  if (length <= MAX_TITLE) return;
  abbe_utf8_trim(title);
  char *blank_at = strrchr(title + 2, ' ');
  if (blank_at != NULL) *blank_at = '\0';
  strcat(title, "…");
}

static abbe_result read_source(reader *r, abbe_material *m) {
  glass *g = &r->glass;
  if (g->comment != NULL && strncasecmp(g->comment, "source:", 7) == 0) {
    ABBE_TRY(keep_text(r, g->comment + 7, &m->source));
    if (m->source != NULL) return ABBE_OK;
  }
  char text[MAX_TEXT], title[MAX_TITLE + 8] = "";
  if (r->remark != NULL) title_of(r->remark, title);
  snprintf(text, sizeof text, "Zemax catalogue %.200s, %s%s", r->file, g->name, title);
  abbe_utf8_trim(text);
  return keep_text(r, text, &m->source);
}

static abbe_result read_texts(reader *r, abbe_material *m) {
  glass *g = &r->glass;
  abbe_result result = keep_text(r, g->name, &m->name);
  if (result == ABBE_OK) result = read_source(r, m);
  bool is_source = g->comment != NULL && strncasecmp(g->comment, "source:", 7) == 0;
  if (result == ABBE_OK && g->comment != NULL && !is_source) {
    /* a remark and a source may share the line */
    char *source = strstr(g->comment, "; source: ");
    if (source != NULL) {
      free(m->source);
      m->source = NULL;
      result = keep_text(r, source + 10, &m->source);
      *source = '\0';
    }
    if (result == ABBE_OK) result = keep_text(r, g->comment, &m->comment);
  }
  if (result == ABBE_OK && strspn(g->code, "0123456789.") == strlen(g->code) &&
      strcspn(g->code, ".") >= 6)
    result = keep_text(r, g->code, &m->catalogue.code);
  return result;
}

static abbe_result read_catalogue(reader *r, abbe_material *m) {
  static const char *const statuses[] = {"standard", "preferred", "obsolete", "special", "melt"};
  const glass *g = &r->glass;
  abbe_material_catalogue *c = &m->catalogue;
  double n_d = abbe_agf_number(&g->nm, 0, 0), v_d = abbe_agf_number(&g->nm, 1, 0),
         status = abbe_agf_number(&g->nm, 3, -1);
  /* placeholders: 1 for n_d, 0 for V_d */
  m->published_n_d = n_d > 1 && n_d < 1000 ? n_d : 0;
  m->published_v_d = fabs(v_d) < 1e6 ? v_d : 0;
  c->melt_frequency = fmax(abbe_agf_number(&g->nm, 4, 0), 0);
  for (int i = 0; i < 2; i++)
    c->expansion_per_k[i] = abbe_number_tidy(abbe_agf_number(&g->ed, (size_t)i, 0) * 1e-6);
  c->density_g_cm3 = fmax(abbe_agf_number(&g->ed, 2, 0), 0);
  c->dpgf = abbe_agf_number(&g->ed, 3, 0);
  for (size_t i = 0; i < 6; i++) c->thermal[i] = abbe_agf_number(&g->td, i, 0);
  for (size_t i = 0; i < 6; i++) {
    c->ratings[i] = abbe_agf_number(&g->od, i, -1);
    if (c->ratings[i] >= 0) c->rating_count = 6;
  }
  size_t beyond = abbe_material_catalogue_bound(c);
  if (beyond > 0)
    abbe_report_add(r->report, ABBE_NOTE_LOST, g->line, g->name,
                    "%zu of its numbers besides the index are too large to be true", beyond);
  /* zeros alone are a record that was not filled in */
  double temperature = abbe_agf_number(&g->td, 6, NAN);
  bool told = temperature != 0 || abbe_material_has_thermal(m);
  m->temperature_c = told && temperature >= -273.15 && temperature <= 1e4 ? temperature : NAN;
  if (status >= 0 && status < 5) return keep_text(r, statuses[(int)status], &c->status);
  return ABBE_OK;
}

static void read_range(reader *r, abbe_material *m) {
  const glass *g = &r->glass;
  double low = abbe_number_tidy(abbe_agf_number(&g->ld, 0, 0) * 1000);
  double high = abbe_number_tidy(abbe_agf_number(&g->ld, 1, 0) * 1000);
  if (low > high && high > 0) {
    double swap = low;
    low = high;
    high = swap;
    abbe_report_add(r->report, ABBE_NOTE_CHANGED, g->line, g->name,
                    "its LD line names the longer wavelength first; read as %g to %g nm", low,
                    high);
  }
  if (!(low > 0 && high > low)) {
    low = ASSUMED_LOW_NM;
    high = ASSUMED_HIGH_NM;
    abbe_report_add(r->report, ABBE_NOTE_ASSUMED, g->line, g->name,
                    "it has no LD line with a range; %g to %g nm are taken", low, high);
  }
  m->min_nm = fmax(low, ABBE_SPECTRUM_LOW_NM);
  m->max_nm = fmin(high, ABBE_SPECTRUM_HIGH_NM);
  if (m->min_nm != low || m->max_nm != high)
    abbe_report_add(r->report, ABBE_NOTE_LOST, g->line, g->name,
                    "its range of %g to %g nm is cut to %g to %g nm", low, high, m->min_nm,
                    m->max_nm);
}

/* A whole table of ones is how catalogues fill the space where nothing was measured. */
static abbe_result read_absorption(reader *r, abbe_material *m) {
  glass *g = &r->glass;
  size_t dropped = 0;
  if (g->odd > 0)
    abbe_report_add(r->report, ABBE_NOTE_LOST, g->line, g->name,
                    "%zu IT lines want a wavelength, a transmittance from 0 to 1 and a thickness",
                    g->odd);
  if (g->transmittance.count == 0 || g->clear == g->transmittance.count) return ABBE_OK;
  if (g->opaque > 0)
    abbe_report_add(r->report, ABBE_NOTE_ASSUMED, g->line, g->name,
                    "%zu transmittances of 0 are too small to measure; taken as %g", g->opaque,
                    ABBE_ABSORPTION_LEAST_TRANSMITTANCE);
  abbe_result result = abbe_points_sort(&g->transmittance, &dropped, r->error);
  if (dropped > 0)
    abbe_report_add(r->report, ABBE_NOTE_LOST, g->line, g->name,
                    "%zu IT lines stand at a wavelength that was there before", dropped);
  return result != ABBE_OK ? result
                           : abbe_points_spectrum(&g->transmittance, ABBE_INTERPOLATION_LINEAR,
                                                  &m->attenuation, r->error);
}

/* 1 to 13; 0 where the text is no formula's number. */
static int formula_number(const char *text) {
  const char *end = text;
  double value = 0;
  bool good = abbe_number_read(text, &end, &value) && *end == '\0' && value == floor(value);
  return good && value >= 1 && value <= 13 ? (int)value : 0;
}

/* Why the glass cannot be used, into why; true where it can. */
static bool read_dispersion(reader *r, abbe_material *m, abbe_error *why) {
  const glass *g = &r->glass;
  abbe_agf_formula formula = {.number = formula_number(g->formula)};
  if (formula.number == 0) {
    abbe_error_set(why, ABBE_SCHEMA, "its formula is '%s'; a catalogue's are 1 to 13",
                   g->formula[0] != '\0' ? g->formula : "missing");
    return false;
  }
  if (g->cd.count == 0 || g->cd.bad) {
    abbe_error_set(why, ABBE_SCHEMA,
                   g->cd.count == 0 ? "it has no CD line with coefficients"
                                    : "its CD line holds something that is no number");
    return false;
  }
  for (size_t i = 0; i < ABBE_AGF_COEFFICIENTS; i++) formula.c[i] = abbe_agf_number(&g->cd, i, 0);
  return abbe_agf_formula_read(&formula, &m->dispersion, why) == ABBE_OK;
}

static abbe_result take_glass(reader *r, abbe_material *m) {
  const glass *g = &r->glass;
  abbe_error why = {0};
  ABBE_TRY(read_texts(r, m));
  ABBE_TRY(read_catalogue(r, m));
  m->line = g->line;
  bool good = read_dispersion(r, m, &why);
  if (good) {
    read_range(r, m);
    good = abbe_material_check(m, &why) == ABBE_OK;
  }
  if (!good) {
    size_t named = strlen(g->name); /* the check's sentence begins with the name */
    bool twice = strncmp(why.text, g->name, named) == 0 && strncmp(why.text + named, ": ", 2) == 0;
    abbe_report_add(r->report, ABBE_NOTE_SKIPPED, g->line, g->name, "%s",
                    twice ? why.text + named + 2 : why.text);
    return ABBE_OK;
  }
  ABBE_TRY(read_absorption(r, m));
  if (g->nm.commas || g->cd.commas || g->ld.commas)
    abbe_report_add(r->report, ABBE_NOTE_CHANGED, g->line, g->name,
                    "its decimal commas are read as points");
  if (abbe_agf_number(&g->nm, 2, 0) != 0 || abbe_agf_number(&g->ed, 4, 0) != 0)
    abbe_report_add(r->report, ABBE_NOTE_LOST, g->line, g->name,
                    "its flags to exclude it from substitution or to ignore expansion are Zemax's "
                    "alone");
  if (r->table->count == ABBE_MATERIAL_TABLE_MAX_COUNT) {
    abbe_report_add(r->report, ABBE_NOTE_SKIPPED, g->line, g->name,
                    "a table holds at most %d materials", ABBE_MATERIAL_TABLE_MAX_COUNT);
    return ABBE_OK;
  }
  return abbe_material_table_append(r->table, m, r->error);
}

static void clear_glass(glass *g) {
  free(g->comment);
  abbe_points_free(&g->transmittance);
  *g = (glass){0};
}

static abbe_result close_glass(reader *r) {
  abbe_result result = ABBE_OK;
  if (r->glass.open) {
    abbe_material m = {.temperature_c = NAN};
    r->glasses++;
    result = take_glass(r, &m);
    abbe_material_free(&m);
  }
  clear_glass(&r->glass);
  r->open = NULL;
  return result;
}

/* ---- records ---- */

/* A name such as OCTANE-1,6 ends at a blank, where a formula follows; else commas part the fields.
 */
static const char *take_name(const char *c, glass *g) {
  c = abbe_agf_skip(c);
  size_t length = strcspn(c, " \t"), kept = length;
  while (kept > 0 && c[kept - 1] == ',') kept--;
  const char *past = abbe_agf_word(c + length, g->formula, sizeof g->formula);
  bool whole = kept > 0 && kept < sizeof g->name && formula_number(g->formula) > 0;
  if (whole) memcpy(g->name, c, kept); /* it is zeroed behind */
  if (whole) return past;
  c = abbe_agf_word(c, g->name, sizeof g->name);
  return abbe_agf_word(c, g->formula, sizeof g->formula);
}

static void open_glass(reader *r, const char *c) {
  glass *g = &r->glass;
  g->open = true;
  g->line = r->line;
  c = take_name(c, g);
  c = abbe_agf_word(c, g->code, sizeof g->code);
  abbe_agf_numbers_read(c, &g->nm);
}

static abbe_result take_transmittance(reader *r, const char *c) {
  glass *g = &r->glass;
  abbe_agf_numbers l = {0};
  abbe_agf_numbers_read(c, &l);
  double lambda_nm = abbe_number_tidy(abbe_agf_number(&l, 0, 0) * 1000),
         share = abbe_agf_number(&l, 1, -1);
  double thickness_m = abbe_agf_number(&l, 2, 0) / 1000;
  bool usable = lambda_nm >= ABBE_SPECTRUM_LOW_NM && lambda_nm <= ABBE_SPECTRUM_HIGH_NM &&
                share >= 0 && share <= 1.02 && thickness_m > 1e-9 && thickness_m < 1e9;
  if (!usable || g->transmittance.count == ABBE_SPECTRUM_MAX_COUNT) {
    g->odd++;
    return ABBE_OK;
  }
  g->opaque += share == 0;
  g->clear += share >= 1;
  abbe_point p = {.lambda_nm = lambda_nm,
                  .value = abbe_absorption_from_transmittance(share, thickness_m)};
  return abbe_points_add(&g->transmittance, p, r->error);
}

/* A code is two letters and a blank or the line's end. */
static bool is_code(const char *line, const char *code) {
  return line[0] == code[0] && line[1] == code[1] &&
         (line[2] == '\0' || abbe_agf_is_blank(line[2]));
}

static abbe_result take_line(reader *r, const char *line) {
  glass *g = &r->glass;
  line = abbe_agf_skip(line);
  if (*line == '\0') return ABBE_OK;
  if (is_code(line, "NM")) {
    abbe_result result = close_glass(r);
    if (result == ABBE_OK) open_glass(r, line + 2);
    return result;
  }
  if (is_code(line, "CC")) {
    r->open = NULL;
    return keep_text(r, line + 2, &r->remark);
  }
  if (!g->open) return ABBE_OK; /* free text before the first glass */
  if (strchr("0123456789+-.", *line) != NULL) {
    if (r->open != NULL) abbe_agf_numbers_read(line, r->open);
    return ABBE_OK;
  }
  r->open = NULL;
  if (is_code(line, "GC")) return keep_text(r, line + 2, &g->comment);
  if (is_code(line, "IT")) return take_transmittance(r, line + 2);
  const struct {
    const char *code;
    abbe_agf_numbers *to;
  } lists[] = {{"ED", &g->ed}, {"CD", &g->cd}, {"TD", &g->td}, {"OD", &g->od}, {"LD", &g->ld}};
  for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++)
    if (is_code(line, lists[i].code)) {
      r->open = lists[i].to;
      *r->open = (abbe_agf_numbers){0};
      abbe_agf_numbers_read(line + 2, r->open);
    }
  return ABBE_OK;
}

static abbe_result take_lines(reader *r, char *text) {
  abbe_result result = ABBE_OK;
  while (*text != '\0' && result == ABBE_OK) {
    char *end = strchr(text, '\n');
    if (end != NULL) *end = '\0';
    r->line++;
    result = take_line(r, text);
    if (end == NULL) break;
    text = end + 1;
  }
  return result == ABBE_OK ? close_glass(r) : result;
}

static const char *first_reason(const reader *r) {
  for (size_t i = r->noted; r->report != NULL && i < r->report->count; i++)
    if (r->report->note[i].kind == ABBE_NOTE_SKIPPED) return r->report->note[i].text;
  return NULL;
}

static abbe_result finish(reader *r, const char *name) {
  if (r->glasses == 0)
    return abbe_error_set(r->error, ABBE_PARSE,
                          "%s: has no NM line, so it is no Zemax glass catalogue", name);
  ABBE_TRY(abbe_material_table_unique(r->table, r->report, r->error));
  if (r->table->count == 0) {
    const char *why = first_reason(r);
    return abbe_error_set(r->error, ABBE_SCHEMA, "%s: none of its %zu glasses can be used%s%s",
                          name, r->glasses, why != NULL ? "; the first: " : "",
                          why != NULL ? why : "");
  }
  r->table->path = strdup(name);
  if (r->table->path == NULL)
    return abbe_error_set(r->error, ABBE_NO_MEMORY, "%s: no memory", name);
  r->table->description = r->remark;
  r->remark = NULL;
  return ABBE_OK;
}

abbe_result abbe_agf_parse(const char *bytes, size_t size, const char *name,
                           abbe_material_table *out, abbe_report *report, abbe_error *error) {
  *out = (abbe_material_table){0};
  char *text = NULL;
  size_t length = 0;
  ABBE_TRY(abbe_encoding_decode(bytes, size, &text, &length, error));
  reader r = {.file = abbe_file_name(name),
              .table = out,
              .report = report,
              .error = error,
              .noted = report != NULL ? report->count : 0};
  abbe_result result = take_lines(&r, text);
  clear_glass(&r.glass);
  free(text);
  if (result == ABBE_OK) result = finish(&r, name);
  free(r.remark);
  if (result != ABBE_OK) abbe_material_table_free(out);
  return result;
}
