#include "cli/materials/materials.h"

#include "spectral/editing/check.h"
#include "spectral/editing/table_edit.h"
#include "spectral/formats/material_import.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct request {
  const char *program, *table, *known, *name;
  bool json, fix, dry_run, all;
} request;

typedef struct counts {
  size_t weight[ABBE_FINDING_WRONG + 1];
} counts;

static counts count(const abbe_findings *found, const abbe_report *unread) {
  counts c = {{0}};
  for (size_t i = 0; i < found->count; i++) c.weight[found->finding[i].weight]++;
  c.weight[ABBE_FINDING_WRONG] += unread->count;
  return c;
}

/* ---- text ---- */

static void print_finding(const abbe_material_table *table, const abbe_finding *f) {
  const abbe_material *m = &table->material[f->row];
  printf("%s (line %zu): %s, %s: %s\n    %s\n    fix: %s\n", m->name, m->line,
         abbe_finding_weight_name(f->weight), abbe_finding_kind_name(f->kind),
         abbe_finding_kind_meaning(f->kind), f->evidence, f->fix);
  if (f->certain) printf("    --fix: %s: %s\n", f->key, f->value);
}

/* Notes of one kind about more rows than this are one line. */
enum { FEW_NOTES = 3 };

static void print_notes(const abbe_material_table *table, const abbe_findings *found,
                        abbe_finding_kind kind, size_t count) {
  size_t named = 0;
  printf("%zu rows (", count);
  for (size_t i = 0; i < found->count && named < FEW_NOTES; i++) {
    const abbe_finding *f = &found->finding[i];
    if (f->kind != kind || f->weight != ABBE_FINDING_NOTE) continue;
    printf("%s, ", table->material[f->row].name);
    named++;
  }
  printf("…): %s, %s: %s; --all tells of each\n", abbe_finding_weight_name(ABBE_FINDING_NOTE),
         abbe_finding_kind_name(kind), abbe_finding_kind_meaning(kind));
}

static void print_findings(const request *r, const abbe_material_table *table,
                           const abbe_findings *found) {
  size_t notes[ABBE_FINDING_KIND_COUNT] = {0};
  for (size_t i = 0; i < found->count; i++)
    notes[found->finding[i].kind] += found->finding[i].weight == ABBE_FINDING_NOTE;
  for (size_t i = 0; i < found->count; i++) {
    const abbe_finding *f = &found->finding[i];
    bool many = f->weight == ABBE_FINDING_NOTE && notes[f->kind] > FEW_NOTES;
    if (!many || r->all) print_finding(table, f);
  }
  for (int k = 0; k < ABBE_FINDING_KIND_COUNT && !r->all; k++)
    if (notes[k] > FEW_NOTES) print_notes(table, found, (abbe_finding_kind)k, notes[k]);
}

static void print_text(const request *r, const abbe_material_table *table,
                       const abbe_findings *found, const abbe_report *unread) {
  for (size_t i = 0; i < unread->count; i++)
    printf("%s (line %zu): wrong, unread: the record cannot be read\n    %s\n",
           unread->note[i].name[0] ? unread->note[i].name : "a record", unread->note[i].line,
           unread->note[i].text);
  print_findings(r, table, found);
  counts c = count(found, unread);
  printf("%s%s: %zu rows, %zu wrong, %zu doubtful, %zu to note\n",
         found->count + unread->count > 0 ? "\n" : "", table->path, table->count + unread->count,
         c.weight[ABBE_FINDING_WRONG], c.weight[ABBE_FINDING_DOUBTFUL],
         c.weight[ABBE_FINDING_NOTE]);
  fflush(stdout); /* what is printed on stderr comes after it, in a pipe too */
}

/* ---- JSON ---- */

static void add_finding(cJSON *list, const abbe_material_table *table, const abbe_finding *f) {
  cJSON *item = cJSON_CreateObject();
  if (item == NULL || !cJSON_AddItemToArray(list, item)) return;
  const abbe_material *m = &table->material[f->row];
  cJSON_AddStringToObject(item, "name", m->name);
  cJSON_AddNumberToObject(item, "line", (double)m->line);
  cJSON_AddStringToObject(item, "weight", abbe_finding_weight_name(f->weight));
  cJSON_AddStringToObject(item, "kind", abbe_finding_kind_name(f->kind));
  cJSON_AddStringToObject(item, "evidence", f->evidence);
  cJSON_AddStringToObject(item, "fix", f->fix);
  cJSON_AddBoolToObject(item, "certain", f->certain);
  abbe_materials_add_text(item, "key", f->key);
  abbe_materials_add_text(item, "value", f->value);
  abbe_materials_add_text(item, "other",
                          f->other == ABBE_FINDING_NO_ROW ? NULL : table->material[f->other].name);
}

static abbe_result print_json(const abbe_material_table *table, const abbe_findings *found,
                              const abbe_report *unread, abbe_error *error) {
  cJSON *root = abbe_materials_json();
  counts c = count(found, unread);
  cJSON_AddStringToObject(root, "table", table->path);
  cJSON_AddNumberToObject(root, "rows", (double)(table->count + unread->count));
  cJSON_AddNumberToObject(root, "wrong", (double)c.weight[ABBE_FINDING_WRONG]);
  cJSON_AddNumberToObject(root, "doubtful", (double)c.weight[ABBE_FINDING_DOUBTFUL]);
  cJSON_AddNumberToObject(root, "notes", (double)c.weight[ABBE_FINDING_NOTE]);
  cJSON *list = cJSON_AddArrayToObject(root, "unread");
  for (size_t i = 0; i < unread->count; i++) {
    cJSON *item = cJSON_CreateObject();
    if (item == NULL || !cJSON_AddItemToArray(list, item)) continue;
    cJSON_AddStringToObject(item, "name", unread->note[i].name);
    cJSON_AddNumberToObject(item, "line", (double)unread->note[i].line);
    cJSON_AddStringToObject(item, "evidence", unread->note[i].text);
  }
  list = cJSON_AddArrayToObject(root, "findings");
  for (size_t i = 0; i < found->count; i++) add_finding(list, table, &found->finding[i]);
  return abbe_materials_print_json(root, error);
}

/* ---- what is asked ---- */

/* All findings are made with the whole table, and those of one row are picked. */
static void keep_row(abbe_findings *found, const abbe_material_table *table,
                     const abbe_material *wanted) {
  size_t kept = 0;
  for (size_t i = 0; i < found->count; i++) {
    abbe_finding f = found->finding[i];
    if (&table->material[f.row] == wanted) {
      found->finding[i] = found->finding[kept];
      found->finding[kept++] = f;
    }
  }
  while (found->count > kept) {
    abbe_finding *last = &found->finding[--found->count];
    free(last->evidence);
    free(last->fix);
    free(last->value);
  }
}

static abbe_result examine(const request *r, const abbe_material_table *known, abbe_error *error) {
  ABBE_OWNED(abbe_material_table, table) = {0};
  ABBE_OWNED(abbe_report, unread) = {0};
  ABBE_OWNED(abbe_findings, found) = {0};
  const abbe_material *one = NULL;
  ABBE_TRY(abbe_material_table_load_lenient(r->table, &table, &unread, error));
  if (r->name != NULL) ABBE_TRY(abbe_material_table_find(&table, r->name, &one, error));
  ABBE_TRY(abbe_check_table(&table, known, &found, error));
  if (one != NULL) {
    keep_row(&found, &table, one);
    abbe_report_free(&unread);
  }
  if (r->json)
    ABBE_TRY(print_json(&table, &found, &unread, error));
  else
    print_text(r, &table, &found, &unread);
  counts c = count(&found, &unread);
  size_t bad = c.weight[ABBE_FINDING_WRONG] + c.weight[ABBE_FINDING_DOUBTFUL];
  if (bad > 0)
    return abbe_error_set(error, ABBE_TOLERANCE, "%zu finding%s in '%s' want%s a look", bad,
                          bad == 1 ? "" : "s", table.path, bad == 1 ? "s" : "");
  return ABBE_OK;
}

static abbe_result fix(const request *r, const abbe_material_table *known, abbe_error *error) {
  ABBE_HELD(abbe_table_edit, edit) = NULL;
  abbe_table_fix made = {0};
  ABBE_TRY(abbe_change_check_table(r->table, error));
  ABBE_TRY(abbe_table_edit_open(r->table, &edit, error));
  ABBE_TRY(abbe_table_fix_make(edit, known, &made, error));
  if (!r->dry_run) ABBE_TRY(abbe_table_edit_save(edit, error));
  fprintf(stderr, "%s: %zu value%s %s\n", r->program, made.fixed, made.fixed == 1 ? "" : "s",
          r->dry_run ? "would be fixed" : "fixed");
  if (made.warned[0] != '\0')
    fprintf(stderr, "%s: %s: the row's own warning stays as it was; see whether it still holds\n",
            r->program, made.warned);
  if (made.refused > 0)
    fprintf(stderr, "%s: %zu could not be: %s\n", r->program, made.refused, made.why);
  return ABBE_OK;
}

/* ---- arguments ---- */

static const abbe_option options[] = {
    ABBE_MATERIALS_TABLE_OPTION(request, table),
    {"known", 0, "FILE", ABBE_ARGUMENT_READS,
     "a table of materials that are known, to compare with; without it, default", 0,
     ABBE_TAKE_TEXT(request, known)},
    {"fix", 0, NULL, 0, "put the fixes that are certain into the file, and check what is left", 0,
     ABBE_TAKE_FLAG(request, fix)},
    {"dry-run", 0, NULL, 0, "with --fix: count what would be fixed, and write nothing", 0,
     ABBE_TAKE_FLAG(request, dry_run)},
    {"all", 0, NULL, 0, "show every note, not one line for many of a kind", 0,
     ABBE_TAKE_FLAG(request, all)},
    ABBE_MATERIALS_JSON_OPTION(request, json),
    ABBE_ARGUMENT(request, name),
    {0}};

static const abbe_parser parser = {
    .options = options,
    .args_doc = "[NAME]",
    .doc = "Looks for what is wrong or doubtful in a table, or in one of its materials.\v"
           "Examples:\n"
           "  abbe materials check --table glasses.yaml\n"
           "  abbe materials check --table glasses.yaml --fix --dry-run\n"
           "  abbe materials check --table glasses.yaml --fix\n"
           "  abbe materials check my-glass --table glasses.yaml\n"
           "  abbe materials check --table thesis\n\n"
           "Each finding has its evidence in numbers and a fix. Ends with 0 where nothing is "
           "wrong or doubtful (notes may be there), with 3 where something is.",
};

int abbe_materials_check(int argc, char **argv) {
  request r = {.program = argv[0]};
  abbe_error error = {0};
  abbe_materials_parse(&parser, argc, argv, &r);
  if (r.dry_run && !r.fix) abbe_materials_wrong_use(r.program, "--dry-run goes with --fix");
  if (r.fix && r.table == NULL)
    abbe_materials_wrong_use(r.program, "--fix changes a file; name it with --table FILE");
  if (r.fix && (r.name != NULL || r.json))
    abbe_materials_wrong_use(r.program, "--fix changes the whole table, and goes without a name "
                                        "and --json");
  abbe_material_table known = {0};
  abbe_result result = abbe_material_table_load(r.known, &known, &error);
  if (result == ABBE_OK && r.fix) result = fix(&r, &known, &error);
  if (result == ABBE_OK && !r.dry_run) result = examine(&r, &known, &error);
  abbe_material_table_free(&known);
  return abbe_command_end(r.program, result, &error);
}
