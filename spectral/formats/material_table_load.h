/* material_table_load.h: a table of materials from where it is: compiled in, a file of YAML, or a
 * store of many.
 *
 * A store is an SQLite file (spectral/store/material_store.h). A catalogue is no table: the error
 * says how it becomes one (spectral/formats/material_import.h).
 */
#ifndef ABBE_SPECTRAL_FORMATS_MATERIAL_TABLE_LOAD_H
#define ABBE_SPECTRAL_FORMATS_MATERIAL_TABLE_LOAD_H

#include "base/error.h"
#include "base/report.h"
#include "spectral/materials/material_table.h"

#include <stddef.h>

/* Loads a table: NULL or "default", "thesis", or the path of a YAML file (at most 16 MiB) or of a
 * store. */
abbe_result abbe_material_table_load(const char *path, abbe_material_table *out, abbe_error *error);
/* The same for a caller that needs these names alone: from a store no other rows are read. Names
 * that it does not have are no failure here; abbe_material_table_find reports each. */
abbe_result abbe_material_table_load_named(const char *path, const char *const *names, size_t count,
                                           abbe_material_table *out, abbe_error *error);
/* A table to be examined, not used, as abbe_material_table_parse_lenient has it. */
abbe_result abbe_material_table_load_lenient(const char *path, abbe_material_table *out,
                                             abbe_report *report, abbe_error *error);

#endif
