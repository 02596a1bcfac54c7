#include "spectral/formats/material_import.h"

#include "base/error.h"
#include "base/file.h"
#include "base/report.h"
#include "base/text.h"
#include "spectral/store/material_store.h"

#include <dirent.h>
#include <errno.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

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

enum { MAX_BYTES = 64 << 20, MAX_PART = 160, MAX_LEVELS = 16 };

/* A row of the table and the file that it comes from. */
typedef struct row {
  abbe_material *material;
  const char *path;
} row;

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

static abbe_result read_file(runner *r, const abbe_import_file *file, bool *strange,
                             abbe_error *error) {
  if (abbe_material_store_is(file->path))
    return abbe_import_load(file->path, NULL, r->table, r->report, error);
  abbe_import_options options = r->batch->import;
  char *bytes = NULL;
  size_t size = 0;
  abbe_result result = abbe_file_read_text(file->path, MAX_BYTES, &bytes, &size, error);
  *strange = result == ABBE_PARSE;
  if (result != ABBE_OK) return result;
  if (options.format == ABBE_IMPORT_AUTO) options.format = abbe_import_detect(bytes, size);
  /* a text may hold a line of numbers */
  *strange = options.format == ABBE_IMPORT_AUTO ||
             (options.format == ABBE_IMPORT_CSV && !ends_with(file->path, ".csv"));
  result = abbe_import_parse(bytes, size, file->path, &options, r->table, r->report, error);
  free(bytes);
  return result;
}

static abbe_result remember(runner *r, const char *path, abbe_error *error) {
  const char **larger = realloc(r->origin, (r->table->count + 1) * sizeof *larger);
  if (larger == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for names of files");
  r->origin = larger;
  while (r->origins < r->table->count) r->origin[r->origins++] = path;
  return ABBE_OK;
}

/* Where a file cannot be used, the reason is reported, not what was met before it. */
static abbe_result take_file(runner *r, const abbe_import_file *file, abbe_error *error) {
  abbe_error why = {0};
  bool strange = false, many = r->files.count > 1;
  abbe_report before = r->report != NULL ? *r->report : (abbe_report){0};
  if (r->report != NULL && many) r->report->file = file->path;
  abbe_result result = read_file(r, file, &strange, &why);
  if (r->report != NULL) r->report->file = NULL;
  if (result == ABBE_NO_MEMORY) return abbe_error_set(error, result, "%s", why.text);
  if (result == ABBE_OK) {
    r->used++;
    return remember(r, file->path, error);
  }
  if (r->first.text[0] == '\0') r->first = why;
  if (r->report != NULL && many) {
    r->report->count = before.count;
    memcpy(r->report->kinds, before.kinds, sizeof before.kinds);
  }
  if (strange && file->found) {
    if (r->strange++ == 0) r->first_strange = file->path;
    return ABBE_OK;
  }
  if (many) abbe_report_add(r->report, ABBE_NOTE_SKIPPED, 0, NULL, "%s", why.text);
  return ABBE_OK;
}

static abbe_result take_files(runner *r, abbe_error *error) {
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < r->files.count && result == ABBE_OK; i++)
    result = take_file(r, &r->files.file[i], error);
  if (result != ABBE_OK) return result;
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

/* ---- names ---- */

/* Whether the file without its ending is just the material's name, as that of a file with one
 * material is. */
static bool is_named_after(const row *it) {
  const char *slash = strrchr(it->path, '/'), *stem = slash != NULL ? slash + 1 : it->path;
  const char *dot = strrchr(stem, '.'), *name = it->material->name;
  size_t length = dot != NULL && dot > stem ? (size_t)(dot - stem) : strlen(stem);
  size_t whole = strlen(name);
  return length <= whole && strncasecmp(name + whole - length, stem, length) == 0;
}

/* The part of a row's path `level` from its end: 0 is the file without its ending, or its folder
 * where the file is just the name; "" beyond the first. */
static void part_of(const row *it, int level, char out[MAX_PART]) {
  const char *path = it->path, *end = path + strlen(path), *start;
  if (is_named_after(it)) level++;
  for (;; level--) {
    for (start = end; start > path && start[-1] != '/';) start--;
    if (level == 0 || start == path) break;
    for (end = start; end > path && end[-1] == '/';) end--;
  }
  const char *dot = *end == '\0' ? strrchr(start, '.') : NULL;
  if (dot != NULL && dot > start) end = dot;
  snprintf(out, MAX_PART, "%.*s", level > 0 ? 0 : (int)(end - start), start);
  abbe_utf8_trim(out);
}

typedef struct label {
  char text[MAX_PART];
} label;

typedef enum likeness { ALL_ALIKE, SOME_ALIKE, ALL_DIFFER } likeness;

static int by_text(const void *a, const void *b) {
  return strcasecmp((*(const label *const *)a)->text, (*(const label *const *)b)->text);
}

static likeness compare(const label *labels, size_t count, const label **sorted) {
  size_t steps = 0;
  for (size_t i = 0; i < count; i++) sorted[i] = &labels[i];
  qsort(sorted, count, sizeof *sorted, by_text);
  for (size_t i = 1; i < count; i++) steps += by_text(&sorted[i - 1], &sorted[i]) != 0;
  return steps == 0 ? ALL_ALIKE : steps + 1 < count ? SOME_ALIKE : ALL_DIFFER;
}

/* The one folder or file, nearest to the file, by which the rows differ; else all that differ,
 * joined. False where the paths are alike. */
static bool find_labels(const row *rows, size_t count, label *labels, label *parts,
                        const label **sorted) {
  for (int level = 0; level < MAX_LEVELS; level++) {
    bool full = true;
    for (size_t i = 0; i < count; i++) {
      part_of(&rows[i], level, labels[i].text);
      full = full && labels[i].text[0] != '\0';
    }
    if (full && compare(labels, count, sorted) == ALL_DIFFER) return true;
  }
  for (size_t i = 0; i < count; i++) labels[i].text[0] = '\0';
  for (int level = 0; level < MAX_LEVELS; level++) {
    for (size_t i = 0; i < count; i++) part_of(&rows[i], level, parts[i].text);
    if (compare(parts, count, sorted) == ALL_ALIKE) continue;
    for (size_t i = 0; i < count; i++) {
      char joined[2 * MAX_PART], *text = labels[i].text, *part = parts[i].text;
      snprintf(joined, sizeof joined, "%s%s%s", part, *part != '\0' && *text != '\0' ? "-" : "",
               text);
      snprintf(text, MAX_PART, "%.*s", MAX_PART - 1, joined);
      abbe_utf8_trim(text);
    }
    if (compare(labels, count, sorted) == ALL_DIFFER) return true;
  }
  return false;
}

/* "BEFORE-NAME" after a label, "BEFORENAME" after a prefix; what stands before is cut where the
 * whole would be too long. */
static abbe_result rename_row(runner *r, const row *it, const char *before, bool is_label,
                              abbe_error *error) {
  char name[MAX_PART + ABBE_MATERIAL_MAX_NAME + 4], cut[MAX_PART];
  const char *old = it->material->name;
  size_t taken = strlen(old) + is_label;
  size_t room = taken < ABBE_MATERIAL_MAX_NAME ? ABBE_MATERIAL_MAX_NAME - taken : 0;
  snprintf(cut, sizeof cut, "%.*s", (int)room, before);
  abbe_utf8_trim(cut);
  bool whole = strcmp(cut, before) == 0;
  for (char *c = cut; *c != '\0'; c++)
    if ((unsigned char)*c < 0x20 || *c == 0x7f) *c = '?';
  const char *begin = cut + strspn(cut, " ");
  snprintf(name, sizeof name, "%s%s%s", begin, is_label && *begin != '\0' ? "-" : "", old);
  if (abbe_material_check_name(name, NULL) != ABBE_OK) return ABBE_OK;
  char *made = strdup(name);
  if (made == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a name");
  if (is_label)
    abbe_report_add(r->report, ABBE_NOTE_RENAMED, it->material->line, old,
                    "is named %s, since several files have a material of this name; it is of %s",
                    made, it->path);
  else if (!whole)
    abbe_report_add(r->report, ABBE_NOTE_RENAMED, it->material->line, old,
                    "with the whole prefix its name would be too long; it is named %s", made);
  free(it->material->name);
  it->material->name = made;
  return ABBE_OK;
}

static abbe_result name_apart(runner *r, const row *rows, size_t count, abbe_error *error) {
  bool one_file = true;
  for (size_t i = 1; i < count; i++) one_file = one_file && strcmp(rows[0].path, rows[i].path) == 0;
  if (one_file) return ABBE_OK; /* reported, and dropped as a repetition */
  label *labels = calloc(2 * count, sizeof *labels);
  const label **sorted = calloc(count, sizeof *sorted);
  abbe_result result = labels != NULL && sorted != NULL
                           ? ABBE_OK
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for names");
  bool apart = result == ABBE_OK && find_labels(rows, count, labels, labels + count, sorted);
  for (size_t i = 0; i < count && apart && result == ABBE_OK; i++)
    result = rename_row(r, &rows[i], labels[i].text, true, error);
  free(labels);
  free(sorted);
  return result;
}

static int by_name(const void *a, const void *b) {
  const row *x = a, *y = b;
  int order = strcasecmp(x->material->name, y->material->name);
  return order != 0 ? order : (x->material > y->material) - (x->material < y->material);
}

static abbe_result name_all(runner *r, abbe_error *error) {
  size_t count = r->table->count;
  row *rows = malloc((count + 1) * sizeof *rows);
  if (rows == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu names", count);
  for (size_t i = 0; i < count; i++)
    rows[i] = (row){&r->table->material[i], i < r->origins ? r->origin[i] : ""};
  qsort(rows, count, sizeof *rows, by_name);
  abbe_result result = ABBE_OK;
  for (size_t from = 0, to; from < count && result == ABBE_OK; from = to) {
    for (to = from + 1; to < count; to++)
      if (strcasecmp(rows[from].material->name, rows[to].material->name) != 0) break;
    if (to - from > 1) result = name_apart(r, rows + from, to - from, error);
  }
  for (size_t i = 0; i < count && r->batch->prefix != NULL && result == ABBE_OK; i++)
    result = rename_row(r, &rows[i], r->batch->prefix, false, error);
  free(rows);
  return result == ABBE_OK ? abbe_material_table_unique(r->table, r->report, error) : result;
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
  if (result == ABBE_OK) result = take_files(&r, error);
  if (result == ABBE_OK) result = name_all(&r, error);
  if (result == ABBE_OK && r.used > 1) { /* it is one file's */
    free(into->description);
    into->description = NULL;
  }
  free(r.origin);
  import_files_free(&r.files);
  return result;
}
