#include "base/yaml/yaml_edit.h"

#include "base/number.h"
#include "base/yaml/yaml_edit_text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Items of a list: taken out as text, and put in at its end. */

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
  return abbe_yaml_edit_closed(stream, &out);
}

abbe_result abbe_yaml_edit_item(const abbe_yaml_edit *e, abbe_yaml_node sequence, size_t index,
                                char **out, abbe_error *error) {
  abbe_yaml_node item = abbe_yaml_item(e->yaml, sequence, index);
  abbe_yaml_bytes own = abbe_yaml_edit_span_of(e, item);
  size_t to = own.to, column = abbe_yaml_edit_column_of(e, own.from);
  if (!abbe_yaml_is_flow(e->yaml, sequence))
    to = abbe_yaml_edit_block_end(
        e, own.to, abbe_yaml_edit_column_of(e, abbe_yaml_edit_dash_before(e, own.from)));
  *out = moved(e->text, own.from, to, column, 0, "", "\n");
  return *out != NULL ? ABBE_OK : abbe_yaml_edit_no_memory(e, error);
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
  if (out == NULL) return abbe_yaml_edit_no_memory(e, error);
  if (count > 0) fputs(", ", out);
  print_flow(out, item->yaml, root);
  text = abbe_yaml_edit_closed(out, &text);
  size_t at = abbe_yaml_edit_span_of(e, list).to - 1;
  if (count > 0) at = abbe_yaml_edit_span_of(e, abbe_yaml_item(e->yaml, list, count - 1)).to;
  abbe_result result = text != NULL
                           ? abbe_yaml_edit_splice(e, (abbe_yaml_bytes){at, at}, text, error)
                           : abbe_yaml_edit_no_memory(e, error);
  free(text);
  return result;
}

static abbe_result append_block(abbe_yaml_edit *e, abbe_yaml_node mapping, size_t index,
                                const abbe_yaml_edit *item, abbe_yaml_node root,
                                abbe_error *error) {
  abbe_yaml_node list = abbe_yaml_value(e->yaml, mapping, index);
  abbe_yaml_bytes key = abbe_yaml_edit_span_of(e, abbe_yaml_key(e->yaml, mapping, index)),
                  own = abbe_yaml_edit_span_of(item, root);
  size_t count = abbe_yaml_count(e->yaml, list), indent = abbe_yaml_edit_column_of(e, key.from) + 2;
  size_t at = abbe_yaml_edit_line_to(e, abbe_yaml_edit_colon_after(e, key.to));
  bool blank = false;
  if (count > 0) {
    size_t to = abbe_yaml_edit_span_of(e, abbe_yaml_item(e->yaml, list, count - 1)).to;
    size_t dash = abbe_yaml_edit_dash_before(
        e, abbe_yaml_edit_span_of(e, abbe_yaml_item(e->yaml, list, count - 1)).from);
    indent = abbe_yaml_edit_column_of(e, dash);
    at = abbe_yaml_edit_block_end(e, to, indent);
    /* as the last two are set off; a single one by its length */
    blank = count > 1 ? abbe_yaml_edit_is_blank(
                            e, abbe_yaml_edit_line_from(e, abbe_yaml_edit_line_from(e, dash) - 1))
                      : abbe_yaml_edit_line_to(e, dash) < to;
  }
  char lead[256];
  const char *end = abbe_yaml_edit_line_end(e);
  snprintf(lead, sizeof lead, "%s%s%*s- ", blank ? end : "", end, (int)(indent % 200), "");
  ABBE_FREED char *text =
      moved(item->text, own.from,
            abbe_yaml_edit_block_end(item, own.to, abbe_yaml_edit_column_of(item, own.from)),
            abbe_yaml_edit_column_of(item, own.from), indent + 2, lead, end);
  if (text == NULL) return abbe_yaml_edit_no_memory(e, error);
  return abbe_yaml_edit_splice(e, (abbe_yaml_bytes){at, at}, text, error);
}

abbe_result abbe_yaml_edit_append(abbe_yaml_edit *e, abbe_yaml_node mapping, size_t index,
                                  const char *item, abbe_error *error) {
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

enum { WIDTH = 100 };

static char *joined(const char *a, const char *b, const char *c, const char *d) {
  size_t size = strlen(a) + strlen(b) + strlen(c) + strlen(d) + 1;
  char *text = malloc(size);
  if (text != NULL) snprintf(text, size, "%s%s%s%s", a, b, c, d);
  return text;
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
  fprintf(out, "[%s%*s", abbe_yaml_edit_line_end(e), (int)indent + 2, "");
  for (size_t i = 1; i < length - 1;) {
    size_t end = i, depth = 0;
    for (; end < length - 1 && (depth > 0 || value[end] != ','); end++)
      depth += (value[end] == '[') - (size_t)(value[end] == ']');
    if (at > indent + 2 && at + 1 + end - i + 1 > WIDTH)
      at = (size_t)fprintf(out, "%s%*s", abbe_yaml_edit_line_end(e), (int)indent + 2, "");
    else if (at > indent + 2)
      at += (size_t)fprintf(out, " ");
    at += (size_t)fprintf(out, "%.*s%s", (int)(end - i), value + i, end < length - 1 ? "," : "");
    for (i = end + (end < length - 1); value[i] == ' ';) i++;
  }
  fprintf(out, "%s%*s]", abbe_yaml_edit_line_end(e), (int)indent, "");
  return abbe_yaml_edit_closed(out, &text);
}

/* ---- values ---- */

static abbe_yaml_node child_of(const abbe_yaml_edit *e, abbe_yaml_node parent, size_t index) {
  return abbe_yaml_is_mapping(e->yaml, parent) ? abbe_yaml_value(e->yaml, parent, index)
                                               : abbe_yaml_item(e->yaml, parent, index);
}

/* An alias shares the node that it names, which stands before its parent or beside it. */
bool abbe_yaml_edit_is_alias(const abbe_yaml_edit *e, abbe_yaml_node parent, size_t index) {
  abbe_yaml_bytes p = abbe_yaml_edit_span_of(e, parent),
                  c = abbe_yaml_edit_span_of(e, child_of(e, parent, index));
  if (c.from < p.from || c.to > p.to) return true;
  size_t floor = p.from; /* the end of what stands before, aliases among it ending earlier */
  if (abbe_yaml_is_mapping(e->yaml, parent))
    floor = abbe_yaml_edit_span_of(e, abbe_yaml_key(e->yaml, parent, index)).to;
  for (size_t i = 0; i < index && abbe_yaml_is_sequence(e->yaml, parent); i++) {
    size_t to = abbe_yaml_edit_span_of(e, abbe_yaml_item(e->yaml, parent, i)).to;
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

/* A block below its key: the value goes onto the key's line, the block's lines go, and comments
 * between the two stay. */
static abbe_result replace_block(abbe_yaml_edit *e, abbe_yaml_bytes key, abbe_yaml_bytes old,
                                 const char *value, const char *what, abbe_error *error) {
  size_t colon = abbe_yaml_edit_colon_after(e, key.to),
         first = abbe_yaml_edit_line_from(e, old.from), keep = first - colon;
  while (keep > 0 && (e->text[colon + keep - 1] == '\n' || e->text[colon + keep - 1] == '\r'))
    keep--; /* the line end before the block goes with the block */
  char *kept = strndup(e->text + colon, keep);
  ABBE_FREED char *text = kept == NULL ? NULL : joined(" ", value, kept, "");
  free(kept);
  if (text == NULL) return abbe_yaml_edit_no_memory(e, error);
  abbe_yaml_bytes where = {colon, abbe_yaml_edit_line_to(e, old.to)};
  return abbe_yaml_edit_splice_value(e, where, text, 1, value, what, error);
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
  abbe_yaml_bytes where = abbe_yaml_edit_span_of(e, old), key = where;
  if (mapping) key = abbe_yaml_edit_span_of(e, abbe_yaml_key(e->yaml, parent, index));
  char *shaped = flow || !mapping ? strdup(value)
                                  : laid_out(e, value, abbe_yaml_edit_column_of(e, key.to) + 2,
                                             abbe_yaml_edit_column_of(e, key.from));
  if (shaped == NULL) return abbe_yaml_edit_no_memory(e, error);
  bool block = !flow && !abbe_yaml_is_scalar(e->yaml, old) && !abbe_yaml_is_flow(e->yaml, old);
  if (block && mapping) {
    result = replace_block(e, key, where, shaped, what, error);
  } else {
    bool touches = where.from == where.to && where.from > 0 && e->text[where.from - 1] != ' ';
    char *text = joined(touches ? " " : "", shaped, "", "");
    result = text == NULL
                 ? abbe_yaml_edit_no_memory(e, error)
                 : abbe_yaml_edit_splice_value(e, where, text, touches, shaped, what, error);
    free(text);
  }
  free(shaped);
  return result;
}

abbe_result abbe_yaml_edit_insert_pair(abbe_yaml_edit *e, abbe_yaml_node mapping, size_t after,
                                       const char *key, const char *value, abbe_error *error) {
  abbe_result result = check_line(value, key, error);
  if (result != ABBE_OK) return result;
  size_t count = abbe_yaml_count(e->yaml, mapping);
  if (after >= count) after = count - 1;
  bool flow = abbe_yaml_is_flow(e->yaml, mapping);
  if (count == 0) { /* only brackets can be empty: {} */
    size_t at = abbe_yaml_edit_span_of(e, mapping).to - 1;
    char *text = joined(key, ": ", value, "");
    result = text == NULL ? abbe_yaml_edit_no_memory(e, error)
                          : abbe_yaml_edit_splice_value(e, (abbe_yaml_bytes){at, at}, text,
                                                        strlen(key) + 2, value, key, error);
    free(text);
    return result;
  }
  if (abbe_yaml_edit_is_alias(e, mapping, after)) {
    /* where the alias itself ends is not known: go before it, after the pair that precedes it */
    if (after == 0 || abbe_yaml_edit_is_alias(e, mapping, after - 1))
      return refuse_alias(e, mapping, error);
    after--;
  }
  abbe_yaml_bytes last = abbe_yaml_edit_span_of(e, abbe_yaml_value(e->yaml, mapping, after));
  size_t indent = abbe_yaml_edit_column_of(
      e, abbe_yaml_edit_span_of(e, abbe_yaml_key(e->yaml, mapping, 0)).from);
  size_t at = flow ? last.to : abbe_yaml_edit_line_to(e, last.to);
  char lead[256] = ", ";
  if (!flow)
    snprintf(lead, sizeof lead, "%s%*s", abbe_yaml_edit_line_end(e), (int)(indent % 200), "");
  char *shaped = flow ? strdup(value) : laid_out(e, value, indent + strlen(key) + 2, indent);
  char *text = shaped == NULL ? NULL : joined(lead, key, ": ", shaped);
  size_t skip = strlen(lead) + strlen(key) + 2;
  result = text == NULL ? abbe_yaml_edit_no_memory(e, error)
                        : abbe_yaml_edit_splice_value(e, (abbe_yaml_bytes){at, at}, text, skip,
                                                      shaped, key, error);
  free(shaped);
  free(text);
  return result;
}

/* ---- taking out ---- */

/* In brackets a pair or item goes with the comma after it, or, the last one, with that before. */
static abbe_yaml_bytes flow_extent(const abbe_yaml_edit *e, abbe_yaml_bytes own, size_t floor) {
  size_t after = own.to;
  while (after < e->size && strchr(" \t\r\n", e->text[after]) != NULL && e->text[after] != '\0')
    after++;
  if (after < e->size && e->text[after] == ',') {
    for (after++; after < e->size && e->text[after] == ' ';) after++;
    return (abbe_yaml_bytes){own.from, after};
  }
  size_t before = own.from;
  while (before > floor && strchr(" \t\r\n", e->text[before - 1]) != NULL) before--;
  if (before > floor && e->text[before - 1] == ',') return (abbe_yaml_bytes){before - 1, own.to};
  return own;
}

/* Whole lines, and of the blank lines around them as many as keep the rest's rhythm. */
static abbe_yaml_bytes block_extent(const abbe_yaml_edit *e, size_t from, size_t to, bool first) {
  abbe_yaml_bytes s = {abbe_yaml_edit_line_from(e, from), abbe_yaml_edit_next_line(e, to)};
  size_t after = s.to;
  while (abbe_yaml_edit_is_blank(e, after) && abbe_yaml_edit_next_line(e, after) > after)
    after = abbe_yaml_edit_next_line(e, after);
  size_t before = s.from > 0 ? abbe_yaml_edit_line_from(e, s.from - 1) : 0;
  bool blank_before = s.from > 0 && abbe_yaml_edit_is_blank(e, before);
  if (first && s.from > 0 && e->text[before + abbe_yaml_edit_indent_of(e, before)] != '#')
    blank_before = true; /* it begins its list: what follows will */
  if (after >= e->size) {
    while (s.from > 0 && abbe_yaml_edit_is_blank(e, abbe_yaml_edit_line_from(e, s.from - 1)))
      s.from = abbe_yaml_edit_line_from(e, s.from - 1);
    if (s.to == e->size && s.from > 0 && e->text[e->size - 1] != '\n') {
      s.from--; /* a text without a last line end stays one */
      if (s.from > 0 && e->text[s.from - 1] == '\r') s.from--;
    }
  } else if (blank_before) {
    s.to = after;
  }
  return s;
}

static abbe_yaml_bytes pair_extent(const abbe_yaml_edit *e, abbe_yaml_node mapping, size_t index) {
  abbe_yaml_bytes key = abbe_yaml_edit_span_of(e, abbe_yaml_key(e->yaml, mapping, index));
  size_t to = abbe_yaml_edit_span_of(e, abbe_yaml_value(e->yaml, mapping, index)).to;
  if (index == 0 &&
      e->text[abbe_yaml_edit_line_from(e, key.from) +
              abbe_yaml_edit_indent_of(e, abbe_yaml_edit_line_from(e, key.from))] == '-')
    return (abbe_yaml_bytes){key.from,
                             abbe_yaml_edit_span_of(e, abbe_yaml_key(e->yaml, mapping, 1)).from};
  return block_extent(e, key.from, abbe_yaml_edit_line_to(e, to), false);
}

abbe_result abbe_yaml_edit_remove(abbe_yaml_edit *e, abbe_yaml_node parent, size_t index,
                                  abbe_error *error) {
  size_t count = abbe_yaml_count(e->yaml, parent);
  if (count < 2 || index >= count)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s:%zu: the only one here cannot be taken out", e->name,
                          abbe_yaml_line(e->yaml, parent));
  if (abbe_yaml_edit_is_alias(e, parent, index)) return refuse_alias(e, parent, error);
  bool mapping = abbe_yaml_is_mapping(e->yaml, parent);
  abbe_yaml_bytes own = abbe_yaml_edit_span_of(e, child_of(e, parent, index)), where;
  if (abbe_yaml_is_flow(e->yaml, parent)) {
    if (mapping) own.from = abbe_yaml_edit_span_of(e, abbe_yaml_key(e->yaml, parent, index)).from;
    where = flow_extent(e, own, abbe_yaml_edit_span_of(e, parent).from);
  } else if (mapping) {
    where = pair_extent(e, parent, index);
  } else {
    size_t dash = abbe_yaml_edit_dash_before(e, own.from);
    where = block_extent(e, dash,
                         abbe_yaml_edit_block_end(e, own.to, abbe_yaml_edit_column_of(e, dash)),
                         index == 0);
  }
  return abbe_yaml_edit_splice(e, where, "", error);
}

/* ---- numbers ---- */

abbe_result abbe_yaml_edit_list(const double *value, size_t count, char **out, abbe_error *error) {
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
