#include "spectral/editing/doctor.h"

#include "base/number.h"
#include "spectral/dispersion/fit.h"
#include "spectral/editing/doctor_parts.h"
#include "spectral/wavelengths.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- names ---- */

static const struct {
  const char *name, *meaning;
} kinds[] = {
#define ABBE_FINDING_ROW(code, name, meaning) {name, meaning},
    ABBE_FINDING_KINDS(ABBE_FINDING_ROW)
#undef ABBE_FINDING_ROW
};

static bool known_kind(abbe_finding_kind kind) {
  return (int)kind >= 0 && kind < ABBE_FINDING_KIND_COUNT;
}

const char *abbe_finding_kind_name(abbe_finding_kind kind) {
  return known_kind(kind) ? kinds[kind].name : "unknown";
}

const char *abbe_finding_kind_meaning(abbe_finding_kind kind) {
  return known_kind(kind) ? kinds[kind].meaning : "unknown";
}

const char *abbe_finding_weight_name(abbe_finding_weight weight) {
  switch (weight) {
  case ABBE_FINDING_NOTE:
    return "note";
  case ABBE_FINDING_DOUBTFUL:
    return "doubtful";
  case ABBE_FINDING_WRONG:
    return "wrong";
  }
  return "unknown";
}

/* Letters and digits in lower case, without Schott's "N-" for lead-free. */
static void plain_name(const char *name, bool drop_n, char *out, size_t size) {
  size_t used = 0;
  if (drop_n && (name[0] == 'n' || name[0] == 'N') && name[1] == '-') name += 2;
  for (; *name != '\0' && used + 1 < size; name++)
    if (isalnum((unsigned char)*name)) out[used++] = (char)tolower((unsigned char)*name);
  out[used] = '\0';
}

const abbe_material *abbe_doctor_namesake(const abbe_material_table *known, const char *name) {
  char wanted[ABBE_MATERIAL_MAX_NAME + 1], other[ABBE_MATERIAL_MAX_NAME + 1];
  for (size_t i = 0; known != NULL && i < known->count; i++)
    if (strcasecmp(known->material[i].name, name) == 0) return &known->material[i];
  plain_name(name, true, wanted, sizeof wanted);
  for (size_t i = 0; known != NULL && wanted[0] != '\0' && i < known->count; i++) {
    plain_name(known->material[i].name, true, other, sizeof other);
    if (strcmp(wanted, other) == 0) return &known->material[i];
  }
  return NULL;
}

/* ---- findings ---- */

void abbe_findings_free(abbe_findings *findings) {
  if (findings == NULL) return;
  for (size_t i = 0; i < findings->count; i++) {
    free(findings->finding[i].evidence);
    free(findings->finding[i].mend);
    free(findings->finding[i].value);
  }
  free(findings->finding);
  *findings = (abbe_findings){0};
}

static abbe_finding *no_memory(abbe_doctor *d) {
  d->result = abbe_error_set(d->error, ABBE_NO_MEMORY, "no memory for what is found");
  return NULL;
}

bool abbe_doctor_has(const abbe_doctor *d, double lambda_nm) {
  return lambda_nm >= d->low_nm && lambda_nm <= d->high_nm;
}

abbe_finding *abbe_doctor_find(abbe_doctor *d, abbe_finding_kind kind, abbe_finding_weight weight) {
  abbe_findings *f = d->findings;
  if (f->count == f->capacity) {
    size_t capacity = f->capacity > 0 ? 2 * f->capacity : 16;
    abbe_finding *larger = realloc(f->finding, capacity * sizeof *larger);
    if (larger == NULL) return no_memory(d);
    f->finding = larger;
    f->capacity = capacity;
  }
  abbe_finding *made = &f->finding[f->count++];
  *made =
      (abbe_finding){.kind = kind, .weight = weight, .row = d->row, .other = ABBE_FINDING_NO_ROW};
  return made;
}

void abbe_doctor_say(abbe_doctor *d, char **sentence, const char *format, ...) {
  char text[1200];
  va_list arguments;
  va_start(arguments, format);
  abbe_number_format_list(text, sizeof text, format, arguments);
  va_end(arguments);
  free(*sentence);
  *sentence = strdup(text);
  if (*sentence == NULL) no_memory(d);
}

void abbe_doctor_set_coefficients(abbe_doctor *d, abbe_finding *finding,
                                  const abbe_dispersion *right) {
  char list[ABBE_DISPERSION_MAX_COEFFICIENTS * (ABBE_NUMBER_TEXT_SIZE + 2) + 3] = "[";
  char text[ABBE_NUMBER_TEXT_SIZE];
  size_t used = 1;
  for (size_t i = 0; i < right->count; i++)
    used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", i > 0 ? ", " : "",
                             abbe_number_text(right->c[i], text));
  abbe_doctor_say(d, &finding->value, "%s]", list);
  finding->key = "coefficients";
}

/* value to so many digits, whatever the locale's point; returns text. */
static const char *digits(double value, int count, char text[ABBE_NUMBER_TEXT_SIZE]) {
  double scale = value == 0 ? 1 : pow(10, count - 1 - floor(log10(fabs(value))));
  bool fits = isfinite(scale) && isfinite(value * scale) && scale > 0;
  return abbe_number_text(fits ? round(value * scale) / scale : value, text);
}

/* ---- the small checks ---- */

static void check_source(abbe_doctor *d) {
  static const char *const empty[] = {"",  "unknown",   "none", "n/a",      "na",
                                      "?", "-",         "tbd",  "source",   "missing",
                                      "x", "no source", "...",  "internet", "the internet"};
  const char *source = d->material->source != NULL ? d->material->source : "";
  for (size_t i = 0; i < sizeof empty / sizeof empty[0]; i++) {
    if (strcasecmp(source, empty[i]) != 0) continue;
    abbe_finding *f = abbe_doctor_find(d, ABBE_FINDING_NO_SOURCE, ABBE_FINDING_DOUBTFUL);
    if (f == NULL) return;
    if (source[0] == '\0')
      abbe_doctor_say(d, &f->evidence, "the record has no source");
    else
      abbe_doctor_say(d, &f->evidence, "its source is '%s', which leads nowhere", source);
    abbe_doctor_say(d, &f->mend, "say which catalogue, paper or measurement the numbers are from");
    return;
  }
}

static void check_range(abbe_doctor *d) {
  const abbe_material *m = d->material;
  bool missing = !(m->min_nm > 0);
  bool tabulated = m->dispersion.table != NULL;
  /* nothing transparent is tabulated below 100 nm, but 0.1 to 100 um is where glass is; X-rays are
   * refracted by no more than 1 */
  if (!missing && m->max_nm >= 100) return;
  if (!missing && tabulated && abbe_dispersion_n(&m->dispersion, m->max_nm) < 1.1) return;
  abbe_finding *f = abbe_doctor_find(d, ABBE_FINDING_UNITS, ABBE_FINDING_WRONG);
  if (f == NULL) return;
  if (missing) {
    abbe_doctor_say(d, &f->evidence, "the record does not say for which wavelengths it holds");
    abbe_doctor_say(d, &f->mend, "give range_nm: [from, to], as the source has it");
    return;
  }
  abbe_doctor_say(d, &f->evidence, "its range of %g to %g nm would be X-rays; it is in um",
                  m->min_nm, m->max_nm);
  abbe_doctor_say(d, &f->mend, "%s: %g to %g nm", tabulated ? "points in nm" : "range_nm in nm",
                  1000 * m->min_nm, 1000 * m->max_nm);
  if (tabulated) return;
  char low[ABBE_NUMBER_TEXT_SIZE], high[ABBE_NUMBER_TEXT_SIZE];
  abbe_doctor_say(d, &f->value, "[%s, %s]", digits(1000 * m->min_nm, 10, low),
                  digits(1000 * m->max_nm, 10, high));
  f->key = "range_nm";
  f->certain = true;
}

static void check_fit(abbe_doctor *d, const abbe_material_fit *fit) {
  const abbe_material *m = d->material;
  abbe_index_difference off;
  if (fit->terms == 0 || abbe_material_fit_residual(m, fit, &off, NULL) != ABBE_OK) return;
  if (off.max <= 1.02 * fit->max_error + 1e-8) return;
  abbe_finding *f = abbe_doctor_find(d, ABBE_FINDING_FIT, ABBE_FINDING_WRONG);
  if (f == NULL) return;
  abbe_doctor_say(d, &f->evidence,
                  "its fit of %zu Cauchy terms says that it errs by %.3g at most; it errs by %.3g "
                  "at %g nm",
                  fit->terms, fit->max_error, off.max, off.max_nm);
  abbe_dispersion right;
  double error = 0;
  abbe_doctor_say(d, &f->mend, "make the fit anew from the record's own %s formula",
                  abbe_dispersion_model_name(m->dispersion.model));
  if (abbe_fit_dispersion(&m->dispersion, fit->terms, fit->min_nm, fit->max_nm, &right, &error,
                          NULL) != ABBE_OK)
    return;
  char list[8 * (ABBE_NUMBER_TEXT_SIZE + 2)] = "", text[3][ABBE_NUMBER_TEXT_SIZE];
  size_t used = 0;
  for (size_t k = 0; k < right.count; k++)
    used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", k ? ", " : "",
                             digits(right.c[k], 9, text[0]));
  abbe_doctor_say(d, &f->value, "{coefficients: [%s], max_error: %s, range_nm: [%s, %s]}", list,
                  digits(error, 3, text[0]), abbe_number_text(fit->min_nm, text[1]),
                  abbe_number_text(fit->max_nm, text[2]));
  f->key = fit->terms == 2 ? "fit.cauchy2" : "fit.cauchy3";
  f->certain = true;
}

/* ---- visits ---- */

static abbe_result visit(const abbe_material *material, size_t row,
                         const abbe_material_table *known, abbe_findings *findings,
                         abbe_error *error) {
  abbe_doctor d = {.material = material,
                   .known = known,
                   .low_nm = material->min_nm,
                   .high_nm = material->max_nm,
                   .row = row,
                   .findings = findings,
                   .error = error};
  if (material->dispersion.model == ABBE_DISPERSION_CONSTANT || !(material->min_nm > 0)) {
    d.low_nm = ABBE_WAVELENGTH_MIN_NM;
    d.high_nm = ABBE_WAVELENGTH_MAX_NM;
  }
  d.namesake = abbe_doctor_namesake(known, material->name);
  abbe_material_published_make(material, &d.published);
  bool unit = material->max_nm < 100 && material->min_nm > 0;
  if (unit) d.low_nm *= 1000, d.high_nm *= 1000;
  if (!abbe_doctor_read_anew(&d) && !unit) {
    abbe_doctor_follow_curve(&d);
    for (int i = 0; i < 2; i++) check_fit(&d, &material->fit[i]);
  }
  check_range(&d);
  check_source(&d);
  return d.result;
}

abbe_result abbe_doctor_check_material(const abbe_material *material,
                                       const abbe_material_table *known, abbe_findings *findings,
                                       abbe_error *error) {
  ABBE_REQUIRE(material && material->name && findings, error);
  return visit(material, 0, known, findings, error);
}

static int by_row_and_kind(const void *a, const void *b) {
  const abbe_finding *x = a, *y = b;
  if (x->row != y->row) return x->row < y->row ? -1 : 1;
  if (x->kind != y->kind) return x->kind < y->kind ? -1 : 1;
  return (x->other > y->other) - (x->other < y->other);
}

abbe_result abbe_doctor_check_table(const abbe_material_table *table,
                                    const abbe_material_table *known, abbe_findings *findings,
                                    abbe_error *error) {
  ABBE_REQUIRE(table && findings, error);
  size_t before = findings->count;
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < table->count && result == ABBE_OK; i++)
    result = visit(&table->material[i], i, known, findings, error);
  if (result == ABBE_OK) result = abbe_doctor_compare_rows(table, findings, error);
  if (result == ABBE_OK && findings->count > before)
    qsort(findings->finding + before, findings->count - before, sizeof *findings->finding,
          by_row_and_kind);
  return result;
}
