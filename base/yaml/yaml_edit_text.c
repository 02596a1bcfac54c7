#include "base/yaml/yaml_edit_text.h"

#include "base/text.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

abbe_result abbe_yaml_edit_no_memory(const abbe_yaml_edit *e, abbe_error *error) {
  return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory to edit it", e->name);
}

/* ---- the text and its lines ---- */

abbe_result abbe_yaml_edit_make(const char *text, size_t size, const char *name,
                                abbe_yaml_edit *out, abbe_error *error) {
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

abbe_yaml_bytes abbe_yaml_edit_span_of(const abbe_yaml_edit *e, abbe_yaml_node node) {
  abbe_yaml_bytes s;
  abbe_yaml_span(e->yaml, node, &s.from, &s.to);
  return s;
}

size_t abbe_yaml_edit_line_from(const abbe_yaml_edit *e, size_t at) {
  while (at > 0 && e->text[at - 1] != '\n') at--;
  return at == 0 && e->size >= 3 && memcmp(e->text, "\xEF\xBB\xBF", 3) == 0 ? 3 : at;
}

size_t abbe_yaml_edit_line_to(const abbe_yaml_edit *e, size_t at) {
  while (at < e->size && e->text[at] != '\n') at++;
  return at > 0 && at < e->size && e->text[at - 1] == '\r' ? at - 1 : at;
}

size_t abbe_yaml_edit_next_line(const abbe_yaml_edit *e, size_t at) {
  while (at < e->size && e->text[at] != '\n') at++;
  return at < e->size ? at + 1 : at;
}

size_t abbe_yaml_edit_indent_of(const abbe_yaml_edit *e, size_t line) {
  size_t count = 0;
  while (line + count < e->size && e->text[line + count] == ' ') count++;
  return count;
}

bool abbe_yaml_edit_is_blank(const abbe_yaml_edit *e, size_t line) {
  return line < e->size &&
         line + abbe_yaml_edit_indent_of(e, line) == abbe_yaml_edit_line_to(e, line);
}

const char *abbe_yaml_edit_line_end(const abbe_yaml_edit *e) {
  const char *end = memchr(e->text, '\n', e->size);
  return end != NULL && end > e->text && end[-1] == '\r' ? "\r\n" : "\n";
}

/* ---- a change ---- */

abbe_result abbe_yaml_edit_splice(abbe_yaml_edit *e, abbe_yaml_bytes where, const char *with,
                                  abbe_error *error) {
  size_t length = strlen(with), size = e->size - (where.to - where.from) + length;
  char *text = malloc(size + 1);
  if (text == NULL) return abbe_yaml_edit_no_memory(e, error);
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

abbe_result abbe_yaml_edit_splice_value(abbe_yaml_edit *e, abbe_yaml_bytes where, const char *with,
                                        size_t skip, const char *value, const char *what,
                                        abbe_error *error) {
  ABBE_OWNED(abbe_yaml_edit, before) = {0};
  ABBE_TRY(abbe_yaml_edit_make(e->text, e->size, e->name, &before, error));
  ABBE_TRY(abbe_yaml_edit_splice(e, where, with, error));
  bool found = false;
  size_t from = where.from + skip, to = from + strlen(value);
  for (int id = 1; !found; id++) {
    abbe_yaml_node node = {id};
    if (abbe_yaml_line(e->yaml, node) == 0) break;
    abbe_yaml_bytes s = abbe_yaml_edit_span_of(e, node);
    found = s.from == from && s.to == to;
  }
  if (!found) {
    abbe_yaml_edit bad = *e;
    *e = before;
    before = bad;
    ABBE_TRY(not_a_value(value, what, error));
  }
  return ABBE_OK;
}

char *abbe_yaml_edit_closed(FILE *stream, char **text) {
  bool good = !ferror(stream);
  good = fclose(stream) == 0 && good;
  if (good) return *text;
  free(*text);
  return NULL;
}

/* ---- where things stand ---- */

size_t abbe_yaml_edit_column_of(const abbe_yaml_edit *e, size_t at) {
  return at - abbe_yaml_edit_line_from(e, at);
}

size_t abbe_yaml_edit_colon_after(const abbe_yaml_edit *e, size_t at) {
  while (at < e->size && e->text[at] != ':') at++;
  return at < e->size ? at + 1 : at;
}

size_t abbe_yaml_edit_dash_before(const abbe_yaml_edit *e, size_t at) {
  size_t line = abbe_yaml_edit_line_from(e, at), dash = line + abbe_yaml_edit_indent_of(e, line);
  while (line > 0 && (dash >= at || e->text[dash] != '-')) {
    line = abbe_yaml_edit_line_from(e, line - 1);
    dash = line + abbe_yaml_edit_indent_of(e, line);
  }
  return dash;
}

size_t abbe_yaml_edit_block_end(const abbe_yaml_edit *e, size_t to, size_t indent) {
  size_t end = abbe_yaml_edit_line_to(e, to);
  for (size_t line = abbe_yaml_edit_next_line(e, to); line < e->size;
       line = abbe_yaml_edit_next_line(e, line)) {
    size_t own = abbe_yaml_edit_indent_of(e, line);
    if (own <= indent || e->text[line + own] != '#') break;
    end = abbe_yaml_edit_line_to(e, line);
  }
  return end;
}

/* Letters, digits and a few signs, beginning with a letter. */
static bool is_plain(const char *text) {
  static const char *const reserved[] = {"true", "false", "null", "yes", "no",
                                         "on",   "off",   "y",    "n"};
  static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
  size_t length = strlen(text), plain = 0;
  if (length == 0 || strchr(letters, text[0]) == NULL || text[length - 1] == ' ') return false;
  for (const char *c = text; *c != '\0'; c++)
    plain += strchr(letters, *c) != NULL || strchr("0123456789 ._/+()=;-", *c) != NULL;
  for (size_t i = 0; i < sizeof reserved / sizeof reserved[0]; i++)
    if (strcasecmp(text, reserved[i]) == 0) return false;
  return plain == length;
}

/* What YAML does not take as it stands: controls, U+0080 to U+009F, line separators, U+FEFF and the
 * two that are no characters. Returns the bytes that it read. */
static size_t escape(const unsigned char *c, FILE *to) {
  if (c[0] < 0x20 || c[0] == 0x7f) {
    fprintf(to, "\\x%02x", c[0]);
    return 1;
  }
  if (c[0] == 0xc2 && c[1] >= 0x80 && c[1] < 0xa0) {
    fprintf(to, "\\x%02x", c[1]);
    return 2;
  }
  if (c[0] == 0xe2 && c[1] == 0x80 && (c[2] == 0xa8 || c[2] == 0xa9)) {
    fprintf(to, "\\u20%02x", c[2] - 0x80);
    return 3;
  }
  if (c[0] == 0xef && ((c[1] == 0xbb && c[2] == 0xbf) || (c[1] == 0xbf && c[2] >= 0xbe))) {
    fprintf(to, c[1] == 0xbb ? "\\ufeff" : "\\uff%02x", c[2] + 0x40);
    return 3;
  }
  return 0;
}

void abbe_yaml_quote_write(const char *text, FILE *to) {
  if (is_plain(text)) {
    fputs(text, to);
    return;
  }
  fputc('"', to);
  for (const unsigned char *c = (const unsigned char *)text; *c != '\0';) {
    size_t taken = 0;
    if (*c == '"' || *c == '\\') {
      fprintf(to, "\\%c", *c);
      taken = 1;
    } else if (*c == '\n' || *c == '\t') {
      fputs(*c == '\n' ? "\\n" : "\\t", to);
      taken = 1;
    } else {
      taken = escape(c, to);
    }
    size_t letter = abbe_utf8_letter((const char *)c);
    if (taken == 0 && letter == 0) fputs("\\ufffd", to);
    if (taken == 0) fwrite(c, 1, letter, to);
    c += taken > 0 ? taken : letter > 0 ? letter : 1;
  }
  fputc('"', to);
}

abbe_result abbe_yaml_quote_make(const char *text, char **out, abbe_error *error) {
  size_t size = 0;
  *out = NULL;
  FILE *to = open_memstream(out, &size);
  if (to != NULL) abbe_yaml_quote_write(text, to);
  if (to != NULL && fclose(to) == 0) return ABBE_OK;
  free(*out);
  *out = NULL;
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to quote a text");
}
