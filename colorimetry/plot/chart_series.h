/* chart_series.h: the data of a chart's panel, drawn: curves, points, bars, bands, shaded ranges.
 * Internal to colorimetry/. */
#ifndef ABBE_COLORIMETRY_PLOT_CHART_SERIES_H
#define ABBE_COLORIMETRY_PLOT_CHART_SERIES_H

#include "colorimetry/plot/chart_panel.h"

/* Where a value lies in the picture; NaN where its axis has no place for it. */
double abbe_chart_panel_x(const abbe_chart_panel *p, double value);
double abbe_chart_panel_y(const abbe_chart_panel *p, double value);

/* The pen of a series: its colour, of that opacity, and its dashes. */
void abbe_chart_set_pen(const abbe_chart_panel *p, size_t index, double alpha);
void abbe_chart_draw_dot(const abbe_chart_panel *panel, size_t index, double x, double y);
/* Each label has its grey; the ranges without one that follow it are more of the same. */
double abbe_chart_shade_grey(const abbe_chart *c, size_t index);

void abbe_chart_draw_series(abbe_chart_panel *p, size_t index);
void abbe_chart_draw_shades(abbe_chart_panel *p);

#endif
