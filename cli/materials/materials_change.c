#include "cli/materials/materials.h"

#include "base/file.h"
#include "base/yaml/yaml_edit_text.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/spectral_picture/reradiation.h"
#include "spectral/formats/material_import.h"
#include "spectral/formats/material_write.h"
#include "spectral/materials/material_table.h"
#include "spectral/store/material_store.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

/* The options that all of them have. */
#define CHANGE_OPTIONS(request)                                                                    \
  {"table",                                                                                        \
   0,                                                                                              \
   "FILE",                                                                                         \
   ABBE_ARGUMENT_READS,                                                                            \
   "the table file to change",                                                                     \
   0,                                                                                              \
   ABBE_TAKE_TEXT(request, change.table)},                                                         \
  {                                                                                                \
    "dry-run", 0, NULL, 0, "say what the change does to the numbers, and write nothing", 0,        \
        ABBE_TAKE_FLAG(request, change.dry_run)                                                    \
  }

abbe_result abbe_change_check_table(const char *table, abbe_error *error) {
  size_t size;
  if (abbe_material_table_shipped(table, &size) == NULL) return ABBE_OK;
  return abbe_error_set(
      error, ABBE_UNSUPPORTED,
      "the table '%s' is compiled in and cannot be edited; 'abbe materials export "
      "--table %s --to yaml -o FILE' makes a copy of it, 'abbe materials add NAME "
      "--from %s --table FILE --create' of one record",
      table, table, table);
}

/* Opens the table; ends the program with ABBE_EXIT_USAGE where --table was not given. */
static abbe_result change_open(abbe_change *change, abbe_error *error) {
  if (change->table == NULL)
    abbe_materials_wrong_use(change->program, "which table? Name its file with --table FILE");
  ABBE_TRY(abbe_change_check_table(change->table, error));
  return abbe_table_edit_open(change->table, &change->edit, error);
}

static bool is_text(const char *key) {
  static const char *const keys[] = {"description", "source",         "warning",
                                     "comment",     "catalogue.code", "catalogue.status"};
  for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
    if (strcmp(key, keys[i]) == 0) return true;
  return false;
}

static bool ends_with(const char *text, const char *end) {
  const size_t length = strlen(text), own = strlen(end);
  return length > own && strcasecmp(text + length - own, end) == 0;
}

/* A matrix of a picture. */
static abbe_result set_matrix(abbe_table_edit *edit, const char *name, const char *path,
                              abbe_error *error) {
  ABBE_OWNED(abbe_image, image) = {0};
  ABBE_FREED char *text = NULL;
  ABBE_TRY(abbe_exr_read(path, &image, error));
  ABBE_TRY(abbe_reradiation_text(&image, path, &text, error));
  return abbe_table_edit_set(edit, name, "fluorescence", text, error);
}

/* Sets NAME's key as one argument "KEY=VALUE" says; a text key's value is taken as it stands, any
 * other's as YAML. */
static abbe_result change_assign(abbe_table_edit *edit, const char *name, const char *assignment,
                                 abbe_error *error) {
  const char *equals = strchr(assignment, '=');
  if (equals == NULL || equals == assignment)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "'%.80s' sets nothing; write KEY=VALUE, such as temperature_c=20",
                          assignment);
  ABBE_FREED char *key = strndup(assignment, (size_t)(equals - assignment));
  if (key == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for an argument");
  if (strcmp(key, "name") == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a name is changed by 'abbe materials set %.80s name=NEW'", name);
  else if (equals[1] == '\0')
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "'%.80s' has no value; to take the key out, say --unset %.80s",
                          assignment, key);
  else if (strcmp(key, "fluorescence") == 0 && ends_with(equals, ".exr"))
    ABBE_TRY(set_matrix(edit, name, equals + 1, error));
  else if (is_text(key))
    ABBE_TRY(abbe_table_edit_set_text(edit, name, key, equals + 1, error));
  else
    ABBE_TRY(abbe_table_edit_set(edit, name, key, equals + 1, error));
  return ABBE_OK;
}

/* ---- what is printed ---- */

static bool numbers_of(const char *text, size_t size, const char *name,
                       abbe_dispersion_numbers *out) {
  abbe_material_table table;
  const abbe_material *m = NULL;
  bool good = abbe_material_table_parse(text, size, "", &table, NULL) == ABBE_OK &&
              abbe_material_table_find(&table, name, &m, NULL) == ABBE_OK &&
              !abbe_material_is_conductor(m);
  if (good) *out = abbe_materials_numbers(m);
  abbe_material_table_free(&table);
  return good;
}

static void say(const abbe_change *change, const char *what, const char *name,
                const abbe_dispersion_numbers *before) {
  abbe_dispersion_numbers now;
  size_t size = 0;
  const char *text = abbe_table_edit_text(change->edit, &size);
  printf("%s: %s\n", change->table, what);
  if (name == NULL || !numbers_of(text, size, name, &now)) return;
  char t[4][32];
  const char *n_d = abbe_materials_number(t[0], sizeof t[0], "%.6f", now.n_d);
  const char *v_d = abbe_materials_number(t[1], sizeof t[1], "%.3f", now.v_d);
  bool same = before != NULL && memcmp(before, &now, sizeof now) == 0;
  if (before == NULL || same) {
    printf("  n_d %s, V_d %s%s\n", n_d, v_d, same ? ", as before" : "");
    return;
  }
  const char *old_n_d = abbe_materials_number(t[2], sizeof t[2], "%.6f", before->n_d);
  const char *old_v_d = abbe_materials_number(t[3], sizeof t[3], "%.3f", before->v_d);
  printf("  n_d %s -> %s, V_d %s -> %s\n", old_n_d, n_d, old_v_d, v_d);
}

/* Saves, and prints what (a sentence) and the numbers n_d and V_d of record `name` (or NULL) before
 * and after. Says it on stderr where the file is still no table for an older reason. Frees the
 * edit. */
static int change_end(abbe_change *change, abbe_result result, const char *what, const char *name,
                      abbe_error *error) {
  abbe_dispersion_numbers before;
  bool known = false;
  if (result == ABBE_OK) {
    size_t size = 0, new_size = 0;
    const char *old = abbe_table_edit_original(change->edit, &size);
    const char *new = abbe_table_edit_text(change->edit, &new_size);
    if (size == new_size && memcmp(old, new, size) == 0)
      what = "it says so already; nothing is changed";
    known = name != NULL && numbers_of(old, size, name, &before);
    result = abbe_table_edit_allow(change->edit, error);
  }
  if (result == ABBE_OK && !change->dry_run) result = abbe_table_edit_save(change->edit, error);
  if (result == ABBE_OK) say(change, what, name, known ? &before : NULL);
  if (result == ABBE_OK && change->dry_run) puts("  nothing is written");
  abbe_error left = {0};
  if (result == ABBE_OK && abbe_table_edit_check(change->edit, &left) != ABBE_OK)
    fprintf(stderr, "%s: the file is not yet a table that can be used: %s\n", change->program,
            left.text);
  abbe_table_edit_free(change->edit);
  return abbe_command_end(change->program, result, error);
}

enum { MAX_CHANGES = 64, MAX_RECORD = 1 << 20 };

typedef struct request {
  abbe_change change;
  const char *name, *as, *from, *record;
  const char *assign[MAX_CHANGES];
  size_t assign_count;
  bool create;
} request;

static const abbe_option options[] = {
    CHANGE_OPTIONS(request),
    {"from", 0, "TABLE", ABBE_ARGUMENT_READS,
     "copy the record from this table file, or from default or thesis, comments and all", 0,
     ABBE_TAKE_TEXT(request, from)},
    {"as", 0, "NEW", 0, "under this name (with --from)", 0, ABBE_TAKE_TEXT(request, as)},
    {"record", 0, "FILE", ABBE_ARGUMENT_READS,
     "the record itself as YAML, as other verbs print it; - reads it from the input", 0,
     ABBE_TAKE_TEXT(request, record)},
    {"create", 0, NULL, 0, "make the table's file, where there is none yet", 0,
     ABBE_TAKE_FLAG(request, create)},
    {0}};

static error_t parse(int key, char *arg, struct argp_state *state) {
  request *r = state->input;
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

static const abbe_parser parser = {
    .options = options,
    .parse = parse,
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
  ABBE_HELD(abbe_table_edit, source) = NULL;
  ABBE_TRY(shipped != NULL ? abbe_table_edit_parse(shipped, size, r->from, &source, error)
                           : abbe_table_edit_open(r->from, &source, error));
  return abbe_table_edit_record(source, r->name, out, error);
}

static abbe_result copy_record(const request *r, char **out, abbe_error *error) {
  ABBE_TRY(abbe_material_store_is(r->from) ? stored_record(r, out, error)
                                           : tables_record(r, out, error));
  return r->as != NULL ? named(r->name, r->as, out, error) : ABBE_OK;
}

static abbe_result read_record(const char *path, char **out, abbe_error *error) {
  size_t size = 0;
  return strcmp(path, "-") == 0 ? abbe_file_read_input(MAX_RECORD, out, &size, error)
                                : abbe_file_read_text(path, MAX_RECORD, out, &size, error);
}

static abbe_result bare_record(const char *name, char **out, abbe_error *error) {
  char *quoted = NULL;
  ABBE_TRY(abbe_yaml_quote_make(name, &quoted, error));
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
  ABBE_FREED char *record = NULL;
  const char *name = r->as != NULL ? r->as : r->name;
  ABBE_TRY(name != NULL ? check_free(r, name, error) : ABBE_OK);
  ABBE_TRY(r->record != NULL ? read_record(r->record, &record, error)
           : r->from != NULL ? copy_record(r, &record, error)
                             : bare_record(r->name, &record, error));
  ABBE_TRY(abbe_table_edit_add(r->change.edit, record, error));
  for (size_t i = 0; i < r->assign_count; i++)
    ABBE_TRY(change_assign(r->change.edit, name, r->assign[i], error));
  return ABBE_OK;
}

static abbe_result open_table(request *r, abbe_error *error) {
  abbe_error why = {0};
  abbe_result result = change_open(&r->change, &why);
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
  return change_end(&r.change, result, what, name, &error);
}

enum { MAX_NAMES = 256 };

typedef struct materials_remove_request {
  abbe_change change;
  const char *name[MAX_NAMES];
  size_t count;
} materials_remove_request;

static const abbe_option materials_remove_options[] = {CHANGE_OPTIONS(materials_remove_request),
                                                       {0}};

static error_t materials_remove_parse(int key, char *arg, struct argp_state *state) {
  materials_remove_request *r = state->input;
  if (key != ARGP_KEY_ARG) return ARGP_ERR_UNKNOWN;
  if (r->count == MAX_NAMES) argp_error(state, "more than %d names", MAX_NAMES);
  r->name[r->count++] = arg;
  return 0;
}

static const abbe_parser materials_remove_parser = {
    .options = materials_remove_options,
    .parse = materials_remove_parse,
    .args_doc = "NAME…",
    .doc = "Takes records out of a table's file; the rest of it stays byte by byte.\v"
           "Examples:\n"
           "  abbe materials remove k5 --table glasses.yaml --dry-run\n"
           "  abbe materials remove k5 bak4 --table glasses.yaml\n\n"
           "Comments inside a record go with it, those before it stay. The last record stays: a "
           "table wants at least one.",
};

int abbe_materials_remove(int argc, char **argv) {
  static materials_remove_request r;
  r = (materials_remove_request){.change.program = argv[0]};
  abbe_error error = {0};
  abbe_materials_parse(&materials_remove_parser, argc, argv, &r);
  if (r.count == 0) abbe_materials_wrong_use(argv[0], "remove what? Name a material");
  abbe_result result = change_open(&r.change, &error);
  for (size_t i = 0; i < r.count && result == ABBE_OK; i++)
    result = abbe_table_edit_remove(r.change.edit, r.name[i], &error);
  char what[64];
  snprintf(what, sizeof what, r.count == 1 ? "%zu record is removed" : "%zu records are removed",
           r.count);
  return change_end(&r.change, result, what, NULL, &error);
}

enum { MATERIALS_SET_MAX_CHANGES = 64, KEY_UNSET = ABBE_MATERIALS_KEY_OWN };

typedef struct materials_set_request {
  abbe_change change;
  const char *name, *new_name;
  const char *assign[MATERIALS_SET_MAX_CHANGES], *unset[MATERIALS_SET_MAX_CHANGES];
  size_t assign_count, unset_count;
} materials_set_request;

static const abbe_option materials_set_options[] = {
    CHANGE_OPTIONS(materials_set_request),
    {"unset", KEY_UNSET, "KEY", 0, "take the key out of the record; may be repeated", 0,
     ABBE_TAKE_BY_KEY},
    {0}};

static error_t materials_set_parse(int key, char *arg, struct argp_state *state) {
  materials_set_request *r = state->input;
  if (key != ARGP_KEY_ARG && key != KEY_UNSET) return ARGP_ERR_UNKNOWN;
  if (key == ARGP_KEY_ARG && r->name == NULL) {
    r->name = arg;
    return 0;
  }
  if (r->assign_count == MATERIALS_SET_MAX_CHANGES || r->unset_count == MATERIALS_SET_MAX_CHANGES)
    argp_error(state, "more than %d changes", MATERIALS_SET_MAX_CHANGES);
  if (key == KEY_UNSET)
    r->unset[r->unset_count++] = arg;
  else if (strchr(arg, '=') == NULL)
    argp_error(state, "'%s' sets nothing; write KEY=VALUE, such as temperature_c=20", arg);
  else if (strncmp(arg, "name=", 5) == 0)
    r->new_name = arg + 5;
  else
    r->assign[r->assign_count++] = arg;
  return 0;
}

static const abbe_parser materials_set_parser = {
    .options = materials_set_options,
    .parse = materials_set_parse,
    .args_doc = "NAME KEY=VALUE…",
    .doc =
        "Changes values of one record, and not a byte of the rest of the file.\v"
        "Examples:\n"
        "  abbe materials set k5 coefficients.0=1.5090 --table glasses.yaml --dry-run\n"
        "  abbe materials set k5 'coefficients=[1.5090, 0.00459]' --table glasses.yaml\n"
        "  abbe materials set k5 source='own measurement: 3 May' --table glasses.yaml\n"
        "  abbe materials set k5 absorption.distance_m=0.02 --table glasses.yaml\n"
        "  abbe materials set k5 --unset warning --table glasses.yaml\n"
        "  abbe materials set k5 name=k5-hikari --table glasses.yaml\n\n"
        "Keys are those of docs/materials.md; a dot leads into a list or a mapping. Texts are "
        "taken "
        "as they stand, other values as YAML. All changes are made together or not at all: the "
        "result must be a table. A key that is not there yet is put where the format has it. The "
        "file is not written if someone else has changed it meanwhile. A name is unique in its "
        "table, "
        "whatever the case; scenes that use the old one are not changed.",
};

static abbe_result change_all(const materials_set_request *r, abbe_error *error) {
  for (size_t i = 0; i < r->unset_count; i++)
    ABBE_TRY(abbe_table_edit_unset(r->change.edit, r->name, r->unset[i], error));
  for (size_t i = 0; i < r->assign_count; i++)
    ABBE_TRY(change_assign(r->change.edit, r->name, r->assign[i], error));
  if (r->new_name != NULL)
    ABBE_TRY(abbe_table_edit_rename(r->change.edit, r->name, r->new_name, error));
  return ABBE_OK;
}

int abbe_materials_set(int argc, char **argv) {
  materials_set_request r = {.change.program = argv[0]};
  abbe_error error = {0};
  abbe_materials_parse(&materials_set_parser, argc, argv, &r);
  if (r.name == NULL || r.assign_count + r.unset_count + (r.new_name != NULL) == 0)
    abbe_materials_wrong_use(argv[0], r.name == NULL
                                          ? "set what? Name a material, and KEY=VALUE"
                                          : "set it to what? Write KEY=VALUE, or --unset KEY");
  abbe_result result = change_open(&r.change, &error);
  if (result == ABBE_OK) result = change_all(&r, &error);
  char what[240];
  if (r.new_name != NULL)
    snprintf(what, sizeof what, "'%.80s' is now '%.80s'", r.name, r.new_name);
  else
    snprintf(what, sizeof what, "the record '%.80s' is changed", r.name);
  return change_end(&r.change, result, what, r.new_name != NULL ? NULL : r.name, &error);
}
