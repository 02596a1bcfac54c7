#include "base/yaml/yaml_edit.h"

#include "base/number.h"
#include "base/yaml/yaml_quote.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { WIDTH = 100 };

static abbe_result no_memory(const abbe_yaml_edit *e, abbe_error *error) {
  return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory to edit it", e->name);
}

/* ---- the text and its lines ---- */

abbe_result abbe_yaml_edit_make(const char *text, size_t size, const char *name,
                                abbe_yaml_edit *out, abbe_error *error) {
  ABBE_REQUIRE(text && name && out, error);
  *out = (abbe_yaml_edit){0};
  if (size >= 2 && (memcmp(text, "\xFF\xFE", 2) == 0 || memcmp(text, "\xFE\xFF", 2) == 0))
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "%s: is UTF-16; edits want UTF-8 (iconv -f UTF-16 -t UTF-8 converts)",
                          name);
  abbe_yaml_edit edit = {.name = strdup(name), .text = malloc(size + 1), .size = size};
  abbe_result result;
  if (edit.name == NULL || edit.text == NULL) {
    result = abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory to edit it", name);
  } else {
    memcpy(edit.text, text, size);
    edit.text[size] = '\0';
    result = abbe_yaml_parse(edit.text, size, name, &edit.yaml, error);
  }
  if (result == ABBE_OK)
    *out = edit;
  else
    abbe_yaml_edit_free(&edit);
  return result;
}

void abbe_yaml_edit_free(abbe_yaml_edit *edit) {
  if (edit == NULL) return;
  abbe_yaml_free(edit->yaml);
  free(edit->name);
  free(edit->text);
  *edit = (abbe_yaml_edit){0};
}

typedef struct span {
  size_t from, to;
} span;

static span span_of(const abbe_yaml_edit *e, abbe_yaml_node node) {
  span s;
  abbe_yaml_span(e->yaml, node, &s.from, &s.to);
  return s;
}

static size_t line_from(const abbe_yaml_edit *e, size_t at) {
  while (at > 0 && e->text[at - 1] != '\n') at--;
  return at == 0 && e->size >= 3 && memcmp(e->text, "\xEF\xBB\xBF", 3) == 0 ? 3 : at;
}

/* The end of the line's text, before its line end. */
static size_t line_to(const abbe_yaml_edit *e, size_t at) {
  while (at < e->size && e->text[at] != '\n') at++;
  return at > 0 && at < e->size && e->text[at - 1] == '\r' ? at - 1 : at;
}

/* The start of the line after that of `at`, or the end of the text. */
static size_t next_line(const abbe_yaml_edit *e, size_t at) {
  while (at < e->size && e->text[at] != '\n') at++;
  return at < e->size ? at + 1 : at;
}

static size_t indent_of(const abbe_yaml_edit *e, size_t line) {
  size_t count = 0;
  while (line + count < e->size && e->text[line + count] == ' ') count++;
  return count;
}

static bool is_blank(const abbe_yaml_edit *e, size_t line) {
  return line < e->size && line + indent_of(e, line) == line_to(e, line);
}

static const char *line_end_of(const abbe_yaml_edit *e) {
  const char *end = memchr(e->text, '\n', e->size);
  return end != NULL && end > e->text && end[-1] == '\r' ? "\r\n" : "\n";
}

/* ---- a change ---- */

/* The text with [from, to) replaced, read anew; on failure all is as it was. */
static abbe_result splice(abbe_yaml_edit *e, span where, const char *with, abbe_error *error) {
  size_t length = strlen(with), size = e->size - (where.to - where.from) + length;
  char *text = malloc(size + 1);
  if (text == NULL) return no_memory(e, error);
  memcpy(text, e->text, where.from);
  memcpy(text + where.from, with, length);
  memcpy(text + where.from + length, e->text + where.to, e->size - where.to);
  text[size] = '\0';
  abbe_yaml *yaml = NULL;
  abbe_error why = {0};
  abbe_result result = abbe_yaml_parse(text, size, e->name, &yaml, &why);
  if (result != ABBE_OK) {
    free(text);
    return abbe_error_set(error, result == ABBE_NO_MEMORY ? result : ABBE_INVALID_ARGUMENT,
                          "the change would break the file: %s", why.text);
  }
  abbe_yaml_free(e->yaml);
  free(e->text);
  *e = (abbe_yaml_edit){e->name, text, size, yaml};
  return ABBE_OK;
}

/* Why value is none, where it stands: most often a decimal comma, in a list. */
static abbe_result not_a_value(const char *value, const char *what, abbe_error *error) {
  char point[64];
  snprintf(point, sizeof point, "%s", value);
  char *comma = strchr(point, ',');
  bool number = comma != NULL && point[strspn(point, "0123456789+-,.eE")] == '\0';
  if (comma != NULL) *comma = '.';
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "'%.60s' cannot stand as the value of %.60s; %s%s", value, what,
                        number ? "write a number with a decimal point, "
                               : "put it in quotes, or balance its brackets",
                        number ? point : "");
}

/* The change holds only if the value that was put in is read as a value: whole, and alone. */
static abbe_result splice_value(abbe_yaml_edit *e, span where, const char *with, size_t skip,
                                const char *value, const char *what, abbe_error *error) {
  abbe_yaml_edit before;
  abbe_result result = abbe_yaml_edit_make(e->text, e->size, e->name, &before, error);
  if (result != ABBE_OK) return result;
  result = splice(e, where, with, error);
  bool found = false;
  size_t from = where.from + skip, to = from + strlen(value);
  for (int id = 1; result == ABBE_OK && !found; id++) {
    abbe_yaml_node node = {id};
    if (abbe_yaml_line(e->yaml, node) == 0) break;
    span s = span_of(e, node);
    found = s.from == from && s.to == to;
  }
  if (result == ABBE_OK && !found) {
    abbe_yaml_edit bad = *e;
    *e = before;
    before = bad;
    result = not_a_value(value, what, error);
  }
  abbe_yaml_edit_free(&before);
  return result;
}

static char *joined(const char *a, const char *b, const char *c, const char *d) {
  size_t size = strlen(a) + strlen(b) + strlen(c) + strlen(d) + 1;
  char *text = malloc(size);
  if (text != NULL) snprintf(text, size, "%s%s%s%s", a, b, c, d);
  return text;
}

/* What was printed into a memory stream, or NULL where memory ran out. */
static char *closed(FILE *stream, char **text) {
  bool good = !ferror(stream);
  good = fclose(stream) == 0 && good;
  if (good) return *text;
  free(*text);
  return NULL;
}

/* A flow list too long for its line, broken after commas outside inner brackets; else a copy. */
static char *laid_out(const abbe_yaml_edit *e, const char *value, size_t column, size_t indent) {
  size_t length = strlen(value);
  bool list =
      length > 2 && value[0] == '[' && value[length - 1] == ']' && strpbrk(value, "\"'#\n") == NULL;
  if (column + length <= WIDTH || !list || indent > WIDTH / 2) return strdup(value);
  char *text = NULL;
  size_t size = 0, at = indent + 2;
  FILE *out = open_memstream(&text, &size);
  if (out == NULL) return NULL;
  fprintf(out, "[%s%*s", line_end_of(e), (int)indent + 2, "");
  for (size_t i = 1; i < length - 1;) {
    size_t end = i, depth = 0;
    for (; end < length - 1 && (depth > 0 || value[end] != ','); end++)
      depth += (value[end] == '[') - (size_t)(value[end] == ']');
    if (at > indent + 2 && at + 1 + end - i + 1 > WIDTH)
      at = (size_t)fprintf(out, "%s%*s", line_end_of(e), (int)indent + 2, "");
    else if (at > indent + 2)
      at += (size_t)fprintf(out, " ");
    at += (size_t)fprintf(out, "%.*s%s", (int)(end - i), value + i, end < length - 1 ? "," : "");
    for (i = end + (end < length - 1); value[i] == ' ';) i++;
  }
  fprintf(out, "%s%*s]", line_end_of(e), (int)indent, "");
  return closed(out, &text);
}

/* ---- values ---- */

static abbe_yaml_node child_of(const abbe_yaml_edit *e, abbe_yaml_node parent, size_t index) {
  return abbe_yaml_is_mapping(e->yaml, parent) ? abbe_yaml_value(e->yaml, parent, index)
                                               : abbe_yaml_item(e->yaml, parent, index);
}

/* An alias shares the node that it names, which stands before its parent or beside it. */
bool abbe_yaml_edit_is_alias(const abbe_yaml_edit *e, abbe_yaml_node parent, size_t index) {
  span p = span_of(e, parent), c = span_of(e, child_of(e, parent, index));
  if (c.from < p.from || c.to > p.to) return true;
  size_t floor = p.from; /* the end of what stands before, aliases among it ending earlier */
  if (abbe_yaml_is_mapping(e->yaml, parent))
    floor = span_of(e, abbe_yaml_key(e->yaml, parent, index)).to;
  for (size_t i = 0; i < index && abbe_yaml_is_sequence(e->yaml, parent); i++) {
    size_t to = span_of(e, abbe_yaml_item(e->yaml, parent, i)).to;
    if (to > floor) floor = to;
  }
  return c.from < floor;
}

static abbe_result refuse_alias(const abbe_yaml_edit *e, abbe_yaml_node parent, abbe_error *error) {
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "%s:%zu: an alias (*name) stands here for a value that other places share; "
                        "edit it by hand",
                        e->name, abbe_yaml_line(e->yaml, parent));
}

static size_t column_of(const abbe_yaml_edit *e, size_t at) {
  return at - line_from(e, at);
}

static size_t colon_after(const abbe_yaml_edit *e, size_t at) {
  while (at < e->size && e->text[at] != ':') at++;
  return at < e->size ? at + 1 : at;
}

/* A block below its key: the value goes onto the key's line, the block's lines go, and comments
 * between the two stay. */
static abbe_result replace_block(abbe_yaml_edit *e, span key, span old, const char *value,
                                 const char *what, abbe_error *error) {
  size_t colon = colon_after(e, key.to), first = line_from(e, old.from), keep = first - colon;
  while (keep > 0 && (e->text[colon + keep - 1] == '\n' || e->text[colon + keep - 1] == '\r'))
    keep--; /* the line end before the block goes with the block */
  char *kept = strndup(e->text + colon, keep);
  char *text = kept == NULL ? NULL : joined(" ", value, kept, "");
  free(kept);
  if (text == NULL) return no_memory(e, error);
  span where = {colon, line_to(e, old.to)};
  abbe_result result = splice_value(e, where, text, 1, value, what, error);
  free(text);
  return result;
}

static abbe_result check_line(const char *value, const char *what, abbe_error *error) {
  if (*value != '\0' && *value != ' ' && value[strlen(value) - 1] != ' ' &&
      strpbrk(value, "\r\n") == NULL)
    return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "the value of '%.60s' must be one line, not empty, without spaces at its "
                        "ends",
                        what);
}

abbe_result abbe_yaml_edit_replace(abbe_yaml_edit *e, abbe_yaml_node parent, size_t index,
                                   const char *value, abbe_error *error) {
  ABBE_REQUIRE(e && value, error);
  abbe_yaml_node old = child_of(e, parent, index);
  if (old.id == 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: has no value number %zu here", e->name,
                          index);
  if (abbe_yaml_edit_is_alias(e, parent, index)) return refuse_alias(e, parent, error);
  bool mapping = abbe_yaml_is_mapping(e->yaml, parent), flow = abbe_yaml_is_flow(e->yaml, parent);
  char what[64] = "an item";
  if (mapping)
    snprintf(what, sizeof what, "%s",
             abbe_yaml_text(e->yaml, abbe_yaml_key(e->yaml, parent, index)));
  abbe_result result = check_line(value, what, error);
  if (result != ABBE_OK) return result;
  span where = span_of(e, old), key = where;
  if (mapping) key = span_of(e, abbe_yaml_key(e->yaml, parent, index));
  char *shaped = flow || !mapping
                     ? strdup(value)
                     : laid_out(e, value, column_of(e, key.to) + 2, column_of(e, key.from));
  if (shaped == NULL) return no_memory(e, error);
  bool block = !flow && !abbe_yaml_is_scalar(e->yaml, old) && !abbe_yaml_is_flow(e->yaml, old);
  if (block && mapping) {
    result = replace_block(e, key, where, shaped, what, error);
  } else {
    bool touches = where.from == where.to && where.from > 0 && e->text[where.from - 1] != ' ';
    char *text = joined(touches ? " " : "", shaped, "", "");
    result = text == NULL ? no_memory(e, error)
                          : splice_value(e, where, text, touches, shaped, what, error);
    free(text);
  }
  free(shaped);
  return result;
}

abbe_result abbe_yaml_edit_insert_pair(abbe_yaml_edit *e, abbe_yaml_node mapping, size_t after,
                                       const char *key, const char *value, abbe_error *error) {
  ABBE_REQUIRE(e && key && value, error);
  abbe_result result = check_line(value, key, error);
  if (result != ABBE_OK) return result;
  size_t count = abbe_yaml_count(e->yaml, mapping);
  if (after >= count) after = count - 1;
  bool flow = abbe_yaml_is_flow(e->yaml, mapping);
  if (count == 0) { /* only brackets can be empty: {} */
    size_t at = span_of(e, mapping).to - 1;
    char *text = joined(key, ": ", value, "");
    result = text == NULL
                 ? no_memory(e, error)
                 : splice_value(e, (span){at, at}, text, strlen(key) + 2, value, key, error);
    free(text);
    return result;
  }
  if (abbe_yaml_edit_is_alias(e, mapping, after)) {
    /* where the alias itself ends is not known: go before it, after the pair that precedes it */
    if (after == 0 || abbe_yaml_edit_is_alias(e, mapping, after - 1))
      return refuse_alias(e, mapping, error);
    after--;
  }
  span last = span_of(e, abbe_yaml_value(e->yaml, mapping, after));
  size_t indent = column_of(e, span_of(e, abbe_yaml_key(e->yaml, mapping, 0)).from);
  size_t at = flow ? last.to : line_to(e, last.to);
  char lead[256] = ", ";
  if (!flow) snprintf(lead, sizeof lead, "%s%*s", line_end_of(e), (int)(indent % 200), "");
  char *shaped = flow ? strdup(value) : laid_out(e, value, indent + strlen(key) + 2, indent);
  char *text = shaped == NULL ? NULL : joined(lead, key, ": ", shaped);
  size_t skip = strlen(lead) + strlen(key) + 2;
  result = text == NULL ? no_memory(e, error)
                        : splice_value(e, (span){at, at}, text, skip, shaped, key, error);
  free(shaped);
  free(text);
  return result;
}

/* ---- taking out ---- */

/* In brackets a pair or item goes with the comma after it, or, the last one, with that before. */
static span flow_extent(const abbe_yaml_edit *e, span own, size_t floor) {
  size_t after = own.to;
  while (after < e->size && strchr(" \t\r\n", e->text[after]) != NULL && e->text[after] != '\0')
    after++;
  if (after < e->size && e->text[after] == ',') {
    for (after++; after < e->size && e->text[after] == ' ';) after++;
    return (span){own.from, after};
  }
  size_t before = own.from;
  while (before > floor && strchr(" \t\r\n", e->text[before - 1]) != NULL) before--;
  if (before > floor && e->text[before - 1] == ',') return (span){before - 1, own.to};
  return own;
}

/* The dash of a block item whose content begins at `at`. */
static size_t dash_before(const abbe_yaml_edit *e, size_t at) {
  size_t line = line_from(e, at), dash = line + indent_of(e, line);
  while (line > 0 && (dash >= at || e->text[dash] != '-')) {
    line = line_from(e, line - 1);
    dash = line + indent_of(e, line);
  }
  return dash;
}

/* The end of the last line of a block: of its content, then of comments indented deeper than it. */
static size_t block_end(const abbe_yaml_edit *e, size_t to, size_t indent) {
  size_t end = line_to(e, to);
  for (size_t line = next_line(e, to); line < e->size; line = next_line(e, line)) {
    size_t own = indent_of(e, line);
    if (own <= indent || e->text[line + own] != '#') break;
    end = line_to(e, line);
  }
  return end;
}

/* Whole lines, and of the blank lines around them as many as keep the rest's rhythm. */
static span block_extent(const abbe_yaml_edit *e, size_t from, size_t to, bool first) {
  span s = {line_from(e, from), next_line(e, to)};
  size_t after = s.to;
  while (is_blank(e, after) && next_line(e, after) > after) after = next_line(e, after);
  size_t before = s.from > 0 ? line_from(e, s.from - 1) : 0;
  bool blank_before = s.from > 0 && is_blank(e, before);
  if (first && s.from > 0 && e->text[before + indent_of(e, before)] != '#')
    blank_before = true; /* it begins its list: what follows will */
  if (after >= e->size) {
    while (s.from > 0 && is_blank(e, line_from(e, s.from - 1))) s.from = line_from(e, s.from - 1);
    if (s.to == e->size && s.from > 0 && e->text[e->size - 1] != '\n') {
      s.from--; /* a text without a last line end stays one */
      if (s.from > 0 && e->text[s.from - 1] == '\r') s.from--;
    }
  } else if (blank_before) {
    s.to = after;
  }
  return s;
}

static span pair_extent(const abbe_yaml_edit *e, abbe_yaml_node mapping, size_t index) {
  span key = span_of(e, abbe_yaml_key(e->yaml, mapping, index));
  size_t to = span_of(e, abbe_yaml_value(e->yaml, mapping, index)).to;
  if (index == 0 && e->text[line_from(e, key.from) + indent_of(e, line_from(e, key.from))] == '-')
    return (span){key.from, span_of(e, abbe_yaml_key(e->yaml, mapping, 1)).from};
  return block_extent(e, key.from, line_to(e, to), false);
}

abbe_result abbe_yaml_edit_remove(abbe_yaml_edit *e, abbe_yaml_node parent, size_t index,
                                  abbe_error *error) {
  ABBE_REQUIRE(e, error);
  size_t count = abbe_yaml_count(e->yaml, parent);
  if (count < 2 || index >= count)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s:%zu: the only one here cannot be taken out", e->name,
                          abbe_yaml_line(e->yaml, parent));
  if (abbe_yaml_edit_is_alias(e, parent, index)) return refuse_alias(e, parent, error);
  bool mapping = abbe_yaml_is_mapping(e->yaml, parent);
  span own = span_of(e, child_of(e, parent, index)), where;
  if (abbe_yaml_is_flow(e->yaml, parent)) {
    if (mapping) own.from = span_of(e, abbe_yaml_key(e->yaml, parent, index)).from;
    where = flow_extent(e, own, span_of(e, parent).from);
  } else if (mapping) {
    where = pair_extent(e, parent, index);
  } else {
    size_t dash = dash_before(e, own.from);
    where = block_extent(e, dash, block_end(e, own.to, column_of(e, dash)), index == 0);
  }
  return splice(e, where, "", error);
}

/* ---- items ---- */

/* text[from, to) with every line after the first moved left by `column`, then right by indent. */
static char *moved(const char *text, size_t from, size_t to, size_t column, size_t indent,
                   const char *lead, const char *line_end) {
  char *out = NULL;
  size_t size = 0;
  FILE *stream = open_memstream(&out, &size);
  if (stream == NULL) return NULL;
  fputs(lead, stream);
  for (size_t at = from; at < to;) {
    const char *end = memchr(text + at, '\n', to - at);
    size_t next = end == NULL ? to : (size_t)(end - text) + 1, stop = next;
    while (stop > at && (text[stop - 1] == '\n' || text[stop - 1] == '\r')) stop--;
    if (at > from) {
      size_t skip = 0;
      while (skip < column && at + skip < stop && text[at + skip] == ' ') skip++;
      at += skip;
      fprintf(stream, "%s%*s", line_end, at < stop ? (int)indent : 0, "");
    }
    fwrite(text + at, 1, stop - at, stream);
    at = next;
  }
  return closed(stream, &out);
}

abbe_result abbe_yaml_edit_item(const abbe_yaml_edit *e, abbe_yaml_node sequence, size_t index,
                                char **out, abbe_error *error) {
  ABBE_REQUIRE(e && out, error);
  abbe_yaml_node item = abbe_yaml_item(e->yaml, sequence, index);
  span own = span_of(e, item);
  size_t to = own.to, column = column_of(e, own.from);
  if (!abbe_yaml_is_flow(e->yaml, sequence))
    to = block_end(e, own.to, column_of(e, dash_before(e, own.from)));
  *out = moved(e->text, own.from, to, column, 0, "", "\n");
  return *out != NULL ? ABBE_OK : no_memory(e, error);
}

/* A node in brackets on one line; scalars that were plain stay so where brackets allow it. */
static void print_flow(FILE *out, const abbe_yaml *yaml, abbe_yaml_node node) {
  size_t count = abbe_yaml_count(yaml, node);
  bool mapping = abbe_yaml_is_mapping(yaml, node);
  if (abbe_yaml_is_scalar(yaml, node)) {
    char *text = NULL;
    double value;
    bool number = abbe_yaml_number(yaml, node, "", -HUGE_VAL, HUGE_VAL, &value, NULL) == ABBE_OK;
    if (!number && abbe_yaml_quote_make(abbe_yaml_text(yaml, node), &text, NULL) != ABBE_OK) return;
    fputs(number ? abbe_yaml_text(yaml, node) : text, out);
    free(text);
    return;
  }
  fputc(mapping ? '{' : '[', out);
  for (size_t i = 0; i < count; i++) {
    if (i > 0) fputs(", ", out);
    if (mapping) fprintf(out, "%s: ", abbe_yaml_text(yaml, abbe_yaml_key(yaml, node, i)));
    print_flow(out, yaml, mapping ? abbe_yaml_value(yaml, node, i) : abbe_yaml_item(yaml, node, i));
  }
  fputc(mapping ? '}' : ']', out);
}

static abbe_result append_flow(abbe_yaml_edit *e, abbe_yaml_node list, const abbe_yaml_edit *item,
                               abbe_yaml_node root, abbe_error *error) {
  char *text = NULL;
  size_t size = 0, count = abbe_yaml_count(e->yaml, list);
  FILE *out = open_memstream(&text, &size);
  if (out == NULL) return no_memory(e, error);
  if (count > 0) fputs(", ", out);
  print_flow(out, item->yaml, root);
  text = closed(out, &text);
  size_t at = span_of(e, list).to - 1;
  if (count > 0) at = span_of(e, abbe_yaml_item(e->yaml, list, count - 1)).to;
  abbe_result result = text != NULL ? splice(e, (span){at, at}, text, error) : no_memory(e, error);
  free(text);
  return result;
}

static abbe_result append_block(abbe_yaml_edit *e, abbe_yaml_node mapping, size_t index,
                                const abbe_yaml_edit *item, abbe_yaml_node root,
                                abbe_error *error) {
  abbe_yaml_node list = abbe_yaml_value(e->yaml, mapping, index);
  span key = span_of(e, abbe_yaml_key(e->yaml, mapping, index)), own = span_of(item, root);
  size_t count = abbe_yaml_count(e->yaml, list), indent = column_of(e, key.from) + 2;
  size_t at = line_to(e, colon_after(e, key.to));
  bool blank = false;
  if (count > 0) {
    size_t to = span_of(e, abbe_yaml_item(e->yaml, list, count - 1)).to;
    size_t dash = dash_before(e, span_of(e, abbe_yaml_item(e->yaml, list, count - 1)).from);
    indent = column_of(e, dash);
    at = block_end(e, to, indent);
    /* as the last two are set off; a single one by its length */
    blank = count > 1 ? is_blank(e, line_from(e, line_from(e, dash) - 1)) : line_to(e, dash) < to;
  }
  char lead[256];
  const char *end = line_end_of(e);
  snprintf(lead, sizeof lead, "%s%s%*s- ", blank ? end : "", end, (int)(indent % 200), "");
  char *text = moved(item->text, own.from, block_end(item, own.to, column_of(item, own.from)),
                     column_of(item, own.from), indent + 2, lead, end);
  if (text == NULL) return no_memory(e, error);
  abbe_result result = splice(e, (span){at, at}, text, error);
  free(text);
  return result;
}

abbe_result abbe_yaml_edit_append(abbe_yaml_edit *e, abbe_yaml_node mapping, size_t index,
                                  const char *item, abbe_error *error) {
  ABBE_REQUIRE(e && item, error);
  abbe_yaml_edit given;
  abbe_result result = abbe_yaml_edit_make(item, strlen(item), "the new record", &given, error);
  if (result != ABBE_OK) return result;
  abbe_yaml_node root = abbe_yaml_root(given.yaml);
  abbe_yaml_node list = abbe_yaml_value(e->yaml, mapping, index);
  if (abbe_yaml_is_sequence(given.yaml, root) && abbe_yaml_count(given.yaml, root) == 1)
    root = abbe_yaml_item(given.yaml, root, 0);
  if (!abbe_yaml_is_mapping(given.yaml, root))
    result = abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "the new record must be one mapping (name: …)");
  else if (abbe_yaml_is_flow(e->yaml, list))
    result = append_flow(e, list, &given, root, error);
  else
    result = append_block(e, mapping, index, &given, root, error);
  abbe_yaml_edit_free(&given);
  return result;
}

/* ---- numbers ---- */

abbe_result abbe_yaml_edit_list(const double *value, size_t count, char **out, abbe_error *error) {
  ABBE_REQUIRE((value || count == 0) && out, error);
  size_t size = (ABBE_NUMBER_TEXT_SIZE + 2) * count + 3, used = 0;
  char *made = *out = malloc(size), number[ABBE_NUMBER_TEXT_SIZE];
  if (made == NULL)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu numbers", count);
  made[used++] = '[';
  for (size_t i = 0; i < count; i++)
    used += (size_t)snprintf(made + used, size - used, "%s%s", i > 0 ? ", " : "",
                             abbe_number_text(value[i], number));
  snprintf(made + used, size - used, "]");
  return ABBE_OK;
}
