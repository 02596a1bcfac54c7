#include "base/text_cursor.h"

#include <stdbool.h>
#include <string.h>

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
