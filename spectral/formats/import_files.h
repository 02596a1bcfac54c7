/* import_files.h: the files that paths name, folders walked. Internal to spectral/.
 *
 * It knows which endings files of materials have and opens none of them.
 */
#ifndef ABBE_SPECTRAL_FORMATS_IMPORT_FILES_H
#define ABBE_SPECTRAL_FORMATS_IMPORT_FILES_H

#include "base/error.h"
#include "base/report.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct abbe_import_file {
  char *path;
  bool found; /* in a folder; false where it was named */
} abbe_import_file;

/* Zero-initialise. */
typedef struct abbe_import_files {
  size_t count, capacity;
  abbe_import_file *file;
} abbe_import_files;

void abbe_import_files_free(abbe_import_files *files);

/* Adds path, or the files below it where it is a folder, in the order of their names. A folder
 * inside it that cannot be read is a note of kind SKIPPED. ABBE_IO where path is neither a file nor
 * a readable folder; ABBE_INVALID_ARGUMENT for more than 100000 files; ABBE_NO_MEMORY. */
abbe_result abbe_import_files_add(abbe_import_files *files, const char *path, abbe_report *report,
                                  abbe_error *error);

#endif
