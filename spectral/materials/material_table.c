#include "spectral/materials/material_table.h"

#include "base/text.h"
#include "base/yaml/yaml.h"
#include "spectral/materials/record_reading.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

extern const unsigned char abbe_embedded_materials[];
extern const size_t abbe_embedded_materials_size;
extern const unsigned char abbe_embedded_thesis[];
extern const size_t abbe_embedded_thesis_size;

enum { MAX_MATERIALS = ABBE_MATERIAL_TABLE_MAX_COUNT };

/* ---- tables ---- */

abbe_result abbe_material_table_append(abbe_material_table *table, abbe_material *material,
                                       abbe_error *error) {
  size_t count = table->count;
  if (count >= MAX_MATERIALS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a table holds at most %d materials",
                          MAX_MATERIALS);
  /* doubled at each power of two; a table that was read has capacity for its count only */
  size_t wanted = 1;
  while (wanted <= count) wanted *= 2;
  abbe_material *larger = realloc(table->material, wanted * sizeof *larger);
  if (larger == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu materials", wanted);
  table->material = larger;
  table->material[table->count++] = *material;
  *material = (abbe_material){0};
  return ABBE_OK;
}

abbe_result abbe_material_table_move(abbe_material_table *from, abbe_material_table *into,
                                     abbe_error *error) {
  if (from->count > MAX_MATERIALS - into->count)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: its %zu materials make more than the %d that a table holds",
                          from->path, from->count, MAX_MATERIALS);
  const size_t before = into->count;
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < from->count && result == ABBE_OK; i++)
    result = abbe_material_table_append(into, &from->material[i], error);
  while (result != ABBE_OK && into->count > before)
    abbe_material_free(&into->material[--into->count]);
  if (result == ABBE_OK && into->count == from->count && into->description == NULL) {
    into->description = from->description;
    from->description = NULL;
  }
  return result;
}

static int by_name(const void *a, const void *b) {
  const abbe_material *const *p = a, *const *q = b;
  int order = strcasecmp((*p)->name, (*q)->name);
  return order != 0 ? order : (*p > *q) - (*p < *q); /* places in one array */
}

abbe_result abbe_material_table_unique(abbe_material_table *table, abbe_report *report,
                                       abbe_error *error) {
  const abbe_material **sorted = malloc((table->count + 1) * sizeof *sorted);
  const abbe_material **first = calloc(table->count + 1, sizeof *first);
  if (sorted == NULL || first == NULL) {
    free(sorted);
    free(first);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu names", table->count);
  }
  for (size_t i = 0; i < table->count; i++) sorted[i] = &table->material[i];
  qsort(sorted, table->count, sizeof *sorted, by_name);
  for (size_t i = 1; i < table->count; i++) {
    const abbe_material *before = sorted[i - 1];
    if (strcasecmp(before->name, sorted[i]->name) != 0) continue;
    size_t place = (size_t)(before - table->material);
    first[sorted[i] - table->material] = first[place] != NULL ? first[place] : before;
  }
  for (size_t i = 0; i < table->count; i++)
    if (first[i] != NULL)
      abbe_report_add(report, ABBE_NOTE_SKIPPED, table->material[i].line, table->material[i].name,
                      "this name was there before, on line %zu", first[i]->line);
  size_t kept = 0;
  for (size_t i = 0; i < table->count; i++) {
    if (first[i] != NULL)
      abbe_material_free(&table->material[i]);
    else
      table->material[kept++] = table->material[i];
  }
  table->count = kept;
  free(sorted);
  free(first);
  return ABBE_OK;
}

/* Sorted, since a table may hold a whole catalogue. */
static abbe_result check_unique(const abbe_material_table *t, abbe_yaml *yaml, abbe_yaml_node list,
                                abbe_error *error) {
  const abbe_material **sorted = malloc(t->count * sizeof *sorted), *again = NULL, *first = NULL;
  if (sorted == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu names", t->count);
  for (size_t i = 0; i < t->count; i++) sorted[i] = &t->material[i];
  qsort(sorted, t->count, sizeof *sorted, by_name);
  for (size_t i = 1; i < t->count; i++) {
    if (strcasecmp(sorted[i - 1]->name, sorted[i]->name) != 0) continue;
    if (again != NULL && sorted[i] >= again) continue;
    again = sorted[i];
    first = sorted[i - 1];
  }
  free(sorted);
  if (again == NULL) return ABBE_OK;
  return abbe_yaml_fail(yaml, abbe_yaml_item(yaml, list, (size_t)(again - t->material)), error,
                        "the material '%s' stands here a second time; the first is on line %zu",
                        again->name, first->line);
}

/* How a table is read: lenient notes what it leaves out. */
typedef struct mode {
  bool lenient;
  abbe_report *report;
} mode;

static abbe_result no_room(abbe_error *error, size_t count) {
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu materials", count);
}

/* Notes what is wrong with a record that cannot be read, without the name and line that stand in
 * the note already. */
static void leave_out(const mode *how, abbe_yaml *yaml, abbe_yaml_node record, const char *file,
                      abbe_material *material, const abbe_error *why) {
  size_t line = abbe_yaml_line(yaml, record), length = strlen(file);
  const char *text = why->text;
  if (strncmp(text, file, length) == 0 && text[length] == ':') {
    char *end = NULL;
    unsigned long at = strtoul(text + length + 1, &end, 10);
    if (end > text + length + 1 && end[0] == ':' && end[1] == ' ') {
      line = at;
      text = end + 2;
    }
  }
  abbe_report_add(how->report, ABBE_NOTE_SKIPPED, line, material->name, "%s", text);
  abbe_material_free(material);
}

static abbe_result read_records(abbe_yaml *yaml, abbe_yaml_node list, const mode *how,
                                abbe_material_table *t, abbe_error *error) {
  size_t count = abbe_yaml_count(yaml, list);
  if (!abbe_yaml_is_sequence(yaml, list) || count == 0 || count > MAX_MATERIALS)
    return abbe_yaml_fail(yaml, list, error, "'materials' wants a list of 1 to %d records",
                          MAX_MATERIALS);
  t->material = calloc(count, sizeof *t->material);
  if (t->material == NULL) return no_room(error, count);
  for (size_t i = 0; i < count; i++) {
    abbe_yaml_node record = abbe_yaml_item(yaml, list, i);
    abbe_material *m = &t->material[t->count++]; /* counted now, so that half of one is freed too */
    if (!how->lenient) {
      ABBE_TRY(abbe_material_record_read(yaml, record, m, error));
      continue;
    }
    abbe_error why = {0};
    abbe_result result = abbe_material_record_read_lenient(yaml, record, m, &why);
    if (result == ABBE_NO_MEMORY) return no_room(error, count);
    if (result == ABBE_OK) continue;
    leave_out(how, yaml, record, t->path, m, &why);
    t->count--;
  }
  return how->lenient ? ABBE_OK : check_unique(t, yaml, list, error);
}

static abbe_result read_table(abbe_yaml *yaml, const char *name, const mode *how,
                              abbe_material_table *t, abbe_error *error) {
  abbe_yaml_node root = abbe_yaml_root(yaml), list;
  t->path = strdup(name);
  if (t->path == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory", name);
  abbe_yaml_get(yaml, root, "materials");
  ABBE_TRY(abbe_yaml_get_string(yaml, root, "description", &t->description, error));
  ABBE_TRY(abbe_yaml_check_keys(yaml, root, "a material table", error));
  ABBE_TRY(abbe_yaml_require(yaml, root, "materials", &list, error));
  return read_records(yaml, list, how, t, error);
}

static abbe_result parse(const char *text, size_t size, const char *name, const mode *how,
                         abbe_material_table *out, abbe_error *error) {
  *out = (abbe_material_table){0};
  abbe_yaml *yaml = NULL;
  abbe_result result = abbe_yaml_parse(text, size, name, &yaml, error);
  if (result == ABBE_OK) result = read_table(yaml, name, how, out, error);
  if (result != ABBE_OK) abbe_material_table_free(out);
  abbe_yaml_free(yaml);
  return result;
}

const char *abbe_material_table_shipped(const char *path, size_t *size) {
  bool thesis = path != NULL && strcmp(path, "thesis") == 0;
  bool shipped = thesis || path == NULL || strcmp(path, "default") == 0;
  *size = !shipped ? 0 : thesis ? abbe_embedded_thesis_size : abbe_embedded_materials_size;
  if (!shipped) return NULL;
  return (const char *)(thesis ? abbe_embedded_thesis : abbe_embedded_materials);
}

abbe_result abbe_material_table_parse(const char *text, size_t size, const char *name,
                                      abbe_material_table *out, abbe_error *error) {
  return parse(text, size, name, &(mode){false, NULL}, out, error);
}

abbe_result abbe_material_table_parse_lenient(const char *text, size_t size, const char *name,
                                              abbe_material_table *out, abbe_report *report,
                                              abbe_error *error) {
  return parse(text, size, name, &(mode){true, report}, out, error);
}

void abbe_material_table_free(abbe_material_table *table) {
  if (table == NULL) return;
  for (size_t i = 0; i < table->count; i++) abbe_material_free(&table->material[i]);
  free(table->material);
  free(table->path);
  free(table->description);
  abbe_material_table_free(table->all);
  free(table->all);
  *table = (abbe_material_table){0};
}

static abbe_result not_found(const abbe_material_table *table, const char *name,
                             abbe_error *error) {
  const char **names = malloc((table->count + 1) * sizeof *names);
  if (names == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory");
  char list[700] = "";
  size_t used = 0, shown = 0;
  for (size_t i = 0; i < table->count; i++) {
    names[i] = table->material[i].name;
    if (shown < i || used + strlen(names[i]) + 60 > sizeof list) continue; /* whole names alone */
    used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", names[i]);
    shown++;
  }
  if (shown < table->count)
    snprintf(list + used, sizeof list - used, " and %zu more; 'abbe materials list' has them",
             table->count - shown);
  const char *near = abbe_nearest_word(name, names, table->count);
  free(names);
  if (strncasecmp(name, "white-gold", 10) == 0 &&
      abbe_material_table_find(table, "rhodium", &(const abbe_material *){0}, NULL) == ABBE_OK)
    return abbe_error_set(error, ABBE_NOT_FOUND,
                          "the table '%.200s' has no material '%.60s', for white gold is worn "
                          "plated: take 'rhodium'",
                          table->path, name);
  if (near != NULL)
    return abbe_error_set(error, ABBE_NOT_FOUND,
                          "the table '%.200s' has no material '%.60s'; did you mean '%s'?",
                          table->path, name, near);
  return abbe_error_set(error, ABBE_NOT_FOUND,
                        "the table '%.100s' has no material '%.60s'; it has %s", table->path, name,
                        list);
}

abbe_result abbe_material_table_find(const abbe_material_table *table, const char *name,
                                     const abbe_material **out, abbe_error *error) {
  for (size_t i = 0; i < table->count; i++) {
    if (strcasecmp(table->material[i].name, name) != 0) continue;
    *out = &table->material[i];
    return ABBE_OK;
  }
  return error != NULL ? not_found(table->all != NULL ? table->all : table, name, error)
                       : ABBE_NOT_FOUND;
}
