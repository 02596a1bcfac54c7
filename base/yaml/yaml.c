#include "base/yaml/yaml.h"

#include "base/file.h"
#include "base/nearest.h"
#include "base/number.h"
#include "base/text_cursor.h"
#include "base/utf8.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

enum {
  MAX_BYTES = 16 << 20,
  MAX_DEPTH = 64,
  MAX_NODES = 1000000, /* counted with every alias written out, so that aliases cannot explode */
  MAX_ANCHORS = 1024
};

typedef enum node_kind { SCALAR, SEQUENCE, MAPPING } node_kind;

typedef struct node {
  node_kind kind;
  bool open;   /* its end has not been read: an alias to it would be a circle */
  bool quoted; /* a scalar in quotes or as a block is text, never a number */
  bool asked;  /* a key that a getter knows */
  bool flow;   /* a list or mapping in brackets */
  size_t line;
  size_t from, to; /* bytes of the text that the node takes up */
  size_t weight; /* nodes below and including it, aliases written out */
  char *text;
  int *child; /* ids; a mapping's are key, value, key, value, … */
  size_t count, capacity;
  char **known; /* a mapping's: keys asked for, as suggestions */
  size_t known_count;
} node;

struct abbe_yaml {
  char *name;
  node *nodes; /* id - 1 */
  size_t count, capacity;
  struct {
    char *name;
    int id;
  } anchors[MAX_ANCHORS];
  size_t anchor_count;
};

static node *at(const abbe_yaml *yaml, abbe_yaml_node which) {
  if (which.id < 1 || (size_t)which.id > yaml->count) return NULL;
  return &yaml->nodes[which.id - 1];
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

__attribute__((format(printf, 5, 6))) static abbe_result fail_at(const abbe_yaml *yaml, size_t line,
                                                                 abbe_result code,
                                                                 abbe_error *error,
                                                                 const char *format, ...) {
  va_list args;
  va_start(args, format);
  complain(yaml, line, code, error, format, args);
  va_end(args);
  return code;
}

abbe_result abbe_yaml_fail(const abbe_yaml *yaml, abbe_yaml_node where, abbe_error *error,
                           const char *format, ...) {
  ABBE_REQUIRE(yaml && format, error);
  va_list args;
  va_start(args, format);
  complain(yaml, abbe_yaml_line(yaml, where), ABBE_SCHEMA, error, format, args);
  va_end(args);
  return ABBE_SCHEMA;
}

static abbe_result no_memory(const abbe_yaml *yaml, abbe_error *error) {
  return fail_at(yaml, 0, ABBE_NO_MEMORY, error, "no memory to read it");
}

/* ---- from libyaml's events to a tree ---- */

/* Doubles the array when it is full; NULL, and the array as it was, where memory is out. */
static void *grown(void *array, size_t count, size_t *capacity, size_t size) {
  if (count < *capacity) return array;
  size_t wanted = *capacity == 0 ? 8 : 2 * *capacity;
  void *larger = realloc(array, wanted * size);
  if (larger != NULL) *capacity = wanted;
  return larger;
}

typedef struct builder {
  abbe_yaml *yaml;
  abbe_error *error;
  int stack[MAX_DEPTH];
  size_t depth;
  bool done; /* the document has ended */
  abbe_text_cursor cursor; /* libyaml's marks count characters */
  size_t leaf_end; /* byte where the latest leaf or bracket ends */
} builder;

/* A block scalar's mark stands after the empty lines that follow it. */
static size_t end_of_leaf(builder *b, const yaml_event_t *event) {
  size_t from = abbe_text_cursor_byte(&b->cursor, event->start_mark.index);
  size_t to = abbe_text_cursor_byte(&b->cursor, event->end_mark.index);
  while (to > from && memchr(" \t\r\n", b->cursor.text[to - 1], 4) != NULL) to--;
  b->leaf_end = to;
  return to;
}

static node *top(const builder *b) {
  return at(b->yaml, (abbe_yaml_node){b->stack[b->depth - 1]});
}

static bool wants_key(const builder *b) {
  return b->depth > 0 && top(b)->kind == MAPPING && top(b)->count % 2 == 0;
}

static abbe_result add_node(builder *b, node_kind kind, size_t line, int *id) {
  abbe_yaml *yaml = b->yaml;
  if (yaml->count >= MAX_NODES)
    return fail_at(yaml, line, ABBE_SCHEMA, b->error, "more than %d values; split the file",
                   MAX_NODES);
  node *nodes = grown(yaml->nodes, yaml->count, &yaml->capacity, sizeof *nodes);
  if (nodes == NULL) return no_memory(yaml, b->error);
  yaml->nodes = nodes;
  nodes[yaml->count++] = (node){.kind = kind, .open = true, .line = line, .weight = 1};
  *id = (int)yaml->count;
  return ABBE_OK;
}

/* Hangs a node below the open one. Its weight is added when it is whole. */
static abbe_result attach(builder *b, int id) {
  if (b->depth == 0) return ABBE_OK;
  node *parent = top(b);
  int *child = grown(parent->child, parent->count, &parent->capacity, sizeof *child);
  if (child == NULL) return no_memory(b->yaml, b->error);
  parent->child = child;
  child[parent->count++] = id;
  return ABBE_OK;
}

static abbe_result close_node(builder *b, int id, size_t line) {
  node *child = at(b->yaml, (abbe_yaml_node){id});
  child->open = false;
  if (b->depth == 0) return ABBE_OK;
  node *parent = top(b);
  parent->weight += child->weight;
  if (parent->weight <= MAX_NODES) return ABBE_OK;
  return fail_at(b->yaml, line, ABBE_SCHEMA, b->error,
                 "more than %d values once its aliases (*name) are written out", MAX_NODES);
}

static abbe_result add_anchor(builder *b, const yaml_char_t *anchor, int id, size_t line) {
  abbe_yaml *yaml = b->yaml;
  if (anchor == NULL) return ABBE_OK;
  if (yaml->anchor_count == MAX_ANCHORS)
    return fail_at(yaml, line, ABBE_SCHEMA, b->error, "more than %d anchors (&name)", MAX_ANCHORS);
  char *name = strdup((const char *)anchor);
  if (name == NULL) return no_memory(yaml, b->error);
  yaml->anchors[yaml->anchor_count].name = name;
  yaml->anchors[yaml->anchor_count++].id = id;
  return ABBE_OK;
}

static abbe_result add_alias(builder *b, const char *name, size_t line) {
  const abbe_yaml *yaml = b->yaml;
  if (wants_key(b))
    return fail_at(yaml, line, ABBE_SCHEMA, b->error,
                   "the alias *%.60s stands for a key; write the key itself", name);
  for (size_t i = yaml->anchor_count; i-- > 0;) { /* the latest of a name holds */
    if (strcmp(yaml->anchors[i].name, name) != 0) continue;
    int id = yaml->anchors[i].id;
    if (at(yaml, (abbe_yaml_node){id})->open)
      return fail_at(yaml, line, ABBE_SCHEMA, b->error,
                     "the alias *%.60s stands inside what it names", name);
    abbe_result result = attach(b, id);
    return result != ABBE_OK ? result : close_node(b, id, line);
  }
  return fail_at(yaml, line, ABBE_SCHEMA, b->error,
                 "the alias *%.60s has no anchor &%.60s before it", name, name);
}

static abbe_result add_scalar(builder *b, const yaml_event_t *event, size_t line) {
  const char *value = (const char *)event->data.scalar.value;
  size_t length = event->data.scalar.length;
  if (strlen(value) != length)
    return fail_at(b->yaml, line, ABBE_SCHEMA, b->error, "a text holds a zero byte");
  int id = 0;
  abbe_result result = add_node(b, SCALAR, line, &id);
  if (result != ABBE_OK) return result;
  node *scalar = at(b->yaml, (abbe_yaml_node){id});
  scalar->quoted = event->data.scalar.style != YAML_PLAIN_SCALAR_STYLE;
  scalar->from = abbe_text_cursor_byte(&b->cursor, event->start_mark.index);
  scalar->to = end_of_leaf(b, event);
  scalar->text = malloc(length + 1);
  if (scalar->text == NULL) return no_memory(b->yaml, b->error);
  memcpy(scalar->text, value, length + 1);
  result = add_anchor(b, event->data.scalar.anchor, id, line);
  if (result == ABBE_OK) result = attach(b, id);
  return result != ABBE_OK ? result : close_node(b, id, line);
}

static abbe_result open_collection(builder *b, node_kind kind, const yaml_event_t *event,
                                   size_t line) {
  bool list = kind == SEQUENCE;
  const yaml_char_t *anchor =
      list ? event->data.sequence_start.anchor : event->data.mapping_start.anchor;
  if (wants_key(b))
    return fail_at(b->yaml, line, ABBE_SCHEMA, b->error, "a key must be a plain word");
  if (b->depth == MAX_DEPTH)
    return fail_at(b->yaml, line, ABBE_SCHEMA, b->error, "is nested deeper than %d levels",
                   MAX_DEPTH);
  int id = 0;
  abbe_result result = add_node(b, kind, line, &id);
  if (result != ABBE_OK) return result;
  node *collection = at(b->yaml, (abbe_yaml_node){id});
  collection->from = abbe_text_cursor_byte(&b->cursor, event->start_mark.index);
  collection->flow = list ? event->data.sequence_start.style == YAML_FLOW_SEQUENCE_STYLE
                          : event->data.mapping_start.style == YAML_FLOW_MAPPING_STYLE;
  result = add_anchor(b, anchor, id, line);
  if (result == ABBE_OK) result = attach(b, id);
  if (result == ABBE_OK) b->stack[b->depth++] = id;
  return result;
}

typedef struct key_place {
  const char *text;
  size_t line;
} key_place;

static int by_text(const void *a, const void *b) {
  const key_place *p = a, *q = b;
  int order = strcmp(p->text, q->text);
  return order != 0 ? order : (p->line > q->line) - (p->line < q->line);
}

static abbe_result check_duplicates(builder *b, const node *mapping) {
  size_t pairs = mapping->count / 2;
  if (pairs < 2) return ABBE_OK;
  key_place *keys = malloc(pairs * sizeof *keys);
  if (keys == NULL) return no_memory(b->yaml, b->error);
  for (size_t i = 0; i < pairs; i++) {
    const node *key = at(b->yaml, (abbe_yaml_node){mapping->child[2 * i]});
    keys[i] = (key_place){key->text, key->line};
  }
  qsort(keys, pairs, sizeof *keys, by_text);
  abbe_result result = ABBE_OK;
  for (size_t i = 1; i < pairs && result == ABBE_OK; i++)
    if (strcmp(keys[i - 1].text, keys[i].text) == 0)
      result = fail_at(b->yaml, keys[i].line, ABBE_SCHEMA, b->error,
                       "the key '%.60s' stands here a second time; the first is on line %zu",
                       keys[i].text, keys[i - 1].line);
  free(keys);
  return result;
}

static abbe_result close_collection(builder *b, const yaml_event_t *event, size_t line) {
  int id = b->stack[b->depth - 1];
  node *closing = top(b);
  if (closing->flow) end_of_leaf(b, event);
  closing->to = b->leaf_end; /* a block's own mark stands after the comments that follow it */
  abbe_result result = closing->kind == MAPPING ? check_duplicates(b, closing) : ABBE_OK;
  b->depth--;
  return result != ABBE_OK ? result : close_node(b, id, line);
}

static abbe_result take_event(builder *b, const yaml_event_t *event) {
  size_t line = event->start_mark.line + 1;
  switch (event->type) {
  case YAML_DOCUMENT_START_EVENT:
    if (!b->done) return ABBE_OK;
    return fail_at(b->yaml, line, ABBE_SCHEMA, b->error,
                   "a second document begins; a file holds one");
  case YAML_DOCUMENT_END_EVENT:
    b->done = true;
    return ABBE_OK;
  case YAML_ALIAS_EVENT:
    end_of_leaf(b, event);
    return add_alias(b, (const char *)event->data.alias.anchor, line);
  case YAML_SCALAR_EVENT:
    return add_scalar(b, event, line);
  case YAML_SEQUENCE_START_EVENT:
    return open_collection(b, SEQUENCE, event, line);
  case YAML_MAPPING_START_EVENT:
    return open_collection(b, MAPPING, event, line);
  case YAML_SEQUENCE_END_EVENT:
  case YAML_MAPPING_END_EVENT:
    return close_collection(b, event, line);
  default:
    return ABBE_OK;
  }
}

static abbe_result not_well_formed(builder *b, const yaml_parser_t *parser) {
  const char *problem = parser->problem != NULL ? parser->problem : "not YAML";
  if (parser->error == YAML_MEMORY_ERROR) return no_memory(b->yaml, b->error);
  if (parser->error == YAML_READER_ERROR)
    return fail_at(b->yaml, 0, ABBE_PARSE, b->error, "is not well-formed YAML: %s at byte %zu",
                   problem, parser->problem_offset);
  return fail_at(b->yaml, parser->problem_mark.line + 1, ABBE_PARSE, b->error,
                 "is not well-formed YAML: %s%s%s", problem, parser->context ? " " : "",
                 parser->context ? parser->context : "");
}

static abbe_result build(builder *b, const char *text, size_t size) {
  yaml_parser_t parser;
  if (!yaml_parser_initialize(&parser)) return no_memory(b->yaml, b->error);
  yaml_parser_set_input_string(&parser, (const unsigned char *)text, size);
  abbe_result result = ABBE_OK;
  for (bool end = false; !end && result == ABBE_OK;) {
    yaml_event_t event;
    if (!yaml_parser_parse(&parser, &event)) {
      result = not_well_formed(b, &parser);
      break;
    }
    result = take_event(b, &event);
    end = event.type == YAML_STREAM_END_EVENT;
    yaml_event_delete(&event);
  }
  yaml_parser_delete(&parser);
  if (result == ABBE_OK && b->yaml->count == 0)
    result = fail_at(b->yaml, 0, ABBE_PARSE, b->error, "is empty");
  return result;
}

abbe_result abbe_yaml_parse(const char *text, size_t size, const char *name, abbe_yaml **out,
                            abbe_error *error) {
  ABBE_REQUIRE(text && name && out, error);
  *out = NULL;
  abbe_yaml *yaml = calloc(1, sizeof *yaml);
  if (yaml != NULL) yaml->name = strdup(name);
  if (yaml == NULL || yaml->name == NULL) {
    abbe_yaml_free(yaml);
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory to read it", name);
  }
  abbe_result result;
  if (size > MAX_BYTES) {
    result = fail_at(yaml, 0, ABBE_IO, error, "is %zu bytes long; at most %d are allowed here",
                     size, MAX_BYTES);
  } else {
    builder b = {.yaml = yaml, .error = error, .cursor = abbe_text_cursor_make(text, size)};
    result = build(&b, text, size);
  }
  if (result != ABBE_OK)
    abbe_yaml_free(yaml);
  else
    *out = yaml;
  return result;
}

abbe_result abbe_yaml_load(const char *path, abbe_yaml **out, abbe_error *error) {
  ABBE_REQUIRE(path && out, error);
  *out = NULL;
  char *text = NULL;
  size_t size = 0;
  abbe_result result = abbe_file_read_text(path, MAX_BYTES, &text, &size, error);
  if (result == ABBE_OK) result = abbe_yaml_parse(text, size, path, out, error);
  free(text);
  return result;
}

void abbe_yaml_free(abbe_yaml *yaml) {
  if (yaml == NULL) return;
  for (size_t i = 0; i < yaml->count; i++) {
    node *n = &yaml->nodes[i];
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

/* ---- the tree ---- */

abbe_yaml_node abbe_yaml_root(const abbe_yaml *yaml) {
  (void)yaml;
  return (abbe_yaml_node){1};
}

size_t abbe_yaml_line(const abbe_yaml *yaml, abbe_yaml_node which) {
  const node *n = at(yaml, which);
  return n != NULL ? n->line : 0;
}

static bool is_kind(const abbe_yaml *yaml, abbe_yaml_node which, node_kind kind) {
  const node *n = at(yaml, which);
  return n != NULL && n->kind == kind;
}

bool abbe_yaml_is_mapping(const abbe_yaml *yaml, abbe_yaml_node which) {
  return is_kind(yaml, which, MAPPING);
}
bool abbe_yaml_is_sequence(const abbe_yaml *yaml, abbe_yaml_node which) {
  return is_kind(yaml, which, SEQUENCE);
}
bool abbe_yaml_is_scalar(const abbe_yaml *yaml, abbe_yaml_node which) {
  return is_kind(yaml, which, SCALAR);
}

bool abbe_yaml_is_flow(const abbe_yaml *yaml, abbe_yaml_node which) {
  const node *n = at(yaml, which);
  return n != NULL && n->flow;
}

void abbe_yaml_span(const abbe_yaml *yaml, abbe_yaml_node which, size_t *from, size_t *to) {
  const node *n = at(yaml, which);
  *from = n == NULL ? 0 : n->from;
  *to = n == NULL ? 0 : n->to;
}

const char *abbe_yaml_text(const abbe_yaml *yaml, abbe_yaml_node which) {
  const node *n = at(yaml, which);
  return n != NULL ? n->text : NULL;
}

size_t abbe_yaml_count(const abbe_yaml *yaml, abbe_yaml_node which) {
  const node *n = at(yaml, which);
  if (n == NULL) return 0;
  return n->kind == MAPPING ? n->count / 2 : n->count;
}

static abbe_yaml_node child_of(const abbe_yaml *yaml, abbe_yaml_node parent, node_kind kind,
                               size_t index) {
  const node *n = at(yaml, parent);
  if (n == NULL || n->kind != kind || index >= n->count) return (abbe_yaml_node){0};
  return (abbe_yaml_node){n->child[index]};
}

abbe_yaml_node abbe_yaml_item(const abbe_yaml *yaml, abbe_yaml_node sequence, size_t index) {
  return child_of(yaml, sequence, SEQUENCE, index);
}
abbe_yaml_node abbe_yaml_key(const abbe_yaml *yaml, abbe_yaml_node mapping, size_t index) {
  return index < SIZE_MAX / 2 ? child_of(yaml, mapping, MAPPING, 2 * index) : (abbe_yaml_node){0};
}
abbe_yaml_node abbe_yaml_value(const abbe_yaml *yaml, abbe_yaml_node mapping, size_t index) {
  return index < SIZE_MAX / 2 ? child_of(yaml, mapping, MAPPING, 2 * index + 1)
                              : (abbe_yaml_node){0};
}

/* Remembers the key for suggestions; without memory a suggestion is lost, nothing else. */
static void remember(node *mapping, const char *key) {
  for (size_t i = 0; i < mapping->known_count; i++)
    if (strcmp(mapping->known[i], key) == 0) return;
  char **known = realloc(mapping->known, (mapping->known_count + 1) * sizeof *known);
  if (known == NULL) return;
  mapping->known = known;
  known[mapping->known_count] = strdup(key);
  if (known[mapping->known_count] != NULL) mapping->known_count++;
}

abbe_yaml_node abbe_yaml_get(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key) {
  node *n = at(yaml, mapping);
  if (n == NULL || n->kind != MAPPING) return (abbe_yaml_node){0};
  remember(n, key);
  for (size_t i = 0; i + 1 < n->count; i += 2) {
    node *k = at(yaml, (abbe_yaml_node){n->child[i]});
    if (strcmp(k->text, key) != 0) continue;
    k->asked = true;
    return (abbe_yaml_node){n->child[i + 1]};
  }
  return (abbe_yaml_node){0};
}

abbe_result abbe_yaml_require(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                              abbe_yaml_node *out, abbe_error *error) {
  ABBE_REQUIRE(yaml && key && out, error);
  if (!abbe_yaml_is_mapping(yaml, mapping))
    return abbe_yaml_fail(yaml, mapping, error, "a mapping with the key '%s' is wanted here", key);
  *out = abbe_yaml_get(yaml, mapping, key);
  if (out->id != 0) return ABBE_OK;
  /* Most often the key is there, mistyped. */
  const node *n = at(yaml, mapping);
  for (size_t i = 0; i + 1 < n->count; i += 2) {
    abbe_yaml_node other = {n->child[i]};
    const char *text = at(yaml, other)->text;
    if (!at(yaml, other)->asked && abbe_nearest_word(text, &key, 1) != NULL)
      return abbe_yaml_fail(yaml, other, error, "the key '%s' is missing here; is '%.60s' meant?",
                            key, text);
  }
  return abbe_yaml_fail(yaml, mapping, error, "the key '%s' is missing here", key);
}

abbe_result abbe_yaml_check_keys(const abbe_yaml *yaml, abbe_yaml_node mapping, const char *what,
                                 abbe_error *error) {
  ABBE_REQUIRE(yaml && what, error);
  const node *n = at(yaml, mapping);
  if (n == NULL || n->kind != MAPPING)
    return abbe_yaml_fail(yaml, mapping, error, "%s must be a mapping (key: value)", what);
  for (size_t i = 0; i + 1 < n->count; i += 2) {
    abbe_yaml_node key = {n->child[i]};
    if (at(yaml, key)->asked) continue;
    const char *text = at(yaml, key)->text;
    const char *near = abbe_nearest_word(text, (const char *const *)n->known, n->known_count);
    if (near != NULL)
      return abbe_yaml_fail(yaml, key, error, "%s has no key '%.60s'; did you mean '%s'?", what,
                            text, near);
    return abbe_yaml_fail(yaml, key, error, "%s has no key '%.60s'", what, text);
  }
  return ABBE_OK;
}

/* ---- typed values ---- */

/* What a node is, for "… is wanted, not …". */
static const char *kind_name(const abbe_yaml *yaml, abbe_yaml_node which) {
  const node *n = at(yaml, which);
  if (n == NULL) return "nothing";
  if (n->kind != SCALAR) return n->kind == MAPPING ? "a mapping" : "a list";
  return n->quoted ? "text in quotes" : "a word";
}

static bool parse_number(const char *text, double *value) {
  const char *end;
  if (*text == '\0' || text[strspn(text, "0123456789+-.eE")] != '\0') return false;
  return abbe_number_read(text, &end, value) && *end == '\0' && isfinite(*value);
}

abbe_result abbe_yaml_number(const abbe_yaml *yaml, abbe_yaml_node which, const char *what,
                             double min, double max, double *out, abbe_error *error) {
  ABBE_REQUIRE(yaml && what && out, error);
  const node *n = at(yaml, which);
  if (n == NULL || n->kind != SCALAR || n->quoted)
    return abbe_yaml_fail(yaml, which, error, "'%s' wants a number, not %s", what,
                          kind_name(yaml, which));
  double value = 0;
  if (!parse_number(n->text, &value))
    return abbe_yaml_fail(yaml, which, error, "'%s: %.60s' is not a finite number", what, n->text);
  if (value < min || value > max)
    return abbe_yaml_fail(yaml, which, error, "'%s: %.60s' is not in the range from %g to %g", what,
                          n->text, min, max);
  *out = value;
  return ABBE_OK;
}

abbe_result abbe_yaml_get_number(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                 double min, double max, double *out, abbe_error *error) {
  ABBE_REQUIRE(yaml && key && out, error);
  abbe_yaml_node value = abbe_yaml_get(yaml, mapping, key);
  return value.id == 0 ? ABBE_OK : abbe_yaml_number(yaml, value, key, min, max, out, error);
}

abbe_result abbe_yaml_get_count(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                size_t min, size_t max, size_t *out, abbe_error *error) {
  ABBE_REQUIRE(yaml && key && out, error);
  abbe_yaml_node which = abbe_yaml_get(yaml, mapping, key);
  if (which.id == 0) return ABBE_OK;
  const node *n = at(yaml, which);
  if (n->kind != SCALAR || n->quoted)
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
  ABBE_REQUIRE(yaml && key && out, error);
  abbe_yaml_node which = abbe_yaml_get(yaml, mapping, key);
  if (which.id == 0) return ABBE_OK;
  const node *n = at(yaml, which);
  if (n->kind != SCALAR || n->quoted)
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
  ABBE_REQUIRE(yaml && key && out, error);
  abbe_yaml_node which = abbe_yaml_get(yaml, mapping, key);
  if (which.id == 0) return ABBE_OK;
  const node *n = at(yaml, which);
  if (n->kind != SCALAR)
    return abbe_yaml_fail(yaml, which, error, "'%s' wants text, not %s", key,
                          kind_name(yaml, which));
  if (*n->text == '\0')
    return abbe_yaml_fail(yaml, which, error, "'%s' is empty; give it a text or leave it out", key);
  char *copy = strdup(n->text);
  if (copy == NULL) return no_memory(yaml, error);
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
    return no_memory(yaml, error);
  }
  abbe_utf8_printable(text, length, false, shown, size);
  free(text);
  free(*out);
  *out = shown;
  return ABBE_OK;
}

abbe_result abbe_yaml_get_choice(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                 const char *const *names, int *out, abbe_error *error) {
  ABBE_REQUIRE(yaml && key && names && out, error);
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
  return abbe_yaml_fail(yaml, which, error, "'%s: %.60s' is not known%s%s%s; it is one of %s", key,
                        text, near ? "; did you mean '" : "", near ? near : "", near ? "'?" : "",
                        list);
}

abbe_result abbe_yaml_get_numbers(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                                  size_t count, double min, double max, double *out,
                                  abbe_error *error) {
  ABBE_REQUIRE(yaml && key && out, error);
  abbe_yaml_node list = abbe_yaml_get(yaml, mapping, key);
  if (list.id == 0) return ABBE_OK;
  if (!abbe_yaml_is_sequence(yaml, list))
    return abbe_yaml_fail(yaml, list, error, "'%s' wants a list of %zu numbers, not %s", key, count,
                          kind_name(yaml, list));
  if (abbe_yaml_count(yaml, list) != count)
    return abbe_yaml_fail(yaml, list, error, "'%s' wants %zu numbers, not %zu", key, count,
                          abbe_yaml_count(yaml, list));
  /* checked before anything is written: a refused list leaves the default whole */
  double value = 0;
  for (size_t i = 0; i < count; i++) {
    abbe_yaml_node item = abbe_yaml_item(yaml, list, i);
    abbe_result result = abbe_yaml_number(yaml, item, key, min, max, &value, error);
    if (result != ABBE_OK) return result;
  }
  for (size_t i = 0; i < count; i++)
    abbe_yaml_number(yaml, abbe_yaml_item(yaml, list, i), key, min, max, &out[i], error);
  return ABBE_OK;
}

abbe_result abbe_yaml_get_list(abbe_yaml *yaml, abbe_yaml_node mapping, const char *key,
                               size_t max_count, double **out, size_t *count, abbe_error *error) {
  ABBE_REQUIRE(yaml && key && out && count, error);
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
  if (values == NULL) return no_memory(yaml, error);
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
