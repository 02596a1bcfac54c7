#include "scenes/export/export_files.h"

#include "base/file.h"
#include "colorimetry/image/exr.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Quotes and brackets are the formats' own, and LuxCore reads by blanks. */
static bool spellable(const char *name) {
  for (; *name != '\0'; name++)
    if ((unsigned char)*name <= ' ' || strchr("\"'\\<>&|#$", *name) != NULL) return false;
  return true;
}

abbe_result abbe_export_files_begin(abbe_export_files *files, const char *path, abbe_error *error) {
  const char *name = abbe_file_name(path), *dot = strrchr(name, '.');
  if (!spellable(name))
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the name '%.200s' has a blank, a quote or another mark that exported "
                          "files cannot name; give it a plainer name",
                          name);
  const size_t length = dot != NULL && dot > name ? (size_t)(dot - path) : strlen(path);
  files->stem = strndup(path, length);
  if (files->stem == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a path");
  files->name = abbe_file_name(files->stem);
  return ABBE_OK;
}

void abbe_export_files_free(abbe_export_files *files) {
  for (size_t i = 0; i < files->count; i++) {
    free(files->file[i].path);
    free(files->file[i].data);
    abbe_image_free(&files->file[i].picture);
  }
  free(files->file);
  free(files->stem);
  memset(files, 0, sizeof *files);
}

static abbe_result add(abbe_export_files *files, const char *suffix, abbe_export_file **out,
                       abbe_error *error) {
  abbe_export_file *all = realloc(files->file, (files->count + 1) * sizeof *all);
  const size_t size = strlen(files->stem) + strlen(suffix) + 1;
  char *path = malloc(size);
  if (all != NULL) files->file = all;
  if (all == NULL || path == NULL) {
    free(path);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for an exported file");
  }
  snprintf(path, size, "%s%s", files->stem, suffix);
  *out = &files->file[files->count++];
  memset(*out, 0, sizeof **out);
  (*out)->path = path;
  (*out)->fresh = access(path, F_OK) != 0;
  return ABBE_OK;
}

abbe_result abbe_export_files_add(abbe_export_files *files, const char *suffix, char *data,
                                  size_t size, abbe_error *error) {
  abbe_export_file *file = NULL;
  const abbe_result result = add(files, suffix, &file, error);
  if (result != ABBE_OK) {
    free(data);
    return result;
  }
  file->data = data;
  file->size = size;
  return ABBE_OK;
}

abbe_result abbe_export_files_add_picture(abbe_export_files *files, const char *suffix,
                                          abbe_image *picture, abbe_error *error) {
  abbe_export_file *file = NULL;
  const abbe_result result = add(files, suffix, &file, error);
  if (result != ABBE_OK) {
    abbe_image_free(picture);
    return result;
  }
  file->picture = *picture;
  memset(picture, 0, sizeof *picture);
  return ABBE_OK;
}

abbe_result abbe_export_files_write(abbe_export_files *files, abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < files->count && result == ABBE_OK; i++) {
    abbe_export_file *file = &files->file[i];
    result = file->data != NULL ? abbe_file_write(file->path, file->data, file->size, error)
                                : abbe_exr_write(file->path, &file->picture, error);
    file->written = result == ABBE_OK;
  }
  if (result != ABBE_OK) abbe_export_files_undo(files);
  return result;
}

void abbe_export_files_undo(abbe_export_files *files) {
  for (size_t i = 0; i < files->count; i++)
    if (files->file[i].written && files->file[i].fresh) unlink(files->file[i].path);
}
