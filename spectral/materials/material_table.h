/* material_table.h: a table of materials, as a text of YAML has it, a record a material.
 *
 * docs/materials.md documents the format; spectral/formats/material_import.h reads files.
 * Errors name file, line, key and value. The shipped tables are compiled in: "default" (published
 * formulas) and "thesis" (the thesis's Table 1, verbatim, historical: its indices are high, see the
 * rows' warnings).
 */
#ifndef ABBE_SPECTRAL_MATERIALS_MATERIAL_TABLE_H
#define ABBE_SPECTRAL_MATERIALS_MATERIAL_TABLE_H

#include "base/error.h"
#include "base/report.h"
#include "spectral/materials/material.h"

#include <stdbool.h>
#include <stddef.h>

enum { ABBE_MATERIAL_TABLE_MAX_COUNT = 10000 };

typedef struct abbe_material_table {
  char *path;        /* file, or "default" or "thesis" */
  char *description; /* what the table is, for people; may be NULL */
  size_t count;
  abbe_material *material;         /* [count], in file order */
  struct abbe_material_table *all; /* if only some rows of a store were read, one of them in vain:
                                      the names of all its rows and no more; else NULL; owned */
} abbe_material_table;

/* The text of a table that is compiled in, as it is in its file: path is NULL, "default" or
 * "thesis"; NULL and 0 for any other. */
const char *abbe_material_table_shipped(const char *path, size_t *size);
/* The table in a text of YAML; name stands for the path in messages. */
abbe_result abbe_material_table_parse(const char *text, size_t size, const char *name,
                                      abbe_material_table *out, abbe_error *error);
/* A table to be examined, not used: records are read as abbe_material_record_read_lenient has it,
 * one that cannot be read even so is noted in report with its line and left out (the table may
 * then be empty), and names may stand twice. */
abbe_result abbe_material_table_parse_lenient(const char *text, size_t size, const char *name,
                                              abbe_material_table *out, abbe_report *report,
                                              abbe_error *error);
void abbe_material_table_free(abbe_material_table *table);

/* Moves the material to the end of the table; *material is zeroed. Neither the record nor its name
 * is checked. ABBE_INVALID_ARGUMENT where the table is full; the material is then as it was. */
abbe_result abbe_material_table_append(abbe_material_table *table, abbe_material *material,
                                       abbe_error *error);

/* Moves all of `from` to the end of `into`, or nothing; its description too where `into` had
 * neither materials nor one. ABBE_INVALID_ARGUMENT where they are more than a table holds. */
abbe_result abbe_material_table_move(abbe_material_table *from, abbe_material_table *into,
                                     abbe_error *error);

/* Drops every material whose name (whatever the case) stands earlier in the table, with a note of
 * kind SKIPPED for each; report may be NULL. */
abbe_result abbe_material_table_unique(abbe_material_table *table, abbe_report *report,
                                       abbe_error *error);

/* The material of that name (case-insensitive), owned by the table. ABBE_NOT_FOUND names the
 * nearest known names. */
abbe_result abbe_material_table_find(const abbe_material_table *table, const char *name,
                                     const abbe_material **out, abbe_error *error);

#endif
