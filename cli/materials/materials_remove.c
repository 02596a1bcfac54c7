#include "cli/materials/materials.h"

#include <argp.h>
#include <stdio.h>

enum { MAX_NAMES = 256 };

typedef struct request {
  abbe_change change;
  const char *name[MAX_NAMES];
  size_t count;
} request;

static const struct argp_option options[] = {ABBE_CHANGE_OPTIONS, {0}};

static error_t parse(int key, char *arg, struct argp_state *state) {
  request *r = state->input;
  if (abbe_change_option(&r->change, key, arg)) return 0;
  if (key != ARGP_KEY_ARG) return ARGP_ERR_UNKNOWN;
  if (r->count == MAX_NAMES) argp_error(state, "more than %d names", MAX_NAMES);
  r->name[r->count++] = arg;
  return 0;
}

static const struct argp parser = {
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
  abbe_materials_parse(&parser, argc, argv, &r);
  if (r.count == 0) abbe_materials_wrong_use(argv[0], "remove what? Name a material");
  abbe_result result = abbe_change_open(&r.change, &error);
  for (size_t i = 0; i < r.count && result == ABBE_OK; i++)
    result = abbe_table_edit_remove(r.change.edit, r.name[i], &error);
  char what[64];
  snprintf(what, sizeof what, r.count == 1 ? "%zu record is removed" : "%zu records are removed",
           r.count);
  return abbe_change_end(&r.change, result, what, NULL, &error);
}
