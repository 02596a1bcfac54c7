#include "cli/materials/materials.h"

#include "spectral/editing/check.h"
#include "spectral/formats/material_import.h"
#include "spectral/formats/material_write.h"
#include "spectral/materials/convert.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct request {
  const char *program, *known, *name, *source;
  double value[8], half[8]; /* by option; NaN where it is not given */
  abbe_given given;
  abbe_fit_form form;
  double from_nm, to_nm;
  bool json;
} request;

enum { ND, VD, BG, A, B, IOR, DISPERSION, VALUES };

/* The two options of each kind, in the order of abbe_given_kind. */
static const int pairs[ABBE_GIVEN_KIND_COUNT][2] = {{ND, VD}, {ND, BG}, {A, B}, {IOR, DISPERSION}};

/* ---- the record ---- */

static void describe(const abbe_convert_error *e, const abbe_material_table *known, char *text,
                     size_t size) {
  size_t used = (size_t)snprintf(text, size, "Made from two numbers.");
  if (e->compared > 0)
    used += (size_t)snprintf(text + used, size - used,
                             " The same made of %zu known materials of like V_d errs by %.1g "
                             "typically and by up to %.1g, at %g nm (%s), at this dispersion.",
                             e->compared, e->typical, e->largest, e->at_nm,
                             known->material[e->worst].name);
  if (e->rounding > 0)
    snprintf(text + used, size - used, " The digits given leave n open by %.1g.", e->rounding);
}

static void describe_source(const request *r, char *text, size_t size) {
  const abbe_given *g = &r->given;
  if (r->source != NULL)
    snprintf(text, size, "%s; %s %.10g, %s %.10g", r->source, abbe_given_first_name(g->kind),
             g->first, abbe_given_second_name(g->kind), g->second);
  else
    snprintf(text, size, "given on the command line: %s %.10g, %s %.10g",
             abbe_given_first_name(g->kind), g->first, abbe_given_second_name(g->kind), g->second);
}

static abbe_result print_json(const request *r, const abbe_material *m, const abbe_convert_error *e,
                              const abbe_material_table *known, abbe_error *error) {
  cJSON *root = abbe_materials_json();
  cJSON_AddStringToObject(root, "name", m->name);
  cJSON_AddStringToObject(root, "model", abbe_dispersion_model_name(m->dispersion.model));
  cJSON_AddItemToObject(root, "coefficients",
                        cJSON_CreateDoubleArray(m->dispersion.c, (int)m->dispersion.count));
  abbe_materials_add_pair(root, "range_nm", r->from_nm, r->to_nm);
  abbe_materials_add_numbers(root, m);
  cJSON_AddNumberToObject(root, "typical_error", e->typical);
  cJSON_AddNumberToObject(root, "largest_error", e->largest);
  cJSON_AddNumberToObject(root, "largest_error_nm", e->at_nm);
  abbe_materials_add_text(root, "largest_error_of",
                          e->compared > 0 ? known->material[e->worst].name : NULL);
  cJSON_AddNumberToObject(root, "rounding_error", e->rounding);
  cJSON_AddStringToObject(root, "source", m->source);
  return abbe_materials_print_json(root, error);
}

/* What the check doubts is printed beside the record, not in it. */
static abbe_result warn(const request *r, const abbe_material *m, const abbe_material_table *known,
                        abbe_error *error) {
  abbe_findings found = {0};
  abbe_result result = abbe_check_material(m, known, &found, error);
  fflush(stdout);
  for (size_t i = 0; i < found.count && result == ABBE_OK; i++)
    if (found.finding[i].weight > ABBE_FINDING_NOTE)
      fprintf(stderr, "%s: %s, %s: %s; %s\n", r->program,
              abbe_finding_weight_name(found.finding[i].weight),
              abbe_finding_kind_meaning(found.finding[i].kind), found.finding[i].evidence,
              found.finding[i].fix);
  abbe_findings_free(&found);
  return result;
}

static abbe_result answer(const request *r, const abbe_material_table *known, abbe_error *error) {
  char name[ABBE_MATERIAL_MAX_NAME + 1], source[600], warning[600];
  abbe_convert_error e;
  abbe_material m = {.name = name,
                     .source = source,
                     .warning = warning,
                     .min_nm = r->from_nm,
                     .max_nm = r->to_nm,
                     .temperature_c = NAN};
  ABBE_TRY(abbe_convert_judge(&r->given, r->form, known, r->from_nm, r->to_nm, &e, error));
  ABBE_TRY(abbe_convert_make(&r->given, r->form, &m.dispersion, error));
  abbe_materials_round(&m.dispersion);
  snprintf(name, sizeof name, "%s", r->name);
  describe_source(r, source, sizeof source);
  describe(&e, known, warning, sizeof warning);
  ABBE_TRY(r->json ? print_json(r, &m, &e, known, error) : abbe_material_write(&m, stdout, error));
  return warn(r, &m, known, error);
}

/* ---- arguments ---- */

enum {
  KEY_VALUE = ABBE_MATERIALS_KEY_OWN, /* and the VALUES - 1 after it */
  KEY_FORM = KEY_VALUE + VALUES
};

static const abbe_option options[] = {
    {"nd", KEY_VALUE + ND, "N", 0, "the index at 587.6 nm, with --vd or --bg", 0, ABBE_TAKE_BY_KEY},
    {"vd", KEY_VALUE + VD, "V", 0, "the Abbe number", 0, ABBE_TAKE_BY_KEY},
    {"bg", KEY_VALUE + BG, "D", 0, "the gem trade's dispersion, n(430.8 nm) - n(686.7 nm)", 0,
     ABBE_TAKE_BY_KEY},
    {"a", KEY_VALUE + A, "A", 0, "Cauchy's A, with --b", 0, ABBE_TAKE_BY_KEY},
    {"b", KEY_VALUE + B, "B", 0, "Cauchy's B in um^2", 0, ABBE_TAKE_BY_KEY},
    {"ior", KEY_VALUE + IOR, "N", 0, "glTF's ior, with --dispersion", 0, ABBE_TAKE_BY_KEY},
    {"dispersion", KEY_VALUE + DISPERSION, "D", 0, "glTF's dispersion, 20 / V_d", 0,
     ABBE_TAKE_BY_KEY},
    {"form", KEY_FORM, "FORM", 0, "cauchy (two terms) or sellmeier (one); without it, cauchy", 1,
     ABBE_TAKE_BY_KEY},
    {"name", 0, "NAME", 0, "of the record; without it, my-material", 1,
     ABBE_TAKE_TEXT(request, name)},
    {"source", 0, "TEXT", 0, "where the numbers come from, for the record", 1,
     ABBE_TAKE_TEXT(request, source)},
    {"range", 0, "A:B", 0, "of the record, nm; without it, 380:780", 1,
     ABBE_TAKE_RANGE(request, from_nm, to_nm)},
    {"known", 0, "FILE", ABBE_ARGUMENT_READS,
     "a table of known materials, which say how far two numbers lead; without it, default", 1,
     ABBE_TAKE_TEXT(request, known)},
    ABBE_MATERIALS_JSON_OPTION(request, json),
    {0}};

/* 1.5168 leaves 5e-5 open. */
static double half_digit(const char *text) {
  size_t whole = strspn(text, "+-0123456789");
  size_t after = text[whole] == '.' ? strspn(text + whole + 1, "0123456789") : 0;
  const char *exponent = strpbrk(text, "eE");
  return 0.5 * pow(10, (exponent != NULL ? atof(exponent + 1) : 0) - (double)after);
}

static error_t parse(int key, char *arg, struct argp_state *state) {
  static const char *const names[VALUES] = {"--nd", "--vd",  "--bg",        "--a",
                                            "--b",  "--ior", "--dispersion"};
  static const char *const forms[] = {"cauchy", "sellmeier"};
  request *r = state->input;
  if (key >= KEY_VALUE && key < KEY_VALUE + VALUES) {
    int i = key - KEY_VALUE;
    r->value[i] = abbe_command_number(r->program, names[i], arg, -1e6, 1e6);
    r->half[i] = half_digit(arg);
    return 0;
  }
  switch (key) {
  case KEY_FORM:
    r->form = (abbe_fit_form)abbe_command_choice(r->program, "--form", arg, forms, 2);
    return 0;
  case ARGP_KEY_ARG:
    argp_error(state, "'%s' is one argument too many; numbers go with options such as --nd", arg);
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const abbe_parser parser = {
    .options = options,
    .parse = parse,
    .doc = "Makes a record from the two numbers that you have, and says how far they lead.\v"
           "Examples:\n"
           "  abbe materials from --nd 1.5168 --vd 64.17 --name my-crown\n"
           "  abbe materials from --nd 2.417 --bg 0.044 --name diamond-by-the-book |\n"
           "    abbe materials add --record - --table gems.yaml\n"
           "  abbe materials from --a 1.5046 --b 0.0042 --form sellmeier\n"
           "  abbe materials from --ior 1.5 --dispersion 0.33\n\n"
           "The record goes to stdout, as an item of a table's list. Its warning states the error "
           "that known materials of like Abbe number show when they are made in the same way, and "
           "what the digits given leave open.",
};

/* The one pair that is given. */
static void choose(request *r) {
  size_t given = 0, found = 0;
  for (int i = 0; i < VALUES; i++) given += !isnan(r->value[i]);
  for (int k = 0; k < ABBE_GIVEN_KIND_COUNT; k++) {
    int first = pairs[k][0], second = pairs[k][1];
    if (isnan(r->value[first]) || isnan(r->value[second])) continue;
    r->given = (abbe_given){(abbe_given_kind)k, r->value[first], r->value[second], r->half[first],
                            r->half[second]};
    found++;
  }
  if (found == 1 && given == 2) return;
  abbe_materials_wrong_use(r->program, "two numbers are wanted: --nd with --vd or --bg, --a with "
                                       "--b, or --ior with --dispersion");
}

int abbe_materials_from(int argc, char **argv) {
  request r = {.program = argv[0],
               .name = "my-material",
               .from_nm = ABBE_WAVELENGTH_MIN_NM,
               .to_nm = ABBE_WAVELENGTH_MAX_NM};
  for (int i = 0; i < VALUES; i++) r.value[i] = NAN;
  abbe_error error = {0};
  abbe_materials_parse(&parser, argc, argv, &r);
  choose(&r);
  abbe_material_table known;
  abbe_result result = abbe_material_check_name(r.name, &error);
  if (result != ABBE_OK) return abbe_command_end(r.program, result, &error);
  result = abbe_material_table_load(r.known, &known, &error);
  if (result == ABBE_OK) result = answer(&r, &known, &error);
  abbe_material_table_free(&known);
  return abbe_command_end(r.program, result, &error);
}
