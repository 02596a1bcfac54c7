/* export_files.h: the files that stand beside an exported one: meshes, pictures, settings.
 *
 * They are gathered in memory and written at the end, each beside its target and renamed, before
 * the file that names them. Where one cannot be written, those that were not there before are
 * removed again. Internal to scenes/.
 */
#ifndef ABBE_SCENES_EXPORT_EXPORT_FILES_H
#define ABBE_SCENES_EXPORT_EXPORT_FILES_H

#include "base/error.h"
#include "colorimetry/image/image.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct abbe_export_file {
  char *path;
  char *data; /* NULL: a picture */
  size_t size;
  abbe_image picture;
  bool written, fresh;
} abbe_export_file;

typedef struct abbe_export_files {
  char *stem;       /* the exported file's path without its ending */
  const char *name; /* what of it comes after the last slash */
  size_t count;
  abbe_export_file *file;
} abbe_export_files;

/* Zeroed before. ABBE_UNSUPPORTED for a name that the formats cannot spell, ABBE_NO_MEMORY. */
abbe_result abbe_export_files_begin(abbe_export_files *files, const char *path, abbe_error *error);
void abbe_export_files_free(abbe_export_files *files);

/* Adds the file STEM + suffix: of size bytes of data, or of a picture. Both are taken, whatever the
 * result. ABBE_NO_MEMORY. */
abbe_result abbe_export_files_add(abbe_export_files *files, const char *suffix, char *data,
                                  size_t size, abbe_error *error);
abbe_result abbe_export_files_add_picture(abbe_export_files *files, const char *suffix,
                                          abbe_image *picture, abbe_error *error);

abbe_result abbe_export_files_write(abbe_export_files *files, abbe_error *error);
/* Removes what was written and had not been there. */
void abbe_export_files_undo(abbe_export_files *files);

#endif
