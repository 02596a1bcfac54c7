#include "cli/materials/materials.h"

#include "spectral/formats/material_import.h"
#include "spectral/materials/table_compare.h"

#include <argp.h>
#include <math.h>
#include <stdio.h>

enum { KEY_TOLERANCE = ABBE_MATERIALS_KEY_OWN };

typedef struct request {
  const char *program, *first, *second;
  double tolerance; /* NaN: none requested */
  bool json;
} request;

/* ---- text ---- */

static void print_parts(unsigned parts, const char *lead) {
  for (int i = 0; i < ABBE_ROW_PART_COUNT; i++)
    if ((parts & 1u << i) != 0) {
      printf("%s%s", lead, abbe_row_part_name((abbe_row_part)i));
      lead = ", ";
    }
}

static void print_numbers(const abbe_material *m) {
  char text[2][32];
  if (abbe_material_is_conductor(m)) {
    printf("  a conductor");
    return;
  }
  abbe_dispersion_numbers d = abbe_materials_numbers(m);
  printf("  n_d %s, V_d %s", abbe_materials_number(text[0], sizeof text[0], "%.6f", d.n_d),
         abbe_materials_number(text[1], sizeof text[1], "%.3f", d.v_d));
}

static void print_change(const abbe_row_difference *row) {
  char text[4][32];
  abbe_dispersion_numbers a = abbe_materials_numbers(row->first);
  abbe_dispersion_numbers b = abbe_materials_numbers(row->second);
  print_parts(row->parts, ": ");
  if (isnan(row->index.max) || row->index.max == 0) return;
  printf("\n    n_d %s -> %s, V_d %s -> %s",
         abbe_materials_number(text[0], sizeof text[0], "%.6f", a.n_d),
         abbe_materials_number(text[1], sizeof text[1], "%.6f", b.n_d),
         abbe_materials_number(text[2], sizeof text[2], "%.3f", a.v_d),
         abbe_materials_number(text[3], sizeof text[3], "%.3f", b.v_d));
  printf("\n    largest change of n %.3g, at %g nm; rms %.3g (%g to %g nm)", row->index.max,
         row->index.max_nm, row->index.rms, row->min_nm, row->max_nm);
}

static void print_text(const request *r, const abbe_table_difference *d) {
  printf("%s -> %s: %zu changed, %zu renamed, %zu only in the first, %zu only in the second, %zu "
         "the same\n",
         r->first, r->second, d->kinds[ABBE_ROW_CHANGED], d->kinds[ABBE_ROW_RENAMED],
         d->kinds[ABBE_ROW_ONLY_IN_FIRST], d->kinds[ABBE_ROW_ONLY_IN_SECOND],
         d->kinds[ABBE_ROW_SAME]);
  for (size_t i = 0; i < d->count; i++) {
    const abbe_row_difference *row = &d->row[i];
    switch (row->kind) {
    case ABBE_ROW_ONLY_IN_FIRST:
      printf("- %s", row->first->name);
      print_numbers(row->first);
      break;
    case ABBE_ROW_ONLY_IN_SECOND:
      printf("+ %s", row->second->name);
      print_numbers(row->second);
      break;
    case ABBE_ROW_RENAMED:
      printf("= %s -> %s", row->first->name, row->second->name);
      print_parts(row->parts, ": ");
      break;
    case ABBE_ROW_CHANGED:
      printf("~ %s", row->first->name);
      print_change(row);
      break;
    default:
      continue;
    }
    printf("\n");
  }
}

/* ---- JSON ---- */

static const char *kind_word(abbe_row_kind kind) {
  static const char *const words[] = {"only in first", "only in second", "renamed", "changed",
                                      "same"};
  return words[kind];
}

static void add_side(cJSON *to, const char *key, const abbe_material *m) {
  if (m == NULL) {
    cJSON_AddNullToObject(to, key);
    return;
  }
  cJSON *side = cJSON_AddObjectToObject(to, key);
  cJSON_AddStringToObject(side, "name", m->name);
  abbe_materials_add_numbers(side, m);
}

static abbe_result print_json(const request *r, const abbe_table_difference *d, abbe_error *error) {
  cJSON *root = abbe_materials_json();
  cJSON_AddStringToObject(root, "first", r->first);
  cJSON_AddStringToObject(root, "second", r->second);
  cJSON *rows = cJSON_AddArrayToObject(root, "rows");
  for (size_t i = 0; i < d->count; i++) {
    const abbe_row_difference *row = &d->row[i];
    cJSON *item = cJSON_CreateObject();
    if (item == NULL || !cJSON_AddItemToArray(rows, item)) continue;
    cJSON_AddStringToObject(item, "kind", kind_word(row->kind));
    add_side(item, "first", row->first);
    add_side(item, "second", row->second);
    cJSON *parts = cJSON_AddArrayToObject(item, "parts");
    for (int k = 0; k < ABBE_ROW_PART_COUNT; k++)
      if ((row->parts & 1u << k) != 0)
        cJSON_AddItemToArray(parts, cJSON_CreateString(abbe_row_part_name((abbe_row_part)k)));
    abbe_materials_add_pair(item, "range_nm", row->min_nm, row->max_nm);
    cJSON_AddNumberToObject(item, "largest", row->index.max);
    cJSON_AddNumberToObject(item, "largest_nm", row->index.max_nm);
    cJSON_AddNumberToObject(item, "rms", row->index.rms);
    cJSON_AddNumberToObject(item, "mean", row->index.mean);
  }
  abbe_result result = abbe_materials_print_json(root, error);
  cJSON_Delete(root);
  return result;
}

/* ---- arguments ---- */

static const struct argp_option options[] = {
    ABBE_MATERIALS_JSON_OPTION,
    {"tolerance", KEY_TOLERANCE, "DN", 0,
     "end with 3 where a row is missing or any index changes by more than this", 0},
    {0}};

static const abbe_take takes[] = {
    ABBE_TAKE_FLAG(request, ABBE_MATERIALS_KEY_JSON, json),
    ABBE_TAKE_NUMBER(request, KEY_TOLERANCE, tolerance, 0, 1e3),
    {0},
};

static error_t parse(int key, char *arg, struct argp_state *state) {
  request *r = state->input;
  if (abbe_take_option(takes, key, arg, state)) return 0;
  if (key != ARGP_KEY_ARG) return ARGP_ERR_UNKNOWN;
  if (r->second != NULL) argp_error(state, "'%s' is one argument too many", arg);
  *(r->first == NULL ? &r->first : &r->second) = arg;
  return 0;
}

static const struct argp parser = {
    .options = options,
    .parser = parse,
    .args_doc = "TABLE TABLE",
    .doc =
        "Says what differs between two tables: rows that came, went or changed, and by how much "
        "their index did.\v"
        "Examples:\n"
        "  abbe materials diff thesis default\n"
        "  abbe materials diff glasses.yaml glasses.old.yaml --tolerance 1e-6\n"
        "  abbe materials diff glasses.yaml default --json\n\n"
        "A table is a file, or default or thesis. Rows are matched by name; a row whose curve is "
        "the same under another name counts as renamed. What rows mean is compared: comments "
        "and layout of the files do not matter.",
};

static abbe_result judge(const request *r, const abbe_table_difference *d, abbe_error *error) {
  if (isnan(r->tolerance)) return ABBE_OK;
  for (size_t i = 0; i < d->count; i++) {
    const abbe_row_difference *row = &d->row[i];
    const char *name = row->first != NULL ? row->first->name : row->second->name;
    if (row->kind == ABBE_ROW_ONLY_IN_FIRST || row->kind == ABBE_ROW_ONLY_IN_SECOND)
      return abbe_error_set(error, ABBE_TOLERANCE, "'%s' is in one of the tables only", name);
    const bool metals = row->first != NULL && row->second != NULL &&
                        abbe_material_is_conductor(row->first) &&
                        abbe_material_is_conductor(row->second);
    if (metals && (row->parts & 1u << ABBE_ROW_PART_POINTS))
      return abbe_error_set(error, ABBE_TOLERANCE, "the points of the conductor '%s' differ", name);
    if (row->kind == ABBE_ROW_CHANGED && isnan(row->index.max) && !metals)
      return abbe_error_set(error, ABBE_TOLERANCE, "the ranges of '%s' have nothing in common",
                            name);
    if (row->index.max > r->tolerance)
      return abbe_error_set(error, ABBE_TOLERANCE,
                            "the index of '%s' changes by %.3g at %g nm, which is more than %g",
                            name, row->index.max, row->index.max_nm, r->tolerance);
  }
  return ABBE_OK;
}

static abbe_result compare(const request *r, const abbe_material_table *first,
                           const abbe_material_table *second, abbe_error *error) {
  abbe_table_difference d;
  abbe_result result = abbe_table_compare(first, second, &d, error);
  if (result == ABBE_OK && r->json) result = print_json(r, &d, error);
  if (result == ABBE_OK && !r->json) print_text(r, &d);
  if (result == ABBE_OK) result = judge(r, &d, error);
  abbe_table_difference_free(&d);
  return result;
}

int abbe_materials_diff(int argc, char **argv) {
  request r = {.program = argv[0], .tolerance = NAN};
  abbe_error error = {0};
  abbe_arguments_parse(&parser, ABBE_ARGUMENT_READS, argc, argv, &r);
  if (r.second == NULL)
    abbe_materials_wrong_use(argv[0], "diff of what? Name two tables, such as thesis default");
  abbe_material_table first, second = {0};
  abbe_result result = abbe_material_table_load(r.first, &first, &error);
  if (result == ABBE_OK) result = abbe_material_table_load(r.second, &second, &error);
  if (result == ABBE_OK) result = compare(&r, &first, &second, &error);
  abbe_material_table_free(&first);
  abbe_material_table_free(&second);
  return abbe_command_end(r.program, result, &error);
}
