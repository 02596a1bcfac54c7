/* edit_cells.h: text and colours in the cells of the editor's screen.
 * Internal to cli/materials/edit/. */
#ifndef ABBE_CLI_MATERIALS_EDIT_EDIT_CELLS_H
#define ABBE_CLI_MATERIALS_EDIT_EDIT_CELLS_H

#include <stdbool.h>
#include <stddef.h>

/* Curses' pairs of colours, which the screen makes. */
enum { ABBE_EDIT_WARNING = 1, ABBE_EDIT_CHANGED, ABBE_EDIT_CURVE };

/* text from column x, cut to width characters and filled up with blanks. */
void abbe_edit_put(int y, int x, int width, const char *text);
/* The characters in so many bytes of UTF-8. */
size_t abbe_edit_characters(const char *text, size_t bytes);
void abbe_edit_colour(int pair, bool on);

#endif
