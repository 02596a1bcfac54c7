/* view_chart.h: a pixel's spectrum with its standard errors, its colour among the gamuts, a
 * histogram. Internal to cli/. */
#ifndef ABBE_CLI_VIEW_WIDGETS_VIEW_CHART_H
#define ABBE_CLI_VIEW_WIDGETS_VIEW_CHART_H

#include <stddef.h>

/* A spectrum, [count] each, ascending in nm: values, standard errors, standard deviations (or
 * NULL). What is not finite is not drawn. */
typedef struct abbe_view_chart_bands {
  size_t count;
  const double *nm, *value, *error, *deviation;
  const char *unit;
} abbe_view_chart_bands;

/* All take a place in the open panel. */
void abbe_view_chart_spectrum(const abbe_view_chart_bands *bands);
/* CIE 1931 x, y and 1976 u', v', with the locus, Rec.709 and ACEScg: points, the first one white,
 * and small ones. */
void abbe_view_chart_colours(const double (*xy)[2], size_t count, const double (*cloud)[2],
                             size_t cloud_count);
/* So many bins, by the square roots of their counts so that few are seen too; least, most: what
 * its ends are called. */
void abbe_view_chart_histogram(const size_t *bin, size_t count, const char *least,
                               const char *most);

#endif
