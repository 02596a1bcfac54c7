#include "cli/materials/edit/edit_screen.h"
#include "cli/materials/materials.h"

#include "spectral/formats/material_table_load.h"

#include <argp.h>
#include <stdio.h>

enum { KEY_POINTS = ABBE_MATERIALS_KEY_OWN, KEY_AGAINST, KEY_FROM };

typedef struct request {
  const char *program, *name, *table, *points, *against, *from;
} request;

static const struct argp_option options[] = {
    {"table", ABBE_MATERIALS_KEY_TABLE, "FILE", ABBE_ARGUMENT_READS, "the table file to change", 0},
    {"points", KEY_POINTS, "FILE.csv", ABBE_ARGUMENT_READS,
     "show the difference to these measured points (wavelength, n, uncertainty)", 0},
    {"against", KEY_AGAINST, "NAME", ABBE_ARGUMENT_ONCE, "show the difference to this material", 0},
    {"from", KEY_FROM, "TABLE", ABBE_ARGUMENT_READS, "which is in this table; without it, default",
     0},
    {0}};

static const abbe_take takes[] = {
    ABBE_TAKE_TEXT(request, ABBE_MATERIALS_KEY_TABLE, table),
    ABBE_TAKE_TEXT(request, KEY_POINTS, points),
    ABBE_TAKE_TEXT(request, KEY_AGAINST, against),
    ABBE_TAKE_TEXT(request, KEY_FROM, from),
    ABBE_TAKE_ARGUMENT(request, name),
    {0},
};

static error_t parse(int key, char *arg, struct argp_state *state) {
  if (abbe_take_option(takes, key, arg, state)) return 0;
  return ARGP_ERR_UNKNOWN;
}

static const struct argp parser = {
    .options = options,
    .parser = parse,
    .args_doc = "NAME",
    .doc =
        "Edits a record by hand and eye: its values, the index over wavelength, the difference to "
        "where it comes from, n_d, V_d and warnings, all as you type.\v"
        "Examples:\n"
        "  abbe materials edit k5 --table glasses.yaml\n"
        "  abbe materials edit k5 --table glasses.yaml --against k5\n"
        "  abbe materials edit my-glass --table glasses.yaml --points measured.csv\n\n"
        "Without --points and --against the difference is to the record as it was opened. The keys "
        "stand on the screen's last line; ? explains them. Saving changes this record and not a "
        "byte of the rest; 'abbe materials set' does the same from a script.",
};

static const char *wrong(const request *r) {
  if (r->name == NULL) return "edit what? Name a material";
  if (r->table == NULL) return "in which table? Name its file with --table FILE";
  if (r->points != NULL && r->against != NULL) return "--points goes without --against";
  if (r->from != NULL && r->against == NULL) return "--from goes with --against";
  return NULL;
}

static abbe_result run(const request *r, abbe_edit_screen *screen, abbe_error *error) {
  abbe_edit_end end = abbe_edit_screen_run(screen);
  bool unsaved = abbe_record_draft_is_changed(screen->draft);
  if (end == ABBE_EDIT_NO_TERMINAL)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "there is no terminal to draw on; 'abbe materials set %.80s KEY=VALUE "
                          "--table %.200s' needs none",
                          r->name, r->table);
  if (end == ABBE_EDIT_INTERRUPTED)
    return abbe_error_set(error, ABBE_IO, "interrupted; %s",
                          unsaved ? "what was changed since the last save is lost"
                                  : "there was nothing left to save");
  return ABBE_OK;
}

static abbe_result edit(const request *r, const abbe_material_table *known,
                        const abbe_material_table *from, abbe_error *error) {
  abbe_edit_screen screen = {.path = r->table, .known = known};
  abbe_index_points points = {0};
  abbe_result result = abbe_change_check_table(r->table, error);
  if (result == ABBE_OK && r->points != NULL)
    result = abbe_index_points_load(r->points, &points, error);
  if (result == ABBE_OK && r->against != NULL)
    result = abbe_material_table_find(from, r->against, &screen.source.material, error);
  if (result == ABBE_OK) result = abbe_record_draft_open(r->table, r->name, &screen.draft, error);
  screen.source.points = r->points != NULL ? &points : NULL;
  screen.source.name = r->points != NULL ? r->points : r->against;
  if (result == ABBE_OK) result = run(r, &screen, error);
  abbe_record_draft_free(screen.draft);
  abbe_index_points_free(&points);
  return result;
}

int abbe_materials_edit(int argc, char **argv) {
  request r = {.program = argv[0]};
  abbe_error error = {0};
  abbe_materials_parse(&parser, argc, argv, &r);
  if (wrong(&r) != NULL) abbe_materials_wrong_use(argv[0], wrong(&r));
  abbe_material_table known = {0}, from = {0};
  abbe_result result = abbe_material_table_load(NULL, &known, &error);
  if (result == ABBE_OK && r.against != NULL)
    result = abbe_material_table_load_named(r.from, &r.against, 1, &from, &error);
  if (result == ABBE_OK) result = edit(&r, &known, &from, &error);
  abbe_material_table_free(&known);
  abbe_material_table_free(&from);
  return abbe_command_end(r.program, result, &error);
}
