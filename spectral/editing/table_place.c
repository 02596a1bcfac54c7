#include "spectral/editing/table_edit.h"

#include "base/text.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

abbe_result abbe_table_place_list(const abbe_yaml_edit *edit, size_t *index, abbe_error *error) {
  const abbe_yaml *yaml = edit->yaml;
  abbe_yaml_node root = abbe_yaml_root(yaml);
  for (*index = 0; *index < abbe_yaml_count(yaml, root) && abbe_yaml_is_mapping(yaml, root);
       ++*index) {
    if (strcmp(abbe_yaml_text(yaml, abbe_yaml_key(yaml, root, *index)), "materials") != 0) continue;
    abbe_yaml_node list = abbe_yaml_value(yaml, root, *index);
    const char *text = abbe_yaml_text(yaml, list);
    if (abbe_yaml_is_sequence(yaml, list) || (text != NULL && *text == '\0')) return ABBE_OK;
  }
  return abbe_error_set(error, ABBE_SCHEMA, "%s: is no material table: it has no list 'materials'",
                        edit->name);
}

abbe_yaml_node abbe_table_place_records(const abbe_yaml_edit *edit) {
  size_t index = 0;
  if (abbe_table_place_list(edit, &index, NULL) != ABBE_OK) return (abbe_yaml_node){0};
  return abbe_yaml_value(edit->yaml, abbe_yaml_root(edit->yaml), index);
}

/* The pair of mapping under key, or count where it has none. */
static size_t find_pair(const abbe_yaml *yaml, abbe_yaml_node mapping, const char *key) {
  size_t count = abbe_yaml_is_mapping(yaml, mapping) ? abbe_yaml_count(yaml, mapping) : 0, i = 0;
  while (i < count && strcmp(abbe_yaml_text(yaml, abbe_yaml_key(yaml, mapping, i)), key) != 0) i++;
  return i;
}

/* The name of a record, or "". */
static const char *table_place_name(const abbe_yaml *yaml, abbe_yaml_node record) {
  size_t index = find_pair(yaml, record, "name");
  const char *name = abbe_yaml_text(yaml, abbe_yaml_value(yaml, record, index));
  return name != NULL ? name : "";
}

static abbe_result not_found(const abbe_yaml_edit *edit, abbe_yaml_node list, const char *name,
                             abbe_error *error) {
  const abbe_yaml *yaml = edit->yaml;
  size_t count = abbe_yaml_count(yaml, list);
  const char **names = malloc((count + 1) * sizeof *names);
  if (names == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory to edit it", edit->name);
  for (size_t i = 0; i < count; i++)
    names[i] = table_place_name(yaml, abbe_yaml_item(yaml, list, i));
  const char *near = abbe_nearest_word(name, names, count);
  free(names);
  return abbe_error_set(error, ABBE_NOT_FOUND,
                        near != NULL ? "%s: has no material '%.80s'; did you mean '%.80s'?"
                                     : "%s: has no material '%.80s'%s",
                        edit->name, name, near != NULL ? near : "");
}

static abbe_result shared(const abbe_yaml_edit *edit, const char *what, abbe_error *error) {
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "%s: '%.80s' is written as an alias (*name) of what stands elsewhere; edit "
                        "it by hand",
                        edit->name, what);
}

abbe_result abbe_table_place_record(const abbe_yaml_edit *edit, const char *name, size_t *index,
                                    abbe_yaml_node *record, abbe_error *error) {
  const abbe_yaml *yaml = edit->yaml;
  abbe_yaml_node list = abbe_table_place_records(edit);
  *record = (abbe_yaml_node){0};
  for (size_t i = 0; i < abbe_yaml_count(yaml, list); i++) {
    abbe_yaml_node item = abbe_yaml_item(yaml, list, i);
    if (strcasecmp(table_place_name(yaml, item), name) != 0) continue;
    if (record->id != 0)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s: the name '%.80s' stands on lines %zu and %zu; give one of them "
                            "another name by hand first",
                            edit->name, name, abbe_yaml_line(yaml, *record),
                            abbe_yaml_line(yaml, item));
    *record = item;
    *index = i;
  }
  if (record->id == 0) return not_found(edit, list, name, error);
  return abbe_yaml_edit_is_alias(edit, list, *index) ? shared(edit, name, error) : ABBE_OK;
}

/* A record's keys in the order of docs/materials.md, so that a new one goes where readers look. */
static size_t rank(const char *key) {
  static const char *const order[] = {
      "name",          "description",   "model",   "coefficients",  "points",     "interpolation",
      "range_nm",      "extraordinary", "biaxial", "temperature_c", "n_absolute", "extrapolate",
      "density_g_cm3", "n_d",           "v_d",     "source",        "warning",    "comment",
      "absorption",    "catalogue",     "fit"};
  enum { COUNT = sizeof order / sizeof order[0] };
  for (size_t i = 0; i < COUNT; i++)
    if (strcmp(order[i], key) == 0) return i;
  return COUNT;
}

size_t abbe_table_place_after(const abbe_yaml *yaml, abbe_yaml_node record, const char *key) {
  size_t place = ABBE_YAML_EDIT_END;
  for (size_t i = 0; i < abbe_yaml_count(yaml, record); i++)
    if (rank(abbe_yaml_text(yaml, abbe_yaml_key(yaml, record, i))) <= rank(key)) place = i;
  return place;
}

abbe_result abbe_table_place_none(const abbe_yaml_edit *edit, const char *name, const char *key,
                                  abbe_error *error) {
  return abbe_error_set(error, ABBE_NOT_FOUND, "%s: the record '%.80s' has no '%.80s'", edit->name,
                        name, key);
}

/* A step that list `at` has not, though the steps before it are there. */
static abbe_result no_such_item(const abbe_yaml_edit *edit, const char *name, const char *key,
                                abbe_yaml_node at, abbe_error *error) {
  size_t count = abbe_yaml_count(edit->yaml, at);
  if (!abbe_yaml_is_sequence(edit->yaml, at) || count == 0)
    return abbe_table_place_none(edit, name, key, error);
  return abbe_error_set(error, ABBE_NOT_FOUND,
                        "%s: the record '%.80s' has no '%.80s'; the list has %zu items, 0 to %zu",
                        edit->name, name, key, count, count - 1);
}

static bool step_into(const abbe_yaml *yaml, abbe_yaml_node at, const char *step, size_t *index) {
  if (abbe_yaml_is_mapping(yaml, at)) {
    *index = find_pair(yaml, at, step);
  } else if (abbe_yaml_is_sequence(yaml, at) && step[strspn(step, "0123456789")] == '\0') {
    *index = strlen(step) < 9 ? (size_t)strtoul(step, NULL, 10) : SIZE_MAX;
  } else {
    return false;
  }
  return *index < abbe_yaml_count(yaml, at);
}

/* Words of letters, digits and _, parted by single dots. */
static bool is_path(const char *key) {
  const char *word = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.";
  size_t length = strlen(key);
  return length > 0 && length < sizeof((abbe_table_place *)0)->rest &&
         key[strspn(key, word)] == '\0' && key[0] != '.' && key[length - 1] != '.' &&
         strstr(key, "..") == NULL;
}

abbe_result abbe_table_place_key(const abbe_yaml_edit *edit, const char *name, const char *key,
                                 abbe_table_place *out, abbe_error *error) {
  const abbe_yaml *yaml = edit->yaml;
  size_t item;
  abbe_yaml_node at;
  ABBE_TRY(abbe_table_place_record(edit, name, &item, &at, error));
  *out = (abbe_table_place){.in_record = true};
  if (!is_path(key))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "'%.80s' is no key; keys are words, parted by a dot where one stands "
                          "inside another, as in absorption.distance_m",
                          key);
  snprintf(out->rest, sizeof out->rest, "%s", key);
  for (char *step = out->rest; step != NULL;) {
    char *dot = strchr(step, '.');
    if (dot != NULL) *dot = '\0';
    out->parent = at;
    out->found = step_into(yaml, at, step, &out->index);
    if (!out->found) {
      if (dot != NULL) *dot = '.';
      memmove(out->rest, step, strlen(step) + 1);
      /* only a mapping takes new keys */
      return abbe_yaml_is_mapping(yaml, at) ? ABBE_OK : no_such_item(edit, name, key, at, error);
    }
    if (dot == NULL) break;
    if (abbe_yaml_edit_is_alias(edit, at, out->index)) return shared(edit, key, error);
    at = abbe_yaml_is_mapping(yaml, at) ? abbe_yaml_value(yaml, at, out->index)
                                        : abbe_yaml_item(yaml, at, out->index);
    out->in_record = false;
    step = dot + 1;
  }
  return ABBE_OK;
}
