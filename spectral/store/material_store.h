/* material_store.h: a table of materials as one SQLite file, for more of them than YAML can hold.
 *
 * Rows are found by name without reading the others. A store is written whole, from a table
 * (spectral/store/material_store.h), and not changed afterwards: what people edit is YAML
 * (spectral/editing/table_edit.h). docs/materials.md describes its columns, which any SQLite
 * program reads.
 */
#ifndef ABBE_SPECTRAL_STORE_MATERIAL_STORE_H
#define ABBE_SPECTRAL_STORE_MATERIAL_STORE_H

#include "base/error.h"
#include "base/report.h"
#include "spectral/materials/material_table.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Whether a regular file stands at path that begins as SQLite's do. */
bool abbe_material_store_is(const char *path);
/* Reads the rows of those names (whatever the case; one that is not there is left out), or with
 * names NULL all rows, in the order in which they were written; a material's line is its row,
 * from 1. With unread a row that cannot be read is noted there and left out, else it is
 * ABBE_SCHEMA. Of all rows it is not tried whether their formulas have an index over their ranges,
 * as abbe_material_check does for those of names. ABBE_IO; ABBE_PARSE where the file is damaged or
 * not a store of this version; ABBE_NO_MEMORY. */
abbe_result abbe_material_store_read(const char *path, const char *const *names, size_t count,
                                     abbe_report *unread, abbe_material_table *out,
                                     abbe_error *error);

/* All rows, but only the name of each: for lists and messages, not to be used. */
abbe_result abbe_material_store_read_names(const char *path, abbe_material_table *out,
                                           abbe_error *error);

/* A table of materials into a store (spectral/store/material_store.h). */

/* Whether a file of this name is to be a store: it ends in .sqlite. */
bool abbe_material_store_is_name(const char *path);

/* Writes the table to the stream; it is made in a file without a name before, in the folder TMPDIR
 * or /tmp. ABBE_INVALID_ARGUMENT for a material that abbe_material_check does not pass and for a
 * name that stands twice (whatever the case); ABBE_IO where a file fails; ABBE_NO_MEMORY. */
abbe_result abbe_material_store_write(const abbe_material_table *table, FILE *to,
                                      abbe_error *error);

/* The same row by row, of more than memory holds. begin; put of each, which abbe_material_check has
 * passed and of which its name, line and row alone stay in memory; end with the table of those that
 * are kept, by the names that they have by then, each once. drop frees it at any time. */
typedef struct abbe_material_store_maker abbe_material_store_maker;
abbe_result abbe_material_store_begin(abbe_material_store_maker **out, abbe_error *error);
abbe_result abbe_material_store_put(abbe_material_store_maker *maker, abbe_material *material,
                                    abbe_error *error);
abbe_result abbe_material_store_end(abbe_material_store_maker *maker,
                                    const abbe_material_table *table, FILE *to, abbe_error *error);
void abbe_material_store_drop(abbe_material_store_maker *maker);

#endif
