/* svg.h: what an SVG's elements say, for tests of pictures that cairo writes: up to 1.16 within
 * style="…", from 1.18 on as attributes. */
#ifndef ABBE_TESTS_SVG_H
#define ABBE_TESTS_SVG_H

#include <stddef.h>
#include <string.h>

/* The next path element from there on, or NULL. */
static const char *svg_path(const char *text) {
  return text != NULL ? strstr(text, "<path ") : NULL;
}

/* What follows the property's name in the element; "" where it has none of that name. */
static const char *svg_value(const char *element, const char *name) {
  const size_t length = strlen(name);
  const char *end = strchr(element, '>');
  for (const char *at = element; (at = strstr(at, name)) != NULL && at < end; at += length) {
    if (at[length] == ':' && strchr(" ;\"", at[-1]) != NULL) return at + length + 1;
    if (at[length] == '=' && at[-1] == ' ') return at + length + 2;
  }
  return "";
}

#endif
