#include "cli/materials.h"

#include "spectral/nearest.h"

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
  fprintf(out,
          "\nExamples:\n"
          "  %s list\n"
          "  %s show diamond --at 430.8 --at 686.7\n"
          "  %s show --help\n",
          program, program, program);
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
  if (argp_parse(parser, argc, argv, 0, NULL, request) == 0) return;
  fprintf(stderr, "%s: no memory to read the arguments\n", argv[0]);
  exit(ABBE_EXIT_FAILED);
}

_Noreturn void abbe_materials_wrong_use(const char *program, const char *sentence) {
  fprintf(stderr, "%s: %s\nTry '%s --help'.\n", program, sentence, program);
  exit(ABBE_EXIT_USAGE);
}

/* A number is told only where the record vouches for it. */
static double told(const abbe_material *m, double value, double from_nm, double to_nm) {
  bool outside = abbe_material_extrapolates(m, from_nm) || abbe_material_extrapolates(m, to_nm);
  return outside && !m->extrapolate ? NAN : value;
}

abbe_dispersion_numbers abbe_materials_numbers(const abbe_material *m) {
  abbe_dispersion_numbers d = abbe_dispersion_describe(&m->dispersion);
  return (abbe_dispersion_numbers){
      .n_d = told(m, d.n_d, ABBE_LINE_D_NM, ABBE_LINE_D_NM),
      .n_F = told(m, d.n_F, ABBE_LINE_F_NM, ABBE_LINE_F_NM),
      .n_C = told(m, d.n_C, ABBE_LINE_C_NM, ABBE_LINE_C_NM),
      .v_d = told(m, d.v_d, ABBE_LINE_F_NM, ABBE_LINE_C_NM),
      .b_g = told(m, d.b_g, ABBE_LINE_G_NM, ABBE_LINE_B_NM),
  };
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
  abbe_dispersion_numbers d = abbe_materials_numbers(m);
  cJSON_AddNumberToObject(to, "n_d", d.n_d);
  cJSON_AddNumberToObject(to, "v_d", d.v_d);
  cJSON_AddNumberToObject(to, "n_F", d.n_F);
  cJSON_AddNumberToObject(to, "n_C", d.n_C);
  cJSON_AddNumberToObject(to, "b_g", d.b_g);
}

void abbe_materials_add_pair(cJSON *to, const char *key, double a, double b) {
  cJSON_AddItemToObject(to, key, cJSON_CreateDoubleArray((double[]){a, b}, 2));
}
