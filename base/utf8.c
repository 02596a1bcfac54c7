#include "base/utf8.h"

#include <string.h>

enum { REPLACEMENT = ABBE_UTF8_REPLACEMENT };

size_t abbe_utf8_read(const unsigned char *c, size_t left, uint32_t *code) {
  size_t count = c[0] < 0x80 ? 1 : c[0] < 0xc2 ? 0 : c[0] < 0xe0 ? 2 : c[0] < 0xf0 ? 3 : 4;
  if (count == 0 || c[0] > 0xf4 || count > left) return 0;
  static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  *code = count == 1 ? c[0] : c[0] & (0xffu >> (count + 1));
  for (size_t i = 1; i < count; i++) {
    if ((c[i] & 0xc0) != 0x80) return 0;
    *code = *code << 6 | (c[i] & 0x3fu);
  }
  bool wrong = *code < least[count] || *code > 0x10ffff || (*code >= 0xd800 && *code < 0xe000);
  return wrong ? 0 : count;
}

size_t abbe_utf8_write(char *to, uint32_t code) {
  if (code < 0x80) {
    to[0] = (char)code;
    return 1;
  }
  size_t count = code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
  for (size_t i = count; i-- > 1; code >>= 6) to[i] = (char)(0x80 | (code & 0x3f));
  to[0] = (char)((0xf00u >> count & 0xf0u) | code);
  return count;
}

/* Letters that turn the direction of what follows, end a line, or cannot be seen: what is read is
 * then not what stands there. Of Unicode's format characters (Cf) and separators (Zl, Zp). */
static bool misleads(uint32_t code) {
  static const uint32_t range[][2] = {{0x061c, 0x061c},  {0x200b, 0x200f}, {0x2028, 0x202e},
                                      {0x2060, 0x206f},  {0xfeff, 0xfeff}, {0xfff9, 0xfffb},
                                      {0xe0000, 0xe007f}};
  for (size_t i = 0; i < sizeof range / sizeof *range; i++)
    if (code >= range[i][0] && code <= range[i][1]) return true;
  return false;
}

static uint32_t shown(uint32_t code, bool before_newline, bool lines) {
  if (code == '\n' || code == '\t') return lines ? code : ' ';
  if (code == '\r' && before_newline) return lines ? code : ' ';
  if (code < 0x20) return 0x2400 + code;
  if (code == 0x7f) return 0x2421;
  return (code >= 0x80 && code < 0xa0) || misleads(code) ? REPLACEMENT : code;
}

size_t abbe_utf8_printable(const char *text, size_t length, bool lines, char *out, size_t size) {
  const unsigned char *c = (const unsigned char *)text;
  size_t used = 0;
  for (size_t i = 0; i < length;) {
    uint32_t code = REPLACEMENT;
    char letter[4];
    size_t step = abbe_utf8_read(c + i, length - i, &code);
    if (step == 0) code = REPLACEMENT;
    i += step == 0 ? 1 : step;
    size_t count = abbe_utf8_write(letter, shown(code, i < length && c[i] == '\n', lines));
    if (used + count >= size) break;
    memcpy(out + used, letter, count);
    used += count;
  }
  if (size > 0) out[used] = '\0';
  return used;
}

size_t abbe_utf8_letter(const char *text) {
  uint32_t code;
  return text[0] == '\0' ? 0 : abbe_utf8_read((const unsigned char *)text, strnlen(text, 4), &code);
}

void abbe_utf8_trim(char *text) {
  size_t end = strlen(text), start = end;
  while (start > 0 && end - start < 4) {
    start--;
    if (((unsigned char)text[start] & 0xc0) == 0x80) continue; /* inside a letter */
    if (start + abbe_utf8_letter(text + start) != end) text[start] = '\0';
    return;
  }
}
