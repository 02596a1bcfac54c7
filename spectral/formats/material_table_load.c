#include "spectral/formats/material_table_load.h"

#include "base/file.h"
#include "spectral/formats/material_import.h"
#include "spectral/store/material_store.h"

#include <stdbool.h>
#include <stdlib.h>

enum { MAX_BYTES = 16 << 20 };

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
  abbe_result result = abbe_file_read_text(path, MAX_BYTES, &text, &size, error);
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
