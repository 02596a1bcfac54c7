#include "cli/materials.h"

#include <argp.h>
#include <stdio.h>
#include <string.h>

typedef struct request {
  const char *program, *table;
  bool json;
} request;

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
    abbe_dispersion_numbers d = abbe_materials_numbers(m);
    char n_d[32], v_d[32], b_g[32], range[64];
    snprintf(range, sizeof range, "%g:%g", m->min_nm, m->max_nm);
    printf("%-*s  %8s  %8s  %8s  %12s  %s\n", width, m->name,
           abbe_materials_number(n_d, sizeof n_d, "%.6f", d.n_d),
           abbe_materials_number(v_d, sizeof v_d, "%.2f", d.v_d),
           abbe_materials_number(b_g, sizeof b_g, "%.5f", d.b_g), range,
           m->description ? m->description : "");
  }
}

static abbe_result list_json(const abbe_material_table *table, abbe_error *error) {
  cJSON *root = abbe_materials_json();
  cJSON_AddStringToObject(root, "table", table->path);
  abbe_materials_add_text(root, "description", table->description);
  cJSON *list = cJSON_AddArrayToObject(root, "materials");
  for (size_t i = 0; i < table->count; i++) {
    const abbe_material *m = &table->material[i];
    cJSON *item = cJSON_CreateObject();
    if (item == NULL || !cJSON_AddItemToArray(list, item)) continue;
    cJSON_AddStringToObject(item, "name", m->name);
    abbe_materials_add_text(item, "description", m->description);
    abbe_materials_add_numbers(item, m);
    abbe_materials_add_pair(item, "range_nm", m->min_nm, m->max_nm);
    cJSON_AddBoolToObject(item, "extrapolate", m->extrapolate);
    abbe_materials_add_text(item, "source", m->source);
    abbe_materials_add_text(item, "warning", m->warning);
  }
  abbe_result result = abbe_materials_print_json(root, error);
  cJSON_Delete(root);
  return result;
}

static const struct argp_option options[] = {
    ABBE_MATERIALS_TABLE_OPTION, ABBE_MATERIALS_JSON_OPTION, {0}};

static error_t parse(int key, char *arg, struct argp_state *state) {
  request *r = state->input;
  switch (key) {
  case ABBE_MATERIALS_KEY_TABLE:
    r->table = arg;
    return 0;
  case ABBE_MATERIALS_KEY_JSON:
    r->json = true;
    return 0;
  case ARGP_KEY_ARG:
    abbe_materials_wrong_use(r->program, "list takes no name; did you mean show?");
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const struct argp parser = {
    .options = options,
    .parser = parse,
    .doc = "Lists the materials of a table.\v"
           "Examples:\n"
           "  abbe materials list\n"
           "  abbe materials list --table thesis\n"
           "  abbe materials list --table glasses.yaml --json\n",
};

int abbe_materials_list(int argc, char **argv) {
  request r = {.program = argv[0]};
  abbe_error error = {0};
  abbe_materials_parse(&parser, argc, argv, &r);
  abbe_material_table table;
  abbe_result result = abbe_material_table_load(r.table, &table, &error);
  if (result == ABBE_OK && r.json)
    result = list_json(&table, &error);
  else if (result == ABBE_OK)
    list_text(&table);
  abbe_material_table_free(&table);
  return abbe_command_end(r.program, result, &error);
}
