#include "colorimetry/plot/text_plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

abbe_result abbe_text_plot_make(size_t columns, size_t rows, abbe_axis x, abbe_axis y,
                                abbe_text_plot *out, abbe_error *error) {
  *out = (abbe_text_plot){0};
  if (columns < 1 || rows < 1 || columns > ABBE_TEXT_PLOT_MAX_SIDE ||
      rows > ABBE_TEXT_PLOT_MAX_SIDE)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a plot of %zu x %zu characters", columns,
                          rows);
  abbe_text_plot plot = {columns, rows, x, y, calloc(columns * rows, 1), calloc(columns * rows, 1)};
  if (plot.dots == NULL || plot.curve == NULL) {
    abbe_text_plot_free(&plot);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a plot");
  }
  *out = plot;
  return ABBE_OK;
}

void abbe_text_plot_free(abbe_text_plot *plot) {
  if (plot == NULL) return;
  free(plot->dots);
  free(plot->curve);
  *plot = (abbe_text_plot){0};
}

/* Dot (x, y) of the fine grid, 2 columns and 4 rows a cell; braille numbers its dots down the left
 * column, down the right, and then the lowest row. */
static void set_dot(abbe_text_plot *p, long x, long y, unsigned char curve) {
  static const unsigned char bit[4][2] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
  if (x < 0 || y < 0 || x >= 2 * (long)p->columns || y >= 4 * (long)p->rows) return;
  size_t cell = (size_t)(y / 4) * p->columns + (size_t)(x / 2);
  p->dots[cell] |= bit[y % 4][x % 2];
  p->curve[cell] = curve;
}

/* The fine grid's place of a value; false outside the plot. */
static bool place(const abbe_text_plot *p, double x, double y, long *column, long *row) {
  double across = abbe_axis_at(&p->x, x), up = abbe_axis_at(&p->y, y);
  if (!(across >= 0 && across <= 1 && up >= 0 && up <= 1)) return false;
  *column = lround(across * (double)(2 * p->columns - 1));
  *row = lround((1 - up) * (double)(4 * p->rows - 1));
  return true;
}

void abbe_text_plot_line(abbe_text_plot *p, unsigned char curve, size_t count, const double *x,
                         const double *y) {
  long from[2], to[2];
  bool down = false;
  for (size_t i = 0; i < count; i++) {
    bool there = place(p, x[i], y[i], &to[0], &to[1]);
    long steps = 0;
    if (there && down) steps = labs(to[0] - from[0]);
    if (there && down && labs(to[1] - from[1]) > steps) steps = labs(to[1] - from[1]);
    for (long k = 0; there && k <= steps; k++) {
      double share = steps > 0 ? (double)k / (double)steps : 1;
      long dx = down ? lround((double)(to[0] - from[0]) * share) : 0;
      long dy = down ? lround((double)(to[1] - from[1]) * share) : 0;
      set_dot(p, down ? from[0] + dx : to[0], down ? from[1] + dy : to[1], curve);
    }
    memcpy(from, to, sizeof from);
    down = there;
  }
}

void abbe_text_plot_points(abbe_text_plot *p, unsigned char curve, size_t count, const double *x,
                           const double *y) {
  for (size_t i = 0; i < count; i++) {
    long column, row;
    if (!place(p, x[i], y[i], &column, &row)) continue;
    for (int k = -1; k <= 1; k++) {
      set_dot(p, column + k, row, curve);
      set_dot(p, column, row + k, curve);
    }
  }
}

const char *abbe_text_plot_cell(const abbe_text_plot *p, size_t column, size_t row, bool plain,
                                char text[4]) {
  unsigned dots = p->dots[row * p->columns + column];
  const unsigned upper = 0x1b, lower = 0xe4; /* the two upper and the two lower rows of dots */
  if (dots == 0) return strcpy(text, " ");
  if (plain) return strcpy(text, (dots & upper) == 0 ? "." : (dots & lower) == 0 ? "'" : ":");
  unsigned code = 0x2800 + dots;
  text[0] = (char)(0xe0 | code >> 12);
  text[1] = (char)(0x80 | (code >> 6 & 0x3f));
  text[2] = (char)(0x80 | (code & 0x3f));
  text[3] = '\0';
  return text;
}

unsigned char abbe_text_plot_curve(const abbe_text_plot *p, size_t column, size_t row) {
  return p->curve[row * p->columns + column];
}
