#include "cli/materials/materials.h"

#include "base/file.h"
#include "spectral/formats/material_import.h"
#include "spectral/formats/material_write.h"
#include "spectral/materials/material_table.h"
#include "spectral/store/material_store.h"

#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

typedef struct request {
  const char *program, *output;
  abbe_import_batch batch;
  bool json, all, force;
} request;

enum { KEY_FORMAT = ABBE_MATERIALS_KEY_OWN, KEY_UNIT, KEY_THIRD };

static const abbe_option options[] = {
    {"output", 'o', "TABLE", ABBE_ARGUMENT_WRITES,
     "where to: YAML, or a store where it ends in .sqlite; without it, YAML to standard output", 0,
     ABBE_TAKE_BY_KEY},
    {"force", 0, NULL, 0, "write over a file that is there", 0, ABBE_TAKE_FLAG(request, force)},
    {"format", KEY_FORMAT, "FORMAT", 0,
     "agf, rii, csv, yaml, sqlite or mtlx; without it, what the text says", 0, ABBE_TAKE_BY_KEY},
    {"name", 0, "NAME", 0, "of the one material of a file (rii, csv); else the file's", 0,
     ABBE_TAKE_TEXT(request, batch.import.name)},
    {"prefix", 0, "TEXT", 0, "before every name, such as schott-", 0,
     ABBE_TAKE_TEXT(request, batch.prefix)},
    {"source", 0, "TEXT", 0, "where measured points come from (csv)", 0,
     ABBE_TAKE_TEXT(request, batch.import.source)},
    {"unit", KEY_UNIT, "UNIT", 0, "nm or um, of the wavelengths where no header says it (csv)", 0,
     ABBE_TAKE_BY_KEY},
    {"third", KEY_THIRD, "WHAT", 0,
     "k, uncertainty or ignored: the third column where no header says it (csv); k", 0,
     ABBE_TAKE_BY_KEY},
    {"all", 0, NULL, 0, "show every note, not the first of each kind", 0,
     ABBE_TAKE_FLAG(request, all)},
    {"json", 0, NULL, 0, "the notes as JSON, with -o", 0, ABBE_TAKE_FLAG(request, json)},
    {0}};

static void read_csv_option(request *r, int key, const char *arg) {
  static const char *const units[] = {"nm", "um"}, *const thirds[] = {"uncertainty", "k",
                                                                      "ignored"};
  if (key == KEY_UNIT)
    r->batch.import.csv.unit_nm =
        abbe_command_choice(r->program, "--unit", arg, units, 2) == 0 ? 1 : 1000;
  else
    r->batch.import.csv.third =
        (abbe_csv_third)abbe_command_choice(r->program, "--third", arg, thirds, 3);
}

static error_t parse(int key, char *arg, struct argp_state *state) {
  static const char *const formats[] = {"auto", "agf", "rii", "csv", "yaml", "sqlite", "mtlx"};
  request *r = state->input;
  switch (key) {
  case 'o':
    r->output = r->batch.target = arg;
    return 0;
  case KEY_FORMAT:
    r->batch.import.format =
        (abbe_import_format)abbe_command_choice(r->program, "--format", arg, formats, 7);
    return 0;
  case KEY_UNIT:
  case KEY_THIRD:
    read_csv_option(r, key, arg);
    return 0;
  case ARGP_KEY_ARGS:
    r->batch.path = (const char *const *)&state->argv[state->next];
    r->batch.count = (size_t)(state->argc - state->next);
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const abbe_parser parser = {
    .options = options,
    .parse = parse,
    .args_doc = "FILE|FOLDER…",
    .doc = "Makes a material table of catalogues and data files: Zemax AGF, refractiveindex.info "
           "YAML, CSV of measured points, MaterialX, tables and stores of ours.\v"
           "Examples:\n"
           "  abbe materials import schott.agf -o schott.yaml\n"
           "  abbe materials import SiO2/nk/Malitson.yml C/nk/Peter.yml -o gems.yaml\n"
           "  abbe materials import points.csv --name my-glass --source \"prism, 21 June\"\n"
           "  abbe materials import schott.agf ohara.agf -o both.yaml --all\n"
           "  abbe materials import database/data -o rii.sqlite\n\n"
           "A record or a file that cannot be used is reported with the reason and does not stop "
           "the rest. What the table does not carry, or what is assumed, is said as well. Of "
           "folders all files are read that hold materials. Materials of one name from several "
           "files get the part of their path before it that tells them apart.",
};

static void check(const request *r) {
  if (r->batch.count == 0)
    abbe_materials_wrong_use(r->program, "which file? Such as catalogue.agf or points.csv");
  if (r->batch.import.name != NULL && r->batch.count > 1)
    abbe_materials_wrong_use(r->program, "--name names the material of one file, not of several");
  if (r->json && r->output == NULL)
    abbe_materials_wrong_use(r->program, "--json goes with -o TABLE.yaml");
}

static abbe_result load(request *r, abbe_material_table *table, abbe_report *report,
                        abbe_error *error) {
  if (r->output != NULL && !r->force && access(r->output, F_OK) == 0)
    return abbe_error_set(error, ABBE_IO,
                          "%s: is there already; --force writes over it, or choose another name",
                          r->output);
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 20); /* a large file's memory goes back and is not kept */
#endif
  if (r->output != NULL && abbe_material_store_is_name(r->output))
    ABBE_TRY(abbe_material_store_begin(&r->batch.store, error));
  return abbe_import_batch_run(&r->batch, table, report, error);
}

static abbe_result save(const request *r, const abbe_material_table *table, abbe_error *error) {
  if (r->output == NULL) return abbe_material_table_write(table, stdout, error);
  abbe_file_writer writer = {0};
  abbe_result result = abbe_file_writer_open(&writer, r->output, error);
  if (result == ABBE_OK)
    result = r->batch.store != NULL
                 ? abbe_material_store_end(r->batch.store, table, writer.stream, error)
                 : abbe_material_table_write(table, writer.stream, error);
  return abbe_file_writer_end(&writer, result, error);
}

static abbe_result tell(const request *r, const abbe_material_table *table,
                        const abbe_report *report, abbe_error *error) {
  if (!r->json) {
    abbe_materials_print_report(r->program, report, r->all);
    fprintf(stderr, "%s: %zu material%s%s%s\n", r->program, table->count,
            table->count == 1 ? "" : "s", r->output != NULL ? " in " : "",
            r->output != NULL ? r->output : "");
    return ABBE_OK;
  }
  cJSON *root = abbe_materials_json();
  cJSON_AddStringToObject(root, "table", r->output);
  cJSON_AddNumberToObject(root, "materials", (double)table->count);
  abbe_materials_add_report(root, report);
  return abbe_materials_print_json(root, error);
}

int abbe_materials_import(int argc, char **argv) {
  request r = {.program = argv[0], .batch.import.csv.third = ABBE_CSV_K};
  abbe_arguments_parse(&parser, ABBE_ARGUMENT_READS, argc, argv, &r);
  check(&r);
  abbe_error error = {0};
  abbe_report report = {0};
  abbe_material_table table = {0};
  abbe_result result = load(&r, &table, &report, &error);
  if (result == ABBE_OK) result = save(&r, &table, &error);
  if (result == ABBE_OK)
    result = tell(&r, &table, &report, &error);
  else if (!r.json)
    abbe_materials_print_report(r.program, &report, r.all);
  abbe_material_store_drop(r.batch.store);
  abbe_material_table_free(&table);
  abbe_report_free(&report);
  return abbe_command_end(r.program, result, &error);
}
