#include "cli/materials/materials.h"

#include "cli/base/command.h"
#include "spectral/materials/material_numbers.h"

#include <argp.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

void abbe_materials_parse(const struct argp *parser, int argc, char **argv, void *request) {
  abbe_arguments_parse(parser, 0, argc, argv, request);
}

_Noreturn void abbe_materials_wrong_use(const char *program, const char *sentence) {
  fprintf(stderr, "%s: %s\nTry '%s --help'.\n", program, sentence, program);
  exit(ABBE_EXIT_USAGE);
}

enum { FIRST_FEW = 12 };

void abbe_materials_print_report(const char *program, const abbe_report *report, bool all) {
  size_t shown[ABBE_NOTE_KIND_COUNT] = {0};
  for (size_t i = 0; i < report->count; i++) {
    const abbe_note *n = &report->note[i];
    if (++shown[n->kind] > FIRST_FEW && !all) continue;
    fprintf(stderr, "%s: %s: ", program, abbe_note_kind_word(n->kind));
    if (n->file[0] != '\0') fprintf(stderr, "%s: ", n->file);
    if (n->name[0] != '\0') fprintf(stderr, "%s: ", n->name);
    if (n->line > 0) fprintf(stderr, "line %zu: ", n->line);
    fprintf(stderr, "%s\n", n->text);
  }
  for (int k = 0; k < ABBE_NOTE_KIND_COUNT; k++) {
    size_t told = all || shown[k] < FIRST_FEW ? shown[k] : FIRST_FEW;
    if (report->kinds[k] > told)
      fprintf(stderr, "%s: %s: %zu more like these; --all shows them\n", program,
              abbe_note_kind_word((abbe_note_kind)k), report->kinds[k] - told);
  }
}

void abbe_materials_add_report(cJSON *to, const abbe_report *report) {
  for (int k = 0; k < ABBE_NOTE_KIND_COUNT; k++)
    cJSON_AddNumberToObject(to, abbe_note_kind_word((abbe_note_kind)k), (double)report->kinds[k]);
  cJSON *list = cJSON_AddArrayToObject(to, "notes");
  for (size_t i = 0; i < report->count; i++) {
    const abbe_note *n = &report->note[i];
    cJSON *item = cJSON_CreateObject();
    if (item == NULL || !cJSON_AddItemToArray(list, item)) continue;
    cJSON_AddStringToObject(item, "kind", abbe_note_kind_word(n->kind));
    if (n->file[0] != '\0') cJSON_AddStringToObject(item, "file", n->file);
    cJSON_AddNumberToObject(item, "line", (double)n->line);
    cJSON_AddStringToObject(item, "name", n->name);
    cJSON_AddStringToObject(item, "text", n->text);
  }
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

void abbe_materials_add_density(cJSON *to, const abbe_material *m) {
  if (m->catalogue.density_g_cm3 > 0)
    cJSON_AddNumberToObject(to, "density_g_cm3", m->catalogue.density_g_cm3);
  else
    cJSON_AddNullToObject(to, "density_g_cm3");
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
