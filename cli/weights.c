#include "cli/base/arguments.h"
#include "cli/base/command.h"
#include "cli/options/picture_options.h"

#include "colorimetry/weights.h"

#include <cjson/cJSON.h>
#include <stdio.h>

typedef struct request {
  const char *program, *illuminant;
  size_t count;
  double min_nm, max_nm;
  abbe_rgb_space space;
  abbe_observer observer;
  bool thesis, chosen, json; /* chosen: a range, observer or space was requested */
} request;

static const char *const component_names[ABBE_RGB_SPACE_COUNT][3] = {
    [ABBE_RGB_SPACE_ACESCG] = {"R", "G", "B"},
    [ABBE_RGB_SPACE_REC709] = {"R", "G", "B"},
    [ABBE_RGB_SPACE_XYZ] = {"X", "Y", "Z"}};

/* What is printed: nodes, and a triple for each. */
typedef struct table {
  const char *space, *illuminant, *observer; /* NULL for the thesis's */
  const char *const *component;
  size_t count;
  const double *lambda_nm;
  const double *edge_nm; /* NULL for the thesis's */
  const double (*weight)[3];
  const double *sum;
} table;

static void print_text(const table *t) {
  printf("%s weights, illuminant %s", t->space, t->illuminant);
  if (t->observer != NULL) printf(", %s", t->observer);
  printf("\n\n");
  printf("%12s %12s %12s %12s\n", "nm", t->component[0], t->component[1], t->component[2]);
  for (size_t i = 0; i < t->count; i++)
    printf("%12.6g %12.8f %12.8f %12.8f\n", t->lambda_nm[i], t->weight[i][0], t->weight[i][1],
           t->weight[i][2]);
  printf("%12s %12.8f %12.8f %12.8f\n", "sum", t->sum[0], t->sum[1], t->sum[2]);
}

static bool add_sample(cJSON *list, const table *t, size_t i) {
  cJSON *item = cJSON_CreateObject();
  if (!cJSON_AddItemToArray(list, item)) return false;
  cJSON *weight = cJSON_CreateDoubleArray(t->weight[i], 3);
  bool made = cJSON_AddNumberToObject(item, "lambda_nm", t->lambda_nm[i]) != NULL &&
              cJSON_AddItemToObject(item, "weight", weight);
  if (made && t->edge_nm != NULL)
    made = cJSON_AddItemToObject(item, "band_nm", cJSON_CreateDoubleArray(t->edge_nm + i, 2));
  return made;
}

static abbe_result print_json(const table *t, abbe_error *error) {
  cJSON *root = cJSON_CreateObject();
  cJSON *list = cJSON_AddArrayToObject(root, "samples");
  bool made = list != NULL;
  for (size_t i = 0; made && i < t->count; i++) made = add_sample(list, t, i);
  made = made && cJSON_AddItemToObject(root, "sum", cJSON_CreateDoubleArray(t->sum, 3)) &&
         cJSON_AddStringToObject(root, "space", t->space) != NULL &&
         cJSON_AddStringToObject(root, "illuminant", t->illuminant) != NULL;
  if (made && t->observer != NULL)
    made = cJSON_AddStringToObject(root, "observer", t->observer) != NULL;
  return abbe_command_print_json(root, made, error);
}

static abbe_result print_table(const request *r, const table *t, abbe_error *error) {
  if (r->json) return print_json(t, error);
  print_text(t);
  return ABBE_OK;
}

static abbe_result print_thesis(const request *r, abbe_error *error) {
  double sum[3] = {0};
  for (int i = 0; i < ABBE_WEIGHTS_THESIS_COUNT; i++)
    for (int k = 0; k < 3; k++) sum[k] += abbe_weights_thesis_rgb[i][k];
  const table t = {.space = "thesis",
                   .illuminant = "none",
                   .component = component_names[ABBE_RGB_SPACE_REC709],
                   .count = ABBE_WEIGHTS_THESIS_COUNT,
                   .lambda_nm = abbe_weights_thesis_lambda_nm,
                   .weight = abbe_weights_thesis_rgb,
                   .sum = sum};
  return print_table(r, &t, error);
}

static abbe_result print_weights(const request *r, abbe_error *error) {
  ABBE_OWNED(abbe_wavelengths, samples) = {0};
  ABBE_OWNED(abbe_illuminant, light) = {0};
  ABBE_OWNED(abbe_weights, weights) = {0};
  ABBE_TRY(abbe_wavelengths_make(r->count, r->min_nm, r->max_nm, &samples, error));
  ABBE_TRY(abbe_illuminant_make(r->illuminant, &light, error));
  ABBE_TRY(abbe_weights_make_by(r->observer, &samples, &light, r->space, &weights, error));
  bool tabulated = light.kind == ABBE_ILLUMINANT_TABULATED && light.name[0] == '\0';
  const table t = {.space = abbe_rgb_space_name(r->space),
                   .illuminant = tabulated ? r->illuminant : abbe_illuminant_name(&light),
                   .observer = abbe_observer_text(r->observer),
                   .component = component_names[r->space],
                   .count = weights.count,
                   .lambda_nm = samples.lambda_nm,
                   .edge_nm = samples.edge_nm,
                   .weight = (const double(*)[3])weights.weight,
                   .sum = weights.sum};
  return print_table(r, &t, error);
}

enum { DEFAULT_COUNT = 7 };
enum { KEY_RANGE = 256, KEY_OBSERVER, KEY_SPACE, KEY_SET };

static const abbe_option options[] = {
    {"count", 0, "N", 0, "wavelength samples, 1 to 4096; without it, 7", 0,
     ABBE_TAKE_COUNT(request, count, 1, ABBE_WAVELENGTHS_MAX_COUNT)},
    {"range", KEY_RANGE, "FROM:TO", 0, "in nm; without it, 380:780", 0, ABBE_TAKE_BY_KEY},
    {"illuminant", 0, "NAME|FILE", ABBE_ARGUMENT_READS,
     "a name of the list below, or a file of two columns, wavelength and power; without it, D65", 0,
     ABBE_TAKE_TEXT(request, illuminant)},
    {"observer", KEY_OBSERVER, "NAME", 0, "1931, 1964, 2015-2 or 2015-10; without it, 1931", 0,
     ABBE_TAKE_BY_KEY},
    {"space", KEY_SPACE, "SPACE", 0, "xyz, rec709 or acescg; without it, xyz", 0, ABBE_TAKE_BY_KEY},
    {"set", KEY_SET, "SET", 0, "cie, or thesis: the thesis's seven RGB triples as printed", 0,
     ABBE_TAKE_BY_KEY},
    {"json", 0, NULL, 0, "as JSON, numbers in full", 0, ABBE_TAKE_FLAG(request, json)},
    {0}};

static abbe_rgb_space choose_space(const request *r, const char *word) {
  const char *names[ABBE_RGB_SPACE_COUNT];
  for (int i = 0; i < ABBE_RGB_SPACE_COUNT; i++) names[i] = abbe_rgb_space_name((abbe_rgb_space)i);
  return (abbe_rgb_space)abbe_command_choice(r->program, "--space", word, names,
                                             ABBE_RGB_SPACE_COUNT);
}

static error_t parse(int key, char *arg, struct argp_state *state) {
  static const char *const sets[] = {"cie", "thesis"};
  request *r = state->input;
  r->chosen = r->chosen || key == KEY_RANGE || key == KEY_OBSERVER || key == KEY_SPACE;
  switch (key) {
  case KEY_RANGE:
    abbe_command_range(r->program, "--range", arg, &r->min_nm, &r->max_nm);
    if (r->min_nm <= 0) argp_error(state, "--range '%s' starts at 0 nm or below", arg);
    return 0;
  case KEY_OBSERVER:
    r->observer = abbe_spectral_options_observer(r->program, arg);
    return 0;
  case KEY_SPACE:
    r->space = choose_space(r, arg);
    return 0;
  case KEY_SET:
    r->thesis = abbe_command_choice(r->program, "--set", arg, sets, 2) == 1;
    return 0;
  case ARGP_KEY_ARG:
    argp_error(state, "'%s' is one argument too many", arg);
    return 0;
  case ARGP_KEY_END:
    if (r->thesis && (r->chosen || r->count > 0 || r->illuminant != NULL))
      argp_error(state, "--set thesis fixes its samples; it goes without --count, --range, "
                        "--illuminant, --observer and --space");
    if (r->count == 0) r->count = DEFAULT_COUNT;
    if (r->illuminant == NULL) r->illuminant = "D65";
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const abbe_parser parser = {
    .options = options,
    .parse = parse,
    .doc = "Prints what each wavelength sample adds to a colour: the integral of observer x "
           "illuminant over the sample's own band, such that all samples together are the "
           "illuminant's white with Y = 1.\v"
           "Illuminants: " ABBE_ILLUMINANT_NAMES ".\n\n"
           "Examples:\n"
           "  abbe weights\n"
           "  abbe weights --count 21 --space acescg\n"
           "  abbe weights --count 7 --range 400:700 --illuminant A --space rec709 --json\n"
           "  abbe weights --count 21 --illuminant LED-B3\n"
           "  abbe weights --set thesis\n",
};

int abbe_command_weights(int argc, char **argv) {
  request r = {.program = argv[0],
               .min_nm = ABBE_WAVELENGTH_MIN_NM,
               .max_nm = ABBE_WAVELENGTH_MAX_NM,
               .space = ABBE_RGB_SPACE_XYZ};
  abbe_arguments_parse(&parser, 0, argc, argv, &r);
  abbe_error error = {0};
  abbe_result result = r.thesis ? print_thesis(&r, &error) : print_weights(&r, &error);
  return abbe_command_end(r.program, result, &error);
}
