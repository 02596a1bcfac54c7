#include "cli/materials/materials.h"

#include "spectral/formats/material_import.h"
#include "spectral/materials/material_query.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* X(code, name in --columns, heading, format of a number or NULL for text). */
#define COLUMNS(X)                                                                                 \
  X(NAME, "name", "name", NULL)                                                                    \
  X(ND, "n_d", "n_d", "%.6f")                                                                      \
  X(VD, "v_d", "V_d", "%.2f")                                                                      \
  X(BG, "b_g", "B-G", "%.5f")                                                                      \
  X(NF, "n_F", "n_F", "%.6f")                                                                      \
  X(NC, "n_C", "n_C", "%.6f")                                                                      \
  X(NE, "n_e", "n_e", "%.6f")                                                                      \
  X(PGF, "p_gF", "P_gF", "%.4f")                                                                   \
  X(DPGF, "dp_gF", "dP_gF", "%+.4f")                                                               \
  X(RANGE, "range", "range nm", NULL)                                                              \
  X(MODEL, "model", "model", NULL)                                                                 \
  X(TEMPERATURE, "temperature", "C", "%g")                                                         \
  X(DENSITY, "density", "g/cm3", "%g")                                                             \
  X(SOURCE, "source", "source", NULL)                                                              \
  X(WARNING, "warning", "warning", NULL)                                                           \
  X(DESCRIPTION, "description", "description", NULL)

enum {
#define COLUMN_ENUM(code, name, heading, format) COLUMN_##code,
  COLUMNS(COLUMN_ENUM)
#undef COLUMN_ENUM
      COLUMN_COUNT
};

static const struct {
  const char *name, *heading, *format;
} columns[] = {
#define COLUMN_ROW(code, name, heading, format) {name, heading, format},
    COLUMNS(COLUMN_ROW)
#undef COLUMN_ROW
};

typedef struct request {
  const char *program, *table;
  abbe_material_query query;
  int column[COLUMN_COUNT];
  int column_count;
  bool json;
} request;

/* ---- text ---- */

static double number_in(int column, const abbe_material *m, const abbe_material_numbers *n) {
  switch (column) {
  case COLUMN_ND:
    return n->n_d;
  case COLUMN_VD:
    return n->v_d;
  case COLUMN_BG:
    return n->b_g;
  case COLUMN_NF:
    return n->n_F;
  case COLUMN_NC:
    return n->n_C;
  case COLUMN_NE:
    return n->n_e;
  case COLUMN_PGF:
    return n->p_gF;
  case COLUMN_DPGF:
    return n->dp_gF;
  case COLUMN_TEMPERATURE:
    return m->temperature_c;
  case COLUMN_DENSITY:
    return m->catalogue.density_g_cm3 > 0 ? m->catalogue.density_g_cm3 : NAN;
  default:
    return NAN;
  }
}

/* What stands in a column, in text where it is not the record's own. */
static const char *cell(int column, const abbe_material *m, const abbe_material_numbers *n,
                        char *text, size_t size) {
  if (columns[column].format != NULL)
    return abbe_materials_number(text, size, columns[column].format, number_in(column, m, n));
  const char *own = column == COLUMN_NAME      ? m->name
                    : column == COLUMN_MODEL   ? abbe_dispersion_model_name(m->dispersion.model)
                    : column == COLUMN_SOURCE  ? m->source
                    : column == COLUMN_WARNING ? m->warning
                                               : m->description;
  if (column != COLUMN_RANGE) return own != NULL ? own : "";
  snprintf(text, size, "%g:%g", m->min_nm, m->max_nm);
  return text;
}

static void list_text(const request *r, const abbe_material_table *table, const size_t *rows,
                      size_t count) {
  int width[COLUMN_COUNT];
  char text[64];
  abbe_material_numbers n;
  for (int c = 0; c < r->column_count; c++) width[c] = (int)strlen(columns[r->column[c]].heading);
  for (size_t i = 0; i < count; i++) {
    const abbe_material *m = &table->material[rows[i]];
    abbe_material_numbers_make(m, &n);
    for (int c = 0; c < r->column_count; c++) {
      int length = (int)strlen(cell(r->column[c], m, &n, text, sizeof text));
      if (length > width[c]) width[c] = length;
    }
  }
  if (table->description != NULL) printf("%s: %s\n\n", table->path, table->description);
  for (size_t i = 0; i <= count; i++) {
    const abbe_material *m = i > 0 ? &table->material[rows[i - 1]] : NULL;
    if (m != NULL) abbe_material_numbers_make(m, &n);
    for (int c = 0; c < r->column_count; c++) {
      int column = r->column[c];
      bool left = columns[column].format == NULL && column != COLUMN_RANGE;
      bool last = c + 1 == r->column_count;
      const char *shown =
          m == NULL ? columns[column].heading : cell(column, m, &n, text, sizeof text);
      printf("%*s%s", last && left ? 0 : (left ? -width[c] : width[c]), shown, last ? "\n" : "  ");
    }
  }
  if (count == 0) printf("(none of %zu materials)\n", table->count);
}

/* ---- JSON ---- */

static abbe_result list_json(const abbe_material_table *table, const size_t *rows, size_t count,
                             abbe_error *error) {
  cJSON *root = abbe_materials_json();
  cJSON_AddStringToObject(root, "table", table->path);
  abbe_materials_add_text(root, "description", table->description);
  cJSON *list = cJSON_AddArrayToObject(root, "materials");
  for (size_t i = 0; i < count; i++) {
    const abbe_material *m = &table->material[rows[i]];
    cJSON *item = cJSON_CreateObject();
    if (item == NULL || !cJSON_AddItemToArray(list, item)) continue;
    cJSON_AddStringToObject(item, "name", m->name);
    abbe_materials_add_text(item, "description", m->description);
    cJSON_AddStringToObject(item, "model", abbe_dispersion_model_name(m->dispersion.model));
    abbe_materials_add_numbers(item, m);
    abbe_materials_add_pair(item, "range_nm", m->min_nm, m->max_nm);
    cJSON_AddBoolToObject(item, "extrapolate", m->extrapolate);
    cJSON_AddNumberToObject(item, "temperature_c", m->temperature_c);
    abbe_materials_add_density(item, m);
    abbe_materials_add_text(item, "source", m->source);
    abbe_materials_add_text(item, "warning", m->warning);
  }
  return abbe_materials_print_json(root, error);
}

/* ---- arguments ---- */

enum { KEY_SORT = ABBE_MATERIALS_KEY_OWN, KEY_COLUMNS };

static const abbe_option options[] = {
    ABBE_MATERIALS_TABLE_OPTION(request, table),
    {"name", 0, "TEXT", ABBE_ARGUMENT_ONCE,
     "only names with TEXT in them, or that match it where it has * ?", 1,
     ABBE_TAKE_TEXT(request, query.name)},
    {"nd", 0, "A:B", ABBE_ARGUMENT_ONCE, "only n_d from A to B", 1,
     ABBE_TAKE_RANGE(request, query.n_d_min, query.n_d_max)},
    {"vd", 0, "A:B", ABBE_ARGUMENT_ONCE, "only V_d from A to B", 1,
     ABBE_TAKE_RANGE(request, query.v_d_min, query.v_d_max)},
    {"source", 0, "TEXT", ABBE_ARGUMENT_ONCE, "only sources with TEXT in them", 1,
     ABBE_TAKE_TEXT(request, query.source)},
    {"sort", KEY_SORT, "KEY", 0, "by name, n_d, v_d, b_g, p_gF, from, to (of the range), source", 2,
     ABBE_TAKE_BY_KEY},
    {"reverse", 0, NULL, 0, "the last first", 2, ABBE_TAKE_FLAG(request, query.descending)},
    {"columns", KEY_COLUMNS, "LIST", 0,
     "of name, n_d, v_d, b_g, n_F, n_C, n_e, p_gF, dp_gF, range, model, temperature, density, "
     "source, warning, description; without it, name,n_d,v_d,b_g,range,description",
     2, ABBE_TAKE_BY_KEY},
    ABBE_MATERIALS_JSON_OPTION(request, json),
    {0}};

static void take_columns(request *r, char *list) {
  const char *names[COLUMN_COUNT];
  for (int i = 0; i < COLUMN_COUNT; i++) names[i] = columns[i].name;
  r->column_count = 0;
  for (char *word = strtok(list, ", "); word != NULL; word = strtok(NULL, ", ")) {
    if (r->column_count == COLUMN_COUNT)
      abbe_materials_wrong_use(r->program, "--columns names more columns than there are");
    r->column[r->column_count++] =
        abbe_command_choice(r->program, "--columns", word, names, COLUMN_COUNT);
  }
  if (r->column_count == 0)
    abbe_materials_wrong_use(r->program, "--columns names no column; try name,n_d,v_d,source");
}

static abbe_material_key key_of(const char *program, const char *word) {
  const char *names[ABBE_MATERIAL_KEY_COUNT];
  for (int i = 0; i < ABBE_MATERIAL_KEY_COUNT; i++)
    names[i] = abbe_material_key_name((abbe_material_key)i);
  return (abbe_material_key)abbe_command_choice(program, "--sort", word, names,
                                                ABBE_MATERIAL_KEY_COUNT);
}

static error_t parse(int key, char *arg, struct argp_state *state) {
  request *r = state->input;
  abbe_material_query *q = &r->query;
  switch (key) {
  case KEY_SORT:
    q->sort = key_of(r->program, arg);
    return 0;
  case KEY_COLUMNS:
    take_columns(r, arg);
    return 0;
  case ARGP_KEY_ARG:
    abbe_materials_wrong_use(r->program, "list takes no name; did you mean show? (--name filters)");
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const abbe_parser parser = {
    .options = options,
    .parse = parse,
    .doc = "Lists the materials of a table, or those that are asked for.\v"
           "Examples:\n"
           "  abbe materials list\n"
           "  abbe materials list --table thesis\n"
           "  abbe materials list --nd 1.5:1.6 --vd 50:70 --sort v_d\n"
           "  abbe materials list --source schott --columns name,n_d,v_d,p_gF,dp_gF,source\n"
           "  abbe materials list --name 'n-*' --table glasses.yaml --json\n",
};

int abbe_materials_list(int argc, char **argv) {
  request r = {
      .program = argv[0],
      .column = {COLUMN_NAME, COLUMN_ND, COLUMN_VD, COLUMN_BG, COLUMN_RANGE, COLUMN_DESCRIPTION},
      .column_count = 6};
  abbe_error error = {0};
  abbe_materials_parse(&parser, argc, argv, &r);
  abbe_material_table table;
  size_t *rows = NULL, count = 0;
  abbe_result result = abbe_material_table_load(r.table, &table, &error);
  if (result == ABBE_OK) result = abbe_material_query_run(&table, &r.query, &rows, &count, &error);
  if (result == ABBE_OK && r.json)
    result = list_json(&table, rows, count, &error);
  else if (result == ABBE_OK)
    list_text(&r, &table, rows, count);
  free(rows);
  abbe_material_table_free(&table);
  return abbe_command_end(r.program, result, &error);
}
