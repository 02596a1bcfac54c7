/* text_plot.h: curves as characters, for terminals.
 *
 * A character cell holds 2 x 4 dots, as braille has them, or one letter of plain text where the
 * terminal knows no better. Each cell remembers which curve drew in it last. It prints nothing: the
 * caller reads cell by cell. */
#ifndef ABBE_COLORIMETRY_PLOT_TEXT_PLOT_H
#define ABBE_COLORIMETRY_PLOT_TEXT_PLOT_H

#include "base/error.h"
#include "colorimetry/plot/axis.h"

#include <stdbool.h>
#include <stddef.h>

enum { ABBE_TEXT_PLOT_MAX_SIDE = 1024 };

typedef struct abbe_text_plot {
  size_t columns, rows;
  abbe_axis x, y;
  unsigned char *dots;  /* [rows][columns] a bit a dot, in braille's order */
  unsigned char *curve; /* [rows][columns] 1 and up; 0: none drew here */
} abbe_text_plot;

/* An empty plot, row 0 at the top. ABBE_INVALID_ARGUMENT for sides outside 1 to
 * ABBE_TEXT_PLOT_MAX_SIDE. */
abbe_result abbe_text_plot_make(size_t columns, size_t rows, abbe_axis x, abbe_axis y,
                                abbe_text_plot *out, abbe_error *error);
void abbe_text_plot_free(abbe_text_plot *plot);

/* Draws the line through the points; one that is not finite, or outside, leaves a gap. */
void abbe_text_plot_line(abbe_text_plot *plot, unsigned char curve, size_t count, const double *x,
                         const double *y);
/* Single points, each a cross of dots. */
void abbe_text_plot_points(abbe_text_plot *plot, unsigned char curve, size_t count, const double *x,
                           const double *y);

/* The cell's character, UTF-8: braille, or where `plain` one of ' . : letters that US-ASCII has. */
const char *abbe_text_plot_cell(const abbe_text_plot *plot, size_t column, size_t row, bool plain,
                                char text[4]);
unsigned char abbe_text_plot_curve(const abbe_text_plot *plot, size_t column, size_t row);

#endif
