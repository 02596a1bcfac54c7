#include "scenes/cuts/cut_text.h"

#include "base/utf8.h"

#include <stdlib.h>
#include <string.h>

/* What the bytes 0x80 to 0x9f stand for; 0: nothing. */
static const unsigned short high[32] = {
    0x20ac, 0,      0x201a, 0x0192, 0x201e, 0x2026, 0x2020, 0x2021, 0x02c6, 0x2030, 0x0160,
    0x2039, 0x0152, 0,      0x017d, 0,      0,      0x2018, 0x2019, 0x201c, 0x201d, 0x2022,
    0x2013, 0x2014, 0x02dc, 0x2122, 0x0161, 0x203a, 0x0153, 0,      0x017e, 0x0178};

static char byte_of(uint32_t code) {
  if (code < 0x20 || code == 0x7f) return ' ';
  if (code < 0x80 || (code >= 0xa0 && code <= 0xff)) return (char)code;
  for (int i = 0; i < 32; i++)
    if (high[i] == code) return (char)(0x80 + i);
  return '?';
}

size_t abbe_cut_text_narrow(const char *utf8, char *out, size_t size) {
  const unsigned char *at = (const unsigned char *)utf8;
  size_t left = strlen(utf8), length = 0;
  while (left > 0 && length + 1 < size) {
    uint32_t code = ABBE_UTF8_REPLACEMENT;
    size_t bytes = abbe_utf8_read(at, left, &code);
    if (bytes == 0) bytes = 1, code = ABBE_UTF8_REPLACEMENT;
    out[length++] = byte_of(code);
    at += bytes;
    left -= bytes;
  }
  out[length] = '\0';
  return length;
}

static uint32_t code_of(unsigned char byte) {
  if (byte < 0x20 || byte == 0x7f) return ' ';
  if (byte < 0x80 || byte > 0x9f) return byte;
  return high[byte - 0x80] != 0 ? high[byte - 0x80] : ABBE_UTF8_REPLACEMENT;
}

char *abbe_cut_text_widen(const char *bytes, size_t size) {
  char *text = malloc(4 * size + 1);
  size_t length = 0;
  if (!text) return NULL;
  for (size_t i = 0; i < size; i++)
    length += abbe_utf8_write(text + length, code_of((unsigned char)bytes[i]));
  text[length] = '\0';
  return text;
}
