#include "validation/lab/ranked_optimum.h"

#include "base/clock.h"
#include "base/file.h"
#include "validation/measure/gem/gem_grid_file.h"

#include <assert.h>
#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static size_t pairs_of(const abbe_gem_optimum *o) {
  return o->crowns * o->pavilions;
}

/* What one file knows and the search does not yet: two of them may have a pair. */
static abbe_result take(const char *path, size_t rank, abbe_gem_optimum *o, abbe_error *error) {
  abbe_gem_optimum theirs = *o;
  char *name = NULL;
  theirs.best = 0;
  theirs.value = malloc(pairs_of(o) * sizeof *theirs.value);
  if (theirs.value == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for pairs");
  for (size_t i = 0; i < pairs_of(o); i++) theirs.value[i] = (abbe_gem_number){NAN, NAN};
  abbe_result result = abbe_rank_files_name(path, rank, &name, error);
  if (result == ABBE_OK) result = abbe_gem_grid_file_read(name, &theirs, error);
  for (size_t i = 0; i < pairs_of(o) && result == ABBE_OK; i++)
    if (isnan(o->value[i].value) && !isnan(theirs.value[i].value))
      abbe_gem_optimum_know(o, i, theirs.value[i]);
  free(theirs.value);
  free(name);
  return result;
}

static abbe_result take_all(const char *path, abbe_gem_optimum *o, abbe_error *error) {
  size_t *rank = NULL, count = 0;
  abbe_result result = abbe_rank_files_find(path, &rank, &count, error);
  for (size_t i = 0; i < count && result == ABBE_OK; i++) result = take(path, rank[i], o, error);
  free(rank);
  return result;
}

static abbe_result judge(const abbe_ranked_optimum_desc *d, abbe_gem_optimum *o, size_t i,
                         abbe_error *error) {
  return abbe_gem_optimum_judge(d->cut, d->polyhedron, d->material, d->wavelengths, d->weights,
                                d->search, o, i, error);
}

/* Every count-th of the pairs that nobody has judged, and what was known before, into the rank's
 * file. */
static abbe_result judge_share(const abbe_ranks *r, const abbe_ranked_optimum_desc *d,
                               const char *own, abbe_gem_optimum *o, abbe_error *error) {
  const abbe_gem_optimum_desc *s = d->search;
  const size_t all = abbe_gem_optimum_missing(o, NULL);
  double kept = abbe_clock_seconds();
  abbe_result result = ABBE_OK;
  size_t at = 0;
  for (size_t i = 0; i < pairs_of(o) && result == ABBE_OK; i++) {
    if (!isnan(o->value[i].value) || at++ % r->count != r->rank) continue;
    result = judge(d, o, i, error);
    const double now = abbe_clock_seconds();
    if (result == ABBE_OK && now - kept >= d->keep_s) {
      result = abbe_gem_grid_file_write(own, o, error);
      kept = now;
    }
    if (result == ABBE_OK && s->progress != NULL &&
        !s->progress(s->user, fmin((double)at / (double)all, 1)))
      result = abbe_error_set(error, ABBE_CANCELLED,
                              "stopped; what each rank has judged is kept, and the same command "
                              "goes on");
  }
  if (result != ABBE_OK && result != ABBE_CANCELLED) return result;
  const abbe_result written = abbe_gem_grid_file_write(own, o, error);
  return written == ABBE_OK ? result : written;
}

static abbe_result search(const abbe_ranks *r, const abbe_ranked_optimum_desc *d,
                          abbe_gem_optimum *o, abbe_error *error) {
  char *own = NULL;
  size_t first = 0;
  abbe_result result = abbe_rank_files_name(d->path, r->rank, &own, error);
  if (result == ABBE_OK) result = take_all(d->path, o, error);
  result = abbe_ranks_agree(r, result, error);
  if (result == ABBE_OK) {
    result = judge_share(r, d, own, o, error);
    result = abbe_ranks_agree(r, result, error);
  }
  free(own);
  if (result != ABBE_OK) return result;
  if (r->rank == 0) result = take_all(d->path, o, error);
  const size_t missing = r->rank == 0 ? abbe_gem_optimum_missing(o, &first) : 0;
  if (result == ABBE_OK && missing > 0)
    result = abbe_error_set(error, ABBE_IO,
                            "%zu of %zu pairs are in no rank's file, the first of them pair %zu; "
                            "have all ranks the folder of %s?",
                            missing, pairs_of(o), first, d->path);
  return abbe_ranks_agree(r, result, error);
}

abbe_result abbe_ranked_optimum_find(const abbe_ranks *ranks, const abbe_ranked_optimum_desc *desc,
                                     abbe_gem_optimum *out, abbe_error *error) {
  assert(ranks->most && desc->path && desc->search);
  *out = (abbe_gem_optimum){0};
  abbe_result result =
      abbe_gem_optimum_begin(desc->cut, desc->polyhedron, desc->material, desc->wavelengths,
                             desc->weights, desc->search, out, error);
  result = abbe_ranks_agree(ranks, result, error);
  if (result == ABBE_OK) result = search(ranks, desc, out, error);
  if (result != ABBE_OK || ranks->rank > 0) abbe_gem_optimum_free(out);
  return result;
}

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
