#include "spectral/formats/material_import.h"

#include "base/error.h"
#include "base/file.h"
#include "base/report.h"
#include "base/text.h"
#include "spectral/store/material_store.h"

#include <dirent.h>
#include <errno.h>
#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

/* The files that paths name, those in folders included.
 * It knows which endings files of materials have and opens none of them. */

typedef struct abbe_import_file {
  char *path;
  bool found; /* in a folder; false where it was named */
} abbe_import_file;

/* Zero-initialise. */
typedef struct abbe_import_files {
  size_t count, capacity;
  abbe_import_file *file;
} abbe_import_files;

enum { MAX_FILES = 100000, MAX_DEPTH = 32 };

static void import_files_free(abbe_import_files *files) {
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
  static const char *const endings[] = {".agf", ".yml", ".yaml", ".csv", ".sqlite", ".mtlx"};
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

static int by_path(const void *a, const void *b) {
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
  if (*count > 0) qsort(*out, *count, sizeof **out, by_path);
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

/* Adds path, or the files below it where it is a folder, in the order of their names. A folder
 * inside it that cannot be read is a note of kind SKIPPED. ABBE_IO where path is neither a file nor
 * a readable folder; ABBE_INVALID_ARGUMENT for more than 100000 files; ABBE_NO_MEMORY. */
static abbe_result import_files_add(abbe_import_files *files, const char *path, abbe_report *report,
                                    abbe_error *error) {
  struct stat status;
  if (stat(path, &status) != 0)
    return abbe_error_set(error, ABBE_IO, "%s: cannot be opened: %s", path, strerror(errno));
  if (S_ISDIR(status.st_mode)) return walk(files, path, 0, report, error);
  return add(files, strdup(path), false, error);
}

enum { AHEAD = 16, MOST_THREADS = 8, WORTH_THREADS = 64 };
enum { MAX_BYTES = 64 << 20 };

typedef struct runner {
  const abbe_import_batch *batch;
  abbe_import_files files;
  abbe_material_table *table;
  const char **origin; /* [count of the table] paths of the files */
  size_t origins;
  size_t used;    /* files that gave materials */
  size_t strange; /* files in folders that hold nothing of ours */
  const char *first_strange;
  abbe_report *report;
  abbe_error first; /* what was wrong with the first file that could not be used */
} runner;

/* ---- files ---- */

static bool ends_with(const char *path, const char *ending) {
  size_t length = strlen(path), wanted = strlen(ending);
  return length >= wanted && strcasecmp(path + length - wanted, ending) == 0;
}

/* What a file holds. */
typedef struct file_read {
  abbe_material_table table;
  abbe_report report;
  abbe_error why;
  abbe_result result;
  bool strange; /* nothing of ours may be in it */
  bool ready;
} file_read;

static abbe_result read_file(const runner *r, const char *path, file_read *t) {
  if (abbe_material_store_is(path))
    return abbe_import_load(path, NULL, &t->table, &t->report, &t->why);
  abbe_import_options options = r->batch->import;
  char *bytes = NULL;
  size_t size = 0;
  abbe_result result = abbe_file_read_text(path, MAX_BYTES, &bytes, &size, &t->why);
  t->strange = result == ABBE_PARSE;
  if (result != ABBE_OK) return result;
  if (options.format == ABBE_IMPORT_AUTO) options.format = abbe_import_detect(bytes, size);
  /* a text may hold a line of numbers */
  t->strange = options.format == ABBE_IMPORT_AUTO ||
               (options.format == ABBE_IMPORT_CSV && !ends_with(path, ".csv"));
  result = abbe_import_parse(bytes, size, path, &options, &t->table, &t->report, &t->why);
  free(bytes);
  return result;
}

static abbe_result remember(runner *r, const char *path, abbe_error *error) {
  for (size_t i = r->origins; i < r->table->count && r->batch->store != NULL; i++)
    ABBE_TRY(abbe_material_store_put(r->batch->store, &r->table->material[i], error));
  const char **larger = realloc(r->origin, (r->table->count + 1) * sizeof *larger);
  if (larger == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for names of files");
  r->origin = larger;
  while (r->origins < r->table->count) r->origin[r->origins++] = path;
  return ABBE_OK;
}

/* Where a file cannot be used, the reason is reported, not what was met before it. */
static abbe_result take_file(runner *r, const abbe_import_file *file, file_read *t,
                             abbe_error *error) {
  const bool many = r->files.count > 1;
  if (t->result == ABBE_OK) t->result = abbe_material_table_move(&t->table, r->table, &t->why);
  if (t->result == ABBE_NO_MEMORY) return abbe_error_set(error, t->result, "%s", t->why.text);
  if (t->result == ABBE_OK || !many) abbe_report_join(r->report, &t->report);
  if (t->result == ABBE_OK) {
    r->used++;
    return remember(r, file->path, error);
  }
  if (r->first.text[0] == '\0') r->first = t->why;
  if (t->strange && file->found) {
    if (r->strange++ == 0) r->first_strange = file->path;
    return ABBE_OK;
  }
  if (many) abbe_report_add(r->report, ABBE_NOTE_SKIPPED, 0, NULL, "%s", t->why.text);
  return ABBE_OK;
}

static void read_one(const runner *r, size_t i, file_read *t) {
  const char *path = r->files.file[i].path;
  *t = (file_read){.report.file = r->files.count > 1 ? path : NULL};
  t->result = read_file(r, path, t);
  t->ready = true;
}

/* Threads that read files ahead of the one that takes them in their order. */
typedef struct readers {
  const runner *r;
  file_read ahead[AHEAD]; /* of file i at i % AHEAD */
  size_t next, taken;
  bool over;
  pthread_mutex_t mutex;
  pthread_cond_t changed;
} readers;

static void *read_ahead(void *user) {
  readers *s = user;
  const size_t count = s->r->files.count;
  pthread_mutex_lock(&s->mutex);
  while (s->next < count && !s->over) {
    if (s->next == s->taken + AHEAD) {
      pthread_cond_wait(&s->changed, &s->mutex);
      continue;
    }
    const size_t i = s->next++;
    file_read t;
    pthread_mutex_unlock(&s->mutex);
    read_one(s->r, i, &t);
    pthread_mutex_lock(&s->mutex);
    s->ahead[i % AHEAD] = t;
    pthread_cond_broadcast(&s->changed);
  }
  pthread_mutex_unlock(&s->mutex);
  return NULL;
}

static abbe_result take_all(runner *r, readers *s, size_t threads, abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < r->files.count && result == ABBE_OK; i++) {
    file_read *t = &s->ahead[i % AHEAD];
    if (threads == 0) read_one(r, i, t);
    pthread_mutex_lock(&s->mutex);
    while (!t->ready) pthread_cond_wait(&s->changed, &s->mutex);
    pthread_mutex_unlock(&s->mutex);
    result = take_file(r, &r->files.file[i], t, error);
    abbe_material_table_free(&t->table);
    abbe_report_free(&t->report);
    pthread_mutex_lock(&s->mutex);
    *t = (file_read){0};
    s->taken = i + 1;
    s->over = result != ABBE_OK;
    pthread_cond_broadcast(&s->changed);
    pthread_mutex_unlock(&s->mutex);
  }
  return result;
}

static abbe_result take_files(runner *r, abbe_error *error) {
  pthread_t thread[MOST_THREADS];
  const long processors = sysconf(_SC_NPROCESSORS_ONLN);
  const size_t worth = r->files.count < WORTH_THREADS ? 0
                       : processors < MOST_THREADS    ? (size_t)processors
                                                      : MOST_THREADS;
  size_t threads = 0;
  readers *s = calloc(1, sizeof *s);
  if (s == NULL) return no_memory(error);
  s->r = r;
  pthread_mutex_init(&s->mutex, NULL);
  pthread_cond_init(&s->changed, NULL);
  while (threads < worth && pthread_create(&thread[threads], NULL, read_ahead, s) == 0) threads++;
  abbe_result result = take_all(r, s, threads, error);
  while (threads > 0) pthread_join(thread[--threads], NULL);
  for (size_t i = 0; i < AHEAD; i++) { /* what is not taken after a failure */
    abbe_material_table_free(&s->ahead[i].table);
    abbe_report_free(&s->ahead[i].report);
  }
  pthread_cond_destroy(&s->changed);
  pthread_mutex_destroy(&s->mutex);
  free(s);
  return result;
}

static abbe_result take_named(runner *r, abbe_error *error) {
  ABBE_TRY(take_files(r, error));
  if (r->strange > 0)
    abbe_report_add(r->report, ABBE_NOTE_SKIPPED, 0, NULL,
                    "%zu files in folders hold no materials; the first is %s", r->strange,
                    r->first_strange);
  if (r->used > 0) return ABBE_OK;
  if (r->files.count == 0)
    return abbe_error_set(
        error, ABBE_NOT_FOUND,
        "%s: holds no file that ends in .agf, .yml, .yaml, .csv, .sqlite or .mtlx",
        r->batch->path[0]);
  if (r->files.count == 1) return abbe_error_set(error, r->first.code, "%s", r->first.text);
  return abbe_error_set(error, r->first.code, "none of the %zu files can be used; the first: %s",
                        r->files.count, r->first.text);
}

/* By device and inode: a folder may hold the target, under another name too. */
static abbe_result check_target(const runner *r, abbe_error *error) {
  struct stat target, one;
  if (r->batch->target == NULL || stat(r->batch->target, &target) != 0) return ABBE_OK;
  for (size_t i = 0; i < r->files.count; i++)
    if (stat(r->files.file[i].path, &one) == 0 && one.st_dev == target.st_dev &&
        one.st_ino == target.st_ino)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "'%s' would be written over '%s', which is read; name another file",
                            r->batch->target, r->files.file[i].path);
  return ABBE_OK;
}

abbe_result abbe_import_batch_run(const abbe_import_batch *batch, abbe_material_table *into,
                                  abbe_report *report, abbe_error *error) {
  if (batch->count == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "no file or folder to import is named");
  runner r = {.batch = batch, .table = into, .report = report};
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < batch->count && result == ABBE_OK; i++)
    result = import_files_add(&r.files, batch->path[i], report, error);
  if (result == ABBE_OK && batch->import.name != NULL && r.files.count > 1)
    result = abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "one name does not go with %zu files; a prefix does", r.files.count);
  if (result == ABBE_OK) result = check_target(&r, error);
  if (result == ABBE_OK) result = remember(&r, "", error); /* what the table had before */
  if (result == ABBE_OK) result = take_named(&r, error);
  if (result == ABBE_OK)
    result = abbe_import_name_all(batch, into, r.origin, r.origins, report, error);
  if (result == ABBE_OK && r.used > 1) { /* it is one file's */
    free(into->description);
    into->description = NULL;
  }
  free(r.origin);
  import_files_free(&r.files);
  return result;
}
