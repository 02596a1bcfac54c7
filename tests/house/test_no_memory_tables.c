/* Every allocation failing in turn: spectra, material tables, imports, exports, edits, fits. */
#include "tests/faults/operations.h"

#include "spectral/dispersion/fit.h"
#include "spectral/editing/check.h"
#include "spectral/editing/table_edit.h"
#include "spectral/formats/material_import.h"
#include "spectral/formats/material_write.h"
#include "spectral/materials/convert.h"
#include "spectral/materials/material_query.h"
#include "spectral/store/material_store.h"
#include "spectral/wavelengths.h"

#include "base/file.h"

#define CORPUS ABBE_SOURCE_DIR "/tests/fuzz/corpus/"
#define TABLE ABBE_SOURCE_DIR "/tests/fuzz/parts/table.yaml"
#define A "{name: a, model: cauchy, coefficients: [1.5, 0.004], range_nm: [400, 800], source: s}"
#define B "{name: b, model: constant, coefficients: [1.6], source: s}"
#define C "{name: c, model: tabulated, points: [[400, 1.5], [500, 1.4]], source: s}"

static const char small[] = "materials:\n- " A "\n- " B "\n- " C "\n";
static const char other[] = "materials:\n- {name: new, model: constant, coefficients: [2], source: "
                            "s}\n- {name: B2, model: constant, coefficients: [1.6], source: t}\n";

static void digest_table(const abbe_material_table *table) {
  digest(&table->count, sizeof table->count);
  for (size_t i = 0; i < table->count; i++) {
    const double n = abbe_dispersion_n(&table->material[i].dispersion, 550);
    digest_text(table->material[i].name);
    digest_text(table->material[i].source);
    digest(&n, sizeof n);
  }
}

static abbe_result parse(const char *text, abbe_material_table *table, abbe_error *error) {
  return abbe_material_table_parse(text, strlen(text), "t", table, error);
}

static abbe_result load_table(abbe_error *error) {
  OWNED(abbe_material_table, table) = {0};
  const abbe_result result = abbe_material_table_load(TABLE, &table, error);
  if (result == ABBE_OK) digest_table(&table);
  return result;
}

static abbe_result load_shipped(abbe_error *error) {
  OWNED(abbe_material_table, table) = {0};
  const abbe_result result = abbe_material_table_load(NULL, &table, error);
  if (result == ABBE_OK) digest_table(&table);
  return result;
}

static abbe_result import(const char *path, abbe_error *error) {
  OWNED(abbe_material_table, table) = {0};
  OWNED(abbe_report, report) = {0};
  const abbe_result result = abbe_import_load(path, NULL, &table, &report, error);
  if (result == ABBE_OK) digest_table(&table);
  return result;
}

#define IMPORT(name, path)                                                                         \
  static abbe_result import_##name(abbe_error *error) {                                            \
    return import(CORPUS path, error);                                                             \
  }
IMPORT(agf, "agf/maker.agf")
IMPORT(rii, "rii/table.yml")
IMPORT(csv, "csv/plain.csv")
IMPORT(mtlx, "mtlx/shaders.mtlx")

static abbe_result write_as(int kind, const abbe_material_table *table, FILE *to,
                            abbe_error *error) {
  OWNED(abbe_report, report) = {0};
  abbe_result result;
  switch (kind) {
  case 0:
    result = abbe_material_table_write(table, to, error);
    break;
  case 1:
    result = abbe_agf_write(table, to, &report, error);
    break;
  case 2:
    result = abbe_rii_write(&table->material[0], to, &report, error);
    break;
  case 3:
    result = abbe_mtlx_write(table, to, &report, error);
    break;
  default:
    result = abbe_csv_write(&table->material[2], NULL, to, &report, error);
  }
  return result;
}

static abbe_result write_tables(abbe_error *error) {
  OWNED(abbe_material_table, table) = {0};
  abbe_result result = parse(small, &table, error);
  for (int kind = 0; kind < 5 && result == ABBE_OK; kind++) {
    FREED char *text = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&text, &size);
    result = to != NULL ? write_as(kind, &table, to, error)
                        : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a text");
    if (to != NULL) fclose(to);
    if (result == ABBE_OK) digest(text, size);
  }
  return result;
}

static abbe_result store_table(abbe_error *error) {
  static const char *const names[] = {"b", "nobody"};
  OWNED(abbe_material_table, table) = {0}, back = {0};
  const abbe_material *m = NULL;
  abbe_file_writer writer = {0};
  const char *path = operation_path("table.sqlite");
  abbe_result result = parse(small, &table, error);
  if (result == ABBE_OK) result = abbe_file_writer_open(&writer, path, error);
  if (result == ABBE_OK) result = abbe_material_store_write(&table, writer.stream, error);
  if (result == ABBE_OK) result = abbe_file_writer_commit(&writer, error);
  abbe_file_writer_discard(&writer);
  if (result == ABBE_OK) result = abbe_material_table_load(path, &back, error);
  if (result == ABBE_OK) digest_table(&back);
  abbe_material_table_free(&back);
  if (result == ABBE_OK) result = abbe_material_table_load_named(path, names, 2, &back, error);
  if (result == ABBE_OK) digest_table(&back);
  if (result == ABBE_OK) result = abbe_material_table_find(&back, names[1], &m, error);
  if (result == ABBE_NOT_FOUND) result = ABBE_OK;
  return result;
}

static abbe_result import_folder(abbe_error *error) {
  static const char *const paths[] = {CORPUS "agf/maker.agf", CORPUS "rii", CORPUS "agf/wide.agf"};
  const abbe_import_batch batch = {.path = paths, .count = 3, .prefix = "my-"};
  OWNED(abbe_material_table, table) = {0};
  OWNED(abbe_report, report) = {0};
  const abbe_result result = abbe_import_batch_run(&batch, &table, &report, error);
  if (result == ABBE_OK) digest_table(&table);
  return result;
}

/* Glasses of one name, of which two files have one each; with remarks, sources, transmittances. */
static abbe_result import_two(abbe_error *error) {
  static const char agf[] =
      "CC maker\nNM G 2 0 1.5 60\nGC a remark; source: me\nCD 1.2 0.01\nLD 0.3 2\n"
      "IT 0.4 0.9 10\nIT 0.5 0.95 10\n";
  static const char rii[] =
      "COMMENTS: c\nDATA:\n- {type: tabulated nk, data: \"0.4 0.2 3\\n0.5 0.2 3\\n0.6 "
      "0.2 3\\n0.7 0.2 3\"}\n";
  static const char *const names[] = {"a.agf", "b.agf", "G.yml", "p.csv"};
  OWNED(abbe_material_table, table) = {0};
  OWNED(abbe_report, report) = {0};
  const char *paths[4];
  abbe_result result = ABBE_OK;
  for (int i = 0; i < 4; i++) paths[i] = operation_path(names[i]);
  for (int i = 0; i < 2 && result == ABBE_OK; i++)
    result = abbe_file_write(paths[i], agf, sizeof agf - 1, error);
  if (result == ABBE_OK) result = abbe_file_write(paths[2], rii, sizeof rii - 1, error);
  if (result == ABBE_OK) result = abbe_file_write(paths[3], "400,1.5\n500,1.4\n", 16, error);
  const abbe_import_batch batch = {.path = paths, .count = 4};
  if (result == ABBE_OK) result = abbe_import_batch_run(&batch, &table, &report, error);
  if (result == ABBE_OK) digest_table(&table);
  return result;
}

static abbe_result examine(abbe_error *error) {
  OWNED(abbe_material_table, table) = {0}, second = {0};
  OWNED(abbe_findings, findings) = {0};
  const abbe_material_query query = {.sort = ABBE_MATERIAL_KEY_ND};
  FREED size_t *rows = NULL;
  size_t count = 0;
  abbe_result result = parse(small, &table, error);
  const abbe_result both = parse(other, &second, result == ABBE_OK ? error : NULL);
  if (result == ABBE_OK) result = both;
  if (result == ABBE_OK) result = abbe_check_table(&table, &second, &findings, error);
  for (size_t i = 0; i < findings.count && result == ABBE_OK; i++)
    digest_text(findings.finding[i].evidence);
  if (result == ABBE_OK) result = abbe_material_query_run(&table, &query, &rows, &count, error);
  if (result == ABBE_OK) digest(rows, count * sizeof *rows);
  return result;
}

static abbe_result edit_table(abbe_error *error) {
  abbe_table_edit *edit = NULL;
  FREED char *record = NULL;
  const char *path = operation_path("edit.yaml");
  abbe_result result = abbe_file_write(path, small, sizeof small - 1, error);
  if (result == ABBE_OK) result = abbe_table_edit_open(path, &edit, error);
  if (result == ABBE_OK) result = abbe_table_edit_set_text(edit, "b", "source", "new: it", error);
  if (result == ABBE_OK)
    result = abbe_table_edit_set(edit, "a", "coefficients", "[1.6, 0.01]", error);
  if (result == ABBE_OK) result = abbe_table_edit_rename(edit, "b", "d", error);
  if (result == ABBE_OK) result = abbe_table_edit_remove(edit, "c", error);
  if (result == ABBE_OK) result = abbe_table_edit_add(edit, C, error);
  if (result == ABBE_OK) result = abbe_table_edit_set_text(edit, "a", "comment", "it", error);
  if (result == ABBE_OK) result = abbe_table_edit_unset(edit, "a", "comment", error);
  if (result == ABBE_OK) result = abbe_table_edit_record(edit, "a", &record, error);
  if (result == ABBE_OK) result = abbe_table_edit_check(edit, error);
  if (result == ABBE_OK) result = abbe_table_edit_save(edit, error);
  if (result == ABBE_OK) digest_text(record);
  abbe_table_edit_free(edit);
  return result;
}

static abbe_result fix_table(abbe_error *error) {
  static const char wrong[] =
      "materials:\n- {name: a, model: cauchy, coefficients: [1.5, 4000], source: s}\n"
      "- {name: b, model: tabulated, points: [[0.4, 1.5], [0.5, 1.4]], source: s}\n";
  abbe_table_edit *edit = NULL;
  abbe_table_fix fix;
  abbe_result result = abbe_table_edit_parse(wrong, sizeof wrong - 1, "t", &edit, error);
  if (result == ABBE_OK) result = abbe_table_fix_make(edit, NULL, &fix, error);
  if (result == ABBE_OK) digest(&fix.fixed, sizeof fix.fixed);
  abbe_table_edit_free(edit);
  return result;
}

static abbe_result fit(abbe_error *error) {
  OWNED(abbe_material_table, table) = {0};
  OWNED(abbe_index_points, points) = {0};
  abbe_fit made;
  abbe_result result = parse(small, &table, error);
  if (result == ABBE_OK)
    result =
        abbe_index_points_sample(&table.material[0].dispersion, 400, 800, 30, 40, &points, error);
  for (int form = 0; form < 2 && result == ABBE_OK; form++) {
    const abbe_fit_request request = {.form = form ? ABBE_FIT_SELLMEIER : ABBE_FIT_CAUCHY};
    result = abbe_fit_make(&points, &request, &made, error);
    if (result == ABBE_OK) digest(&made.rms, sizeof made.rms);
  }
  return result;
}

static abbe_result convert(abbe_error *error) {
  const abbe_given given = {.first = 1.5, .second = 60};
  OWNED(abbe_material_table, table) = {0};
  abbe_dispersion dispersion;
  abbe_convert_error judged;
  abbe_result result = parse(small, &table, error);
  if (result == ABBE_OK) result = abbe_convert_make(&given, ABBE_FIT_CAUCHY, &dispersion, error);
  if (result == ABBE_OK)
    result = abbe_convert_judge(&given, ABBE_FIT_CAUCHY, &table, 400, 700, &judged, error);
  if (result == ABBE_OK) digest(&judged.largest, sizeof judged.largest);
  return result;
}

static abbe_result small_things(abbe_error *error) {
  static const double nm[] = {400, 500, 600}, value[] = {1, 2, 1};
  abbe_spectrum *spectrum = NULL;
  OWNED(abbe_wavelengths, wavelengths) = {0};
  abbe_result result =
      abbe_spectrum_make(nm, value, 3, ABBE_INTERPOLATION_SPLINE, &spectrum, error);
  if (result == ABBE_OK) result = abbe_wavelengths_make(7, 380, 780, &wavelengths, error);
  abbe_spectrum_free(spectrum);
  return result;
}

GROUP(operation_setup, operation_teardown);

TEST(tables) {
  static const operation list[] = {
      {"load a table", load_table, 0},
      {"load the shipped table", load_shipped, 60},
      {"import AGF", import_agf, 400},
      {"import RII", import_rii, 400},
      {"import CSV", import_csv, 400},
      {"import MaterialX", import_mtlx, 0},
      {"import a folder", import_folder, 200},
      {"import two makers", import_two, 0},
      {"store a table", store_table, 80},
      {"write tables", write_tables, 300},
      {"examine a table", examine, 0},
      {"edit a table", edit_table, 120},
      {"fix a table", fix_table, 500},
      {"fit", fit, 300},
      {"convert", convert, 0},
      {"spectrum, samples", small_things, 0},
  };
  operation_check_all(list, sizeof list / sizeof *list);
}
