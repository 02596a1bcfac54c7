#include "cli/command.h"

#include "spectral/material_table.h"
#include "spectral/wavelengths.h"

#include <argp.h>
#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_AT = 4096 };

typedef struct request {
  const char *program;
  const char *action, *name, *table;
  double at[MAX_AT];
  size_t at_count;
  bool json, fit;
} request;

/* ---- what is known about a material ---- */

/* A number is told only where the record vouches for it. */
static double told(const abbe_material *m, double value, double from_nm, double to_nm) {
  bool outside = abbe_material_extrapolates(m, from_nm) || abbe_material_extrapolates(m, to_nm);
  return outside && !m->extrapolate ? NAN : value;
}

static abbe_dispersion_numbers numbers_of(const abbe_material *m) {
  abbe_dispersion_numbers d = abbe_dispersion_describe(&m->dispersion);
  return (abbe_dispersion_numbers){
      .n_d = told(m, d.n_d, ABBE_LINE_D_NM, ABBE_LINE_D_NM),
      .n_F = told(m, d.n_F, ABBE_LINE_F_NM, ABBE_LINE_F_NM),
      .n_C = told(m, d.n_C, ABBE_LINE_C_NM, ABBE_LINE_C_NM),
      .v_d = told(m, d.v_d, ABBE_LINE_F_NM, ABBE_LINE_C_NM),
      .b_g = told(m, d.b_g, ABBE_LINE_G_NM, ABBE_LINE_B_NM),
  };
}

static const char *number_text(char *text, size_t size, const char *format, double value) {
  if (isnan(value)) return "-";
  if (isinf(value)) return "infinite";
  snprintf(text, size, format, value);
  return text;
}

/* ---- text ---- */

static void list_text(const abbe_material_table *table) {
  int width = 4;
  for (size_t i = 0; i < table->count; i++) {
    int length = (int)strlen(table->material[i].name);
    if (length > width) width = length;
  }
  if (table->description != NULL) printf("%s: %s\n\n", table->path, table->description);
  printf("%-*s  %8s  %8s  %8s  %12s  %s\n", width, "name", "n_d", "V_d", "B-G", "range nm",
         "description");
  for (size_t i = 0; i < table->count; i++) {
    const abbe_material *m = &table->material[i];
    abbe_dispersion_numbers d = numbers_of(m);
    char n_d[32], v_d[32], b_g[32], range[64];
    snprintf(range, sizeof range, "%g:%g", m->min_nm, m->max_nm);
    printf("%-*s  %8s  %8s  %8s  %12s  %s\n", width, m->name,
           number_text(n_d, sizeof n_d, "%.6f", d.n_d), number_text(v_d, sizeof v_d, "%.2f", d.v_d),
           number_text(b_g, sizeof b_g, "%.5f", d.b_g), range,
           m->description ? m->description : "");
  }
}

static void show_formula(const abbe_material *m) {
  printf("  model         %s: %s\n", abbe_dispersion_model_name(m->dispersion.model),
         abbe_dispersion_model_formula(m->dispersion.model));
  if (m->dispersion.table != NULL)
    printf("  points        %zu\n", abbe_spectrum_count(m->dispersion.table));
  for (size_t i = 0; i < m->dispersion.count; i++)
    printf("%s%.10g%s", i == 0 ? "  coefficients  " : "", m->dispersion.c[i],
           i + 1 < m->dispersion.count ? ", " : "   (L in um)\n");
  printf("  range         %g to %g nm%s\n", m->min_nm, m->max_nm,
         m->extrapolate ? ", extrapolated outside" : "");
  if (!isnan(m->temperature_c)) printf("  temperature   %g C\n", m->temperature_c);
}

static void show_absorption(const abbe_material *m) {
  if (m->attenuation == NULL) {
    printf("  absorption    none recorded\n");
    return;
  }
  printf("  absorption    1/m, at nm:");
  const double *l = abbe_spectrum_lambda_nm(m->attenuation);
  const double *a = abbe_spectrum_value(m->attenuation);
  size_t count = abbe_spectrum_count(m->attenuation);
  for (size_t i = 0; i < count && i < 8; i++)
    printf(" %.4g at %g%s", a[i], l[i], i + 1 < count ? "," : "");
  printf(count > 8 ? " … (%zu points)\n" : "\n", count);
}

static void show_fits(const abbe_material *m) {
  for (int i = 0; i < 2; i++) {
    const abbe_material_fit *fit = &m->fit[i];
    if (fit->terms == 0) continue;
    printf("  Cauchy, %zu     ", fit->terms);
    for (size_t k = 0; k < fit->terms; k++)
      printf("%.9g%s", fit->c[k], k + 1 < fit->terms ? ", " : "");
    printf("   (largest error %.3g, %g to %g nm)\n", fit->max_error, fit->min_nm, fit->max_nm);
  }
}

static abbe_result show_text(const request *r, const abbe_material *m, abbe_error *error) {
  char text[4][32];
  abbe_dispersion_numbers d = numbers_of(m);
  printf("%s%s%s\n", m->name, m->description ? ": " : "", m->description ? m->description : "");
  printf("  n_d %s   V_d %s   B-G %s   n_F - n_C %s\n",
         number_text(text[0], sizeof text[0], "%.6f", d.n_d),
         number_text(text[1], sizeof text[1], "%.3f", d.v_d),
         number_text(text[2], sizeof text[2], "%.6f", d.b_g),
         number_text(text[3], sizeof text[3], "%.6f", d.n_F - d.n_C));
  show_formula(m);
  show_absorption(m);
  show_fits(m);
  printf("  source        %s\n", m->source);
  if (m->warning != NULL) printf("  warning       %s\n", m->warning);
  if (r->at_count > 0) printf("\n  %10s  %12s\n", "nm", "n");
  for (size_t i = 0; i < r->at_count; i++) {
    double n = 0;
    abbe_result result = abbe_material_n(m, r->at[i], &n, error);
    if (result != ABBE_OK) return result;
    printf("  %10.6g  %12.9f%s\n", r->at[i], n,
           abbe_material_extrapolates(m, r->at[i]) ? "  extrapolated" : "");
  }
  return ABBE_OK;
}

/* The `fit` key of a record, made anew from its model, as it is pasted into a table. */
static abbe_result show_fit_yaml(const abbe_material *m, abbe_error *error) {
  const double low = ABBE_WAVELENGTH_MIN_NM, high = ABBE_WAVELENGTH_MAX_NM;
  double n = 0;
  abbe_result result = abbe_material_n(m, low, &n, error);
  if (result == ABBE_OK) result = abbe_material_n(m, high, &n, error);
  if (result != ABBE_OK) return result;
  abbe_dispersion fit[2];
  double max_error[2];
  for (int i = 0; i < 2; i++) {
    result = abbe_dispersion_fit_cauchy(&m->dispersion, (size_t)i + 2, low, high, &fit[i],
                                        &max_error[i], error);
    if (result != ABBE_OK) return result;
  }
  printf("fit:\n");
  for (int i = 0; i < 2; i++) {
    printf("  cauchy%d: {coefficients: [", i + 2);
    for (size_t k = 0; k < fit[i].count; k++) printf("%s%.9g", k ? ", " : "", fit[i].c[k]);
    printf("], max_error: %.3g, range_nm: [%g, %g]}\n", max_error[i], low, high);
  }
  return ABBE_OK;
}

/* ---- JSON ---- */

/* cJSON drops what it has no memory for, one value at a time; half an answer is none. */
static bool json_lost;

static void *json_allocate(size_t size) {
  void *memory = malloc(size);
  if (memory == NULL) json_lost = true;
  return memory;
}

static cJSON *json_root(void) {
  cJSON_InitHooks(&(cJSON_Hooks){.malloc_fn = json_allocate, .free_fn = free});
  json_lost = false;
  return cJSON_CreateObject();
}

/* Adds text, or null where there is none. */
static void add_text(cJSON *to, const char *key, const char *text) {
  if (text != NULL)
    cJSON_AddStringToObject(to, key, text);
  else
    cJSON_AddNullToObject(to, key);
}

/* cJSON writes NaN and infinity as null, and every other double so that it reads back the same. */
static void add_numbers(cJSON *to, const abbe_material *m) {
  abbe_dispersion_numbers d = numbers_of(m);
  cJSON_AddNumberToObject(to, "n_d", d.n_d);
  cJSON_AddNumberToObject(to, "v_d", d.v_d);
  cJSON_AddNumberToObject(to, "n_F", d.n_F);
  cJSON_AddNumberToObject(to, "n_C", d.n_C);
  cJSON_AddNumberToObject(to, "b_g", d.b_g);
}

static void add_pair(cJSON *to, const char *key, double a, double b) {
  cJSON_AddItemToObject(to, key, cJSON_CreateDoubleArray((double[]){a, b}, 2));
}

static void add_points(cJSON *to, const char *key, const abbe_spectrum *spectrum) {
  cJSON *list = cJSON_AddArrayToObject(to, key);
  for (size_t i = 0; list != NULL && i < abbe_spectrum_count(spectrum); i++) {
    double pair[2] = {abbe_spectrum_lambda_nm(spectrum)[i], abbe_spectrum_value(spectrum)[i]};
    cJSON_AddItemToArray(list, cJSON_CreateDoubleArray(pair, 2));
  }
}

static void add_record(cJSON *to, const abbe_material *m) {
  const abbe_dispersion *d = &m->dispersion;
  cJSON_AddStringToObject(to, "model", abbe_dispersion_model_name(d->model));
  cJSON_AddStringToObject(to, "formula", abbe_dispersion_model_formula(d->model));
  if (d->table != NULL)
    add_points(to, "points", d->table);
  else
    cJSON_AddItemToObject(to, "coefficients", cJSON_CreateDoubleArray(d->c, (int)d->count));
  add_pair(to, "range_nm", m->min_nm, m->max_nm);
  cJSON_AddBoolToObject(to, "extrapolate", m->extrapolate);
  cJSON_AddNumberToObject(to, "temperature_c", m->temperature_c);
  if (m->attenuation != NULL)
    add_points(to, "attenuation_per_m", m->attenuation);
  else
    cJSON_AddNullToObject(to, "attenuation_per_m");
  add_text(to, "source", m->source);
  add_text(to, "warning", m->warning);
  cJSON *fits = cJSON_AddArrayToObject(to, "fits");
  for (int i = 0; i < 2; i++) {
    const abbe_material_fit *fit = &m->fit[i];
    cJSON *item = fit->terms > 0 ? cJSON_CreateObject() : NULL;
    if (item == NULL || !cJSON_AddItemToArray(fits, item)) continue;
    cJSON_AddNumberToObject(item, "terms", (double)fit->terms);
    cJSON_AddItemToObject(item, "coefficients", cJSON_CreateDoubleArray(fit->c, (int)fit->terms));
    cJSON_AddNumberToObject(item, "max_error", fit->max_error);
    add_pair(item, "range_nm", fit->min_nm, fit->max_nm);
  }
}

static abbe_result list_json(const abbe_material_table *table, abbe_error *error) {
  cJSON *root = json_root();
  cJSON_AddStringToObject(root, "table", table->path);
  add_text(root, "description", table->description);
  cJSON *list = cJSON_AddArrayToObject(root, "materials");
  for (size_t i = 0; i < table->count; i++) {
    const abbe_material *m = &table->material[i];
    cJSON *item = cJSON_CreateObject();
    if (item == NULL || !cJSON_AddItemToArray(list, item)) continue;
    cJSON_AddStringToObject(item, "name", m->name);
    add_text(item, "description", m->description);
    add_numbers(item, m);
    add_pair(item, "range_nm", m->min_nm, m->max_nm);
    cJSON_AddBoolToObject(item, "extrapolate", m->extrapolate);
    add_text(item, "source", m->source);
    add_text(item, "warning", m->warning);
  }
  abbe_result result = abbe_command_print_json(json_lost ? NULL : root, error);
  cJSON_Delete(root);
  return result;
}

static abbe_result show_json(const request *r, const abbe_material_table *table,
                             const abbe_material *m, abbe_error *error) {
  cJSON *root = json_root();
  cJSON_AddStringToObject(root, "name", m->name);
  add_text(root, "description", m->description);
  cJSON_AddStringToObject(root, "table", table->path);
  cJSON *list = cJSON_AddArrayToObject(root, "n");
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < r->at_count && result == ABBE_OK; i++) {
    double n = 0;
    result = abbe_material_n(m, r->at[i], &n, error);
    cJSON *item = cJSON_CreateObject();
    cJSON_AddNumberToObject(item, "lambda_nm", r->at[i]);
    cJSON_AddNumberToObject(item, "n", n);
    cJSON_AddBoolToObject(item, "extrapolated", abbe_material_extrapolates(m, r->at[i]));
    cJSON_AddItemToArray(list, item);
  }
  add_numbers(root, m);
  add_record(root, m);
  if (result == ABBE_OK) result = abbe_command_print_json(json_lost ? NULL : root, error);
  cJSON_Delete(root);
  return result;
}

/* ---- arguments ---- */

enum { KEY_AT = 256, KEY_TABLE, KEY_JSON, KEY_FIT };

static const struct argp_option options[] = {
    {"at", KEY_AT, "NM", 0, "also the index at this wavelength; may be repeated (show)", 0},
    {"table", KEY_TABLE, "FILE", 0, "a table file, or default or thesis; without it, default", 0},
    {"json", KEY_JSON, NULL, 0, "as JSON, numbers in full", 0},
    {"fit", KEY_FIT, NULL, 0,
     "the two Cauchy fits over 380:780 nm made anew, as YAML for the record (show)", 0},
    {0}};

static error_t parse(int key, char *arg, struct argp_state *state) {
  request *r = state->input;
  switch (key) {
  case KEY_AT:
    if (r->at_count == MAX_AT) argp_error(state, "more than %d --at", MAX_AT);
    r->at[r->at_count++] = abbe_command_number(r->program, "--at", arg, 1, 1e6);
    return 0;
  case KEY_TABLE:
    r->table = arg;
    return 0;
  case KEY_JSON:
    r->json = true;
    return 0;
  case KEY_FIT:
    r->fit = true;
    return 0;
  case ARGP_KEY_ARG:
    if (state->arg_num == 0)
      r->action = arg;
    else if (state->arg_num == 1)
      r->name = arg;
    else
      argp_error(state, "'%s' is one argument too many", arg);
    return 0;
  case ARGP_KEY_END:
    if (r->action == NULL) argp_error(state, "list or show?");
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const struct argp parser = {
    .options = options,
    .parser = parse,
    .args_doc = "list\nshow NAME",
    .doc = "Lists the materials of a table, or shows one.\v"
           "Examples:\n"
           "  abbe materials list\n"
           "  abbe materials list --table thesis\n"
           "  abbe materials show diamond --at 430.8 --at 686.7\n"
           "  abbe materials show n-bk7 --at 587.5618 --json\n"
           "  abbe materials show my-glass --table glasses.yaml --fit\n\n"
           "A wavelength outside a record's range is an error, unless the record says "
           "'extrapolate: true'; the answer then says so.",
};

/* What cannot go together is wrong use, said before anything is read. */
static bool is_list(const request *r) {
  static const char *const actions[] = {"list", "show"};
  bool list = abbe_command_choice(r->program, "action", r->action, actions, 2) == 0;
  const char *wrong = NULL;
  if (list && r->name != NULL) wrong = "list takes no name; did you mean show?";
  if (list && (r->at_count > 0 || r->fit)) wrong = "--at and --fit go with show";
  if (!list && r->name == NULL)
    wrong = "show what? Name a material; 'abbe materials list' has them";
  if (r->fit && (r->json || r->at_count > 0)) wrong = "--fit goes without --json and --at";
  if (wrong == NULL) return list;
  fprintf(stderr, "%s: %s\nTry '%s --help'.\n", r->program, wrong, r->program);
  exit(ABBE_EXIT_USAGE);
}

static abbe_result answer(const request *r, bool list, const abbe_material_table *table,
                          abbe_error *error) {
  if (list && r->json) return list_json(table, error);
  if (list) {
    list_text(table);
    return ABBE_OK;
  }
  const abbe_material *m = NULL;
  abbe_result result = abbe_material_table_find(table, r->name, &m, error);
  if (result != ABBE_OK) return result;
  /* asked first, so that a failure prints nothing else */
  for (size_t i = 0; i < r->at_count && result == ABBE_OK; i++) {
    double n;
    result = abbe_material_n(m, r->at[i], &n, error);
  }
  if (result != ABBE_OK) return result;
  if (r->fit) return show_fit_yaml(m, error);
  return r->json ? show_json(r, table, m, error) : show_text(r, m, error);
}

int abbe_command_materials(int argc, char **argv) {
  static request r;
  r = (request){.program = argv[0]};
  abbe_error error = {0};
  if (argp_parse(&parser, argc, argv, 0, NULL, &r) != 0) {
    abbe_error_set(&error, ABBE_NO_MEMORY, "no memory to read the arguments");
    return abbe_command_fail(r.program, &error);
  }
  bool list = is_list(&r);
  abbe_material_table table;
  abbe_result result = abbe_material_table_load(r.table, &table, &error);
  if (result == ABBE_OK) result = answer(&r, list, &table, &error);
  abbe_material_table_free(&table);
  return abbe_command_end(r.program, result, &error);
}
