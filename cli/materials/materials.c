#include "cli/materials/materials.h"

#include "base/nearest.h"
#include "spectral/materials/material_numbers.h"

#include <argp.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
  const char *name, *summary;
  int (*run)(int argc, char **argv);
} verbs[] = {
#define ABBE_MATERIALS_ROW(name, summary) {#name, summary, abbe_materials_##name},
    ABBE_MATERIALS_VERBS(ABBE_MATERIALS_ROW)
#undef ABBE_MATERIALS_ROW
};

enum { VERB_COUNT = sizeof verbs / sizeof verbs[0] };

static void help(FILE *out, const char *program) {
  fprintf(out, "usage: %s VERB [OPTION…] [NAME…]\n\n", program);
  for (int i = 0; i < VERB_COUNT; i++) fprintf(out, "  %-8s %s\n", verbs[i].name, verbs[i].summary);
  static const char *const examples[] = {
      "list",
      "show diamond --at 430.8 --at 686.7",
      "nearest --nd 1.728 --vd 28.4",
      "plot --map -o map.png",
      "import maker.agf -o glasses.yaml",
      "check --table glasses.yaml",
      "set sf10 coefficients.1=1.61625977 --table glasses.yaml --dry-run",
      "edit sf10 --table glasses.yaml"};
  fprintf(out, "\nExamples:\n");
  for (size_t i = 0; i < sizeof examples / sizeof examples[0]; i++)
    fprintf(out, "  %s %s\n", program, examples[i]);
  fprintf(out,
          "\n'%s VERB --help' shows a verb's options, with examples; docs/materials.md goes from\n"
          "a catalogue to a picture.\n",
          program);
}

static bool is_help(const char *word) {
  return strcmp(word, "--help") == 0 || strcmp(word, "-?") == 0 || strcmp(word, "-h") == 0 ||
         strcmp(word, "help") == 0;
}

int abbe_command_materials(int argc, char **argv) {
  const char *program = argv[0];
  if (argc < 2) {
    fprintf(stderr, "%s: a verb is wanted\n", program);
    help(stderr, program);
    return ABBE_EXIT_USAGE;
  }
  if (is_help(argv[1]) && argc == 2) {
    help(stdout, program);
    return ABBE_EXIT_DONE;
  }
  const char *word = is_help(argv[1]) ? argv[2] : argv[1], *names[VERB_COUNT];
  for (int i = 0; i < VERB_COUNT; i++) {
    names[i] = verbs[i].name;
    if (strcmp(word, names[i]) != 0) continue;
    static char name[64];
    snprintf(name, sizeof name, "%s %s", program, names[i]);
    char *help_argv[] = {name, (char[]){"--help"}, NULL};
    if (word != argv[1]) return verbs[i].run(2, help_argv);
    argv[1] = name;
    return verbs[i].run(argc - 1, argv + 1);
  }
  const char *near = abbe_nearest_word(word, names, VERB_COUNT);
  fprintf(stderr, "%s: there is no verb '%s'", program, word);
  if (near != NULL) fprintf(stderr, "; did you mean '%s'?", near);
  fprintf(stderr, "\nTry '%s --help'.\n", program);
  return ABBE_EXIT_USAGE;
}

/* ---- what the verbs share ---- */

void abbe_materials_parse(const struct argp *parser, int argc, char **argv, void *request) {
  abbe_arguments_parse(parser, 0, argc, argv, request);
}

_Noreturn void abbe_materials_wrong_use(const char *program, const char *sentence) {
  fprintf(stderr, "%s: %s\nTry '%s --help'.\n", program, sentence, program);
  exit(ABBE_EXIT_USAGE);
}

abbe_dispersion_numbers abbe_materials_numbers(const abbe_material *m) {
  abbe_material_numbers n;
  abbe_material_numbers_make(m, &n);
  return (abbe_dispersion_numbers){
      .n_d = n.n_d, .n_F = n.n_F, .n_C = n.n_C, .v_d = n.v_d, .b_g = n.b_g};
}

const char *abbe_materials_number(char *text, size_t size, const char *format, double value) {
  if (isnan(value)) return "-";
  if (isinf(value)) return "infinite";
  snprintf(text, size, format, value);
  return text;
}

/* cJSON drops what it has no memory for, one value at a time; half an answer is none. */
static bool json_lost;

static void *json_allocate(size_t size) {
  void *memory = malloc(size);
  if (memory == NULL) json_lost = true;
  return memory;
}

cJSON *abbe_materials_json(void) {
  cJSON_InitHooks(&(cJSON_Hooks){.malloc_fn = json_allocate, .free_fn = free});
  json_lost = false;
  return cJSON_CreateObject();
}

abbe_result abbe_materials_print_json(const cJSON *root, abbe_error *error) {
  return abbe_command_print_json(json_lost ? NULL : root, error);
}

void abbe_materials_add_text(cJSON *to, const char *key, const char *text) {
  if (text != NULL)
    cJSON_AddStringToObject(to, key, text);
  else
    cJSON_AddNullToObject(to, key);
}

/* cJSON writes NaN and infinity as null, and every other double so that it reads back the same. */
void abbe_materials_add_numbers(cJSON *to, const abbe_material *m) {
  abbe_material_numbers n;
  abbe_material_numbers_make(m, &n);
  cJSON_AddNumberToObject(to, "n_d", n.n_d);
  cJSON_AddNumberToObject(to, "v_d", n.v_d);
  cJSON_AddNumberToObject(to, "n_F", n.n_F);
  cJSON_AddNumberToObject(to, "n_C", n.n_C);
  cJSON_AddNumberToObject(to, "n_e", n.n_e);
  cJSON_AddNumberToObject(to, "n_g", n.n_g);
  cJSON_AddNumberToObject(to, "b_g", n.b_g);
  cJSON_AddNumberToObject(to, "p_gF", n.p_gF);
  cJSON_AddNumberToObject(to, "dp_gF", n.dp_gF);
}

void abbe_materials_add_pair(cJSON *to, const char *key, double a, double b) {
  cJSON_AddItemToObject(to, key, cJSON_CreateDoubleArray((double[]){a, b}, 2));
}

void abbe_materials_round(abbe_dispersion *dispersion) {
  char text[64];
  for (size_t i = 0; i < dispersion->count && dispersion->count <= 9; i++) {
    snprintf(text, sizeof text, "%.12g", dispersion->c[i]);
    dispersion->c[i] = strtod(text, NULL);
  }
}
