#include "spectral/formats/material_import.h"

#include "base/file.h"
#include "base/foreign_text.h"
#include "base/number.h"
#include "spectral/materials/absorption.h"
#include "spectral/store/material_store.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_BYTES = 64 << 20 };

/* ---- what a file is ---- */

static bool begins(const char *line, size_t length, const char *word) {
  size_t count = strlen(word);
  return length >= count && memcmp(line, word, count) == 0;
}

/* What only one format has. */
static abbe_import_format marked(const char *line, size_t length) {
  if (begins(line, length, "NM ") || begins(line, length, "NM\t")) return ABBE_IMPORT_AGF;
  if (begins(line, length, "DATA:")) return ABBE_IMPORT_RII;
  if (begins(line, length, "materials:")) return ABBE_IMPORT_YAML;
  if (begins(line, length, "<?xml")) { /* what follows its end in the same line */
    const char *end = memchr(line, '>', length);
    const size_t used = end != NULL ? (size_t)(end + 1 - line) : length;
    line += used;
    length -= used;
  }
  if (begins(line, length, "<materialx")) return ABBE_IMPORT_MTLX;
  return ABBE_IMPORT_AUTO;
}

/* Two numbers: "20 C" is a remark. */
static abbe_import_format numbered(const char *line, size_t length) {
  static const char between[] = " \t,;\"";
  char start[80];
  double value;
  snprintf(start, sizeof start, "%.*s", (int)(length < 79 ? length : 79), line);
  const char *first = start + strspn(start, between), *end;
  if (!abbe_number_read(first, &end, &value)) return ABBE_IMPORT_AUTO;
  const char *second = end + strspn(end, between);
  return second > end && abbe_number_read(second, &end, &value) ? ABBE_IMPORT_CSV
                                                                : ABBE_IMPORT_AUTO;
}

/* The first line that fits it, among all of them or among those that begin at the margin. */
static abbe_import_format say(const char *text, bool at_margin,
                              abbe_import_format (*kind)(const char *line, size_t length)) {
  for (const char *line = text; *line != '\0';) {
    size_t count = strcspn(line, "\n"), indent = at_margin ? 0 : strspn(line, " \t");
    abbe_import_format found =
        indent < count ? kind(line + indent, count - indent) : ABBE_IMPORT_AUTO;
    if (found != ABBE_IMPORT_AUTO) return found;
    line += count + (line[count] == '\n');
  }
  return ABBE_IMPORT_AUTO;
}

/* Remarks are indented or hold numbers, so that marks at the margin come first, numbers last. */
static abbe_result detect(const char *text, size_t size, abbe_import_format *out,
                          abbe_error *error) {
  static const char store[16] = "SQLite format 3"; /* with its zero */
  char *clean = NULL;
  size_t length = 0;
  bool is_store = size >= sizeof store && memcmp(text, store, sizeof store) == 0;
  *out = is_store ? ABBE_IMPORT_STORE : ABBE_IMPORT_AUTO;
  if (is_store) return ABBE_OK;
  ABBE_TRY(abbe_encoding_decode(text, size, &clean, &length, error));
  *out = say(clean, true, marked);
  if (*out == ABBE_IMPORT_AUTO) *out = say(clean, false, marked);
  if (*out == ABBE_IMPORT_AUTO) *out = say(clean, false, numbered);
  free(clean);
  return ABBE_OK;
}

abbe_import_format abbe_import_detect(const char *text, size_t size) {
  abbe_import_format found;
  detect(text, size, &found, NULL);
  return found;
}

/* ---- points ---- */

static char *text_of(const char *before, const char *path, bool stem) {
  const char *file = abbe_file_name(path), *dot = strrchr(file, '.');
  size_t length = stem && dot != NULL && dot > file ? (size_t)(dot - file) : strlen(file);
  size_t size = strlen(before) + length + 1;
  char *text = malloc(size);
  if (text != NULL) snprintf(text, size, "%s%.*s", before, (int)length, file);
  return text;
}

static abbe_result make_points(const abbe_csv_points *points, const char *path,
                               const abbe_import_options *o, abbe_material *m, abbe_report *report,
                               abbe_error *error) {
  if (points->n.count == 0)
    return abbe_error_set(error, ABBE_SCHEMA,
                          "%s: holds k but no n; a material needs n, in a column of that name",
                          path);
  *m = (abbe_material){.temperature_c = NAN, .line = points->first_line};
  m->name = o->name != NULL ? strdup(o->name) : text_of("", path, true);
  m->source = o->source != NULL ? strdup(o->source) : text_of("measured points in ", path, false);
  if (m->name == NULL || m->source == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory", path);
  m->dispersion.model = ABBE_DISPERSION_TABULATED;
  m->min_nm = points->n.point[0].lambda_nm;
  m->max_nm = points->n.point[points->n.count - 1].lambda_nm;
  bool uncertain = false, absorbs = false;
  for (size_t i = 0; i < points->n.count; i++)
    uncertain = uncertain || points->n.point[i].error > 0;
  for (size_t i = 0; i < points->k.count; i++) absorbs = absorbs || points->k.point[i].value > 0;
  if (uncertain)
    abbe_report_add(report, ABBE_NOTE_LOST, 0, m->name,
                    "a table's points carry no uncertainties; 'abbe materials fit' uses them");
  if (o->source == NULL)
    abbe_report_add(report, ABBE_NOTE_ASSUMED, 0, m->name,
                    "its source is the file; --source TEXT says a better one");
  abbe_result result =
      abbe_points_spectrum(&points->n, ABBE_INTERPOLATION_MONOTONE, &m->dispersion.table, error);
  if (result == ABBE_OK && absorbs)
    result = abbe_absorption_spectrum_of_k(&points->k, &m->attenuation, error);
  bool metal = false;
  if (result == ABBE_OK) result = abbe_conductor_of_metal(&points->n, &points->k, m, &metal, error);
  if (metal)
    abbe_report_add(report, ABBE_NOTE_CHANGED, 0, m->name,
                    "light does not get into it (k is above 0.08 in most of the visible): it is "
                    "taken as a conductor, for mirrors");
  return result == ABBE_OK ? abbe_material_check(m, error) : result;
}

static abbe_result parse_points(const char *bytes, size_t size, const char *path,
                                const abbe_import_options *o, abbe_material *m, abbe_report *report,
                                abbe_error *error) {
  ABBE_OWNED(abbe_csv_points, points) = {0};
  ABBE_TRY(abbe_csv_points_parse(bytes, size, path, &o->csv, &points, report, error));
  return make_points(&points, path, o, m, report, error);
}

/* ---- into the table ---- */

static abbe_result parse_as(abbe_import_format format, const char *bytes, size_t size,
                            const char *path, const abbe_import_options *o,
                            abbe_material_table *into, abbe_report *report, abbe_error *error) {
  abbe_material_table table = {0};
  abbe_material one = {0};
  abbe_result result;
  switch (format) {
  case ABBE_IMPORT_AGF:
    result = abbe_agf_parse(bytes, size, path, &table, report, error);
    break;
  case ABBE_IMPORT_MTLX:
    result = abbe_mtlx_parse(bytes, size, path, &table, report, error);
    break;
  case ABBE_IMPORT_YAML:
    result = abbe_material_table_parse(bytes, size, path, &table, error);
    break;
  case ABBE_IMPORT_STORE:
    result = abbe_error_set(error, ABBE_UNSUPPORTED, "%s: a store is read from its file", path);
    break;
  case ABBE_IMPORT_RII:
    result = abbe_rii_parse(bytes, size, path, o->name, &one, report, error);
    break;
  default:
    result = parse_points(bytes, size, path, o, &one, report, error);
  }
  if (result == ABBE_OK && one.name != NULL) result = abbe_material_table_append(into, &one, error);
  if (result == ABBE_OK) result = abbe_material_table_move(&table, into, error);
  abbe_material_free(&one);
  abbe_material_table_free(&table);
  return result;
}

abbe_result abbe_import_parse(const char *bytes, size_t size, const char *path,
                              const abbe_import_options *options, abbe_material_table *into,
                              abbe_report *report, abbe_error *error) {
  static const abbe_import_options defaults = {0};
  const abbe_import_options *o = options != NULL ? options : &defaults;
  abbe_import_format format = o->format;
  if (format == ABBE_IMPORT_AUTO &&
      detect(bytes, size, &format, error) == ABBE_NO_MEMORY) /* else it is of no known format */
    return ABBE_NO_MEMORY;
  if (format == ABBE_IMPORT_AUTO)
    return abbe_error_set(
        error, ABBE_PARSE,
        "%s: is none of what can be read: a Zemax catalogue has NM lines, a file "
        "of refractiveindex.info 'DATA:', a table of ours 'materials:', MaterialX "
        "'<materialx', points "
        "lines such as 587.6, 1.5168",
        path);
  return parse_as(format, bytes, size, path, o, into, report, error);
}

static abbe_result load_store(const char *path, abbe_material_table *into, abbe_error *error) {
  ABBE_OWNED(abbe_material_table, table) = {0};
  ABBE_TRY(abbe_material_store_read(path, NULL, 0, NULL, &table, error));
  for (size_t i = 0; i < table.count; i++) ABBE_TRY(abbe_material_check(&table.material[i], error));
  return abbe_material_table_move(&table, into, error);
}

abbe_result abbe_import_load(const char *path, const abbe_import_options *options,
                             abbe_material_table *into, abbe_report *report, abbe_error *error) {
  ABBE_FREED char *bytes = NULL;
  size_t size = 0;
  if (abbe_material_store_is(path)) return load_store(path, into, error);
  ABBE_TRY(abbe_file_read_text(path, MAX_BYTES, &bytes, &size, error));
  return abbe_import_parse(bytes, size, path, options, into, report, error);
}

abbe_result abbe_import_explain(const char *path, abbe_result result, abbe_error *error) {
  static const char *const names[ABBE_IMPORT_FORMAT_COUNT] = {
      [ABBE_IMPORT_AGF] = "a Zemax catalogue",
      [ABBE_IMPORT_RII] = "a file of refractiveindex.info",
      [ABBE_IMPORT_CSV] = "a list of points",
      [ABBE_IMPORT_MTLX] = "a MaterialX document"};
  char *bytes = NULL;
  size_t size = 0;
  if (result != ABBE_PARSE && result != ABBE_SCHEMA) return result;
  if (abbe_file_read_text(path, MAX_BYTES, &bytes, &size, NULL) != ABBE_OK) return result;
  const char *name = names[abbe_import_detect(bytes, size)];
  free(bytes);
  if (name == NULL) return result;
  return abbe_error_set(error, result,
                        "%s: is %s, not a table of materials; 'abbe materials import %s -o "
                        "TABLE.yaml' makes one of it",
                        path, name, path);
}

enum { MATERIAL_TABLE_LOAD_MAX_BYTES = 16 << 20 };

static abbe_result parse(const char *text, size_t size, const char *name, bool lenient,
                         abbe_material_table *out, abbe_report *report, abbe_error *error) {
  return lenient ? abbe_material_table_parse_lenient(text, size, name, out, report, error)
                 : abbe_material_table_parse(text, size, name, out, error);
}

static abbe_result load(const char *path, bool lenient, abbe_material_table *out,
                        abbe_report *report, abbe_error *error) {
  *out = (abbe_material_table){0};
  size_t size = 0;
  const char *shipped = abbe_material_table_shipped(path, &size);
  if (shipped != NULL)
    return parse(shipped, size, path == NULL ? "default" : path, lenient, out, report, error);
  if (abbe_material_store_is(path))
    return abbe_material_store_read(path, NULL, 0, report, out, error);
  char *text = NULL;
  abbe_result result =
      abbe_file_read_text(path, MATERIAL_TABLE_LOAD_MAX_BYTES, &text, &size, error);
  if (result == ABBE_OK) result = parse(text, size, path, lenient, out, report, error);
  free(text);
  return abbe_import_explain(path, result, error);
}

abbe_result abbe_material_table_load(const char *path, abbe_material_table *out,
                                     abbe_error *error) {
  return load(path, false, out, NULL, error);
}

abbe_result abbe_material_table_load_lenient(const char *path, abbe_material_table *out,
                                             abbe_report *report, abbe_error *error) {
  return load(path, true, out, report, error);
}

/* Adds the names that are there, for a message about a row that is not. */
static abbe_result add_all_names(abbe_material_table *table, abbe_error *error) {
  table->all = calloc(1, sizeof *table->all);
  if (table->all == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory for its names", table->path);
  return abbe_material_store_read_names(table->path, table->all, error);
}

abbe_result abbe_material_table_load_named(const char *path, const char *const *names, size_t count,
                                           abbe_material_table *out, abbe_error *error) {
  size_t size;
  bool shipped = abbe_material_table_shipped(path, &size) != NULL;
  if (shipped || !abbe_material_store_is(path)) return abbe_material_table_load(path, out, error);
  abbe_result result = abbe_material_store_read(path, names, count, NULL, out, error);
  const abbe_material *m;
  bool missing = false;
  for (size_t i = 0; i < count && result == ABBE_OK; i++)
    missing = missing || abbe_material_table_find(out, names[i], &m, NULL) != ABBE_OK;
  if (result == ABBE_OK && missing) result = add_all_names(out, error);
  if (result != ABBE_OK) abbe_material_table_free(out);
  return result;
}
