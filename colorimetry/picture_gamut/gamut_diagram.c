/* The CIE's diagrams of a picture's chromaticities. */
#include "colorimetry/picture_gamut/gamut_check.h"

#include "colorimetry/chromaticity.h"
#include "colorimetry/plot/chart.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

/* The cloud has one point for each cell of a diagram that has a pixel. */
enum { CELLS = 256, MAX_LOCUS = 512, CORNERS = 4, SERIES = ABBE_GAMUT_COUNT + 2 };
static const double side = 0.9; /* both diagrams lie within 0 to 0.9 */

typedef struct line {
  size_t count;
  double x[MAX_LOCUS], y[MAX_LOCUS];
} line;

typedef struct diagram {
  bool uniform; /* u', v' instead of x, y */
  line locus, gamut[ABBE_GAMUT_COUNT];
  size_t count;
  double *x, *y; /* [count] of the cloud */
} diagram;

static void add(const diagram *d, const double xy[2], line *to) {
  double at[2] = {xy[0], xy[1]};
  if (d->uniform) abbe_chromaticity_uv_of_xy(xy, at);
  to->x[to->count] = at[0];
  to->y[to->count++] = at[1];
}

static void add_lines(diagram *d) {
  double first, last, xy[8];
  abbe_chromaticity_locus_ends(ABBE_OBSERVER_CIE_1931, &first, &last);
  for (double nm = first; nm <= last && d->locus.count < MAX_LOCUS - 1; nm++) {
    abbe_chromaticity_locus(ABBE_OBSERVER_CIE_1931, nm, xy);
    add(d, xy, &d->locus);
  }
  abbe_chromaticity_locus(ABBE_OBSERVER_CIE_1931, first, xy);
  add(d, xy, &d->locus);
  for (int g = 0; g < ABBE_GAMUT_COUNT; g++) {
    abbe_gamut_chromaticities((abbe_gamut)g, xy);
    for (int i = 0; i < CORNERS; i++) add(d, xy + 2 * (i % 3), &d->gamut[g]);
  }
}

static abbe_result add_cloud(const abbe_gamut_check *check, diagram *d, abbe_error *error) {
  unsigned char *has = calloc((size_t)CELLS * CELLS, 1);
  d->x = malloc(sizeof *d->x * CELLS * CELLS);
  d->y = malloc(sizeof *d->y * CELLS * CELLS);
  const bool made = has != NULL && d->x != NULL && d->y != NULL;
  for (size_t p = 0; made && p < check->width * check->height; p++) {
    double xyz[3], at[2];
    for (int c = 0; c < 3; c++) xyz[c] = (double)check->xyz[p][c];
    if (isnan(check->excess[p]) || !abbe_chromaticity_xy(xyz, at)) continue;
    if (d->uniform) {
      const double xy[2] = {at[0], at[1]};
      abbe_chromaticity_uv_of_xy(xy, at);
    }
    if (!(at[0] >= 0 && at[0] < side && at[1] >= 0 && at[1] < side)) continue;
    const size_t cell = (size_t)(at[1] / side * CELLS) * CELLS + (size_t)(at[0] / side * CELLS);
    if (has[cell] != 0) continue;
    has[cell] = 1;
    d->x[d->count] = at[0];
    d->y[d->count++] = at[1];
  }
  free(has);
  return made ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the diagram");
}

static void draw(const diagram *d, const char *title, abbe_chart_series series[SERIES],
                 abbe_chart *chart) {
  size_t n = 0;
  if (d->count > 0)
    series[n++] = (abbe_chart_series){.label = d->uniform ? NULL : "the picture",
                                      .style = ABBE_CHART_POINTS,
                                      .count = d->count,
                                      .x = d->x,
                                      .y = d->y,
                                      .colour = 2};
  series[n++] = (abbe_chart_series){.label = d->uniform ? NULL : "spectral locus",
                                    .style = ABBE_CHART_LINE,
                                    .count = d->locus.count,
                                    .x = d->locus.x,
                                    .y = d->locus.y,
                                    .colour = 1};
  for (int g = 0; g < ABBE_GAMUT_COUNT; g++)
    series[n++] = (abbe_chart_series){.label = d->uniform ? NULL : abbe_gamut_text((abbe_gamut)g),
                                      .style = ABBE_CHART_LINE,
                                      .count = d->gamut[g].count,
                                      .x = d->gamut[g].x,
                                      .y = d->gamut[g].y,
                                      .colour = 3 + g};
  *chart = (abbe_chart){.title = title,
                        .x = {.label = d->uniform ? "u'" : "x", .min = 0, .max = side},
                        .y = {.label = d->uniform ? "v'" : "y", .min = 0, .max = side},
                        .series_count = n,
                        .series = series};
}

abbe_result abbe_gamut_check_diagram(const abbe_gamut_check *check, const char *path,
                                     const char *title, abbe_error *error) {
  assert(check->xyz && check->excess);
  abbe_chart charts[2];
  abbe_chart_series series[2][SERIES];
  diagram *d = calloc(2, sizeof *d);
  abbe_result result =
      d == NULL ? abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the diagram") : ABBE_OK;
  for (int k = 0; k < 2 && result == ABBE_OK; k++) {
    d[k].uniform = k == 1;
    add_lines(&d[k]);
    result = add_cloud(check, &d[k], error);
    draw(&d[k], k == 0 ? title : "CIE 1976", series[k], &charts[k]);
  }
  if (result == ABBE_OK) result = abbe_chart_write_grid(path, charts, 2, 2, 1280, 680, error);
  for (int k = 0; k < 2 && d != NULL; k++) {
    free(d[k].x);
    free(d[k].y);
  }
  free(d);
  return result;
}
