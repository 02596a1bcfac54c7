#include "spectral/editing/check.h"

#include "base/number.h"
#include "spectral/dispersion/fit.h"
#include "spectral/wavelengths.h"

#include <assert.h>
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- namesakes ---- */

/* Letters and digits in lower case, without Schott's "N-" for lead-free. */
static void plain_name(const char *name, bool drop_n, char *out, size_t size) {
  size_t used = 0;
  if (drop_n && (name[0] == 'n' || name[0] == 'N') && name[1] == '-') name += 2;
  for (; *name != '\0' && used + 1 < size; name++)
    if (isalnum((unsigned char)*name)) out[used++] = (char)tolower((unsigned char)*name);
  out[used] = '\0';
}

const abbe_material *abbe_check_namesake(const abbe_material_table *known, const char *name) {
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

/* ---- the small checks ---- */

/* value to so many digits, whatever the locale's point; returns text. */
static const char *digits(double value, int count, char text[ABBE_NUMBER_TEXT_SIZE]) {
  double scale = value == 0 ? 1 : pow(10, count - 1 - floor(log10(fabs(value))));
  bool fits = isfinite(scale) && isfinite(value * scale) && scale > 0;
  return abbe_number_text(fits ? round(value * scale) / scale : value, text);
}

static void check_source(abbe_check *c) {
  static const char *const empty[] = {"",  "unknown",   "none", "n/a",      "na",
                                      "?", "-",         "tbd",  "source",   "missing",
                                      "x", "no source", "...",  "internet", "the internet"};
  const char *source = c->material->source != NULL ? c->material->source : "";
  for (size_t i = 0; i < sizeof empty / sizeof empty[0]; i++) {
    if (strcasecmp(source, empty[i]) != 0) continue;
    abbe_finding *f = abbe_check_find(c, ABBE_FINDING_NO_SOURCE, ABBE_FINDING_DOUBTFUL);
    if (f == NULL) return;
    if (source[0] == '\0')
      abbe_check_say(c, &f->evidence, "the record has no source");
    else
      abbe_check_say(c, &f->evidence, "its source is '%s', which leads nowhere", source);
    abbe_check_say(c, &f->fix, "say which catalogue, paper or measurement the numbers are from");
    return;
  }
}

static void check_range(abbe_check *c) {
  const abbe_material *m = c->material;
  bool missing = !(m->min_nm > 0);
  bool tabulated = m->dispersion.table != NULL;
  /* nothing transparent is tabulated below 100 nm, but 0.1 to 100 um is where glass is; X-rays are
   * refracted by no more than 1 */
  if (!missing && m->max_nm >= 100) return;
  if (!missing && tabulated && abbe_dispersion_n(&m->dispersion, m->max_nm) < 1.1) return;
  abbe_finding *f = abbe_check_find(c, ABBE_FINDING_UNITS, ABBE_FINDING_WRONG);
  if (f == NULL) return;
  if (missing) {
    abbe_check_say(c, &f->evidence, "the record does not say for which wavelengths it holds");
    abbe_check_say(c, &f->fix, "give range_nm: [from, to], as the source has it");
    return;
  }
  abbe_check_say(c, &f->evidence, "its range of %g to %g nm would be X-rays; it is in um",
                 m->min_nm, m->max_nm);
  abbe_check_say(c, &f->fix, "%s: %g to %g nm", tabulated ? "points in nm" : "range_nm in nm",
                 1000 * m->min_nm, 1000 * m->max_nm);
  if (tabulated) return;
  char low[ABBE_NUMBER_TEXT_SIZE], high[ABBE_NUMBER_TEXT_SIZE];
  abbe_check_say(c, &f->value, "[%s, %s]", digits(1000 * m->min_nm, 10, low),
                 digits(1000 * m->max_nm, 10, high));
  f->key = "range_nm";
  f->certain = true;
}

/* Osmium, the densest of all, has 22.6 g/cm3; what is lighter than 0.1 is foam, and bends light by
 * less than 1.2. */
static void check_density(abbe_check *c) {
  const abbe_material *m = c->material;
  const double density = m->catalogue.density_g_cm3;
  const bool foam = density > 0 && density < 0.1 &&
                    abbe_dispersion_n(&m->dispersion, 0.5 * (c->low_nm + c->high_nm)) > 1.2;
  if (density <= 23 && !foam) return;
  abbe_finding *f = abbe_check_find(c, ABBE_FINDING_UNITS, ABBE_FINDING_WRONG);
  if (f == NULL) return;
  abbe_check_say(c, &f->evidence, "its density of %g g/cm3 is that of no %s", density,
                 foam ? "solid or liquid of such an index" : "matter; osmium has 22.6");
  abbe_check_say(c, &f->fix, "give density_g_cm3 in g/cm3: water has 1, quartz 2.65, diamond 3.52");
}

static void check_three_indices(abbe_check *c) {
  const abbe_material *m = c->material;
  const double at_nm[3] = {c->low_nm, 0.5 * (c->low_nm + c->high_nm), c->high_nm};
  for (int i = 0; i < 3; i++) {
    const double alpha = abbe_dispersion_n(&m->outer[0], at_nm[i]),
                 beta = abbe_dispersion_n(&m->dispersion, at_nm[i]),
                 gamma = abbe_dispersion_n(&m->outer[1], at_nm[i]);
    if (alpha > 0 && alpha <= beta && beta <= gamma && gamma <= 10) continue;
    abbe_finding *f = abbe_check_find(c, ABBE_FINDING_BIREFRINGENCE, ABBE_FINDING_WRONG);
    if (f == NULL) return;
    abbe_check_say(
        c, &f->evidence,
        "at %g nm its indices alpha, beta and gamma are %.6g, %.6g and %.6g; they are to "
        "ascend from above 0 to at most 10",
        at_nm[i], alpha, beta, gamma);
    abbe_check_say(c, &f->fix, "compare 'biaxial' with the source; the record's own index is beta");
    return;
  }
}

/* Calomel, the most birefringent of minerals, has 0.68. */
static void check_birefringence(abbe_check *c) {
  const abbe_material *m = c->material;
  const double middle_nm = 0.5 * (c->low_nm + c->high_nm);
  if (abbe_material_is_biaxial(m)) check_three_indices(c);
  if (!abbe_material_is_uniaxial(m)) return;
  const double n_o = abbe_dispersion_n(&m->dispersion, middle_nm);
  const double n_e = abbe_dispersion_n(&m->extraordinary, middle_nm);
  if (isnan(n_o) || (n_e >= 1 && fabs(n_e - n_o) <= 0.7)) return;
  abbe_finding *f = abbe_check_find(c, ABBE_FINDING_BIREFRINGENCE, ABBE_FINDING_DOUBTFUL);
  if (f == NULL) return;
  if (isnan(n_e))
    abbe_check_say(c, &f->evidence, "its extraordinary formula has no real index at %g nm",
                   middle_nm);
  else
    abbe_check_say(c, &f->evidence,
                   "at %g nm its ordinary index is %.5g and its extraordinary one %.5g; no known "
                   "crystal has them 0.7 apart, or one below 1",
                   middle_nm, n_o, n_e);
  abbe_check_say(c, &f->fix,
                 "compare 'extraordinary' with the source: the model, and coefficients "
                 "for wavelengths in micrometres");
}

static void check_fit(abbe_check *c, const abbe_material_fit *fit) {
  const abbe_material *m = c->material;
  abbe_index_difference off;
  if (fit->terms == 0 || abbe_material_fit_residual(m, fit, &off, NULL) != ABBE_OK) return;
  if (off.max <= 1.02 * fit->max_error + 1e-8) return;
  abbe_finding *f = abbe_check_find(c, ABBE_FINDING_FIT, ABBE_FINDING_WRONG);
  if (f == NULL) return;
  abbe_check_say(c, &f->evidence,
                 "its fit of %zu Cauchy terms says that it errs by %.3g at most; it errs by %.3g "
                 "at %g nm",
                 fit->terms, fit->max_error, off.max, off.max_nm);
  abbe_dispersion right;
  double error = 0;
  abbe_check_say(c, &f->fix, "make the fit anew from the record's own %s formula",
                 abbe_dispersion_model_name(m->dispersion.model));
  if (abbe_fit_dispersion(&m->dispersion, fit->terms, fit->min_nm, fit->max_nm, &right, &error,
                          NULL) != ABBE_OK)
    return;
  char list[8 * (ABBE_NUMBER_TEXT_SIZE + 2)] = "", text[3][ABBE_NUMBER_TEXT_SIZE];
  size_t used = 0;
  for (size_t k = 0; k < right.count; k++)
    used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", k ? ", " : "",
                             digits(right.c[k], 9, text[0]));
  abbe_check_say(c, &f->value, "{coefficients: [%s], max_error: %s, range_nm: [%s, %s]}", list,
                 digits(error, 3, text[0]), abbe_number_text(fit->min_nm, text[1]),
                 abbe_number_text(fit->max_nm, text[2]));
  f->key = fit->terms == 2 ? "fit.cauchy2" : "fit.cauchy3";
  f->certain = true;
}

/* ---- all of them ---- */

static abbe_result check(const abbe_material *material, size_t row,
                         const abbe_material_table *known, abbe_findings *findings,
                         abbe_error *error) {
  abbe_check c = {.material = material,
                  .known = known,
                  .low_nm = material->min_nm,
                  .high_nm = material->max_nm,
                  .row = row,
                  .findings = findings,
                  .error = error};
  if (material->dispersion.model == ABBE_DISPERSION_CONSTANT || !(material->min_nm > 0)) {
    c.low_nm = ABBE_WAVELENGTH_MIN_NM;
    c.high_nm = ABBE_WAVELENGTH_MAX_NM;
  }
  c.namesake = abbe_check_namesake(known, material->name);
  abbe_material_published_make(material, &c.published);
  const bool metal = abbe_material_is_conductor(material);
  bool unit = material->max_nm < 100 && material->min_nm > 0;
  if (unit) c.low_nm *= 1000, c.high_nm *= 1000;
  if (metal) {
    if (!unit) abbe_check_cover(&c);
  } else if (!abbe_check_read_anew(&c) && !unit) {
    abbe_check_follow_curve(&c);
    for (int i = 0; i < 2; i++) check_fit(&c, &material->fit[i]);
  }
  check_range(&c);
  check_density(&c);
  check_birefringence(&c);
  check_source(&c);
  return c.result;
}

abbe_result abbe_check_material(const abbe_material *material, const abbe_material_table *known,
                                abbe_findings *findings, abbe_error *error) {
  assert(material->name);
  return check(material, 0, known, findings, error);
}

static int by_row_and_kind(const void *a, const void *b) {
  const abbe_finding *x = a, *y = b;
  if (x->row != y->row) return x->row < y->row ? -1 : 1;
  if (x->kind != y->kind) return x->kind < y->kind ? -1 : 1;
  return (x->other > y->other) - (x->other < y->other);
}

abbe_result abbe_check_table(const abbe_material_table *table, const abbe_material_table *known,
                             abbe_findings *findings, abbe_error *error) {
  size_t before = findings->count;
  for (size_t i = 0; i < table->count; i++)
    ABBE_TRY(check(&table->material[i], i, known, findings, error));
  ABBE_TRY(abbe_check_compare_rows(table, findings, error));
  if (findings->count > before)
    qsort(findings->finding + before, findings->count - before, sizeof *findings->finding,
          by_row_and_kind);
  return ABBE_OK;
}
