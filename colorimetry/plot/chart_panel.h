/* chart_panel.h: one chart of a picture, laid out and drawn. For a chart as a whole use
 * chart.h; the pen below is for drawings of any kind.
 */
#ifndef ABBE_COLORIMETRY_PLOT_CHART_PANEL_H
#define ABBE_COLORIMETRY_PLOT_CHART_PANEL_H

#include "colorimetry/plot/chart.h"

#include <stdbool.h>
#include <stddef.h>

/* The axis of a chart: where a value lies on it, and which ticks it shows.
 *
 * Linear or logarithmic, in either direction. It draws nothing. */

enum { ABBE_AXIS_MAX_TICKS = 128 };

typedef struct abbe_axis {
  double min, max; /* min < max, finite; log: 0 < min */
  bool log;
  bool reversed; /* max is at the origin */
} abbe_axis;

typedef struct abbe_axis_tick {
  double value;
  bool major;     /* a long tick, with a label */
  char label[24]; /* UTF-8; "" for a minor tick */
} abbe_axis_tick;

/* An axis that shows min to max with `margin` of its length free at either end; a single value, or
 * none (min > max), gets a range too. */
abbe_axis abbe_axis_make(double min, double max, double margin, bool log, bool reversed);

/* Where value lies: 0 at the origin, 1 at the end, beyond them outside; NaN for what a logarithmic
 * axis does not have. */
double abbe_axis_at(const abbe_axis *axis, double value);

/* About `wanted` (2 or more) labelled ticks at round values, ascending, and on a logarithmic axis
 * minor ones between; how many. Labels show value / 10^*exponent, so that long rows of zeros go
 * into one note; *exponent is 0 where that is not needed. */
size_t abbe_axis_ticks(const abbe_axis *axis, size_t wanted,
                       abbe_axis_tick tick[ABBE_AXIS_MAX_TICKS], int *exponent);

/* "10" with the exponent raised, as UTF-8. */
const char *abbe_axis_power(int exponent, char text[40]);

struct _cairo;

typedef struct abbe_chart_panel {
  struct _cairo *cr;
  const abbe_chart *chart;
  abbe_axis x, y, scale; /* scale: of the field's colours */
  double top, bottom;    /* the panel's edges in the picture */
  double left, right;    /* the plot's edges, shared by all panels of a picture */
  double plot_top, plot_bottom;
  size_t x_count, y_count, scale_count;
  abbe_axis_tick x_tick[ABBE_AXIS_MAX_TICKS], y_tick[ABBE_AXIS_MAX_TICKS];
  abbe_axis_tick scale_tick[ABBE_AXIS_MAX_TICKS];
  int x_exponent, y_exponent, scale_exponent;
} abbe_chart_panel;

/* The axes, from the chart or its data. ABBE_INVALID_ARGUMENT as abbe_chart_write has it. */
abbe_result abbe_chart_panel_make(const abbe_chart *chart, abbe_chart_panel *out,
                                  abbe_error *error);
/* The space that the labels need to the left and to the right of the plot, for a panel of this
 * height; fills the ticks. */
void abbe_chart_panel_measure(abbe_chart_panel *panel, double *left, double *right);
/* Draws it between top and bottom, left and right. */
void abbe_chart_panel_draw(abbe_chart_panel *panel);

/* Names beside points, and the legend: what finds itself a free place in a panel. */

/* No name covers a point or another name, of whatever series; the last series' come first. */
void abbe_chart_draw_names(abbe_chart_panel *panel);
/* The labels of the series and of the shaded ranges, where they hide least of the data. */
void abbe_chart_draw_legend(abbe_chart_panel *panel);

/* The data of a chart's panel, drawn: curves, points, bars, bands, shaded ranges. */

/* Where a value lies in the picture; NaN where its axis has no place for it. */
double abbe_chart_panel_x(const abbe_chart_panel *p, double value);
double abbe_chart_panel_y(const abbe_chart_panel *p, double value);

void abbe_chart_draw_series(abbe_chart_panel *p, size_t index);
void abbe_chart_draw_shades(abbe_chart_panel *p);

/* Text and lines as the charts have them. */

struct _cairo;

void abbe_chart_set_font(struct _cairo *cr, double size, bool bold);
void abbe_chart_set_grey(struct _cairo *cr, double grey);

double abbe_chart_text_width(struct _cairo *cr, const char *text);
/* text with its anchor at (x, y): across 0 left, 0.5 middle, 1 right; down 0 top to 1 baseline. */
void abbe_chart_put_text(struct _cairo *cr, const char *text, double x, double y, double across,
                         double down);
/* Written upwards, its middle at y. */
void abbe_chart_put_upright(struct _cairo *cr, const char *text, double x, double y);

void abbe_chart_draw_line(struct _cairo *cr, double x0, double y0, double x1, double y1);
/* Where a line one pixel wide fills one row or column of pixels. */
double abbe_chart_sharp(double at);

#endif
