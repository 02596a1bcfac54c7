#include "cli/materials/materials.h"

#include <argp.h>
#include <stdio.h>
#include <string.h>

enum { MAX_CHANGES = 64, KEY_UNSET = ABBE_CHANGE_KEY_OWN };

typedef struct request {
  abbe_change change;
  const char *name, *new_name;
  const char *assign[MAX_CHANGES], *unset[MAX_CHANGES];
  size_t assign_count, unset_count;
} request;

static const struct argp_option options[] = {
    ABBE_CHANGE_OPTIONS,
    {"unset", KEY_UNSET, "KEY", 0, "take the key out of the record; may be repeated", 0},
    {0}};

static error_t parse(int key, char *arg, struct argp_state *state) {
  request *r = state->input;
  if (abbe_change_option(&r->change, key, arg)) return 0;
  if (key != ARGP_KEY_ARG && key != KEY_UNSET) return ARGP_ERR_UNKNOWN;
  if (key == ARGP_KEY_ARG && r->name == NULL) {
    r->name = arg;
    return 0;
  }
  if (r->assign_count == MAX_CHANGES || r->unset_count == MAX_CHANGES)
    argp_error(state, "more than %d changes", MAX_CHANGES);
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

static const struct argp parser = {
    .options = options,
    .parser = parse,
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

static abbe_result change_all(const request *r, abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < r->unset_count && result == ABBE_OK; i++)
    result = abbe_table_edit_unset(r->change.edit, r->name, r->unset[i], error);
  for (size_t i = 0; i < r->assign_count && result == ABBE_OK; i++)
    result = abbe_change_assign(r->change.edit, r->name, r->assign[i], error);
  if (result == ABBE_OK && r->new_name != NULL)
    result = abbe_table_edit_rename(r->change.edit, r->name, r->new_name, error);
  return result;
}

int abbe_materials_set(int argc, char **argv) {
  request r = {.change.program = argv[0]};
  abbe_error error = {0};
  abbe_materials_parse(&parser, argc, argv, &r);
  if (r.name == NULL || r.assign_count + r.unset_count + (r.new_name != NULL) == 0)
    abbe_materials_wrong_use(argv[0], r.name == NULL
                                          ? "set what? Name a material, and KEY=VALUE"
                                          : "set it to what? Write KEY=VALUE, or --unset KEY");
  abbe_result result = abbe_change_open(&r.change, &error);
  if (result == ABBE_OK) result = change_all(&r, &error);
  char what[240];
  if (r.new_name != NULL)
    snprintf(what, sizeof what, "'%.80s' is now '%.80s'", r.name, r.new_name);
  else
    snprintf(what, sizeof what, "the record '%.80s' is changed", r.name);
  return abbe_change_end(&r.change, result, what, r.new_name != NULL ? NULL : r.name, &error);
}
