#include "cli/materials/materials.h"

#include <argp.h>
#include <stdio.h>

typedef struct request {
  abbe_change change;
  const char *name, *new_name;
} request;

static const struct argp_option options[] = {ABBE_CHANGE_OPTIONS, {0}};

static error_t parse(int key, char *arg, struct argp_state *state) {
  request *r = state->input;
  if (abbe_change_option(&r->change, key, arg)) return 0;
  if (key != ARGP_KEY_ARG) return ARGP_ERR_UNKNOWN;
  if (r->new_name != NULL) argp_error(state, "'%s' is one argument too many", arg);
  if (r->name == NULL)
    r->name = arg;
  else
    r->new_name = arg;
  return 0;
}

static const struct argp parser = {
    .options = options,
    .parser = parse,
    .args_doc = "NAME NEW",
    .doc = "Gives a record of a table another name.\v"
           "Examples:\n"
           "  abbe materials rename k5 k5-hikari --table glasses.yaml\n"
           "  abbe materials rename k5 'K5, Hikari' --table glasses.yaml --dry-run\n\n"
           "A name is unique in its table, whatever the case. Scenes that use the old name are not "
           "changed.",
};

int abbe_materials_rename(int argc, char **argv) {
  request r = {.change.program = argv[0]};
  abbe_error error = {0};
  abbe_materials_parse(&parser, argc, argv, &r);
  if (r.new_name == NULL)
    abbe_materials_wrong_use(argv[0], r.name == NULL ? "rename what? Name a material, and its new "
                                                       "name"
                                                     : "to what? Give the new name too");
  abbe_result result = abbe_change_open(&r.change, &error);
  if (result == ABBE_OK) result = abbe_table_edit_rename(r.change.edit, r.name, r.new_name, &error);
  char what[240];
  snprintf(what, sizeof what, "'%.80s' is now '%.80s'", r.name, r.new_name);
  return abbe_change_end(&r.change, result, what, NULL, &error);
}
