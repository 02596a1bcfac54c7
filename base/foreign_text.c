#include "base/foreign_text.h"

#include "base/text.h"

#include <ctype.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static const struct {
  const char *entity, *text;
} entities[] = {
    {"&amp;", "&"},          {"&lt;", "<"},
    {"&gt;", ">"},           {"&quot;", "\""},
    {"&apos;", "'"},         {"&#39;", "'"},
    {"&nbsp;", " "},         {"&ndash;", "\xe2\x80\x93"},
    {"&deg;", "\xc2\xb0"},   {"&micro;", "\xc2\xb5"},
    {"&times;", "\xc3\x97"},
};
enum { MAX_TAG = 2000 };
enum { ENTITIES = sizeof entities / sizeof entities[0] };

/* Past the tag that begins at c, or c where none does. */
static const char *past_tag(const char *c) {
  if (c[0] != '<' || !(isalpha((unsigned char)c[1]) || c[1] == '/' || c[1] == '!')) return c;
  /* no farther than any tag reaches, so that many openings without an end cost little */
  const char *end = memchr(c, '>', strnlen(c, MAX_TAG));
  return end == NULL ? c : end + 1;
}

static const char *entity(const char **c) {
  for (int i = 0; i < ENTITIES; i++) {
    size_t length = strlen(entities[i].entity);
    if (strncasecmp(*c, entities[i].entity, length) != 0) continue;
    *c += length;
    return entities[i].text;
  }
  return NULL;
}

typedef struct writer {
  char *text;
  size_t used;
  bool gap; /* a blank is due before the next letter */
} writer;

static void put(writer *w, const char *letters, size_t count) {
  if (w->gap && w->used > 0) w->text[w->used++] = ' ';
  w->gap = false;
  memcpy(w->text + w->used, letters, count);
  w->used += count;
}

char *abbe_html_text(const char *html, size_t max) {
  size_t length = strlen(html);
  writer w = {.text = malloc(length + 1)};
  if (w.text == NULL) return NULL;
  for (const char *c = html; *c != '\0';) {
    const char *past = past_tag(c);
    if (past != c) {
      /* only a line's break parts words */
      w.gap = w.gap || strncasecmp(c, "<br", 3) == 0 || strncasecmp(c, "<p", 2) == 0;
      c = past;
      continue;
    }
    const char *letters = *c == '&' ? entity(&c) : NULL;
    if (letters != NULL && letters[0] == ' ')
      w.gap = true;
    else if (letters != NULL)
      put(&w, letters, strlen(letters));
    else if (isspace((unsigned char)*c))
      w.gap = true, c++;
    else
      put(&w, c++, 1);
  }
  if (w.used > max) {
    w.used = max;
    while (w.used > 0 && ((unsigned char)w.text[w.used] & 0xc0) == 0x80) w.used--;
  }
  w.text[w.used] = '\0';
  return w.text;
}

char *abbe_html_escape(const char *text) {
  size_t length = strlen(text), used = 0;
  char *html = malloc(5 * length + 1);
  if (html == NULL) return NULL;
  for (; *text != '\0'; text++) {
    const char *is = *text == '&' ? "&amp;" : *text == '<' ? "&lt;" : *text == '>' ? "&gt;" : NULL;
    if (is == NULL) {
      html[used++] = *text;
      continue;
    }
    memcpy(html + used, is, strlen(is));
    used += strlen(is);
  }
  html[used] = '\0';
  return html;
}

typedef enum form { UTF8, UTF16_LITTLE, UTF16_BIG, WINDOWS } form;

enum { REPLACEMENT = ABBE_UTF8_REPLACEMENT };

/* ---- which encoding ---- */

static bool is_utf8(const unsigned char *c, size_t size) {
  uint32_t code;
  for (size_t i = 0, step; i < size; i += step) {
    uint64_t eight = 0; /* letters of ASCII are taken together */
    if (size - i >= sizeof eight) memcpy(&eight, c + i, step = sizeof eight);
    if (size - i >= sizeof eight && (eight & 0x8080808080808080) == 0) continue;
    step = abbe_utf8_read(c + i, size - i, &code);
    if (step == 0) return false;
  }
  return true;
}

static form detect(const unsigned char *c, size_t size, size_t *skip) {
  *skip = 2;
  if (size >= 2 && c[0] == 0xff && c[1] == 0xfe) return UTF16_LITTLE;
  if (size >= 2 && c[0] == 0xfe && c[1] == 0xff) return UTF16_BIG;
  *skip = 3;
  if (size >= 3 && memcmp(c, "\xef\xbb\xbf", 3) == 0) return UTF8;
  *skip = 0;
  /* Latin text in UTF-16 is half zeros, all on one side */
  size_t zeros[2] = {0, 0}, looked = size < 4096 ? size : 4096;
  for (size_t i = 0; i < looked; i++) zeros[i & 1] += c[i] == 0;
  if (looked >= 8 && zeros[1] > looked / 4 && zeros[0] <= looked / 64) return UTF16_LITTLE;
  if (looked >= 8 && zeros[0] > looked / 4 && zeros[1] <= looked / 64) return UTF16_BIG;
  return is_utf8(c, size) ? UTF8 : WINDOWS;
}

/* ---- one code point ---- */

/* Windows-1252 where it differs from Latin-1. */
static const uint16_t windows[32] = {
    0x20ac, 0xfffd, 0x201a, 0x0192, 0x201e, 0x2026, 0x2020, 0x2021, 0x02c6, 0x2030, 0x0160,
    0x2039, 0x0152, 0xfffd, 0x017d, 0xfffd, 0xfffd, 0x2018, 0x2019, 0x201c, 0x201d, 0x2022,
    0x2013, 0x2014, 0x02dc, 0x2122, 0x0161, 0x203a, 0x0153, 0xfffd, 0x017e, 0x0178};

static uint32_t unit(const unsigned char *c, bool big) {
  return big ? (uint32_t)c[0] << 8 | c[1] : (uint32_t)c[1] << 8 | c[0];
}

static size_t utf16(const unsigned char *c, size_t left, bool big, uint32_t *code) {
  *code = REPLACEMENT;
  if (left < 2) return left;
  uint32_t high = unit(c, big);
  if (high < 0xd800 || high > 0xdfff) *code = high;
  if (high < 0xd800 || high > 0xdbff || left < 4) return 2;
  uint32_t low = unit(c + 2, big);
  if (low < 0xdc00 || low > 0xdfff) return 2;
  *code = 0x10000 + ((high - 0xd800) << 10) + (low - 0xdc00);
  return 4;
}

/* Bytes consumed, at least 1. */
static size_t take(const unsigned char *c, size_t left, form from, uint32_t *code) {
  size_t step = 1;
  switch (from) {
  case UTF8:
    step = abbe_utf8_read(c, left, code);
    if (step == 0) *code = REPLACEMENT;
    return step == 0 ? 1 : step;
  case UTF16_LITTLE:
  case UTF16_BIG:
    return utf16(c, left, from == UTF16_BIG, code);
  case WINDOWS:
    *code = c[0] >= 0x80 && c[0] < 0xa0 ? windows[c[0] - 0x80] : c[0];
    break;
  }
  return step;
}

/* Control characters, the C1 range, and the two that YAML does not allow. */
static bool unwanted(uint32_t code) {
  bool control = code < 0x20 || (code >= 0x7f && code < 0xa0);
  return (control && code != '\n' && code != '\t') || code == 0xfeff || code == 0xfffe ||
         code == 0xffff;
}

/* How many bytes from c on are letters of ASCII, tabs and line ends, which stay as they are. */
static size_t plain(const unsigned char *c, size_t left) {
  size_t n = 0;
  while (n < left && ((c[n] >= 0x20 && c[n] < 0x7f) || c[n] == '\n' || c[n] == '\t')) n++;
  return n;
}

abbe_result abbe_encoding_decode(const char *bytes, size_t size, char **text, size_t *length,
                                 abbe_error *error) {
  const unsigned char *c = (const unsigned char *)bytes;
  char *out = size < SIZE_MAX / 3 ? malloc(3 * size + 1) : NULL;
  if (out == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu bytes", size);
  size_t i = 0, used = 0;
  form from = detect(c, size, &i);
  bool after_return = false;
  while (i < size) {
    const size_t run = from == UTF8 && !after_return ? plain(c + i, size - i) : 0;
    memcpy(out + used, c + i, run);
    i += run;
    used += run;
    if (i == size) break;
    uint32_t code = REPLACEMENT;
    i += take(c + i, size - i, from, &code);
    bool skip = after_return && code == '\n';
    after_return = code == '\r';
    if (skip) continue;
    if (after_return) code = '\n';
    used += abbe_utf8_write(out + used, unwanted(code) ? ' ' : code);
  }
  out[used] = '\0';
  *text = out;
  *length = used;
  return ABBE_OK;
}

bool abbe_encoding_is_binary(const char *bytes, size_t size) {
  const unsigned char *c = (const unsigned char *)bytes;
  size_t skip, looked = size < 4096 ? size : 4096, zeros = 0, controls = 0;
  const form from = detect(c, size, &skip);
  if (from == UTF16_LITTLE || from == UTF16_BIG) return false;
  for (size_t i = 0; i < looked; i++) {
    zeros += c[i] == 0;
    controls += c[i] < 0x20 && strchr("\t\n\r\f\x1a", c[i]) == NULL; /* CP/M's end of a file too */
  }
  return zeros > 0 || controls > looked / 32;
}
