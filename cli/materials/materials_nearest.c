#include "cli/materials/materials.h"

#include "spectral/formats/material_import.h"
#include "spectral/materials/partners.h"
#include "spectral/wavelengths.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct request {
  const char *program, *table, *like, *like_table, *points;
  double n_d, v_d, from_nm, to_nm;
  unsigned long count;
  bool json;
} request;

static void print_text(const request *r, const abbe_material_table *table,
                       const abbe_glass_distances *d) {
  int width = 4;
  for (size_t i = 0; i < d->count; i++) {
    int length = (int)strlen(table->material[d->nearest[i].index].name);
    if (length > width) width = length;
  }
  printf("%-*s  %9s  %8s  %11s  %8s", width, "name", "n_d", "V_d", "rms of n", "");
  printf(r->n_d > 0 ? "%9s  %8s\n" : "%11s  %7s\n", r->n_d > 0 ? "n_d off" : "largest",
         r->n_d > 0 ? "V_d off" : "at nm");
  for (size_t i = 0; i < d->count; i++) {
    const abbe_glass_distance *g = &d->nearest[i];
    char n_d[32], v_d[32];
    printf("%-*s  %9s  %8s  %11.3g  %8s", width, table->material[g->index].name,
           abbe_materials_number(n_d, sizeof n_d, "%.6f", g->n_d),
           abbe_materials_number(v_d, sizeof v_d, "%.3f", g->v_d), g->rms, "");
    if (r->n_d > 0)
      printf("%+9.5f  %+8.3f\n", g->n_d - r->n_d, g->v_d - r->v_d);
    else
      printf("%11.3g  %7.6g\n", g->max, g->max_nm);
  }
  if (d->skipped > 0)
    printf("\n%zu of %zu materials have no data there and were skipped\n", d->skipped,
           table->count);
}

static abbe_result print_json(const abbe_material_table *table, const abbe_glass_distances *d,
                              abbe_error *error) {
  cJSON *root = abbe_materials_json();
  cJSON_AddStringToObject(root, "table", table->path);
  cJSON_AddNumberToObject(root, "skipped", (double)d->skipped);
  cJSON *list = cJSON_AddArrayToObject(root, "nearest");
  for (size_t i = 0; i < d->count; i++) {
    const abbe_glass_distance *g = &d->nearest[i];
    cJSON *item = cJSON_CreateObject();
    if (item == NULL || !cJSON_AddItemToArray(list, item)) continue;
    cJSON_AddStringToObject(item, "name", table->material[g->index].name);
    cJSON_AddNumberToObject(item, "n_d", g->n_d);
    cJSON_AddNumberToObject(item, "v_d", g->v_d);
    cJSON_AddNumberToObject(item, "rms", g->rms);
    cJSON_AddNumberToObject(item, "max", g->max);
    cJSON_AddNumberToObject(item, "max_nm", g->max_nm);
  }
  return abbe_materials_print_json(root, error);
}

/* A material is not listed as its own nearest. */
static void leave_out(abbe_glass_distances *d, const abbe_material_table *table,
                      const abbe_material *self) {
  size_t kept = 0;
  for (size_t i = 0; i < d->count; i++)
    if (&table->material[d->nearest[i].index] != self) d->nearest[kept++] = d->nearest[i];
  d->count = kept;
}

static abbe_result like(const request *r, const abbe_material_table *table,
                        abbe_glass_distances *out, abbe_error *error) {
  ABBE_OWNED(abbe_material_table, other) = {0};
  const abbe_material *m = NULL;
  double n;
  if (r->like_table != NULL)
    ABBE_TRY(abbe_material_table_load_named(r->like_table, &r->like, 1, &other, error));
  ABBE_TRY(abbe_material_table_find(r->like_table != NULL ? &other : table, r->like, &m, error));
  ABBE_TRY(abbe_material_n(m, r->from_nm, &n, error));
  ABBE_TRY(abbe_material_n(m, r->to_nm, &n, error));
  ABBE_TRY(
      abbe_glass_distance_to_curve(table, &m->dispersion, r->from_nm, r->to_nm, 0, out, error));
  leave_out(out, table, m);
  return ABBE_OK;
}

static abbe_result by_points(const request *r, const abbe_material_table *table,
                             abbe_glass_distances *out, abbe_error *error) {
  ABBE_OWNED(abbe_index_points, points) = {0};
  ABBE_TRY(abbe_index_points_load(r->points, &points, error));
  return abbe_glass_distance_to_points(table, &points, 0, out, error);
}

static abbe_result answer(const request *r, const abbe_material_table *table, abbe_error *error) {
  ABBE_OWNED(abbe_glass_distances, d) = {0};
  if (r->like != NULL)
    ABBE_TRY(like(r, table, &d, error));
  else if (r->points != NULL)
    ABBE_TRY(by_points(r, table, &d, error));
  else
    ABBE_TRY(abbe_glass_distance_to_numbers(table, r->n_d, r->v_d, 0, &d, error));
  if (d.count > r->count) d.count = r->count;
  if (d.count == 0)
    return abbe_error_set(error, ABBE_NOT_FOUND, "no material of '%s' has data there", table->path);
  if (r->json)
    ABBE_TRY(print_json(table, &d, error));
  else
    print_text(r, table, &d);
  return ABBE_OK;
}

/* ---- arguments ---- */

static const abbe_option options[] = {
    {"nd", 0, "N", 0, "the index at 587.6 nm, with --vd", 0,
     ABBE_TAKE_NUMBER(request, n_d, 1.0001, 10)},
    {"vd", 0, "V", 0, "the Abbe number, with --nd", 0, ABBE_TAKE_NUMBER(request, v_d, 0.1, 1e6)},
    {"like", 0, "NAME", ABBE_ARGUMENT_ONCE, "the whole curve of this material", 0,
     ABBE_TAKE_TEXT(request, like)},
    {"like-table", 0, "FILE", ABBE_ARGUMENT_READS, "the table that NAME is in; without it, --table",
     0, ABBE_TAKE_TEXT(request, like_table)},
    {"points", 0, "FILE", ABBE_ARGUMENT_READS, "measured points: columns of wavelength and n", 0,
     ABBE_TAKE_TEXT(request, points)},
    {"range", 0, "A:B", 0, "with --like: compare from A to B nm; without it, 380:780", 0,
     ABBE_TAKE_RANGE(request, from_nm, to_nm)},
    {"count", 0, "N", 0, "how many to show; without it, 5", 0,
     ABBE_TAKE_COUNT(request, count, 1, 10000)},
    ABBE_MATERIALS_TABLE_OPTION(request, table),
    ABBE_MATERIALS_JSON_OPTION(request, json),
    {0}};

static error_t parse(int key, char *arg, struct argp_state *state) {
  switch (key) {
  case ARGP_KEY_ARG:
    argp_error(state, "'%s' is one argument too many; --like %s compares with that material", arg,
               arg);
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const abbe_parser parser = {
    .options = options,
    .parse = parse,
    .doc = "Finds the materials nearest to an n_d and V_d, to another material's curve, or to "
           "measured points.\v"
           "Examples:\n"
           "  abbe materials nearest --nd 1.517 --vd 64.2\n"
           "  abbe materials nearest --nd 1.517 --vd 64.2 --table schott.yaml --count 10\n"
           "  abbe materials nearest --like bk7 --like-table thesis\n"
           "  abbe materials nearest --points measured.csv --json\n\n"
           "The distance is the root mean square difference of n over 380 to 780 nm, between the "
           "curves or, for n_d and V_d, between the two-term Cauchy curves that they imply.",
};

static void check(const request *r) {
  bool numbers = r->n_d > 0 || r->v_d > 0;
  int ways = numbers + (r->like != NULL) + (r->points != NULL);
  if (ways == 0)
    abbe_materials_wrong_use(r->program,
                             "nearest to what? Give --nd and --vd, --like, or --points");
  if (ways > 1)
    abbe_materials_wrong_use(r->program, "--nd and --vd, --like and --points exclude each other");
  if (numbers && (r->n_d == 0 || r->v_d == 0))
    abbe_materials_wrong_use(r->program, "--nd and --vd go together");
  if (r->like == NULL && r->like_table != NULL)
    abbe_materials_wrong_use(r->program, "--like-table goes with --like");
}

int abbe_materials_nearest(int argc, char **argv) {
  request r = {.program = argv[0],
               .from_nm = ABBE_WAVELENGTH_MIN_NM,
               .to_nm = ABBE_WAVELENGTH_MAX_NM,
               .count = 5};
  abbe_error error = {0};
  abbe_materials_parse(&parser, argc, argv, &r);
  check(&r);
  abbe_material_table table;
  abbe_result result = abbe_material_table_load(r.table, &table, &error);
  if (result == ABBE_OK) result = answer(&r, &table, &error);
  abbe_material_table_free(&table);
  return abbe_command_end(r.program, result, &error);
}
