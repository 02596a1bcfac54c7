#include "spectral/editing/table_edit.h"

#include "base/file.h"
#include "base/number.h"
#include "base/yaml/yaml_edit_text.h"
#include "spectral/editing/check.h"
#include "spectral/formats/material_import.h"
#include "spectral/store/material_store.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

enum { MAX_BYTES = 16 << 20 };

struct abbe_table_edit {
  abbe_yaml_edit yaml;
  char *before; /* as the file is on the disk */
  size_t before_size;
  bool in_memory, is_new;
};

/* ---- reading ---- */

static abbe_result no_memory(abbe_error *error, const char *name) {
  return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory to edit it", name);
}

abbe_result abbe_table_edit_parse(const char *text, size_t size, const char *name,
                                  abbe_table_edit **out, abbe_error *error) {
  *out = NULL;
  abbe_table_edit *edit = calloc(1, sizeof *edit);
  if (edit == NULL) return no_memory(error, name);
  edit->in_memory = true;
  size_t list;
  abbe_result result = abbe_yaml_edit_make(text, size, name, &edit->yaml, error);
  if (result == ABBE_OK) result = abbe_table_place_list(&edit->yaml, &list, error);
  if (result == ABBE_OK) {
    edit->before = malloc(size + 1);
    edit->before_size = size;
    if (edit->before == NULL) result = no_memory(error, name);
  }
  if (result != ABBE_OK) {
    abbe_table_edit_free(edit);
    return result;
  }
  memcpy(edit->before, text, size);
  *out = edit;
  return ABBE_OK;
}

abbe_result abbe_table_edit_open(const char *path, abbe_table_edit **out, abbe_error *error) {
  *out = NULL;
  size_t size = 0;
  if (abbe_material_table_shipped(path, &size) != NULL)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the table '%s' is compiled in and cannot be edited; write a copy of it "
                          "to a file, and edit that",
                          path == NULL ? "default" : path);
  if (abbe_material_store_is(path))
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: a store is not edited; 'abbe materials add NAME --from %s --table "
                          "FILE.yaml --create' copies a record to a table that can be, 'abbe "
                          "materials export --table %s -o FILE.yaml' all of them",
                          path, path, path);
  char *text = NULL;
  abbe_result result = abbe_file_read_text(path, MAX_BYTES, &text, &size, error);
  if (result == ABBE_OK) result = abbe_table_edit_parse(text, size, path, out, error);
  if (result == ABBE_OK) (*out)->in_memory = false;
  free(text);
  return abbe_import_explain(path, result, error);
}

abbe_result abbe_table_edit_make(const char *path, abbe_table_edit **out, abbe_error *error) {
  static const char empty[] = "materials:\n";
  *out = NULL;
  if (access(path, F_OK) == 0)
    return abbe_error_set(error, ABBE_IO, "%s: is there already; a new table wants a new name",
                          path);
  ABBE_TRY(abbe_table_edit_parse(empty, strlen(empty), path, out, error));
  (*out)->in_memory = false;
  (*out)->is_new = true;
  (*out)->before_size = 0;
  return ABBE_OK;
}

void abbe_table_edit_free(abbe_table_edit *edit) {
  if (edit == NULL) return;
  abbe_yaml_edit_free(&edit->yaml);
  free(edit->before);
  free(edit);
}

const char *abbe_table_edit_text(const abbe_table_edit *edit, size_t *size) {
  *size = edit->yaml.size;
  return edit->yaml.text;
}

const char *abbe_table_edit_original(const abbe_table_edit *edit, size_t *size) {
  *size = edit->before_size;
  return edit->before;
}

/* ---- changes ---- */

/* "a.b" and v as the key a and the value {b: v}. */
static char *nested(char *rest, const char *value) {
  char *text = NULL;
  size_t size = 0, depth = 0;
  FILE *out = open_memstream(&text, &size);
  if (out == NULL) return NULL;
  for (char *dot = strchr(rest, '.'); dot != NULL; depth++) {
    *dot = '\0';
    char *step = dot + 1;
    dot = strchr(step, '.');
    fprintf(out, "{%.*s: ", dot != NULL ? (int)(dot - step) : (int)strlen(step), step);
  }
  fputs(value, out);
  while (depth-- > 0) fputc('}', out);
  bool good = !ferror(out);
  if (fclose(out) == 0 && good) return text;
  free(text);
  return NULL;
}

abbe_result abbe_table_edit_set(abbe_table_edit *edit, const char *name, const char *key,
                                const char *value, abbe_error *error) {
  abbe_table_place p;
  ABBE_TRY(abbe_table_place_key(&edit->yaml, name, key, &p, error));
  if (p.found) return abbe_yaml_edit_replace(&edit->yaml, p.parent, p.index, value, error);
  ABBE_FREED char *whole = nested(p.rest, value);
  if (whole == NULL) return no_memory(error, edit->yaml.name);
  size_t after =
      p.in_record ? abbe_table_place_after(edit->yaml.yaml, p.parent, p.rest) : ABBE_YAML_EDIT_END;
  return abbe_yaml_edit_insert_pair(&edit->yaml, p.parent, after, p.rest, whole, error);
}

abbe_result abbe_table_edit_set_text(abbe_table_edit *edit, const char *name, const char *key,
                                     const char *text, abbe_error *error) {
  ABBE_FREED char *quoted = NULL;
  ABBE_TRY(abbe_yaml_quote_make(text, &quoted, error));
  return abbe_table_edit_set(edit, name, key, quoted, error);
}

abbe_result abbe_table_edit_unset(abbe_table_edit *edit, const char *name, const char *key,
                                  abbe_error *error) {
  abbe_table_place p;
  ABBE_TRY(abbe_table_place_key(&edit->yaml, name, key, &p, error));
  if (!p.found) ABBE_TRY(abbe_table_place_none(&edit->yaml, name, key, error));
  return abbe_yaml_edit_remove(&edit->yaml, p.parent, p.index, error);
}

abbe_result abbe_table_edit_add(abbe_table_edit *edit, const char *record, abbe_error *error) {
  size_t index;
  ABBE_TRY(abbe_table_place_list(&edit->yaml, &index, error));
  return abbe_yaml_edit_append(&edit->yaml, abbe_yaml_root(edit->yaml.yaml), index, record, error);
}

abbe_result abbe_table_edit_remove(abbe_table_edit *edit, const char *name, abbe_error *error) {
  size_t index = 0;
  abbe_yaml_node record, list = abbe_table_place_records(&edit->yaml);
  ABBE_TRY(abbe_table_place_record(&edit->yaml, name, &index, &record, error));
  if (abbe_yaml_count(edit->yaml.yaml, list) == 1)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: '%.80s' is its only record, and a table wants at least one",
                          edit->yaml.name, name);
  return abbe_yaml_edit_remove(&edit->yaml, list, index, error);
}

abbe_result abbe_table_edit_rename(abbe_table_edit *edit, const char *name, const char *new_name,
                                   abbe_error *error) {
  size_t index = 0, other = 0;
  abbe_yaml_node record, taken;
  ABBE_TRY(abbe_table_place_record(&edit->yaml, name, &index, &record, error));
  if (abbe_table_place_record(&edit->yaml, new_name, &other, &taken, NULL) == ABBE_OK &&
      other != index)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s:%zu: the name '%.80s' is taken by the record here", edit->yaml.name,
                          abbe_yaml_line(edit->yaml.yaml, taken), new_name);
  return abbe_table_edit_set_text(edit, name, "name", new_name, error);
}

abbe_result abbe_table_edit_record(abbe_table_edit *edit, const char *name, char **out,
                                   abbe_error *error) {
  size_t index = 0;
  abbe_yaml_node record;
  ABBE_TRY(abbe_table_place_record(&edit->yaml, name, &index, &record, error));
  return abbe_yaml_edit_item(&edit->yaml, abbe_table_place_records(&edit->yaml), index, out, error);
}

/* ---- what becomes of them ---- */

abbe_result abbe_table_edit_check(const abbe_table_edit *edit, abbe_error *error) {
  ABBE_OWNED(abbe_material_table, table) = {0};
  return abbe_material_table_parse(edit->yaml.text, edit->yaml.size, edit->yaml.name, &table,
                                   error);
}

static abbe_result check_unchanged(const abbe_table_edit *edit, abbe_error *error) {
  const char *path = edit->yaml.name;
  if (edit->is_new) {
    if (access(path, F_OK) != 0) return ABBE_OK;
    return abbe_error_set(error, ABBE_IO,
                          "%s: has appeared since it was found missing; nothing was written", path);
  }
  char *text = NULL;
  size_t size = 0;
  ABBE_TRY(abbe_file_read_text(path, MAX_BYTES, &text, &size, error));
  bool same = size == edit->before_size && memcmp(text, edit->before, size) == 0;
  free(text);
  if (same) return ABBE_OK;
  return abbe_error_set(error, ABBE_IO,
                        "%s: has been changed by someone else since it was read; nothing was "
                        "written. Look at it, and make the edit again",
                        path);
}

static bool was_a_table(const abbe_table_edit *edit) {
  abbe_material_table table;
  bool good = edit->is_new || abbe_material_table_parse(edit->before, edit->before_size,
                                                        edit->yaml.name, &table, NULL) == ABBE_OK;
  if (good && !edit->is_new) abbe_material_table_free(&table);
  return good;
}

abbe_result abbe_table_edit_allow(const abbe_table_edit *edit, abbe_error *error) {
  abbe_error why = {0};
  abbe_result result = abbe_table_edit_check(edit, &why);
  if (result == ABBE_OK || !was_a_table(edit)) return ABBE_OK;
  return abbe_error_set(error, result, "the edit is refused, nothing was written: %s", why.text);
}

abbe_result abbe_table_edit_save(abbe_table_edit *edit, abbe_error *error) {
  if (edit->in_memory)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: was read from memory, not from a file",
                          edit->yaml.name);
  if (edit->yaml.size == edit->before_size &&
      memcmp(edit->yaml.text, edit->before, edit->before_size) == 0)
    return ABBE_OK;
  ABBE_TRY(abbe_table_edit_allow(edit, error));
  char *copy = malloc(edit->yaml.size + 1);
  if (copy == NULL) return no_memory(error, edit->yaml.name);
  memcpy(copy, edit->yaml.text, edit->yaml.size);
  abbe_result result = check_unchanged(edit, error);
  if (result == ABBE_OK)
    result = abbe_file_write(edit->yaml.name, edit->yaml.text, edit->yaml.size, error);
  if (result != ABBE_OK) {
    free(copy);
    return result;
  }
  free(edit->before);
  edit->before = copy;
  edit->before_size = edit->yaml.size;
  edit->is_new = false;
  return ABBE_OK;
}

enum { MAX_PASSES = 4 };

static bool stands_twice(const abbe_material_table *table, size_t row) {
  for (size_t i = 0; i < table->count; i++)
    if (i != row && strcasecmp(table->material[i].name, table->material[row].name) == 0)
      return true;
  return false;
}

static void refuse(abbe_table_fix *out, const char *name, const char *why) {
  if (out->refused++ == 0) snprintf(out->why, sizeof out->why, "%.80s: %.300s", name, why);
}

static void remember_warning(abbe_table_fix *out, const abbe_material *m) {
  size_t used = strlen(out->warned), length = strlen(m->name);
  if (m->warning == NULL || used + length + 3 > sizeof out->warned) return;
  bool second = used >= length && strcmp(out->warned + used - length, m->name) == 0;
  if (second) return; /* value of the same row */
  snprintf(out->warned + used, sizeof out->warned - used, "%s%s", used > 0 ? ", " : "", m->name);
}

/* The number of values that were set, into *set. */
static abbe_result apply(abbe_table_edit *edit, const abbe_material_table *table,
                         const abbe_findings *found, abbe_table_fix *out, size_t *set,
                         abbe_error *error) {
  out->refused = 0;
  out->why[0] = '\0';
  for (size_t i = 0; i < found->count; i++) {
    const abbe_finding *f = &found->finding[i];
    if (!f->certain || f->key == NULL || f->value == NULL) continue;
    const char *name = table->material[f->row].name;
    abbe_error why = {0};
    if (stands_twice(table, f->row)) {
      refuse(out, name, "the name stands twice, so it does not say which record to fix");
      continue;
    }
    abbe_result result = abbe_table_edit_set(edit, name, f->key, f->value, &why);
    if (result == ABBE_NO_MEMORY) return abbe_error_set(error, result, "%s", why.text);
    if (result != ABBE_OK) {
      refuse(out, name, why.text);
    } else {
      remember_warning(out, &table->material[f->row]);
      ++*set;
    }
  }
  out->fixed += *set;
  return ABBE_OK;
}

static abbe_result pass(abbe_table_edit *edit, const abbe_material_table *known,
                        abbe_table_fix *out, size_t *set, abbe_error *error) {
  size_t size = 0;
  const char *text = abbe_table_edit_text(edit, &size);
  ABBE_OWNED(abbe_material_table, table) = {0};
  ABBE_OWNED(abbe_findings, found) = {0};
  ABBE_TRY(abbe_material_table_parse_lenient(text, size, "the table", &table, NULL, error));
  ABBE_TRY(abbe_check_table(&table, known, &found, error));
  return apply(edit, &table, &found, out, set, error);
}

abbe_result abbe_table_fix_make(abbe_table_edit *edit, const abbe_material_table *known,
                                abbe_table_fix *out, abbe_error *error) {
  *out = (abbe_table_fix){0};
  size_t set = 1;
  for (int i = 0; i < MAX_PASSES && set > 0; i++) {
    set = 0;
    ABBE_TRY(pass(edit, known, out, &set, error));
  }
  return ABBE_OK;
}
