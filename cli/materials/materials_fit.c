#include "cli/materials/materials.h"

#include "base/number.h"
#include "spectral/dispersion/fit.h"
#include "spectral/dispersion/index_points.h"
#include "spectral/formats/material_import.h"
#include "spectral/formats/material_write.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct request {
  const char *program, *name, *table, *points, *formula, *record, *plot;
  abbe_fit_request fit;
  double over_from_nm, over_to_nm; /* 0: not asked */
  bool ranged, json, residuals;
} request;

/* What is fitted, and what is printed of it. */
typedef struct subject {
  abbe_index_points points;
  char text[300];
  char beyond[120]; /* where the entry has no data of its own; or "" */
} subject;

/* ---- what is fitted ---- */

/* "sellmeier2 0 1.04 0.006": a model and its coefficients. */
static abbe_result read_formula(const char *text, abbe_dispersion *out, abbe_error *error) {
  size_t length = strcspn(text, " ,");
  *out = (abbe_dispersion){.model = ABBE_DISPERSION_MODEL_COUNT};
  for (int i = 0; i < ABBE_DISPERSION_TABULATED; i++) {
    const char *name = abbe_dispersion_model_name((abbe_dispersion_model)i);
    if (strlen(name) == length && strncmp(name, text, length) == 0)
      out->model = (abbe_dispersion_model)i;
  }
  if (out->model == ABBE_DISPERSION_MODEL_COUNT)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "--formula '%.*s' is not a model; it is a model and its coefficients, "
                          "such as 'cauchy 1.5046 0.0042'",
                          (int)length, text);
  for (const char *at = text + length;;) {
    at += strspn(at, " ,");
    if (*at == '\0') return abbe_dispersion_check(out, error);
    const char *end;
    double value;
    bool number = abbe_number_read(at, &end, &value) && isfinite(value) &&
                  (*end == '\0' || strchr(" ,", *end) != NULL);
    if (!number || out->count == ABBE_DISPERSION_MAX_COEFFICIENTS)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            number ? "--formula has more than 32 coefficients at '%.40s'"
                                   : "--formula: '%.40s' does not begin with a number",
                            at);
    out->c[out->count++] = value;
    at = end;
  }
}

static abbe_result sample(request *r, const abbe_dispersion *d, subject *s, abbe_error *error) {
  if (!r->ranged) {
    r->fit.min_nm = ABBE_WAVELENGTH_MIN_NM;
    r->fit.max_nm = ABBE_WAVELENGTH_MAX_NM;
  }
  return abbe_index_points_sample(d, r->fit.min_nm, r->fit.max_nm, 8 * r->fit.terms + 32, 4001,
                                  &s->points, error);
}

static abbe_result take_entry(request *r, const abbe_material *m, subject *s, abbe_error *error) {
  double n, low = r->ranged ? r->fit.min_nm : ABBE_WAVELENGTH_MIN_NM;
  double high = r->ranged ? r->fit.max_nm : ABBE_WAVELENGTH_MAX_NM;
  abbe_result result = abbe_material_n(m, low, &n, error);
  if (result == ABBE_OK) result = abbe_material_n(m, high, &n, error);
  if (result == ABBE_OK) result = sample(r, &m->dispersion, s, error);
  snprintf(s->text, sizeof s->text, "%s", m->name);
  if (abbe_material_extrapolates(m, low) || abbe_material_extrapolates(m, high))
    snprintf(s->beyond, sizeof s->beyond, "its data reach from %g to %g nm; the rest is continued",
             m->min_nm, m->max_nm);
  return result;
}

static abbe_result take(request *r, const abbe_material_table *table, abbe_dispersion *source,
                        subject *s, abbe_error *error) {
  const abbe_material *m = NULL;
  abbe_result result;
  if (r->points != NULL) {
    snprintf(s->text, sizeof s->text, "%s", r->points);
    return abbe_index_points_load(r->points, &s->points, error);
  }
  if (r->formula != NULL) {
    snprintf(s->text, sizeof s->text, "%s", r->formula);
    result = read_formula(r->formula, source, error);
    return result == ABBE_OK ? sample(r, source, s, error) : result;
  }
  ABBE_TRY(abbe_material_table_find(table, r->name, &m, error));
  *source = m->dispersion; /* borrowed */
  return take_entry(r, m, s, error);
}

/* ---- text ---- */

static void print_coefficients(const abbe_fit *f) {
  const char *scale = f->weighted ? "from the uncertainties" : "from the residuals";
  printf("  %s   (L in um)\n", abbe_dispersion_model_formula(f->dispersion.model));
  size_t first = f->dispersion.count - f->free;
  for (size_t i = first; i < f->dispersion.count; i++) {
    double error = abbe_fit_standard_error(f, i);
    printf("    c%-2zu %16.10g", i, f->dispersion.c[i]);
    if (isnan(error))
      printf("   no point is left over to tell its error\n");
    else
      printf("   +- %.2g%s%s\n", error, i == first ? "   " : "", i == first ? scale : "");
  }
  if (first == 1) printf("    c0 is held at 0\n");
}

static void print_covariance(const abbe_fit *f) {
  size_t first = f->dispersion.count - f->free;
  if (f->free > 8 || isnan(f->covariance[first][first])) return;
  printf("  covariance\n");
  for (size_t i = first; i < f->dispersion.count; i++) {
    printf("    c%-2zu", i);
    for (size_t j = first; j <= i; j++) printf(" %11.3g", f->covariance[i][j]);
    printf("\n");
  }
}

static void print_residuals(const subject *s, const abbe_fit *f) {
  printf("\n  %10s  %12s  %12s  %10s%s\n", "nm", "n", "fit", "n - fit",
         f->weighted ? "  in uncertainties" : "");
  for (size_t i = 0; i < s->points.count; i++) {
    double lambda_nm = s->points.lambda_nm[i], n = s->points.n[i];
    if (lambda_nm < f->min_nm || lambda_nm > f->max_nm) continue;
    double fitted = abbe_dispersion_n(&f->dispersion, lambda_nm);
    printf("  %10.6g  %12.8f  %12.8f  %+10.2e", lambda_nm, n, fitted, n - fitted);
    if (f->weighted) printf("  %+16.2f", (n - fitted) / s->points.uncertainty[i]);
    printf("\n");
  }
}

/* What is measured at points says nothing beyond them. */
static void print_reach(const request *r, const subject *s) {
  size_t used = 0;
  double low = r->over_to_nm, high = r->over_from_nm;
  for (size_t i = 0; i < s->points.count; i++) {
    double lambda_nm = s->points.lambda_nm[i];
    if (lambda_nm < r->over_from_nm || lambda_nm > r->over_to_nm) continue;
    low = fmin(low, lambda_nm);
    high = fmax(high, lambda_nm);
    used++;
  }
  if (s->points.exact)
    printf("\n");
  else
    printf("   (at the %zu points there, %g to %g nm)\n", used, low, high);
}

static void print_text(const request *r, const subject *s, const abbe_fit *f,
                       const abbe_index_difference *over) {
  abbe_dispersion_numbers d = abbe_dispersion_describe(&f->dispersion);
  printf("%s, %zu term%s, fitted to %s: %zu points from %g to %g nm\n",
         abbe_fit_form_name(r->fit.form), r->fit.terms, r->fit.terms == 1 ? "" : "s", s->text,
         f->points, f->min_nm, f->max_nm);
  if (s->beyond[0] != '\0') printf("  %s\n", s->beyond);
  print_coefficients(f);
  printf("  rms error      %.3g\n  largest error  %.3g at %g nm\n", f->rms, f->max_error,
         f->max_nm_of_error);
  if (over != NULL)
    printf("  over %g:%g nm  rms %.3g, largest %.3g at %g nm", r->over_from_nm, r->over_to_nm,
           over->rms, over->max, over->max_nm);
  if (over != NULL) print_reach(r, s);
  if (f->weighted && !isnan(f->reduced_chi_squared))
    printf("  reduced chi^2  %.3g%s\n", f->reduced_chi_squared,
           f->reduced_chi_squared > 3 ? "   (the form or the uncertainties are too small)" : "");
  printf("  n_d %.6f   V_d %.3f%s\n", d.n_d, d.v_d,
         f->min_nm > ABBE_LINE_F_NM || f->max_nm < ABBE_LINE_C_NM ? "   (outside the points)" : "");
  print_covariance(f);
  if (r->residuals) print_residuals(s, f);
}

/* ---- as a record, and as JSON ---- */

static abbe_result print_record(const request *r, const subject *s, const abbe_fit *f,
                                abbe_error *error) {
  char name[ABBE_MATERIAL_MAX_NAME + 1], source[400], warning[420];
  ABBE_TRY(abbe_material_check_name(r->record, error));
  snprintf(name, sizeof name, "%s", r->record);
  snprintf(source, sizeof source, "%s form of %zu terms, fitted to %s",
           abbe_fit_form_name(r->fit.form), r->fit.terms, s->text);
  snprintf(warning, sizeof warning,
           "A fit: rms error %.2g, largest %.2g at %g nm, over %zu points from %g to %g nm%s%s.",
           f->rms, f->max_error, f->max_nm_of_error, f->points, f->min_nm, f->max_nm,
           s->beyond[0] != '\0' ? "; " : "", s->beyond);
  abbe_material m = {.name = name,
                     .source = source,
                     .warning = warning,
                     .dispersion = f->dispersion,
                     .min_nm = f->min_nm,
                     .max_nm = f->max_nm,
                     .temperature_c = NAN};
  abbe_materials_round(&m.dispersion);
  return abbe_material_write(&m, stdout, error);
}

static void add_arrays(cJSON *root, const subject *s, const abbe_fit *f) {
  size_t first = f->dispersion.count - f->free;
  cJSON *errors = cJSON_AddArrayToObject(root, "standard_errors");
  for (size_t i = 0; i < f->dispersion.count; i++)
    cJSON_AddItemToArray(errors, cJSON_CreateNumber(abbe_fit_standard_error(f, i)));
  cJSON *rows = cJSON_AddArrayToObject(root, "covariance");
  for (size_t i = 0; i < f->dispersion.count; i++)
    cJSON_AddItemToArray(rows, cJSON_CreateDoubleArray(f->covariance[i], (int)f->dispersion.count));
  cJSON_AddNumberToObject(root, "first_free", (double)first);
  cJSON *list = cJSON_AddArrayToObject(root, "residuals");
  for (size_t i = 0; i < s->points.count; i++) {
    double lambda_nm = s->points.lambda_nm[i];
    if (lambda_nm < f->min_nm || lambda_nm > f->max_nm) continue;
    double row[] = {lambda_nm, s->points.n[i],
                    s->points.n[i] - abbe_dispersion_n(&f->dispersion, lambda_nm)};
    cJSON_AddItemToArray(list, cJSON_CreateDoubleArray(row, 3));
  }
}

static abbe_result print_json(const request *r, const subject *s, const abbe_fit *f,
                              const abbe_index_difference *over, abbe_error *error) {
  cJSON *root = abbe_materials_json();
  abbe_dispersion_numbers d = abbe_dispersion_describe(&f->dispersion);
  cJSON_AddStringToObject(root, "of", s->text);
  abbe_materials_add_text(root, "beyond", s->beyond[0] != '\0' ? s->beyond : NULL);
  cJSON_AddStringToObject(root, "model", abbe_dispersion_model_name(f->dispersion.model));
  cJSON_AddItemToObject(root, "coefficients",
                        cJSON_CreateDoubleArray(f->dispersion.c, (int)f->dispersion.count));
  abbe_materials_add_pair(root, "range_nm", f->min_nm, f->max_nm);
  cJSON_AddNumberToObject(root, "points", (double)f->points);
  cJSON_AddNumberToObject(root, "rms", f->rms);
  cJSON_AddNumberToObject(root, "max_error", f->max_error);
  cJSON_AddNumberToObject(root, "max_error_nm", f->max_nm_of_error);
  cJSON_AddBoolToObject(root, "weighted", f->weighted);
  cJSON_AddNumberToObject(root, "reduced_chi_squared", f->reduced_chi_squared);
  cJSON_AddNumberToObject(root, "n_d", d.n_d);
  cJSON_AddNumberToObject(root, "v_d", d.v_d);
  if (over != NULL) {
    cJSON *item = cJSON_AddObjectToObject(root, "over");
    abbe_materials_add_pair(item, "range_nm", r->over_from_nm, r->over_to_nm);
    cJSON_AddNumberToObject(item, "rms", over->rms);
    cJSON_AddNumberToObject(item, "max_error", over->max);
    cJSON_AddNumberToObject(item, "max_error_nm", over->max_nm);
  }
  add_arrays(root, s, f);
  return abbe_materials_print_json(root, error);
}

/* ---- the answer ---- */

static abbe_result measure_over(const request *r, const subject *s, const abbe_dispersion *source,
                                const abbe_fit *f, abbe_index_difference *out, abbe_error *error) {
  if (s->points.exact)
    return abbe_index_difference_of_curves(&f->dispersion, source, r->over_from_nm, r->over_to_nm,
                                           out, error);
  return abbe_index_difference_of_points(&f->dispersion, &s->points, r->over_from_nm, r->over_to_nm,
                                         out, error);
}

static abbe_result answer(request *r, const abbe_material_table *table, abbe_error *error) {
  subject s = {0};
  abbe_dispersion source = {0};
  abbe_index_difference over;
  abbe_fit f;
  abbe_result result = take(r, table, &source, &s, error);
  if (result == ABBE_OK) result = abbe_fit_make(&s.points, &r->fit, &f, error);
  if (result == ABBE_OK && r->over_to_nm > 0)
    result = measure_over(r, &s, &source, &f, &over, error);
  const abbe_index_difference *asked = r->over_to_nm > 0 ? &over : NULL;
  if (result == ABBE_OK && r->plot != NULL)
    result = abbe_materials_fit_plot(r->plot, s.text, &s.points, &f, error);
  if (result == ABBE_OK && r->json)
    result = print_json(r, &s, &f, asked, error);
  else if (result == ABBE_OK && r->record != NULL)
    result = print_record(r, &s, &f, error);
  else if (result == ABBE_OK)
    print_text(r, &s, &f, asked);
  abbe_index_points_free(&s.points);
  return result;
}

/* ---- arguments ---- */

enum { KEY_FORM = ABBE_MATERIALS_KEY_OWN, KEY_RANGE };

static const abbe_option options[] = {
    {"points", 0, "FILE", ABBE_ARGUMENT_READS,
     "fit measured points: columns of wavelength, n and, if known, its uncertainty", 0,
     ABBE_TAKE_TEXT(request, points)},
    {"formula", 0, "TEXT", ABBE_ARGUMENT_ONCE, "fit a formula: a model and its coefficients", 0,
     ABBE_TAKE_TEXT(request, formula)},
    ABBE_MATERIALS_TABLE_OPTION(request, table),
    {"form", KEY_FORM, "FORM", 0, "cauchy or sellmeier; without it, cauchy", 1, ABBE_TAKE_BY_KEY},
    {"terms", 0, "N", 0, "how many; without it, 2", 1, ABBE_TAKE_COUNT(request, fit.terms, 1, 32)},
    {"range", KEY_RANGE, "A:B", 0,
     "fit from A to B nm; without it, 380:780, and all points of a file", 1, ABBE_TAKE_BY_KEY},
    {"over", 0, "A:B", 0, "also state the errors from A to B nm", 1,
     ABBE_TAKE_RANGE(request, over_from_nm, over_to_nm)},
    {"residuals", 0, NULL, 0, "also the residual of every point", 2,
     ABBE_TAKE_FLAG(request, residuals)},
    {"plot", 0, "FILE", ABBE_ARGUMENT_WRITES, "draw the fit and its residuals: .png or .svg", 2,
     ABBE_TAKE_TEXT(request, plot)},
    {"record", 0, "NAME", 0, "the fit as a record of this name, for a table", 2,
     ABBE_TAKE_TEXT(request, record)},
    ABBE_MATERIALS_JSON_OPTION(request, json),
    ABBE_ARGUMENT(request, name),
    {0}};

static error_t parse(int key, char *arg, struct argp_state *state) {
  static const char *const forms[] = {"cauchy", "sellmeier"};
  request *r = state->input;
  switch (key) {
  case KEY_FORM:
    r->fit.form = (abbe_fit_form)abbe_command_choice(r->program, "--form", arg, forms, 2);
    return 0;
  case KEY_RANGE:
    abbe_command_range(r->program, "--range", arg, &r->fit.min_nm, &r->fit.max_nm);
    r->ranged = true;
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const abbe_parser parser = {
    .options = options,
    .parse = parse,
    .args_doc = "[NAME]",
    .doc = "Fits a Cauchy or Sellmeier form to a material, a formula or measured points.\v"
           "Examples:\n"
           "  abbe materials fit n-bk7 --terms 3\n"
           "  abbe materials fit n-sf11 --form sellmeier --range 400:700 --over 380:780\n"
           "  abbe materials fit --points measured.csv --residuals --plot fit.png\n"
           "  abbe materials fit --points measured.csv --record my-glass |\n"
           "    abbe materials add --record - --table glasses.yaml\n"
           "  abbe materials fit --formula 'cauchy 1.5 0.004' --form sellmeier --terms 1\n\n"
           "Weighted least squares where the points have uncertainties. What the points cannot "
           "support is refused: more coefficients than wavelengths, a range too narrow, a highest "
           "term that they do not tell from zero.",
};

static void check(const request *r) {
  int given = (r->name != NULL) + (r->points != NULL) + (r->formula != NULL);
  if (given == 0)
    abbe_materials_wrong_use(r->program,
                             "fit what? Name a material, or give --points or --formula");
  if (given > 1)
    abbe_materials_wrong_use(r->program, "a name, --points and --formula exclude each other");
  if (r->table != NULL && r->name == NULL)
    abbe_materials_wrong_use(r->program, "--table goes with the name of a material");
  if (r->record != NULL && (r->json || r->residuals || r->over_to_nm > 0))
    abbe_materials_wrong_use(r->program,
                             "--record prints the record alone: without --json, --residuals and "
                             "--over");
}

int abbe_materials_fit(int argc, char **argv) {
  request r = {.program = argv[0], .fit = {.terms = 2}};
  abbe_error error = {0};
  abbe_materials_parse(&parser, argc, argv, &r);
  check(&r);
  abbe_material_table table = {0};
  abbe_result result = ABBE_OK;
  if (r.name != NULL) result = abbe_material_table_load_named(r.table, &r.name, 1, &table, &error);
  if (result == ABBE_OK) result = answer(&r, &table, &error);
  abbe_material_table_free(&table);
  return abbe_command_end(r.program, result, &error);
}
