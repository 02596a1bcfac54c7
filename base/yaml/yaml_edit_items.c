/* Items of a list: taken out as text, and put in at its end. */
#include "base/yaml/yaml_edit_text.h"
#include "base/yaml/yaml_quote.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
  char *text =
      moved(item->text, own.from,
            abbe_yaml_edit_block_end(item, own.to, abbe_yaml_edit_column_of(item, own.from)),
            abbe_yaml_edit_column_of(item, own.from), indent + 2, lead, end);
  if (text == NULL) return abbe_yaml_edit_no_memory(e, error);
  abbe_result result = abbe_yaml_edit_splice(e, (abbe_yaml_bytes){at, at}, text, error);
  free(text);
  return result;
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
