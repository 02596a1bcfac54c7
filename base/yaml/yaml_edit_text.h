/* yaml_edit_text.h: the text under base/yaml/yaml_edit.h: its lines, where things stand in it, and
 * how bytes of it are replaced. */
#ifndef ABBE_BASE_YAML_YAML_EDIT_TEXT_H
#define ABBE_BASE_YAML_YAML_EDIT_TEXT_H

#include "base/error.h"
#include "base/yaml/yaml_edit.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* The bytes [from, to) of the text. */
typedef struct abbe_yaml_bytes {
  size_t from, to;
} abbe_yaml_bytes;

abbe_result abbe_yaml_edit_no_memory(const abbe_yaml_edit *e, abbe_error *error);

/* Those of a node, as abbe_yaml_span has them. */
abbe_yaml_bytes abbe_yaml_edit_span_of(const abbe_yaml_edit *e, abbe_yaml_node node);

/* For the line of `at`: its start behind a byte-order mark, the end of its text before its line
 * end, and the start of the line after it, or the end of the text. */
size_t abbe_yaml_edit_line_from(const abbe_yaml_edit *e, size_t at);
size_t abbe_yaml_edit_line_to(const abbe_yaml_edit *e, size_t at);
size_t abbe_yaml_edit_next_line(const abbe_yaml_edit *e, size_t at);
size_t abbe_yaml_edit_column_of(const abbe_yaml_edit *e, size_t at);
/* Spaces at the start of a line. */
size_t abbe_yaml_edit_indent_of(const abbe_yaml_edit *e, size_t line);
bool abbe_yaml_edit_is_blank(const abbe_yaml_edit *e, size_t line);
/* "\n" or "\r\n", as the first line has it. */
const char *abbe_yaml_edit_line_end(const abbe_yaml_edit *e);

/* Behind the colon that follows a key. */
size_t abbe_yaml_edit_colon_after(const abbe_yaml_edit *e, size_t at);
/* The dash of a block item whose content begins at `at`. */
size_t abbe_yaml_edit_dash_before(const abbe_yaml_edit *e, size_t at);
/* The end of the last line of a block: of its content, then of comments indented deeper than it. */
size_t abbe_yaml_edit_block_end(const abbe_yaml_edit *e, size_t to, size_t indent);

/* Replaces bytes of the text and reads it anew; on failure all is as it was. */
abbe_result abbe_yaml_edit_splice(abbe_yaml_edit *e, abbe_yaml_bytes where, const char *with,
                                  abbe_error *error);
/* The same, which holds only if the value, skip bytes into `with`, is read as a value: whole, and
 * alone. what is its key, for messages. */
abbe_result abbe_yaml_edit_splice_value(abbe_yaml_edit *e, abbe_yaml_bytes where, const char *with,
                                        size_t skip, const char *value, const char *what,
                                        abbe_error *error);
/* Closes a memory stream: its text, or NULL where memory ran out. */
char *abbe_yaml_edit_closed(FILE *stream, char **text);

/* Any text as one YAML scalar that reads back the same.
 *
 * Plain where no place in YAML takes it for anything else, else in double quotes, on one line
 * either way. Bytes that are no UTF-8 (a file's name may hold them) become U+FFFD, since they would
 * make the whole file unreadable. */

/* Writes to the stream, whose own error state shows a failure. */
void abbe_yaml_quote_write(const char *text, FILE *to);
/* *out is malloc'd, NULL on failure. ABBE_NO_MEMORY. */
abbe_result abbe_yaml_quote_make(const char *text, char **out, abbe_error *error);

#endif
