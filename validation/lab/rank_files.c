#include "validation/lab/ranked_optimum.h"

#include "base/file.h"

#include <dirent.h>
#include <errno.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

abbe_result abbe_rank_files_name(const char *path, size_t rank, char **out, abbe_error *error) {
  const size_t size = strlen(path) + 32;
  *out = malloc(size);
  if (*out == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a file's name");
  snprintf(*out, size, "%s.%zu", path, rank);
  return ABBE_OK;
}

/* Whether an entry is "FILE.7", spelt as abbe_rank_files_name has it. */
static bool is_rank(const char *entry, const char *file, size_t *rank) {
  const size_t length = strlen(file);
  char own[32];
  if (strncmp(entry, file, length) != 0 || entry[length] != '.') return false;
  *rank = strtoul(entry + length + 1, NULL, 10);
  snprintf(own, sizeof own, "%zu", *rank);
  return strcmp(own, entry + length + 1) == 0;
}

static int ascending(const void *a, const void *b) {
  const size_t x = *(const size_t *)a, y = *(const size_t *)b;
  return (x > y) - (x < y);
}

static abbe_result list(DIR *folder, const char *file, size_t **out, size_t *count,
                        abbe_error *error) {
  size_t rank;
  for (const struct dirent *e; (e = readdir(folder)) != NULL;) {
    if (!is_rank(e->d_name, file, &rank)) continue;
    size_t *more = realloc(*out, (*count + 1) * sizeof *more);
    if (more == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for names of files");
    *out = more;
    more[(*count)++] = rank;
  }
  if (*count > 0) qsort(*out, *count, sizeof **out, ascending);
  return ABBE_OK;
}

abbe_result abbe_rank_files_find(const char *path, size_t **out_rank, size_t *out_count,
                                 abbe_error *error) {
  const char *file = abbe_file_name(path);
  char *folder = strndup(path, (size_t)(file - path));
  *out_rank = NULL;
  *out_count = 0;
  if (folder == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a file's name");
  DIR *open = opendir(folder[0] == '\0' ? "." : folder);
  abbe_result result = open == NULL
                           ? abbe_error_set(error, ABBE_IO, "%s: the folder cannot be read: %s",
                                            folder[0] == '\0' ? "." : folder, strerror(errno))
                           : list(open, file, out_rank, out_count, error);
  if (open != NULL) closedir(open);
  free(folder);
  if (result == ABBE_OK) return ABBE_OK;
  free(*out_rank);
  *out_rank = NULL;
  *out_count = 0;
  return result;
}

void abbe_rank_files_remove(const char *path) {
  size_t *rank = NULL, count = 0;
  if (path == NULL || abbe_rank_files_find(path, &rank, &count, NULL) != ABBE_OK) return;
  for (size_t i = 0; i < count; i++) {
    char *name = NULL;
    if (abbe_rank_files_name(path, rank[i], &name, NULL) == ABBE_OK) unlink(name);
    free(name);
  }
  free(rank);
}
