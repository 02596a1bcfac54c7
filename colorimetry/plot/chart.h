/* chart.h: two-dimensional charts as PNG and SVG, drawn by cairo.
 *
 * Series over linear or logarithmic axes, with ticks, labels and a legend that does not cover the
 * data; error bars, bands, shaded ranges, points with names; a field of numbers in false colours
 * with its scale bar. Several charts stand one above the other in one picture, their plots flush,
 * or in a grid. It computes nothing from the data but ranges, and knows nothing of what they mean.
 *
 * A zeroed abbe_chart is a valid, empty chart. Texts are UTF-8. */
#ifndef ABBE_COLORIMETRY_PLOT_CHART_H
#define ABBE_COLORIMETRY_PLOT_CHART_H

#include "base/error.h"
#include "colorimetry/image/picture_space.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_CHART_MAX_SIDE 16384
#define ABBE_CHART_COLOURS 8 /* [OkabeIto2008]; further series repeat them, dashed */

typedef enum abbe_chart_style {
  ABBE_CHART_LINE,
  ABBE_CHART_DASHED,
  ABBE_CHART_POINTS,
  ABBE_CHART_JOINED_POINTS, /* points and the line through them */
  ABBE_CHART_BAND           /* the area from low to high */
} abbe_chart_style;

/* A value that is not finite, or not positive on a logarithmic axis, leaves a gap. */
typedef struct abbe_chart_series {
  const char *label; /* in the legend; NULL: not there */
  abbe_chart_style style;
  size_t count;
  const double *x, *y;      /* [count]; y may be NULL for a band */
  const double *low, *high; /* [count] ends of error bars, or edges of the band; or NULL */
  const char *const *text;  /* [count] names beside the points, where there is space; or NULL */
  int colour;               /* 1 to 2 ABBE_CHART_COLOURS, the second of them dashed; 0: the next */
} abbe_chart_series;

typedef struct abbe_chart_axis {
  const char *label;
  double min, max; /* both 0: from the data */
  bool log, reversed;
} abbe_chart_axis;

/* A range of x (or y) shaded over the whole plot, such as the visible wavelengths. */
typedef struct abbe_chart_shade {
  double from, to;
  bool of_y;
  const char *label; /* in the legend; NULL: more of the range before it, in its grey */
} abbe_chart_shade;

/* Numbers in false colours. Unless the axes give other ranges x runs from 0 to width, y from 0 at
 * the top to height, and the pixels are square; without axis labels there are no ticks. */
typedef struct abbe_chart_field {
  size_t width, height;
  const float *value; /* [height][width], row 0 at the top */
  double min, max;    /* at the ends of the scale bar; both 0: from the data, about 0 for
                         ABBE_COLOUR_MAP_DIFFERENCE */
  bool log;
  abbe_colour_map map;
  const char *label; /* label of the scale bar */
} abbe_chart_field;

typedef struct abbe_chart {
  const char *title;
  abbe_chart_axis x, y;
  size_t series_count;
  const abbe_chart_series *series;
  size_t shade_count;
  const abbe_chart_shade *shade;
  const abbe_chart_field *field; /* or NULL */
  double share;                  /* share of the picture's height, relative to the others; 0: 1 */
} abbe_chart;

/* Writes the charts, the first at the top, as a picture of width x height pixels (SVG: points; 0:
 * 960 x 600), beside and renamed. The format is the name's ending, .png or .svg;
 * ABBE_INVALID_ARGUMENT for another, for sides outside 64 to ABBE_CHART_MAX_SIDE, an axis that has
 * no length or is logarithmic and not positive, missing arrays. */
abbe_result abbe_chart_write(const char *path, const abbe_chart *charts, size_t count, size_t width,
                             size_t height, abbe_error *error);

/* The same of rows x columns charts, a row after another: of each column the plots are flush, and
 * all columns are as wide. ABBE_INVALID_ARGUMENT also where count is no multiple of columns. */
abbe_result abbe_chart_write_grid(const char *path, const abbe_chart *charts, size_t count,
                                  size_t columns, size_t width, size_t height, abbe_error *error);

#endif
