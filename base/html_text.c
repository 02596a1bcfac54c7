#include "base/encoding.h"

#include <ctype.h>
#include <stdbool.h>
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
