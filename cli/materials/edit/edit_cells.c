#include "cli/materials/edit/edit_state.h"

#include "base/utf8.h"

#include <curses.h>
#include <string.h>

void abbe_edit_put(int y, int x, int width, const char *text) {
  char shown[2048];
  int used = 0;
  move(y, x);
  abbe_utf8_printable(text, strlen(text), false, shown, sizeof shown);
  for (const char *c = shown; *c != '\0' && used < width; used++) {
    const size_t size = abbe_utf8_letter(c);
    addnstr(c, (int)size);
    c += size;
  }
  for (; used < width; used++) addch(' ');
}

size_t abbe_edit_characters(const char *text, size_t bytes) {
  size_t count = 0;
  for (size_t i = 0; i < bytes; i++) count += ((unsigned char)text[i] & 0xc0) != 0x80;
  return count;
}

void abbe_edit_colour(int pair, bool on) {
  if (!has_colors()) return;
  if (on)
    attron(COLOR_PAIR(pair));
  else
    attroff(COLOR_PAIR(pair));
}
