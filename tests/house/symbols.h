/* symbols.h: which object calls which, as nm tells it of the objects of a build. */
#ifndef ABBE_TESTS_HOUSE_SYMBOLS_H
#define ABBE_TESTS_HOUSE_SYMBOLS_H

#include <stdbool.h>
#include <stddef.h>

/* A line of `nm -A -P`: an object, a symbol, and whether it is defined there for others or wanted.
 */
typedef struct symbol {
  char *source; /* of the object, from the root: "gl/plan/plan.c" */
  char *name;
  bool defined;
} symbol;

typedef struct symbols {
  size_t count;
  symbol *symbol;
} symbols;

/* The source of an object: of …/gl/CMakeFiles/abbe_gl.dir/plan/plan.c.o under the build's folder it
 * is gl/plan/plan.c; false for other names. */
bool symbols_source(const char *object, char *out, size_t size);
/* One line; false where it is of no object of ours, or tells of no name that others can see. */
bool symbols_line(const char *line, symbol *out);

/* All lines of all objects that the file `list` names, one a line, and whose sources are there.
 * Fails the test where nm does. */
void symbols_read(const char *nm, const char *list, symbols *out);
void symbols_free(symbols *all);

/* Calls edge for each pair of objects of which one wants what the other defines. */
void symbols_edges(const symbols *all,
                   void (*edge)(void *user, const char *from, const char *to, const char *name),
                   void *user);

#endif
