#include "cli/materials/edit/edit_plot.h"

#include "cli/materials/edit/edit_cells.h"

#include "colorimetry/plot/text_plot.h"
#include "spectral/wavelengths.h"

#include <curses.h>
#include <math.h>
#include <stdlib.h>

enum { SAMPLES = 400, LABELS = 10 };
enum { CURVE_BEFORE = 1, CURVE_NOW, CURVE_POINTS };

typedef struct curves {
  double x[SAMPLES + 1], now[SAMPLES + 1], before[SAMPLES + 1];
} curves;

static double index_at(const abbe_material *m, double nm) {
  double n = NAN, k;
  if (m != NULL && abbe_material_is_conductor(m))
    return abbe_material_nk(m, nm, &n, &k, NULL) == ABBE_OK ? n : NAN;
  return m != NULL && abbe_material_n(m, nm, &n, NULL) == ABBE_OK ? n : NAN;
}

static const abbe_material *source_of(const abbe_edit_state *a) {
  const abbe_material *m = a->screen->source.material;
  return m != NULL ? m : abbe_record_draft_original(a->draft);
}

static void sample(const abbe_edit_state *a, const abbe_material *now, curves *out) {
  const double from = ABBE_WAVELENGTH_MIN_NM, to = ABBE_WAVELENGTH_MAX_NM;
  for (int i = 0; i <= SAMPLES; i++) {
    out->x[i] = from + (to - from) * i / SAMPLES;
    out->now[i] = index_at(now, out->x[i]);
    out->before[i] = index_at(source_of(a), out->x[i]);
  }
}

static void widen(double *low, double *high, const double *value, size_t count) {
  for (size_t i = 0; i < count; i++) {
    if (!isfinite(value[i])) continue;
    *low = fmin(*low, value[i]);
    *high = fmax(*high, value[i]);
  }
}

static void draw_cells(const abbe_edit_state *a, const abbe_text_plot *plot, int top, int left) {
  for (size_t row = 0; row < plot->rows; row++)
    for (size_t i = 0; i < plot->columns; i++) {
      char text[4];
      bool now = abbe_text_plot_curve(plot, i, row) != CURVE_BEFORE;
      if (now) abbe_edit_colour(ABBE_EDIT_CURVE, true);
      mvaddstr(top + (int)row, left + (int)i, abbe_text_plot_cell(plot, i, row, a->plain, text));
      if (now) abbe_edit_colour(ABBE_EDIT_CURVE, false);
    }
}

/* What one plot shows; before and points may be NULL. */
typedef struct plot_content {
  const char *caption, *format;   /* format: of the ends of its height */
  double least_span;              /* of its height: rounding errors are no curve */
  const double *x, *now, *before; /* [SAMPLES + 1] */
  const abbe_index_points *points;
  const double *point_y; /* [points->count] */
} plot_content;

static void find_height(const plot_content *p, double *low, double *high) {
  *low = INFINITY, *high = -INFINITY;
  widen(low, high, p->now, SAMPLES + 1);
  if (p->before != NULL) widen(low, high, p->before, SAMPLES + 1);
  if (p->points != NULL) widen(low, high, p->point_y, p->points->count);
  if (!(*low <= *high && *high - *low < p->least_span)) return;
  double middle = (*low + *high) / 2;
  *low = middle - p->least_span / 2;
  *high = middle + p->least_span / 2;
}

/* The ends of its height, where there is one, and of the wavelengths. */
static void draw_ends(abbe_edit_area area, const plot_content *p, const abbe_axis *x,
                      const abbe_axis *y, bool has_height) {
  char text[32];
  if (has_height) {
    snprintf(text, sizeof text, p->format, y->max);
    abbe_edit_put(area.top + 1, area.left, LABELS - 1, text);
    snprintf(text, sizeof text, p->format, y->min);
    abbe_edit_put(area.top + area.rows - 2, area.left, LABELS - 1, text);
  }
  mvprintw(area.top + area.rows - 1, area.left + LABELS, "%.0f", x->min);
  mvprintw(area.top + area.rows - 1, area.left + area.columns - 6, "%.0f nm", x->max);
}

/* One plot with its caption. */
static void draw_plot(const abbe_edit_state *a, abbe_edit_area area, const plot_content *p) {
  double low, high;
  find_height(p, &low, &high);
  attron(A_BOLD);
  abbe_edit_put(area.top, area.left, area.columns, p->caption);
  attroff(A_BOLD);
  const abbe_axis x = {ABBE_WAVELENGTH_MIN_NM, ABBE_WAVELENGTH_MAX_NM, false, false};
  const abbe_axis y = abbe_axis_make(low, high, 0.02, false, false);
  abbe_text_plot plot;
  if (area.rows < 4 || area.columns < LABELS + 10 ||
      abbe_text_plot_make((size_t)(area.columns - LABELS), (size_t)area.rows - 2, x, y, &plot,
                          NULL) != ABBE_OK)
    return;
  if (p->before != NULL) abbe_text_plot_line(&plot, CURVE_BEFORE, SAMPLES + 1, p->x, p->before);
  abbe_text_plot_line(&plot, CURVE_NOW, SAMPLES + 1, p->x, p->now);
  if (p->points != NULL)
    abbe_text_plot_points(&plot, CURVE_POINTS, p->points->count, p->points->lambda_nm, p->point_y);
  draw_cells(a, &plot, area.top + 1, area.left + LABELS);
  abbe_text_plot_free(&plot);
  draw_ends(area, p, &x, &y, low <= high);
}

/* Against points the difference is at them alone, else along the curve. */
void abbe_edit_plot_draw(const abbe_edit_state *a, abbe_edit_area area) {
  static curves c;
  static double residual[SAMPLES + 1];
  const abbe_index_points *points = a->screen->source.points;
  const abbe_material *m = abbe_edit_state_shown(a);
  double *difference = points != NULL ? calloc(points->count, sizeof *difference) : NULL;
  sample(a, m, &c);
  double largest = 0;
  for (size_t i = 0; i <= SAMPLES; i++) residual[i] = c.now[i] - c.before[i];
  for (size_t i = 0; difference != NULL && i < points->count; i++)
    difference[i] = index_at(m, points->lambda_nm[i]) - points->n[i];
  const double *value = difference != NULL ? difference : residual;
  for (size_t i = 0; i < (difference != NULL ? points->count : SAMPLES + 1); i++)
    if (isfinite(value[i])) largest = fmax(largest, fabs(value[i]));
  char caption[160];
  snprintf(caption, sizeof caption, "n - that of %s, up to %.3g",
           a->screen->source.name != NULL ? a->screen->source.name : "the record as opened",
           largest);
  const int upper = area.rows / 2;
  const abbe_edit_area above = {area.top, upper, area.left, area.columns};
  const abbe_edit_area below = {area.top + upper, area.rows - upper, area.left, area.columns};
  draw_plot(a, above,
            &(plot_content){"n over wavelength", "%.5f", 1e-4, c.x, c.now,
                            points != NULL ? NULL : c.before, points,
                            points != NULL ? points->n : NULL});
  for (size_t i = 0; difference != NULL && i <= SAMPLES; i++) residual[i] = NAN;
  draw_plot(a, below,
            &(plot_content){caption, "%+.2e", 1e-6, c.x, residual, NULL,
                            difference != NULL ? points : NULL, difference});
  free(difference);
}
