/* yaml_tree.h: the document that base/yaml/yaml.h hides, for those who make and read it.
 * Internal to base/. */
#ifndef ABBE_BASE_YAML_YAML_TREE_H
#define ABBE_BASE_YAML_YAML_TREE_H

#include "base/yaml/yaml.h"

#include <stdbool.h>
#include <stddef.h>

enum { ABBE_YAML_MAX_ANCHORS = 1024 };

typedef enum abbe_yaml_kind {
  ABBE_YAML_SCALAR,
  ABBE_YAML_SEQUENCE,
  ABBE_YAML_MAPPING
} abbe_yaml_kind;

typedef struct abbe_yaml_part {
  abbe_yaml_kind kind;
  bool open;   /* its end has not been read: an alias to it would be a circle */
  bool quoted; /* a scalar in quotes or as a block is text, never a number */
  bool asked;  /* a key that a getter knows */
  bool flow;   /* a list or mapping in brackets */
  size_t line;
  size_t from, to; /* bytes of the text that the node takes up */
  size_t weight;   /* nodes below and including it, aliases written out */
  char *text;
  int *child; /* ids; a mapping's are key, value, key, value, … */
  size_t count, capacity;
  char **known; /* a mapping's: keys asked for, as suggestions */
  size_t known_count;
} abbe_yaml_part;

struct abbe_yaml {
  char *name;
  abbe_yaml_part *nodes; /* id - 1 */
  size_t count, capacity;
  struct {
    char *name;
    int id;
  } anchors[ABBE_YAML_MAX_ANCHORS];
  size_t anchor_count;
};

/* The part that a node stands for; NULL for an absent one. */
abbe_yaml_part *abbe_yaml_at(const abbe_yaml *yaml, abbe_yaml_node which);

/* "FILE:LINE: " (without a line where it is 0) and the sentence; returns code. */
#if defined(__GNUC__)
__attribute__((format(printf, 5, 6)))
#endif
abbe_result
abbe_yaml_fail_at(const abbe_yaml *yaml, size_t line, abbe_result code, abbe_error *error,
                  const char *format, ...);
abbe_result abbe_yaml_no_memory(const abbe_yaml *yaml, abbe_error *error);

/* From counts of characters to bytes in UTF-8 text.
 *
 * libyaml's marks count characters; edits need bytes. The cursor walks from where it last was, so
 * marks that come nearly in order cost little however long the text is. It does not check the
 * encoding: a wrong text gives a wrong byte, never one outside the text. */

typedef struct abbe_text_cursor {
  const char *text; /* the caller's */
  size_t size;      /* bytes */
  size_t byte;      /* where the cursor is */
  size_t index;     /* characters before it; a byte order mark at the start is none */
} abbe_text_cursor;

/* A cursor at the text's first character. */
abbe_text_cursor abbe_text_cursor_make(const char *text, size_t size);
/* Moves to the character of that index; its first byte, or size where the text is shorter. */
size_t abbe_text_cursor_byte(abbe_text_cursor *cursor, size_t index);

#endif
