#include "cli/materials/materials.h"

#include "colorimetry/plot/material_chart.h"
#include "spectral/formats/material_import.h"
#include "spectral/materials/partners.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct request {
  const char *program, *table, *name, *third, *map;
  double most_power;
  unsigned long count;
  bool json;
} request;

/* 1e-6/K at e and 20 C, relative to air; NaN where it is not known. */
static double gain_of(const abbe_material *m) {
  double gain[2];
  abbe_material_dn_dt(m, ABBE_LINE_E_NM, 20, gain);
  return 1e6 * gain[0];
}

static double cost_of(const abbe_material *m) {
  const abbe_material_catalogue *c = &m->catalogue;
  return c->rating_count > 0 && c->ratings[0] > 0 ? c->ratings[0] : NAN;
}

static void print_text(const request *r, const abbe_glass_partners *found) {
  const bool three = r->third != NULL;
  int width = 7;
  for (size_t i = 0; i < found->count; i++) {
    const int length = (int)strlen(found->partner[i].material->name);
    if (length > width) width = length;
  }
  printf("Thin lenses of %s, a partner%s%s, f 100 mm at d:\n\n", r->name, three ? " and " : "",
         three ? r->third : "");
  printf("%-*s  %7s  %6s  %9s  %9s%s  %6s  %9s  %6s  %5s  status\n", width, "partner", "V_d",
         "P_gF", "power 1", "power 2", three ? "    power 3" : "", "sum",
         three ? "f_d-f_F mm" : "f_g-f_F mm", "dn/dT", "cost");
  for (size_t i = 0; i < found->count; i++) {
    const abbe_glass_partner *p = &found->partner[i];
    const abbe_material *m = p->material;
    char text[3][32];
    printf("%-*s  %7.2f  %.4f  %9.6f  %9.6f", width, m->name, p->numbers.v_d, p->numbers.p_gF,
           p->power[0], p->power[1]);
    if (three) printf("  %9.6f", p->power[2]);
    printf("  %6.3f  %10.6f  %6s  %5s  %s", p->power_sum, 100 * p->secondary,
           abbe_materials_number(text[0], sizeof text[0], "%.1f", gain_of(m)),
           abbe_materials_number(text[1], sizeof text[1], "%.1f", cost_of(m)),
           m->catalogue.status != NULL ? m->catalogue.status : "-");
    printf(p->doubles > 0 ? ", and %zu of the same index\n" : "\n", p->doubles);
  }
  if (found->skipped > 0) printf("\n%zu have no single index with a P_gF\n", found->skipped);
}

static abbe_result print_json(const request *r, const abbe_glass_partners *found,
                              abbe_error *error) {
  cJSON *root = abbe_materials_json();
  cJSON_AddStringToObject(root, "name", r->name);
  abbe_materials_add_text(root, "with", r->third);
  cJSON_AddNumberToObject(root, "skipped", (double)found->skipped);
  cJSON *list = cJSON_AddArrayToObject(root, "partners");
  for (size_t i = 0; i < found->count; i++) {
    const abbe_glass_partner *p = &found->partner[i];
    cJSON *item = cJSON_CreateObject();
    if (item == NULL || !cJSON_AddItemToArray(list, item)) continue;
    cJSON_AddStringToObject(item, "name", p->material->name);
    cJSON_AddNumberToObject(item, "v_d", p->numbers.v_d);
    cJSON_AddNumberToObject(item, "p_gF", p->numbers.p_gF);
    cJSON_AddItemToObject(item, "powers",
                          cJSON_CreateDoubleArray(p->power, r->third != NULL ? 3 : 2));
    cJSON_AddNumberToObject(item, "power_sum", p->power_sum);
    cJSON_AddNumberToObject(item, "secondary_spectrum", p->secondary);
    cJSON_AddNumberToObject(item, "dn_dt_e_relative_per_k", 1e-6 * gain_of(p->material));
    cJSON_AddNumberToObject(item, "cost", cost_of(p->material));
    abbe_materials_add_text(item, "status", p->material->catalogue.status);
    cJSON_AddNumberToObject(item, "doubles", (double)p->doubles);
  }
  return abbe_materials_print_json(root, error);
}

/* The glass, the third and the partners that are listed, among all of the table. */
static abbe_result draw(const request *r, const abbe_material_table *table,
                        const abbe_material *glass, const abbe_material *third,
                        const abbe_glass_partners *found, abbe_error *error) {
  const abbe_material **marked = calloc(found->count + 2, sizeof *marked);
  size_t count = 0;
  if (marked == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a map");
  marked[count++] = glass;
  if (third != NULL) marked[count++] = third;
  for (size_t i = 0; i < found->count; i++) marked[count++] = found->partner[i].material;
  const abbe_material_map map = {
      .table_count = 1, .table = &table, .marked_count = count, .marked = marked, .partial = true};
  const abbe_result result = abbe_material_map_write(r->map, &map, NULL, error);
  free(marked);
  return result;
}

static abbe_result answer(const request *r, const abbe_material_table *table, abbe_error *error) {
  const abbe_material *glass = NULL, *third = NULL;
  ABBE_OWNED(abbe_glass_partners, found) = {0};
  ABBE_TRY(abbe_material_table_find(table, r->name, &glass, error));
  if (r->third != NULL) ABBE_TRY(abbe_material_table_find(table, r->third, &third, error));
  ABBE_TRY(abbe_glass_partners_find(table, glass, third, r->most_power, &found, error));
  if (found.count > r->count) found.count = r->count;
  if (found.count == 0)
    return abbe_error_set(error, ABBE_NOT_FOUND,
                          "no glass of '%.200s' makes an achromat with %s whose powers' sizes "
                          "have a sum up to %g",
                          table->path, r->name, r->most_power);
  if (r->map != NULL) ABBE_TRY(draw(r, table, glass, third, &found, error));
  if (r->json)
    ABBE_TRY(print_json(r, &found, error));
  else
    print_text(r, &found);
  return ABBE_OK;
}

/* ---- arguments ---- */

static const abbe_option options[] = {
    {"with", 0, "THIRD", 0, "a second glass: F, C and g in one focus by three lenses", 0,
     ABBE_TAKE_TEXT(request, third)},
    {"most-power", 0, "SUM", 0,
     "the largest sum of the powers' sizes, of 1 together; without it, 12", 0,
     ABBE_TAKE_NUMBER(request, most_power, 1, 1e6)},
    {"count", 0, "N", 0, "how many to show; without it, 10", 0,
     ABBE_TAKE_COUNT(request, count, 1, 10000)},
    {"output", 'o', "FILE", ABBE_ARGUMENT_WRITES,
     "also the map of P_gF over V_d with all of them marked; .png or .svg", 0,
     ABBE_TAKE_TEXT(request, map)},
    ABBE_MATERIALS_TABLE_OPTION(request, table),
    ABBE_MATERIALS_JSON_OPTION(request, json),
    ABBE_ARGUMENT(request, name),
    {0}};

static const abbe_parser parser = {
    .options = options,
    .args_doc = "GLASS",
    .doc =
        "Finds the glasses that make an achromat with a glass, by the secondary spectrum.\v"
        "Examples:\n"
        "  abbe materials partners n-bk7\n"
        "  abbe materials partners n-bk7 --with n-sf6 --table schott.yaml\n"
        "  abbe materials partners n-fk51a --table schott.yaml -o map.png\n\n"
        "Of two lenses F and C have one focus, and the secondary spectrum is f_g - f_F; of three "
        "F, C and g have one, and f_d - f_F is left. dn/dT is 1e-6/K at e relative to air, cost "
        "as the catalogue has it.",
};

int abbe_materials_partners(int argc, char **argv) {
  request r = {.program = argv[0], .most_power = 12, .count = 10};
  abbe_error error = {0};
  abbe_materials_parse(&parser, argc, argv, &r);
  if (r.name == NULL) abbe_materials_wrong_use(r.program, "partners of what? Name a glass");
  abbe_material_table table;
  abbe_result result = abbe_material_table_load(r.table, &table, &error);
  if (result == ABBE_OK) result = answer(&r, &table, &error);
  abbe_material_table_free(&table);
  return abbe_command_end(r.program, result, &error);
}
