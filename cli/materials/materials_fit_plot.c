#include "cli/materials/materials.h"

#include "colorimetry/plot/chart.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { CURVE = 801 };

/* The numbers of the picture, in one piece of memory. */
typedef struct figures {
  double *memory;
  double *x, *n, *off, *low, *high; /* [count]: the points, and their residuals' error bars */
  double *curve_x, *curve_n;        /* [CURVE] */
  size_t count;
} figures;

static abbe_result open_figures(const abbe_index_points *points, const abbe_fit *fit, figures *f,
                                abbe_error *error) {
  size_t all = points->count;
  *f = (figures){.memory = calloc(5 * all + 2 * (size_t)CURVE, sizeof(double))};
  if (f->memory == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a picture");
  f->x = f->memory;
  f->n = f->x + all;
  f->off = f->n + all;
  f->low = f->off + all;
  f->high = f->low + all;
  f->curve_x = f->high + all;
  f->curve_n = f->curve_x + CURVE;
  for (size_t i = 0; i < all; i++) {
    double lambda_nm = points->lambda_nm[i];
    if (lambda_nm < fit->min_nm || lambda_nm > fit->max_nm) continue;
    size_t k = f->count++;
    double bar = points->uncertainty != NULL ? points->uncertainty[i] : 0;
    f->x[k] = lambda_nm;
    f->n[k] = points->n[i];
    f->off[k] = points->n[i] - abbe_dispersion_n(&fit->dispersion, lambda_nm);
    f->low[k] = f->off[k] - bar;
    f->high[k] = f->off[k] + bar;
  }
  for (int i = 0; i < CURVE; i++) {
    f->curve_x[i] = fit->min_nm + (fit->max_nm - fit->min_nm) * i / (CURVE - 1);
    f->curve_n[i] = abbe_dispersion_n(&fit->dispersion, f->curve_x[i]);
  }
  return ABBE_OK;
}

abbe_result abbe_materials_fit_plot(const char *path, const char *of,
                                    const abbe_index_points *points, const abbe_fit *fit,
                                    abbe_error *error) {
  figures f;
  char title[400];
  abbe_result result = open_figures(points, fit, &f, error);
  if (result != ABBE_OK) return result;
  abbe_chart_style style = points->exact ? ABBE_CHART_LINE : ABBE_CHART_POINTS;
  bool bars = points->uncertainty != NULL;
  snprintf(title, sizeof title, "%s form of %zu coefficients, fitted to %s: rms %.2g, largest %.2g",
           abbe_dispersion_model_name(fit->dispersion.model), fit->free, of, fit->rms,
           fit->max_error);
  const double ends[] = {fit->min_nm, fit->max_nm}, zero[] = {0, 0};
  const abbe_chart_series above[] = {
      {.label = of, .style = style, .count = f.count, .x = f.x, .y = f.n, .colour = 1},
      {.label = "fit",
       .style = ABBE_CHART_DASHED,
       .count = CURVE,
       .x = f.curve_x,
       .y = f.curve_n,
       .colour = 2}};
  const abbe_chart_series below[] = {
      {.style = style,
       .count = f.count,
       .x = f.x,
       .y = f.off,
       .low = bars ? f.low : NULL,
       .high = bars ? f.high : NULL,
       .colour = 1},
      {.style = ABBE_CHART_DASHED, .count = 2, .x = ends, .y = zero, .colour = 2}};
  const abbe_chart charts[] = {
      {.title = title, .y = {.label = "n"}, .series_count = 2, .series = above, .share = 1.6},
      {.x = {.label = "wavelength, nm"},
       .y = {.label = "n - fit"},
       .series_count = 2,
       .series = below}};
  result = abbe_chart_write(path, charts, 2, 0, 0, error);
  free(f.memory);
  return result;
}
