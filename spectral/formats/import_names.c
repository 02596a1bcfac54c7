#include "spectral/formats/material_import.h"

#include "base/text.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MAX_PART = 160, MAX_LEVELS = 16 };

/* A row of the table and the file that it comes from. */
typedef struct row {
  abbe_material *material;
  const char *path;
} row;

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
static abbe_result rename_row(abbe_report *report, const row *it, const char *before, bool is_label,
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
    abbe_report_add(report, ABBE_NOTE_RENAMED, it->material->line, old,
                    "is named %s, since several files have a material of this name; it is of %s",
                    made, it->path);
  else if (!whole)
    abbe_report_add(report, ABBE_NOTE_RENAMED, it->material->line, old,
                    "with the whole prefix its name would be too long; it is named %s", made);
  free(it->material->name);
  it->material->name = made;
  return ABBE_OK;
}

static abbe_result name_apart(abbe_report *report, const row *rows, size_t count,
                              abbe_error *error) {
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
    result = rename_row(report, &rows[i], labels[i].text, true, error);
  free(labels);
  free(sorted);
  return result;
}

static int by_name(const void *a, const void *b) {
  const row *x = a, *y = b;
  int order = strcasecmp(x->material->name, y->material->name);
  return order != 0 ? order : (x->material > y->material) - (x->material < y->material);
}

abbe_result abbe_import_name_all(const abbe_import_batch *batch, abbe_material_table *table,
                                 const char *const *origin, size_t origins, abbe_report *report,
                                 abbe_error *error) {
  const size_t count = table->count;
  row *rows = malloc((count + 1) * sizeof *rows);
  if (rows == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu names", count);
  for (size_t i = 0; i < count; i++)
    rows[i] = (row){&table->material[i], i < origins ? origin[i] : ""};
  qsort(rows, count, sizeof *rows, by_name);
  abbe_result result = ABBE_OK;
  for (size_t from = 0, to; from < count && result == ABBE_OK; from = to) {
    for (to = from + 1; to < count; to++)
      if (strcasecmp(rows[from].material->name, rows[to].material->name) != 0) break;
    if (to - from > 1) result = name_apart(report, rows + from, to - from, error);
  }
  for (size_t i = 0; i < count && batch->prefix != NULL && result == ABBE_OK; i++)
    result = rename_row(report, &rows[i], batch->prefix, false, error);
  free(rows);
  return result == ABBE_OK ? abbe_material_table_unique(table, report, error) : result;
}
