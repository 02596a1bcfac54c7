/* chart_names.h: names beside points, and the legend: what finds itself a free place in a panel.
 * Internal to colorimetry/. */
#ifndef ABBE_COLORIMETRY_PLOT_CHART_NAMES_H
#define ABBE_COLORIMETRY_PLOT_CHART_NAMES_H

#include "colorimetry/plot/chart_panel.h"

/* No name covers a point or another name, of whatever series; the last series' come first. */
void abbe_chart_draw_names(abbe_chart_panel *panel);
/* The labels of the series and of the shaded ranges, where they hide least of the data. */
void abbe_chart_draw_legend(abbe_chart_panel *panel);

#endif
