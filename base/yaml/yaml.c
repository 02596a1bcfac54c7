#include "base/yaml/yaml.h"

#include "base/nearest.h"
#include "base/yaml/yaml_tree.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void abbe_yaml_free(abbe_yaml *yaml) {
  if (yaml == NULL) return;
  for (size_t i = 0; i < yaml->count; i++) {
    abbe_yaml_part *n = &yaml->nodes[i];
    for (size_t k = 0; k < n->known_count; k++) free(n->known[k]);
    free(n->known);
    free(n->child);
    free(n->text);
  }
  for (size_t i = 0; i < yaml->anchor_count; i++) free(yaml->anchors[i].name);
  free(yaml->nodes);
  free(yaml->name);
  free(yaml);
}

/* ---- complaints ---- */

static abbe_result complain(const abbe_yaml *yaml, size_t line, abbe_result code, abbe_error *error,
                            const char *format, va_list args) {
  char place[440];
  if (line > 0)
    snprintf(place, sizeof place, "%.400s:%zu: ", yaml->name, line);
  else
    snprintf(place, sizeof place, "%.400s: ", yaml->name);
  return abbe_error_set_list(error, code, place, format, args);
}

abbe_result abbe_yaml_fail_at(const abbe_yaml *yaml, size_t line, abbe_result code,
                              abbe_error *error, const char *format, ...) {
  va_list args;
  va_start(args, format);
  complain(yaml, line, code, error, format, args);
  va_end(args);
  return code;
}

abbe_result abbe_yaml_fail(const abbe_yaml *yaml, abbe_yaml_node where, abbe_error *error,
                           const char *format, ...) {
  va_list args;
  va_start(args, format);
  complain(yaml, abbe_yaml_line(yaml, where), ABBE_SCHEMA, error, format, args);
  va_end(args);
  return ABBE_SCHEMA;
}

abbe_result abbe_yaml_no_memory(const abbe_yaml *yaml, abbe_error *error) {
  return abbe_yaml_fail_at(yaml, 0, ABBE_NO_MEMORY, error, "no memory to read it");
}

/* ---- the tree ---- */

abbe_yaml_part *abbe_yaml_at(const abbe_yaml *yaml, abbe_yaml_node which) {
  if (which.id < 1 || (size_t)which.id > yaml->count) return NULL;
  return &yaml->nodes[which.id - 1];
}

abbe_yaml_node abbe_yaml_root(const abbe_yaml *yaml) {
  (void)yaml;
  return (abbe_yaml_node){1};
}

size_t abbe_yaml_line(const abbe_yaml *yaml, abbe_yaml_node which) {
  const abbe_yaml_part *n = abbe_yaml_at(yaml, which);
  return n != NULL ? n->line : 0;
}

static bool is_kind(const abbe_yaml *yaml, abbe_yaml_node which, abbe_yaml_kind kind) {
  const abbe_yaml_part *n = abbe_yaml_at(yaml, which);
  return n != NULL && n->kind == kind;
}

bool abbe_yaml_is_mapping(const abbe_yaml *yaml, abbe_yaml_node which) {
  return is_kind(yaml, which, ABBE_YAML_MAPPING);
}
bool abbe_yaml_is_sequence(const abbe_yaml *yaml, abbe_yaml_node which) {
  return is_kind(yaml, which, ABBE_YAML_SEQUENCE);
}
bool abbe_yaml_is_scalar(const abbe_yaml *yaml, abbe_yaml_node which) {
  return is_kind(yaml, which, ABBE_YAML_SCALAR);
}

bool abbe_yaml_is_flow(const abbe_yaml *yaml, abbe_yaml_node which) {
  const abbe_yaml_part *n = abbe_yaml_at(yaml, which);
  return n != NULL && n->flow;
}

void abbe_yaml_span(const abbe_yaml *yaml, abbe_yaml_node which, size_t *from, size_t *to) {
  const abbe_yaml_part *n = abbe_yaml_at(yaml, which);
  *from = n == NULL ? 0 : n->from;
  *to = n == NULL ? 0 : n->to;
}

const char *abbe_yaml_text(const abbe_yaml *yaml, abbe_yaml_node which) {
  const abbe_yaml_part *n = abbe_yaml_at(yaml, which);
  return n != NULL ? n->text : NULL;
}

size_t abbe_yaml_count(const abbe_yaml *yaml, abbe_yaml_node which) {
  const abbe_yaml_part *n = abbe_yaml_at(yaml, which);
  if (n == NULL) return 0;
  return n->kind == ABBE_YAML_MAPPING ? n->count / 2 : n->count;
}

static abbe_yaml_node child_of(const abbe_yaml *yaml, abbe_yaml_node parent, abbe_yaml_kind kind,
                               size_t index) {
  const abbe_yaml_part *n = abbe_yaml_at(yaml, parent);
  if (n == NULL || n->kind != kind || index >= n->count) return (abbe_yaml_node){0};
  return (abbe_yaml_node){n->child[index]};
}

abbe_yaml_node abbe_yaml_item(const abbe_yaml *yaml, abbe_yaml_node sequence, size_t index) {
  return child_of(yaml, sequence, ABBE_YAML_SEQUENCE, index);
}
abbe_yaml_node abbe_yaml_key(const abbe_yaml *yaml, abbe_yaml_node mapping, size_t index) {
  return index < SIZE_MAX / 2 ? child_of(yaml, mapping, ABBE_YAML_MAPPING, 2 * index)
                              : (abbe_yaml_node){0};
}
abbe_yaml_node abbe_yaml_value(const abbe_yaml *yaml, abbe_yaml_node mapping, size_t index) {
  return index < SIZE_MAX / 2 ? child_of(yaml, mapping, ABBE_YAML_MAPPING, 2 * index + 1)
                              : (abbe_yaml_node){0};
}

/* Remembers the key for suggestions; without memory a suggestion is lost, nothing else. */
static void remember(abbe_yaml_part *mapping, const char *key) {
  for (size_t i = 0; i < mapping->known_count; i++)
    if (strcmp(mapping->known[i], key) == 0) return;
  char **known = realloc(mapping->known, (mapping->known_count + 1) * sizeof *known);
  if (known == NULL) return;
  mapping->known = known;
  known[mapping->known_count] = strdup(key);
  if (known[mapping->known_count] != NULL) mapping->known_count++;
}

abbe_yaml_node abbe_yaml_get(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key) {
  abbe_yaml_part *n = abbe_yaml_at(yaml, mapping);
  if (n == NULL || n->kind != ABBE_YAML_MAPPING) return (abbe_yaml_node){0};
  remember(n, key);
  for (size_t i = 0; i + 1 < n->count; i += 2) {
    abbe_yaml_part *k = abbe_yaml_at(yaml, (abbe_yaml_node){n->child[i]});
    if (strcmp(k->text, key) != 0) continue;
    k->asked = true;
    return (abbe_yaml_node){n->child[i + 1]};
  }
  return (abbe_yaml_node){0};
}

abbe_result abbe_yaml_refuse_near(const abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                  abbe_error *error) {
  const abbe_yaml_part *n = abbe_yaml_at(yaml, mapping);
  for (size_t i = 0; n != NULL && n->kind == ABBE_YAML_MAPPING && i + 1 < n->count; i += 2) {
    const abbe_yaml_node other = {n->child[i]};
    const char *text = abbe_yaml_at(yaml, other)->text;
    if (!abbe_yaml_at(yaml, other)->asked && abbe_nearest_word(text, &key, 1) != NULL)
      return abbe_yaml_fail(yaml, other, error,
                            "the key '%s' is missing here, and '%.60s' is no key; did you mean "
                            "'%s'?",
                            key, text, key);
  }
  return ABBE_OK;
}

abbe_result abbe_yaml_require(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                              abbe_yaml_node *out, abbe_error *error) {
  if (!abbe_yaml_is_mapping(yaml, mapping))
    return abbe_yaml_fail(yaml, mapping, error, "a mapping with the key '%s' is wanted here", key);
  *out = abbe_yaml_get(yaml, mapping, key);
  if (out->id != 0) return ABBE_OK;
  const abbe_result result = abbe_yaml_refuse_near(yaml, mapping, key, error);
  return result != ABBE_OK
             ? result
             : abbe_yaml_fail(yaml, mapping, error, "the key '%s' is missing here", key);
}

abbe_result abbe_yaml_check_keys(const abbe_yaml *yaml, abbe_yaml_node mapping, const char *what,
                                 abbe_error *error) {
  const abbe_yaml_part *n = abbe_yaml_at(yaml, mapping);
  if (n == NULL || n->kind != ABBE_YAML_MAPPING)
    return abbe_yaml_fail(yaml, mapping, error, "%s must be a mapping (key: value)", what);
  for (size_t i = 0; i + 1 < n->count; i += 2) {
    abbe_yaml_node key = {n->child[i]};
    if (abbe_yaml_at(yaml, key)->asked) continue;
    const char *text = abbe_yaml_at(yaml, key)->text;
    const char *near = abbe_nearest_word(text, (const char *const *)n->known, n->known_count);
    if (near != NULL)
      return abbe_yaml_fail(yaml, key, error, "%s has no key '%.60s'; did you mean '%s'?", what,
                            text, near);
    return abbe_yaml_fail(yaml, key, error, "%s has no key '%.60s'", what, text);
  }
  return ABBE_OK;
}
