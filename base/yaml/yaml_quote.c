#include "base/yaml/yaml_quote.h"

#include "base/utf8.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

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
