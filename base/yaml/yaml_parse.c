/* From libyaml's events to a tree. */
#include "base/file.h"

#include "base/yaml/yaml_tree.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

abbe_text_cursor abbe_text_cursor_make(const char *text, size_t size) {
  bool marked = size >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0;
  return (abbe_text_cursor){.text = text, .size = size, .byte = marked ? 3 : 0};
}

static bool continues(const abbe_text_cursor *c) {
  return c->byte < c->size && ((unsigned char)c->text[c->byte] & 0xc0) == 0x80;
}

size_t abbe_text_cursor_byte(abbe_text_cursor *c, size_t index) {
  for (; c->index < index && c->byte < c->size; c->index++) {
    do c->byte++;
    while (continues(c));
  }
  for (; c->index > index && c->byte > 0; c->index--) {
    do c->byte--;
    while (c->byte > 0 && continues(c));
  }
  return c->byte;
}

enum {
  MAX_BYTES = 16 << 20,
  MAX_DEPTH = 64,
  MAX_NODES = 1000000 /* counted with every alias written out, so that aliases cannot explode */
};

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
  bool done;               /* the document has ended */
  abbe_text_cursor cursor; /* libyaml's marks count characters */
  size_t leaf_end;         /* byte where the latest leaf or bracket ends */
} builder;

/* A block scalar's mark stands after the empty lines that follow it. */
static size_t end_of_leaf(builder *b, const yaml_event_t *event) {
  size_t from = abbe_text_cursor_byte(&b->cursor, event->start_mark.index);
  size_t to = abbe_text_cursor_byte(&b->cursor, event->end_mark.index);
  while (to > from && memchr(" \t\r\n", b->cursor.text[to - 1], 4) != NULL) to--;
  b->leaf_end = to;
  return to;
}

static abbe_yaml_part *top(const builder *b) {
  return abbe_yaml_at(b->yaml, (abbe_yaml_node){b->stack[b->depth - 1]});
}

static bool wants_key(const builder *b) {
  return b->depth > 0 && top(b)->kind == ABBE_YAML_MAPPING && top(b)->count % 2 == 0;
}

static abbe_result add_node(builder *b, abbe_yaml_kind kind, size_t line, int *id) {
  abbe_yaml *yaml = b->yaml;
  if (yaml->count >= MAX_NODES)
    return abbe_yaml_fail_at(yaml, line, ABBE_SCHEMA, b->error,
                             "more than %d values; split the file", MAX_NODES);
  abbe_yaml_part *nodes = grown(yaml->nodes, yaml->count, &yaml->capacity, sizeof *nodes);
  if (nodes == NULL) return abbe_yaml_no_memory(yaml, b->error);
  yaml->nodes = nodes;
  nodes[yaml->count++] = (abbe_yaml_part){.kind = kind, .open = true, .line = line, .weight = 1};
  *id = (int)yaml->count;
  return ABBE_OK;
}

/* Hangs a node below the open one. Its weight is added when it is whole. */
static abbe_result attach(builder *b, int id) {
  if (b->depth == 0) return ABBE_OK;
  abbe_yaml_part *parent = top(b);
  int *child = grown(parent->child, parent->count, &parent->capacity, sizeof *child);
  if (child == NULL) return abbe_yaml_no_memory(b->yaml, b->error);
  parent->child = child;
  child[parent->count++] = id;
  return ABBE_OK;
}

static abbe_result close_node(builder *b, int id, size_t line) {
  abbe_yaml_part *child = abbe_yaml_at(b->yaml, (abbe_yaml_node){id});
  child->open = false;
  if (b->depth == 0) return ABBE_OK;
  abbe_yaml_part *parent = top(b);
  parent->weight += child->weight;
  if (parent->weight <= MAX_NODES) return ABBE_OK;
  return abbe_yaml_fail_at(b->yaml, line, ABBE_SCHEMA, b->error,
                           "more than %d values once its aliases (*name) are written out",
                           MAX_NODES);
}

static abbe_result add_anchor(builder *b, const yaml_char_t *anchor, int id, size_t line) {
  abbe_yaml *yaml = b->yaml;
  if (anchor == NULL) return ABBE_OK;
  if (yaml->anchor_count == ABBE_YAML_MAX_ANCHORS)
    return abbe_yaml_fail_at(yaml, line, ABBE_SCHEMA, b->error, "more than %d anchors (&name)",
                             ABBE_YAML_MAX_ANCHORS);
  char *name = strdup((const char *)anchor);
  if (name == NULL) return abbe_yaml_no_memory(yaml, b->error);
  yaml->anchors[yaml->anchor_count].name = name;
  yaml->anchors[yaml->anchor_count++].id = id;
  return ABBE_OK;
}

static abbe_result add_alias(builder *b, const char *name, size_t line) {
  const abbe_yaml *yaml = b->yaml;
  if (wants_key(b))
    return abbe_yaml_fail_at(yaml, line, ABBE_SCHEMA, b->error,
                             "the alias *%.60s stands for a key; write the key itself", name);
  for (size_t i = yaml->anchor_count; i-- > 0;) { /* the latest of a name holds */
    if (strcmp(yaml->anchors[i].name, name) != 0) continue;
    int id = yaml->anchors[i].id;
    if (abbe_yaml_at(yaml, (abbe_yaml_node){id})->open)
      return abbe_yaml_fail_at(yaml, line, ABBE_SCHEMA, b->error,
                               "the alias *%.60s stands inside what it names", name);
    abbe_result result = attach(b, id);
    return result != ABBE_OK ? result : close_node(b, id, line);
  }
  return abbe_yaml_fail_at(yaml, line, ABBE_SCHEMA, b->error,
                           "the alias *%.60s has no anchor &%.60s before it", name, name);
}

static abbe_result add_scalar(builder *b, const yaml_event_t *event, size_t line) {
  const char *value = (const char *)event->data.scalar.value;
  size_t length = event->data.scalar.length;
  if (strlen(value) != length)
    return abbe_yaml_fail_at(b->yaml, line, ABBE_SCHEMA, b->error, "a text holds a zero byte");
  int id = 0;
  ABBE_TRY(add_node(b, ABBE_YAML_SCALAR, line, &id));
  abbe_yaml_part *scalar = abbe_yaml_at(b->yaml, (abbe_yaml_node){id});
  scalar->quoted = event->data.scalar.style != YAML_PLAIN_SCALAR_STYLE;
  scalar->from = abbe_text_cursor_byte(&b->cursor, event->start_mark.index);
  scalar->to = end_of_leaf(b, event);
  scalar->text = malloc(length + 1);
  if (scalar->text == NULL) return abbe_yaml_no_memory(b->yaml, b->error);
  memcpy(scalar->text, value, length + 1);
  ABBE_TRY(add_anchor(b, event->data.scalar.anchor, id, line));
  ABBE_TRY(attach(b, id));
  return close_node(b, id, line);
}

static abbe_result open_collection(builder *b, abbe_yaml_kind kind, const yaml_event_t *event,
                                   size_t line) {
  bool list = kind == ABBE_YAML_SEQUENCE;
  const yaml_char_t *anchor =
      list ? event->data.sequence_start.anchor : event->data.mapping_start.anchor;
  if (wants_key(b))
    return abbe_yaml_fail_at(b->yaml, line, ABBE_SCHEMA, b->error, "a key must be a plain word");
  if (b->depth == MAX_DEPTH)
    return abbe_yaml_fail_at(b->yaml, line, ABBE_SCHEMA, b->error,
                             "is nested deeper than %d levels", MAX_DEPTH);
  int id = 0;
  ABBE_TRY(add_node(b, kind, line, &id));
  abbe_yaml_part *collection = abbe_yaml_at(b->yaml, (abbe_yaml_node){id});
  collection->from = abbe_text_cursor_byte(&b->cursor, event->start_mark.index);
  collection->flow = list ? event->data.sequence_start.style == YAML_FLOW_SEQUENCE_STYLE
                          : event->data.mapping_start.style == YAML_FLOW_MAPPING_STYLE;
  ABBE_TRY(add_anchor(b, anchor, id, line));
  ABBE_TRY(attach(b, id));
  b->stack[b->depth++] = id;
  return ABBE_OK;
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

static abbe_result check_duplicates(builder *b, const abbe_yaml_part *mapping) {
  size_t pairs = mapping->count / 2;
  if (pairs < 2) return ABBE_OK;
  ABBE_FREED key_place *keys = malloc(pairs * sizeof *keys);
  if (keys == NULL) return abbe_yaml_no_memory(b->yaml, b->error);
  for (size_t i = 0; i < pairs; i++) {
    const abbe_yaml_part *key = abbe_yaml_at(b->yaml, (abbe_yaml_node){mapping->child[2 * i]});
    keys[i] = (key_place){key->text, key->line};
  }
  qsort(keys, pairs, sizeof *keys, by_text);
  for (size_t i = 1; i < pairs; i++)
    if (strcmp(keys[i - 1].text, keys[i].text) == 0)
      ABBE_TRY(
          abbe_yaml_fail_at(b->yaml, keys[i].line, ABBE_SCHEMA, b->error,
                            "the key '%.60s' stands here a second time; the first is on line %zu",
                            keys[i].text, keys[i - 1].line));
  return ABBE_OK;
}

static abbe_result close_collection(builder *b, const yaml_event_t *event, size_t line) {
  int id = b->stack[b->depth - 1];
  abbe_yaml_part *closing = top(b);
  if (closing->flow) end_of_leaf(b, event);
  closing->to = b->leaf_end; /* a block's own mark stands after the comments that follow it */
  abbe_result result = closing->kind == ABBE_YAML_MAPPING ? check_duplicates(b, closing) : ABBE_OK;
  b->depth--;
  return result != ABBE_OK ? result : close_node(b, id, line);
}

static abbe_result take_event(builder *b, const yaml_event_t *event) {
  size_t line = event->start_mark.line + 1;
  switch (event->type) {
  case YAML_DOCUMENT_START_EVENT:
    if (!b->done) return ABBE_OK;
    return abbe_yaml_fail_at(b->yaml, line, ABBE_SCHEMA, b->error,
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
    return open_collection(b, ABBE_YAML_SEQUENCE, event, line);
  case YAML_MAPPING_START_EVENT:
    return open_collection(b, ABBE_YAML_MAPPING, event, line);
  case YAML_SEQUENCE_END_EVENT:
  case YAML_MAPPING_END_EVENT:
    return close_collection(b, event, line);
  default:
    return ABBE_OK;
  }
}

/* Whether that line, counted from 0, begins with a tab among its blanks. */
static bool begins_with_tab(const char *text, size_t size, size_t line) {
  const char *at = text, *end = text + size;
  for (; line > 0 && at != NULL; line--) {
    at = memchr(at, '\n', (size_t)(end - at));
    if (at != NULL) at++;
  }
  while (at != NULL && at < end && *at == ' ') at++;
  return at != NULL && at < end && *at == '\t';
}

static abbe_result not_well_formed(builder *b, const yaml_parser_t *parser, const char *text,
                                   size_t size) {
  const char *problem = parser->problem != NULL ? parser->problem : "not YAML";
  if (parser->error == YAML_MEMORY_ERROR) return abbe_yaml_no_memory(b->yaml, b->error);
  if (parser->error == YAML_READER_ERROR)
    return abbe_yaml_fail_at(b->yaml, 0, ABBE_PARSE, b->error,
                             "is not well-formed YAML: %s at byte %zu", problem,
                             parser->problem_offset);
  if (begins_with_tab(text, size, parser->problem_mark.line))
    return abbe_yaml_fail_at(b->yaml, parser->problem_mark.line + 1, ABBE_PARSE, b->error,
                             "the line begins with a tab; YAML indents by blanks");
  return abbe_yaml_fail_at(b->yaml, parser->problem_mark.line + 1, ABBE_PARSE, b->error,
                           "is not well-formed YAML: %s%s%s", problem, parser->context ? " " : "",
                           parser->context ? parser->context : "");
}

static abbe_result build(builder *b, const char *text, size_t size) {
  yaml_parser_t parser;
  if (!yaml_parser_initialize(&parser)) return abbe_yaml_no_memory(b->yaml, b->error);
  yaml_parser_set_input_string(&parser, (const unsigned char *)text, size);
  abbe_result result = ABBE_OK;
  for (bool end = false; !end && result == ABBE_OK;) {
    yaml_event_t event;
    if (!yaml_parser_parse(&parser, &event)) {
      result = not_well_formed(b, &parser, text, size);
      break;
    }
    result = take_event(b, &event);
    end = event.type == YAML_STREAM_END_EVENT;
    yaml_event_delete(&event);
  }
  yaml_parser_delete(&parser);
  if (result == ABBE_OK && b->yaml->count == 0)
    result = abbe_yaml_fail_at(b->yaml, 0, ABBE_PARSE, b->error, "is empty");
  return result;
}

abbe_result abbe_yaml_parse(const char *text, size_t size, const char *name, abbe_yaml **out,
                            abbe_error *error) {
  *out = NULL;
  abbe_yaml *yaml = calloc(1, sizeof *yaml);
  if (yaml != NULL) yaml->name = strdup(name);
  if (yaml == NULL || yaml->name == NULL) {
    abbe_yaml_free(yaml);
    return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory to read it", name);
  }
  abbe_result result;
  if (size > MAX_BYTES) {
    result = abbe_yaml_fail_at(yaml, 0, ABBE_IO, error,
                               "is %zu bytes long; at most %d are allowed here", size, MAX_BYTES);
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
  *out = NULL;
  ABBE_FREED char *text = NULL;
  size_t size = 0;
  ABBE_TRY(abbe_file_read_text(path, MAX_BYTES, &text, &size, error));
  return abbe_yaml_parse(text, size, path, out, error);
}
