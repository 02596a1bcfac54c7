/* material_import.h: materials from files of any kind that is read, into one table.
 *
 * Finds out what a file is and calls spectral/formats/agf.h, rii.h, csv_points.h or material_table.h. What
 * could not be used is noted and does not stop the rest.
 */
#ifndef ABBE_SPECTRAL_FORMATS_MATERIAL_IMPORT_H
#define ABBE_SPECTRAL_FORMATS_MATERIAL_IMPORT_H

#include "base/error.h"
#include "base/report.h"
#include "spectral/dispersion/csv_points.h"
#include "spectral/materials/material_table.h"

#include <stddef.h>

/* X(code, name, what it is). */
#define ABBE_IMPORT_FORMATS(X)                                                                     \
  X(AUTO, "auto", "what the file's own text says")                                                 \
  X(AGF, "agf", "a Zemax glass catalogue")                                                         \
  X(RII, "rii", "a file of refractiveindex.info")                                                  \
  X(CSV, "csv", "measured points: wavelength, n, and k or uncertainty")                            \
  X(YAML, "yaml", "a table of ours")                                                               \
  X(STORE, "sqlite", "a store of ours")

typedef enum abbe_import_format {
#define ABBE_IMPORT_ENUM(code, name, text) ABBE_IMPORT_##code,
  ABBE_IMPORT_FORMATS(ABBE_IMPORT_ENUM)
#undef ABBE_IMPORT_ENUM
      ABBE_IMPORT_FORMAT_COUNT
} abbe_import_format;

/* Zero: found out, named after the file. */
typedef struct abbe_import_options {
  abbe_import_format format;
  const char *name;   /* of the one material that a file of RII or CSV holds; NULL: the file's */
  const char *source; /* of measured points; NULL: "measured points in FILE" */
  abbe_csv_options csv;
} abbe_import_options;

const char *abbe_import_format_name(abbe_import_format format);

/* What the bytes are: STORE where they begin as SQLite's; AGF where a line begins with NM, RII with
 * DATA:, YAML with materials:. The first such line decides, one at the margin before one that is
 * indented, as remarks are. Else CSV where a line begins with two numbers, else AUTO. */
abbe_import_format abbe_import_detect(const char *text, size_t size);

/* Adds the materials of size bytes to the table, which may be zeroed; path stands for the file.
 * Points become a tabulated material, monotone between them. Names that stand there already are not
 * looked for: see abbe_material_table_unique. On failure the table is as it was. */
abbe_result abbe_import_parse(const char *bytes, size_t size, const char *path,
                              const abbe_import_options *options, abbe_material_table *into,
                              abbe_report *report, abbe_error *error);
/* The same from a file of at most 64 MiB; a store is read from a file alone, of any size. */
abbe_result abbe_import_load(const char *path, const abbe_import_options *options,
                             abbe_material_table *into, abbe_report *report, abbe_error *error);

/* After a table could not be read with `result`: where the file at path is a catalogue, a file of
 * refractiveindex.info or a list of points, error says so and how it becomes a table; else it stays
 * as it is. Returns result. */
abbe_result abbe_import_explain(const char *path, abbe_result result, abbe_error *error);

#endif
