#include "cli/materials/materials.h"

#include "base/file.h"
#include "colorimetry/image/exr.h"
#include "colorimetry/spectral_picture/reradiation.h"
#include "spectral/formats/material_import.h"
#include "spectral/formats/material_write.h"
#include "spectral/store/material_store.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

enum { MAX_NAMES = ABBE_MATERIAL_TABLE_MAX_COUNT };

typedef enum format { YAML, STORE, AGF, RII, CSV, MTLX, EXR, FORMATS } format;

static const char *const format_names[FORMATS] = {"yaml", "sqlite", "agf", "rii",
                                                  "csv",  "mtlx",   "exr"};

typedef struct request {
  const char *program, *table, *output;
  const char *name[MAX_NAMES];
  size_t names;
  int format; /* -1: not given */
  abbe_csv_sampling sampling;
  bool sampled, json, all, force;
} request;

enum { KEY_TO = ABBE_MATERIALS_KEY_OWN, KEY_RANGE, KEY_STEP };

static const abbe_option options[] = {
    ABBE_MATERIALS_TABLE_OPTION(request, table),
    {"to", KEY_TO, "FORMAT", 0,
     "yaml, sqlite, agf, rii, csv, mtlx or exr; without it, by the ending of -o", 0,
     ABBE_TAKE_BY_KEY},
    {"output", 'o', "FILE", ABBE_ARGUMENT_WRITES | ABBE_ARGUMENT_STREAMS,
     "where to; without it or as -, to standard output", 0, ABBE_TAKE_BY_KEY},
    {"force", 0, NULL, 0, "write over a file that is there", 0, ABBE_TAKE_FLAG(request, force)},
    {"range", KEY_RANGE, "FROM:TO", 0, "nm, of the points (csv); 380:780 within the record's", 0,
     ABBE_TAKE_BY_KEY},
    {"step", KEY_STEP, "NM", 0, "between the points (csv); 5", 0, ABBE_TAKE_BY_KEY},
    {"all", 0, NULL, 0, "show every note, not the first of each kind", 0,
     ABBE_TAKE_FLAG(request, all)},
    {"json", 0, NULL, 0, "the notes as JSON, with -o", 0, ABBE_TAKE_FLAG(request, json)},
    {0}};

static error_t parse(int key, char *arg, struct argp_state *state) {
  request *r = state->input;
  switch (key) {
  case KEY_TO:
    r->format = abbe_command_choice(r->program, "--to", arg, format_names, FORMATS);
    return 0;
  case 'o':
    r->output = strcmp(arg, "-") == 0 ? NULL : arg;
    return 0;
  case KEY_RANGE:
    abbe_command_range(r->program, "--range", arg, &r->sampling.min_nm, &r->sampling.max_nm);
    r->sampled = true;
    return 0;
  case KEY_STEP:
    r->sampling.step_nm = abbe_command_number(r->program, "--step", arg, 1e-3, 1e5);
    r->sampled = true;
    return 0;
  case ARGP_KEY_ARG:
    if (r->names == MAX_NAMES) argp_error(state, "more than %d names", MAX_NAMES);
    r->name[r->names++] = arg;
    return 0;
  default:
    return ARGP_ERR_UNKNOWN;
  }
}

static const abbe_parser parser = {
    .options = options,
    .parse = parse,
    .args_doc = "[NAME…]",
    .doc = "Writes materials of a table in other forms: all of them, or those named.\v"
           "Examples:\n"
           "  abbe materials export --table mine.yaml -o mine.agf\n"
           "  abbe materials export ruby n-bk7 -o stones.mtlx\n"
           "  abbe materials export water --to csv --range 400:700 --step 10\n"
           "  abbe materials export sapphire --to rii -o sapphire.yml\n"
           "  abbe materials export ruby-fluorescent -o glow.exr\n"
           "  abbe materials export --to yaml -o my-copy.yaml\n\n"
           "The last makes a copy of the compiled-in table that can be edited. What the form does "
           "not carry, and the error of n that it implies, is said on standard error. rii and csv "
           "hold one material a file, and so does exr, which is its re-radiation matrix alone.",
};

/* By the file's ending; -1 where it says nothing. */
static int format_of(const char *path) {
  static const struct {
    const char *ending;
    int format;
  } endings[] = {{".yaml", YAML}, {".sqlite", STORE}, {".yml", RII}, {".agf", AGF},
                 {".csv", CSV},   {".mtlx", MTLX},    {".exr", EXR}};
  const char *dot = path != NULL ? strrchr(path, '.') : NULL;
  for (size_t i = 0; dot != NULL && i < sizeof endings / sizeof endings[0]; i++)
    if (strcasecmp(dot, endings[i].ending) == 0) return endings[i].format;
  return -1;
}

static void check(request *r) {
  if (r->format < 0) r->format = format_of(r->output);
  if (r->format < 0)
    abbe_materials_wrong_use(
        r->program, "to what? --to yaml, sqlite, agf, rii, csv, mtlx or exr, or -o with such an "
                    "ending; for other renderers 'abbe export' writes a scene");
  if ((r->format == STORE || r->format == EXR) && r->output == NULL)
    abbe_materials_wrong_use(r->program, r->format == STORE
                                             ? "a store is a file; name it with -o FILE.sqlite"
                                             : "a picture is a file; name it with -o FILE.exr");
  if ((r->format == RII || r->format == CSV || r->format == EXR) && r->names != 1)
    abbe_materials_wrong_use(
        r->program, r->format == RII   ? "a file of refractiveindex.info holds one material; name "
                                         "one"
                    : r->format == CSV ? "a CSV file holds one material; name one"
                                       : "a picture holds the re-radiation of one material; name "
                                         "one");
  if (r->sampled && r->format != CSV)
    abbe_materials_wrong_use(r->program, "--range and --step go with --to csv");
  if (r->json && r->output == NULL)
    abbe_materials_wrong_use(r->program, "--json goes with -o FILE");
}

/* The named materials, still owned by the table; `chosen` owns its array alone. */
static abbe_result choose(const request *r, const abbe_material_table *table,
                          abbe_material_table *chosen, abbe_error *error) {
  *chosen = (abbe_material_table){.description = r->names == 0 ? table->description : NULL};
  size_t count = r->names == 0 ? table->count : r->names;
  chosen->material = calloc(count + 1, sizeof *chosen->material);
  if (chosen->material == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu materials", count);
  for (size_t i = 0; i < count; i++) {
    const abbe_material *m = &table->material[i];
    ABBE_TRY(r->names == 0 ? ABBE_OK : abbe_material_table_find(table, r->name[i], &m, error));
    for (size_t k = 0; k < i; k++)
      if (r->names > 0 && strcasecmp(chosen->material[k].name, m->name) == 0)
        return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "'%s' is named twice", m->name);
    chosen->material[chosen->count++] = *m;
  }
  return ABBE_OK;
}

static abbe_result write_to(const request *r, const abbe_material_table *chosen, FILE *to,
                            abbe_report *report, abbe_error *error) {
  switch (r->format) {
  case YAML:
    return abbe_material_table_write(chosen, to, error);
  case STORE:
    return abbe_material_store_write(chosen, to, error);
  case AGF:
    return abbe_agf_write(chosen, to, report, error);
  case RII:
    return abbe_rii_write(&chosen->material[0], to, report, error);
  case MTLX:
    return abbe_mtlx_write(chosen, to, report, error);
  default:
    return abbe_csv_write(&chosen->material[0], &r->sampling, to, report, error);
  }
}

/* The whole answer, or nothing of it. */
static abbe_result print(const request *r, const abbe_material_table *chosen, abbe_report *report,
                         abbe_error *error) {
  char *text = NULL;
  size_t size = 0;
  FILE *to = open_memstream(&text, &size);
  if (to == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the answer");
  abbe_result result = write_to(r, chosen, to, report, error);
  if (fclose(to) != 0 && result == ABBE_OK)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the answer");
  if (result == ABBE_OK) fwrite(text, 1, size, stdout);
  fflush(stdout); /* before the notes */
  free(text);
  return result;
}

static abbe_result save(const request *r, const abbe_material_table *chosen, abbe_report *report,
                        abbe_error *error) {
  if (r->output == NULL) return print(r, chosen, report, error);
  if (!r->force && access(r->output, F_OK) == 0)
    return abbe_error_set(error, ABBE_IO,
                          "%s: is there already; --force writes over it, or choose another name",
                          r->output);
  abbe_image matrix = {0};
  if (r->format == EXR) ABBE_TRY(abbe_reradiation_picture(chosen->material, &matrix, error));
  if (r->format == EXR) {
    const abbe_result written = abbe_exr_write(r->output, &matrix, error);
    abbe_image_free(&matrix);
    return written;
  }
  abbe_file_writer writer = {0};
  abbe_result result = abbe_file_writer_open(&writer, r->output, error);
  if (result == ABBE_OK) result = write_to(r, chosen, writer.stream, report, error);
  return abbe_file_writer_end(&writer, result, error);
}

static abbe_result tell(const request *r, size_t count, const abbe_report *report,
                        abbe_error *error) {
  if (!r->json) {
    abbe_materials_print_report(r->program, report, r->all);
    if (r->output != NULL)
      fprintf(stderr, "%s: %zu material%s in %s\n", r->program,
              count - report->kinds[ABBE_NOTE_SKIPPED], count == 1 ? "" : "s", r->output);
    return ABBE_OK;
  }
  cJSON *root = abbe_materials_json();
  cJSON_AddStringToObject(root, "file", r->output);
  cJSON_AddStringToObject(root, "format", format_names[r->format]);
  cJSON_AddNumberToObject(root, "materials", (double)(count - report->kinds[ABBE_NOTE_SKIPPED]));
  abbe_materials_add_report(root, report);
  return abbe_materials_print_json(root, error);
}

int abbe_materials_export(int argc, char **argv) {
  static request r;
  r = (request){.program = argv[0], .format = -1};
  abbe_materials_parse(&parser, argc, argv, &r);
  check(&r);
  abbe_error error = {0};
  abbe_report report = {0};
  abbe_material_table table = {0}, chosen = {0};
  abbe_result result =
      r.names > 0 ? abbe_material_table_load_named(r.table, r.name, r.names, &table, &error)
                  : abbe_material_table_load(r.table, &table, &error);
  if (result == ABBE_OK) result = choose(&r, &table, &chosen, &error);
  if (result == ABBE_OK) result = save(&r, &chosen, &report, &error);
  if (result == ABBE_OK) result = tell(&r, chosen.count, &report, &error);
  free(chosen.material);
  abbe_material_table_free(&table);
  abbe_report_free(&report);
  return abbe_command_end(r.program, result, &error);
}
