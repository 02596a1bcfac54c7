#include "spectral/formats/import_files.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

enum { MAX_FILES = 100000, MAX_DEPTH = 32 };

void abbe_import_files_free(abbe_import_files *files) {
  for (size_t i = 0; i < files->count; i++) free(files->file[i].path);
  free(files->file);
  *files = (abbe_import_files){0};
}

static abbe_result no_memory(abbe_error *error) {
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the names of files");
}

/* Takes path over, whatever happens. */
static abbe_result add(abbe_import_files *files, char *path, bool found, abbe_error *error) {
  if (path == NULL) return no_memory(error);
  if (files->count == MAX_FILES) {
    abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                   "there are more than %d files; name folders with fewer", MAX_FILES);
    free(path);
    return ABBE_INVALID_ARGUMENT;
  }
  if (files->count == files->capacity) {
    size_t capacity = files->capacity == 0 ? 16 : 2 * files->capacity;
    abbe_import_file *larger = realloc(files->file, capacity * sizeof *larger);
    if (larger == NULL) {
      free(path);
      return no_memory(error);
    }
    files->file = larger;
    files->capacity = capacity;
  }
  files->file[files->count++] = (abbe_import_file){path, found};
  return ABBE_OK;
}

static bool may_hold_materials(const char *name) {
  static const char *const endings[] = {".agf", ".yml", ".yaml", ".csv", ".sqlite"};
  const char *dot = strrchr(name, '.');
  for (size_t i = 0; dot != NULL && i < sizeof endings / sizeof endings[0]; i++)
    if (strcasecmp(dot, endings[i]) == 0) return true;
  return false;
}

static char *join(const char *folder, const char *name) {
  size_t length = strlen(folder), size = length + strlen(name) + 2;
  const char *slash = length > 0 && folder[length - 1] == '/' ? "" : "/";
  char *path = malloc(size);
  if (path != NULL) snprintf(path, size, "%s%s%s", folder, slash, name);
  return path;
}

static int by_name(const void *a, const void *b) {
  return strcmp(*(char *const *)a, *(char *const *)b);
}

/* The names in a folder, sorted; each and the array are freed by the caller. */
static abbe_result names_in(DIR *dir, char ***out, size_t *count, abbe_error *error) {
  size_t capacity = 0;
  for (struct dirent *entry; (entry = readdir(dir)) != NULL;) {
    if (entry->d_name[0] == '.') continue;
    if (*count == MAX_FILES)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a folder holds more than %d names",
                            MAX_FILES);
    if (*count == capacity) {
      capacity = capacity == 0 ? 32 : 2 * capacity;
      char **larger = realloc(*out, capacity * sizeof *larger);
      if (larger == NULL) return no_memory(error);
      *out = larger;
    }
    char *name = strdup(entry->d_name);
    if (name == NULL) return no_memory(error);
    (*out)[(*count)++] = name;
  }
  if (*count > 0) qsort(*out, *count, sizeof **out, by_name);
  return ABBE_OK;
}

static abbe_result walk(abbe_import_files *files, const char *folder, int depth,
                        abbe_report *report, abbe_error *error);

/* Takes path over. Links to files are followed, those to folders are not: they may lead in a
 * circle. */
static abbe_result visit(abbe_import_files *files, char *path, int depth, abbe_report *report,
                         abbe_error *error) {
  struct stat status;
  if (path == NULL) return no_memory(error);
  bool there = stat(path, &status) == 0;
  if (there && S_ISREG(status.st_mode) && may_hold_materials(path))
    return add(files, path, true, error);
  abbe_result result = ABBE_OK;
  if (there && S_ISDIR(status.st_mode) && lstat(path, &status) == 0 && S_ISDIR(status.st_mode))
    result = walk(files, path, depth + 1, report, error);
  free(path);
  return result;
}

static abbe_result walk(abbe_import_files *files, const char *folder, int depth,
                        abbe_report *report, abbe_error *error) {
  DIR *dir = depth < MAX_DEPTH ? opendir(folder) : NULL;
  if (dir == NULL) {
    const char *why = depth < MAX_DEPTH ? strerror(errno) : "it lies too deep";
    if (depth == 0)
      return abbe_error_set(error, ABBE_IO, "%s: the folder cannot be read: %s", folder, why);
    abbe_report_add(report, ABBE_NOTE_SKIPPED, 0, NULL, "%s: the folder cannot be read: %s", folder,
                    why);
    return ABBE_OK;
  }
  char **names = NULL;
  size_t count = 0;
  abbe_result result = names_in(dir, &names, &count, error);
  closedir(dir);
  for (size_t i = 0; i < count; i++) {
    if (result == ABBE_OK) result = visit(files, join(folder, names[i]), depth, report, error);
    free(names[i]);
  }
  free(names);
  return result;
}

abbe_result abbe_import_files_add(abbe_import_files *files, const char *path, abbe_report *report,
                                  abbe_error *error) {
  struct stat status;
  if (stat(path, &status) != 0)
    return abbe_error_set(error, ABBE_IO, "%s: cannot be opened: %s", path, strerror(errno));
  if (S_ISDIR(status.st_mode)) return walk(files, path, 0, report, error);
  return add(files, strdup(path), false, error);
}
