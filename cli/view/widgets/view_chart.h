/* view_chart.h: a pixel's spectrum with its standard errors, and its colour among the gamuts.
 * Internal to cli/. */
#ifndef ABBE_CLI_VIEW_WIDGETS_VIEW_CHART_H
#define ABBE_CLI_VIEW_WIDGETS_VIEW_CHART_H

#include "cli/view/picture/view_painter.h"

/* Both take a place in the open panel. */
void abbe_view_chart_spectrum(const abbe_view_probe *probe);
/* CIE 1931 x, y and 1976 u', v', with the locus, Rec.709 and ACEScg. */
void abbe_view_chart_colours(const abbe_view_probe *probe);

#endif
