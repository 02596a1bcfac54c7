#include "cli/materials/materials.h"

#include "base/file.h"
#include "base/yaml/yaml_edit.h"
#include "base/yaml/yaml_quote.h"
#include "spectral/formats/material_table_load.h"
#include "spectral/formats/material_write.h"
#include "spectral/store/material_store.h"

#include <argp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MAX_CHANGES = 64, MAX_RECORD = 1 << 20 };
enum { KEY_FROM = ABBE_CHANGE_KEY_OWN, KEY_AS, KEY_RECORD, KEY_CREATE };

typedef struct request {
  abbe_change change;
  const char *name, *as, *from, *record;
  const char *assign[MAX_CHANGES];
  size_t assign_count;
  bool create;
} request;

static const struct argp_option options[] = {
    ABBE_CHANGE_OPTIONS,
    {"from", KEY_FROM, "TABLE", ABBE_ARGUMENT_READS,
     "copy the record from this table file, or from default or thesis, comments and all", 0},
    {"as", KEY_AS, "NEW", 0, "under this name (with --from)", 0},
    {"record", KEY_RECORD, "FILE", ABBE_ARGUMENT_READS,
     "the record itself as YAML, as other verbs print it; - reads it from the input", 0},
    {"create", KEY_CREATE, NULL, 0, "make the table's file, where there is none yet", 0},
    {0}};

static const abbe_take takes[] = {
    ABBE_TAKE_TEXT(request, KEY_FROM, from),
    ABBE_TAKE_TEXT(request, KEY_AS, as),
    ABBE_TAKE_TEXT(request, KEY_RECORD, record),
    ABBE_TAKE_FLAG(request, KEY_CREATE, create),
    {0},
};

static error_t parse(int key, char *arg, struct argp_state *state) {
  request *r = state->input;
  if (abbe_change_option(&r->change, key, arg)) return 0;
  if (abbe_take_option(takes, key, arg, state)) return 0;
  switch (key) {
  case ARGP_KEY_ARG:
    if (r->name == NULL && strchr(arg, '=') == NULL) {
      r->name = arg;
      return 0;
    }
    if (strchr(arg, '=') == NULL)
      argp_error(state, "'%s' sets nothing; write KEY=VALUE, such as temperature_c=20", arg);
    if (r->assign_count == MAX_CHANGES) argp_error(state, "more than %d values", MAX_CHANGES);
    r->assign[r->assign_count++] = arg;
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const struct argp parser = {
    .options = options,
    .parser = parse,
    .args_doc = "NAME KEY=VALUE…\nNAME --from TABLE [KEY=VALUE…]\n--record FILE",
    .doc = "Adds a record at the end of a table's file; the rest of it stays byte by byte.\v"
           "Examples:\n"
           "  abbe materials add n-bk7 --from default --table glasses.yaml --create\n"
           "  abbe materials add my-glass model=cauchy 'coefficients=[1.509, 0.0046]' \\\n"
           "      'range_nm=[400, 700]' source='own measurement' --table glasses.yaml\n"
           "  abbe materials add n-bk7 --from default --as my-bk7 source='melt 12' \\\n"
           "      --table glasses.yaml --dry-run\n"
           "  abbe materials add --record new.yaml --table glasses.yaml\n\n"
           "Keys are those of docs/materials.md; values given with --from replace those copied.",
};

static const char *wrong(const request *r) {
  if (r->record != NULL && (r->name != NULL || r->from != NULL || r->as != NULL))
    return "--record goes without a NAME, --from and --as: the record has its name";
  if (r->record == NULL && r->name == NULL)
    return "add what? Name the new material, or say --record";
  if (r->as != NULL && r->from == NULL) return "--as goes with --from; NAME is the name otherwise";
  if (r->record == NULL && r->from == NULL && r->assign_count == 0)
    return "what is it made of? Write KEY=VALUE for its keys, or copy it with --from TABLE";
  if (r->record != NULL && r->assign_count > 0)
    return "--record goes without KEY=VALUE; change the record with 'abbe materials set' after";
  return NULL;
}

/* ---- the record's text ---- */

/* The same record under another name. */
static abbe_result named(const char *name, const char *new_name, char **record, abbe_error *error) {
  static const char none[] = "materials:\n";
  abbe_table_edit *alone = NULL;
  abbe_result result = abbe_table_edit_parse(none, strlen(none), "the copy", &alone, error);
  if (result == ABBE_OK) result = abbe_table_edit_add(alone, *record, error);
  if (result == ABBE_OK) result = abbe_table_edit_rename(alone, name, new_name, error);
  free(*record);
  *record = NULL;
  if (result == ABBE_OK) result = abbe_table_edit_record(alone, new_name, record, error);
  abbe_table_edit_free(alone);
  return result;
}

/* A store's record as it stands in YAML. */
static abbe_result stored_record(const request *r, char **out, abbe_error *error) {
  abbe_material_table table;
  const abbe_material *m = NULL;
  size_t size = 0;
  abbe_result result = abbe_material_table_load_named(r->from, &r->name, 1, &table, error);
  if (result == ABBE_OK) result = abbe_material_table_find(&table, r->name, &m, error);
  FILE *to = result == ABBE_OK ? open_memstream(out, &size) : NULL;
  if (result == ABBE_OK && to == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a record");
  if (result == ABBE_OK) result = abbe_material_write(m, to, error);
  if (to != NULL && fclose(to) != 0 && result == ABBE_OK)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a record");
  abbe_material_table_free(&table);
  return result;
}

static abbe_result tables_record(const request *r, char **out, abbe_error *error) {
  size_t size = 0;
  const char *shipped = abbe_material_table_shipped(r->from, &size);
  abbe_table_edit *source = NULL;
  abbe_result result = shipped != NULL
                           ? abbe_table_edit_parse(shipped, size, r->from, &source, error)
                           : abbe_table_edit_open(r->from, &source, error);
  if (result == ABBE_OK) result = abbe_table_edit_record(source, r->name, out, error);
  abbe_table_edit_free(source);
  return result;
}

static abbe_result copy_record(const request *r, char **out, abbe_error *error) {
  abbe_result result =
      abbe_material_store_is(r->from) ? stored_record(r, out, error) : tables_record(r, out, error);
  return result == ABBE_OK && r->as != NULL ? named(r->name, r->as, out, error) : result;
}

static abbe_result read_record(const char *path, char **out, abbe_error *error) {
  size_t size = 0;
  return strcmp(path, "-") == 0 ? abbe_file_read_input(MAX_RECORD, out, &size, error)
                                : abbe_file_read_text(path, MAX_RECORD, out, &size, error);
}

static abbe_result bare_record(const char *name, char **out, abbe_error *error) {
  char *quoted = NULL;
  abbe_result result = abbe_yaml_quote_make(name, &quoted, error);
  if (result != ABBE_OK) return result;
  size_t size = strlen(quoted) + 8;
  *out = malloc(size);
  if (*out != NULL) snprintf(*out, size, "name: %s", quoted);
  free(quoted);
  return *out != NULL ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a record");
}

static abbe_result check_free(const request *r, const char *name, abbe_error *error) {
  char *text = NULL;
  if (abbe_table_edit_record(r->change.edit, name, &text, NULL) != ABBE_OK) return ABBE_OK;
  free(text);
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "%s: has a material '%.80s' already; 'abbe materials set' changes it, and "
                        "'--from TABLE --as NEW' copies one under another name",
                        r->change.table, name);
}

static abbe_result add(const request *r, abbe_error *error) {
  char *record = NULL;
  const char *name = r->as != NULL ? r->as : r->name;
  abbe_result result = name != NULL ? check_free(r, name, error) : ABBE_OK;
  if (result != ABBE_OK) return result;
  result = r->record != NULL ? read_record(r->record, &record, error)
           : r->from != NULL ? copy_record(r, &record, error)
                             : bare_record(r->name, &record, error);
  if (result == ABBE_OK) result = abbe_table_edit_add(r->change.edit, record, error);
  free(record);
  for (size_t i = 0; i < r->assign_count && result == ABBE_OK; i++)
    result = abbe_change_assign(r->change.edit, name, r->assign[i], error);
  return result;
}

static abbe_result open_table(request *r, abbe_error *error) {
  abbe_error why = {0};
  abbe_result result = abbe_change_open(&r->change, &why);
  const bool there = access(r->change.table, F_OK) == 0;
  if (result == ABBE_IO && !there && r->create)
    return abbe_table_edit_make(r->change.table, &r->change.edit, error);
  if (result == ABBE_IO && !there)
    return abbe_error_set(error, result, "%s; --create makes a new table", why.text);
  if (result != ABBE_OK) return abbe_error_set(error, result, "%s", why.text);
  return ABBE_OK;
}

int abbe_materials_add(int argc, char **argv) {
  request r = {.change.program = argv[0]};
  abbe_error error = {0};
  abbe_materials_parse(&parser, argc, argv, &r);
  if (wrong(&r) != NULL) abbe_materials_wrong_use(argv[0], wrong(&r));
  abbe_result result = open_table(&r, &error);
  if (result == ABBE_OK) result = add(&r, &error);
  char what[160] = "a record is added";
  const char *name = r.as != NULL ? r.as : r.name;
  if (name != NULL) snprintf(what, sizeof what, "the record '%.80s' is added", name);
  return abbe_change_end(&r.change, result, what, name, &error);
}
