/* import_batch.h: materials from many files and whole folders, into one table.
 *
 * Finds the files, hands each to spectral/formats/material_import.h, and keeps materials of one
 * name apart by the files that they come from. A file that cannot be used is noted and does not
 * stop the rest.
 */
#ifndef ABBE_SPECTRAL_FORMATS_IMPORT_BATCH_H
#define ABBE_SPECTRAL_FORMATS_IMPORT_BATCH_H

#include "base/error.h"
#include "base/report.h"
#include "spectral/formats/material_import.h"
#include "spectral/materials/material_table.h"

#include <stddef.h>

typedef struct abbe_import_batch {
  const char *const *path; /* [count] files and folders */
  size_t count;
  const char *prefix; /* stands before every name; NULL: none */
  const char
      *target; /* what the table is to be written to, so none of the files; NULL: not known */
  abbe_import_options import;
} abbe_import_batch;

/* Adds what the files hold to the table, which may be zeroed; report may be NULL. From a folder
 * come, in the order of their names and with the folders in it, those files that end in .agf, .yml,
 * .yaml, .csv or .sqlite and hold materials; hidden ones and links to folders do not.
 *
 * Where several files have a material of one name, each is called FOLDER-NAME or FILE-NAME, after
 * the part of its path by which they differ, with a note of kind RENAMED; where nothing differs,
 * the first stays. One of several files that cannot be read is a note of kind SKIPPED.
 *
 * ABBE_INVALID_ARGUMENT for no path, for import.name with several files, and where the target is
 * one of them; ABBE_IO where a path is neither a file nor a folder: before anything is read. The
 * first file's own failure where no file could be used; ABBE_NO_MEMORY. */
abbe_result abbe_import_batch_run(const abbe_import_batch *batch, abbe_material_table *into,
                                  abbe_report *report, abbe_error *error);

#endif
