/* lists.h: what grows while the house is read. */
#ifndef ABBE_TESTS_HOUSE_LISTS_H
#define ABBE_TESTS_HOUSE_LISTS_H

#include "tests/check.h"

/* The list with room for one more than count entries; the room doubles at each power of two. */
static inline void *grown(void *list, size_t count, size_t size) {
  if (count > 0 && (count & (count - 1)) != 0) return list;
  void *larger = realloc(list, (count == 0 ? 1 : 2 * count) * size);
  assert_non_null(larger);
  return larger;
}

static inline char *copy_of(const char *text) {
  char *copy = strdup(text);
  assert_non_null(copy);
  return copy;
}

#endif
