/* chart_pen.h: text and lines as the charts have them. */
#ifndef ABBE_COLORIMETRY_PLOT_CHART_PEN_H
#define ABBE_COLORIMETRY_PLOT_CHART_PEN_H

#include <stdbool.h>

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
