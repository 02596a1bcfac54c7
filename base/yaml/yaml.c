#include "base/yaml/yaml.h"

#include "base/number.h"
#include "base/text.h"
#include "base/yaml/yaml_tree.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Values of a type, checked. */

/* What a node is, for "… is wanted, not …". */
static const char *kind_name(const abbe_yaml *yaml, abbe_yaml_node which) {
  const abbe_yaml_part *n = abbe_yaml_at(yaml, which);
  if (n == NULL) return "nothing";
  if (n->kind != ABBE_YAML_SCALAR) return n->kind == ABBE_YAML_MAPPING ? "a mapping" : "a list";
  return n->quoted ? "text in quotes" : "a word";
}

static bool parse_number(const char *text, double *value) {
  const char *end;
  if (*text == '\0' || text[strspn(text, "0123456789+-.eE")] != '\0') return false;
  return abbe_number_read(text, &end, value) && *end == '\0' && isfinite(*value);
}

static bool parse_length(const char *text, double *value) {
  const char *end;
  return abbe_number_read_length(text, &end, value) && *end == '\0' && isfinite(*value);
}

static abbe_result read_number(const abbe_yaml *yaml, abbe_yaml_node which, const char *what,
                               bool length, double min, double max, double *out,
                               abbe_error *error) {
  const abbe_yaml_part *n = abbe_yaml_at(yaml, which);
  if (n == NULL || n->kind != ABBE_YAML_SCALAR || n->quoted)
    return abbe_yaml_fail(yaml, which, error, "'%s' wants a %s, not %s", what,
                          length ? "length" : "number", kind_name(yaml, which));
  double value = 0;
  if (!(length ? parse_length : parse_number)(n->text, &value))
    return abbe_yaml_fail(yaml, which, error, "'%s: %.60s' is not a finite number%s", what, n->text,
                          length ? ", of metres or with its unit behind it (" ABBE_LENGTH_UNITS ")"
                                 : "");
  if (value < min || value > max)
    return abbe_yaml_fail(yaml, which, error, "'%s: %.60s' is not in the range from %g to %g%s",
                          what, n->text, min, max, length ? " m" : "");
  *out = value;
  return ABBE_OK;
}

abbe_result abbe_yaml_number(const abbe_yaml *yaml, abbe_yaml_node which, const char *what,
                             double min, double max, double *out, abbe_error *error) {
  return read_number(yaml, which, what, false, min, max, out, error);
}

abbe_result abbe_yaml_length(const abbe_yaml *yaml, abbe_yaml_node which, const char *what,
                             double min, double max, double *out, abbe_error *error) {
  return read_number(yaml, which, what, true, min, max, out, error);
}

abbe_result abbe_yaml_get_number(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                 double min, double max, double *out, abbe_error *error) {
  abbe_yaml_node value = abbe_yaml_get(yaml, mapping, key);
  return value.id == 0 ? ABBE_OK : read_number(yaml, value, key, false, min, max, out, error);
}

abbe_result abbe_yaml_get_length(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                 double min, double max, double *out, abbe_error *error) {
  abbe_yaml_node value = abbe_yaml_get(yaml, mapping, key);
  return value.id == 0 ? ABBE_OK : read_number(yaml, value, key, true, min, max, out, error);
}

abbe_result abbe_yaml_get_count(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                size_t min, size_t max, size_t *out, abbe_error *error) {
  abbe_yaml_node which = abbe_yaml_get(yaml, mapping, key);
  if (which.id == 0) return ABBE_OK;
  const abbe_yaml_part *n = abbe_yaml_at(yaml, which);
  if (n->kind != ABBE_YAML_SCALAR || n->quoted)
    return abbe_yaml_fail(yaml, which, error, "'%s' wants a whole number, not %s", key,
                          kind_name(yaml, which));
  errno = 0;
  bool digits = *n->text != '\0' && n->text[strspn(n->text, "0123456789")] == '\0';
  unsigned long long value = digits ? strtoull(n->text, NULL, 10) : 0;
  if (!digits || errno != 0 || value < min || value > max)
    return abbe_yaml_fail(yaml, which, error, "'%s: %.60s' is not a whole number from %zu to %zu",
                          key, n->text, min, max);
  *out = (size_t)value;
  return ABBE_OK;
}

abbe_result abbe_yaml_get_bool(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key, bool *out,
                               abbe_error *error) {
  abbe_yaml_node which = abbe_yaml_get(yaml, mapping, key);
  if (which.id == 0) return ABBE_OK;
  const abbe_yaml_part *n = abbe_yaml_at(yaml, which);
  if (n->kind != ABBE_YAML_SCALAR || n->quoted)
    return abbe_yaml_fail(yaml, which, error, "'%s' wants true or false, not %s", key,
                          kind_name(yaml, which));
  bool yes = strcmp(n->text, "true") == 0;
  if (!yes && strcmp(n->text, "false") != 0)
    return abbe_yaml_fail(yaml, which, error, "'%s: %.60s' is neither true nor false", key,
                          n->text);
  *out = yes;
  return ABBE_OK;
}

abbe_result abbe_yaml_get_string(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                 char **out, abbe_error *error) {
  abbe_yaml_node which = abbe_yaml_get(yaml, mapping, key);
  if (which.id == 0) return ABBE_OK;
  const abbe_yaml_part *n = abbe_yaml_at(yaml, which);
  if (n->kind != ABBE_YAML_SCALAR)
    return abbe_yaml_fail(yaml, which, error, "'%s' wants text, not %s", key,
                          kind_name(yaml, which));
  if (*n->text == '\0')
    return abbe_yaml_fail(yaml, which, error, "'%s' is empty; give it a text or leave it out", key);
  char *copy = strdup(n->text);
  if (copy == NULL) return abbe_yaml_no_memory(yaml, error);
  free(*out);
  *out = copy;
  return ABBE_OK;
}

abbe_result abbe_yaml_get_name(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key, char **out,
                               abbe_error *error) {
  char *text = NULL;
  abbe_result result = abbe_yaml_get_string(yaml, mapping, key, &text, error);
  if (text == NULL) return result;
  const size_t length = strlen(text), size = 3 * length + 1;
  char *shown = malloc(size);
  if (shown == NULL) {
    free(text);
    return abbe_yaml_no_memory(yaml, error);
  }
  abbe_utf8_printable(text, length, false, shown, size);
  free(text);
  free(*out);
  *out = shown;
  return ABBE_OK;
}

abbe_result abbe_yaml_get_choice(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                 const char *const *names, int *out, abbe_error *error) {
  abbe_yaml_node which = abbe_yaml_get(yaml, mapping, key);
  if (which.id == 0) return ABBE_OK;
  const char *text = abbe_yaml_text(yaml, which);
  char list[512] = "";
  int count = 0;
  for (size_t used = 0; names[count] != NULL; count++) {
    if (text != NULL && strcmp(text, names[count]) == 0) {
      *out = count;
      return ABBE_OK;
    }
    if (used < sizeof list)
      used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", count ? ", " : "",
                               names[count]);
  }
  if (text == NULL)
    return abbe_yaml_fail(yaml, which, error, "'%s' wants one word of %s, not %s", key, list,
                          kind_name(yaml, which));
  const char *near = abbe_nearest_word(text, names, (size_t)count);
  return abbe_yaml_fail(yaml, which, error, "'%s: %.60s' is not known; %s%s%s is one of %s", key,
                        text, near ? "did you mean '" : "", near ? near : "", near ? "'? It" : "it",
                        list);
}

static abbe_result read_numbers(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                bool length, size_t count, double min, double max, double *out,
                                abbe_error *error) {
  abbe_yaml_node list = abbe_yaml_get(yaml, mapping, key);
  if (list.id == 0) return ABBE_OK;
  if (!abbe_yaml_is_sequence(yaml, list))
    return abbe_yaml_fail(yaml, list, error, "'%s' wants a list of %zu %s, not %s", key, count,
                          length ? "lengths" : "numbers", kind_name(yaml, list));
  if (abbe_yaml_count(yaml, list) != count)
    return abbe_yaml_fail(yaml, list, error, "'%s' wants %zu numbers, not %zu", key, count,
                          abbe_yaml_count(yaml, list));
  /* checked before anything is written: a refused list leaves the default whole */
  double value = 0;
  for (size_t i = 0; i < count; i++) {
    abbe_yaml_node item = abbe_yaml_item(yaml, list, i);
    ABBE_TRY(read_number(yaml, item, key, length, min, max, &value, error));
  }
  for (size_t i = 0; i < count; i++)
    read_number(yaml, abbe_yaml_item(yaml, list, i), key, length, min, max, &out[i], error);
  return ABBE_OK;
}

abbe_result abbe_yaml_get_numbers(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                  size_t count, double min, double max, double *out,
                                  abbe_error *error) {
  return read_numbers(yaml, mapping, key, false, count, min, max, out, error);
}

abbe_result abbe_yaml_get_lengths(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                  size_t count, double min, double max, double *out,
                                  abbe_error *error) {
  return read_numbers(yaml, mapping, key, true, count, min, max, out, error);
}

abbe_result abbe_yaml_get_list(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                               size_t max_count, double **out, size_t *count, abbe_error *error) {
  *out = NULL;
  *count = 0;
  abbe_yaml_node list = abbe_yaml_get(yaml, mapping, key);
  if (list.id == 0) return ABBE_OK;
  if (!abbe_yaml_is_sequence(yaml, list))
    return abbe_yaml_fail(yaml, list, error, "'%s' wants a list of numbers, not %s", key,
                          kind_name(yaml, list));
  size_t length = abbe_yaml_count(yaml, list);
  if (length > max_count)
    return abbe_yaml_fail(yaml, list, error, "'%s' holds %zu numbers; at most %zu are possible",
                          key, length, max_count);
  double *values = malloc((length > 0 ? length : 1) * sizeof *values);
  if (values == NULL) return abbe_yaml_no_memory(yaml, error);
  for (size_t i = 0; i < length; i++) {
    abbe_result result = abbe_yaml_number(yaml, abbe_yaml_item(yaml, list, i), key, -HUGE_VAL,
                                          HUGE_VAL, &values[i], error);
    if (result == ABBE_OK) continue;
    free(values);
    return result;
  }
  *out = values;
  *count = length;
  return ABBE_OK;
}

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
  ABBE_TRY(abbe_yaml_refuse_near(yaml, mapping, key, error));
  return abbe_yaml_fail(yaml, mapping, error, "the key '%s' is missing here", key);
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
