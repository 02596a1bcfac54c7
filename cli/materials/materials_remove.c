#include "cli/materials/materials.h"

#include <argp.h>
#include <stdio.h>

enum { MAX_NAMES = 256 };

typedef struct request {
  abbe_change change;
  const char *name[MAX_NAMES];
  size_t count;
  bool renames; /* a name and its new one, no others */
} request;

static const struct argp_option options[] = {ABBE_CHANGE_OPTIONS, {0}};

static error_t parse(int key, char *arg, struct argp_state *state) {
  request *r = state->input;
  if (abbe_change_option(&r->change, key, arg)) return 0;
  if (key != ARGP_KEY_ARG) return ARGP_ERR_UNKNOWN;
  if (r->renames && r->count == 2) argp_error(state, "'%s' is one argument too many", arg);
  if (r->count == MAX_NAMES) argp_error(state, "more than %d names", MAX_NAMES);
  r->name[r->count++] = arg;
  return 0;
}

static const struct argp remove_parser = {
    .options = options,
    .parser = parse,
    .args_doc = "NAME…",
    .doc = "Takes records out of a table's file; the rest of it stays byte by byte.\v"
           "Examples:\n"
           "  abbe materials remove k5 --table glasses.yaml --dry-run\n"
           "  abbe materials remove k5 bak4 --table glasses.yaml\n\n"
           "Comments inside a record go with it, those before it stay. The last record stays: a "
           "table wants at least one.",
};

int abbe_materials_remove(int argc, char **argv) {
  static request r;
  r = (request){.change.program = argv[0]};
  abbe_error error = {0};
  abbe_materials_parse(&remove_parser, argc, argv, &r);
  if (r.count == 0) abbe_materials_wrong_use(argv[0], "remove what? Name a material");
  abbe_result result = abbe_change_open(&r.change, &error);
  for (size_t i = 0; i < r.count && result == ABBE_OK; i++)
    result = abbe_table_edit_remove(r.change.edit, r.name[i], &error);
  char what[64];
  snprintf(what, sizeof what, r.count == 1 ? "%zu record is removed" : "%zu records are removed",
           r.count);
  return abbe_change_end(&r.change, result, what, NULL, &error);
}

static const struct argp rename_parser = {
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
  static request r;
  r = (request){.change.program = argv[0], .renames = true};
  abbe_error error = {0};
  abbe_materials_parse(&rename_parser, argc, argv, &r);
  if (r.count < 2)
    abbe_materials_wrong_use(argv[0], r.count == 0 ? "rename what? Name a material, and its new "
                                                     "name"
                                                   : "to what? Give the new name too");
  abbe_result result = abbe_change_open(&r.change, &error);
  if (result == ABBE_OK)
    result = abbe_table_edit_rename(r.change.edit, r.name[0], r.name[1], &error);
  char what[240];
  snprintf(what, sizeof what, "'%.80s' is now '%.80s'", r.name[0], r.name[1]);
  return abbe_change_end(&r.change, result, what, NULL, &error);
}
