#include "colorimetry/plot/chart_panel.h"

#include "base/maths.h"
#include "colorimetry/plot/chart_pen.h"

#include <cairo.h>
#include <math.h>

/* Blue, vermilion, green, purple, orange, sky blue, black, yellow [OkabeIto2008]. */
static const double palette[ABBE_CHART_COLOURS][3] = {
    {0, 0.447, 0.698}, {0.835, 0.369, 0},     {0, 0.620, 0.451}, {0.800, 0.475, 0.655},
    {0.902, 0.624, 0}, {0.337, 0.706, 0.914}, {0, 0, 0},         {0.941, 0.894, 0.259}};

double abbe_chart_panel_x(const abbe_chart_panel *p, double value) {
  double x = p->left + (p->right - p->left) * abbe_axis_at(&p->x, value);
  return x < -1e5 ? -1e5 : x > 1e5 ? 1e5 : x; /* cairo's own numbers are small; NaN stays */
}

double abbe_chart_panel_y(const abbe_chart_panel *p, double value) {
  double y = p->plot_bottom - (p->plot_bottom - p->plot_top) * abbe_axis_at(&p->y, value);
  return y < -1e5 ? -1e5 : y > 1e5 ? 1e5 : y;
}

static int colour_of(const abbe_chart *c, size_t index, int *turn) {
  int next = 0;
  for (size_t i = 0; i < index; i++) next += c->series[i].colour == 0;
  if (c->series[index].colour > 0) next = c->series[index].colour - 1;
  *turn = next / ABBE_CHART_COLOURS;
  return next % ABBE_CHART_COLOURS;
}

void abbe_chart_set_pen(const abbe_chart_panel *p, size_t index, double alpha) {
  int turn;
  const double *rgb = palette[colour_of(p->chart, index, &turn)];
  bool dashed = p->chart->series[index].style == ABBE_CHART_DASHED;
  const double dash[2] = {dashed ? 6 : 10, dashed ? 4 : 2 + 2 * (double)turn};
  cairo_set_source_rgba(p->cr, rgb[0], rgb[1], rgb[2], alpha);
  cairo_set_line_width(p->cr, 1.8);
  cairo_set_line_join(p->cr, CAIRO_LINE_JOIN_ROUND);
  cairo_set_dash(p->cr, dash, dashed || turn > 0 ? 2 : 0, 0);
}

void abbe_chart_draw_dot(const abbe_chart_panel *p, size_t index, double x, double y) {
  int turn;
  colour_of(p->chart, index, &turn);
  cairo_set_dash(p->cr, NULL, 0, 0);
  cairo_new_sub_path(p->cr);
  cairo_arc(p->cr, x, y, 3.2, 0, 2 * ABBE_PI);
  if (turn == 0) {
    cairo_fill(p->cr);
    return;
  }
  cairo_set_line_width(p->cr, 1.3);
  cairo_stroke(p->cr);
}

static void draw_band(abbe_chart_panel *p, const abbe_chart_series *s) {
  for (size_t i = 0; i + 1 < s->count; i++) {
    double x[2] = {abbe_chart_panel_x(p, s->x[i]), abbe_chart_panel_x(p, s->x[i + 1])};
    double low[2] = {abbe_chart_panel_y(p, s->low[i]), abbe_chart_panel_y(p, s->low[i + 1])};
    double high[2] = {abbe_chart_panel_y(p, s->high[i]), abbe_chart_panel_y(p, s->high[i + 1])};
    if (!isfinite(x[0] + x[1] + low[0] + low[1] + high[0] + high[1])) continue;
    cairo_move_to(p->cr, x[0], low[0]);
    cairo_line_to(p->cr, x[1], low[1]);
    cairo_line_to(p->cr, x[1], high[1]);
    cairo_line_to(p->cr, x[0], high[0]);
    cairo_close_path(p->cr);
  }
  cairo_fill(p->cr); /* once, so that its parts do not darken one another */
}

static void draw_line(abbe_chart_panel *p, const abbe_chart_series *s) {
  bool down = false;
  for (size_t i = 0; i < s->count; i++) {
    double x = abbe_chart_panel_x(p, s->x[i]), y = abbe_chart_panel_y(p, s->y[i]);
    if (isfinite(x + y) && down) cairo_line_to(p->cr, x, y);
    if (isfinite(x + y) && !down) cairo_move_to(p->cr, x, y);
    down = isfinite(x + y);
  }
  cairo_stroke(p->cr);
}

static void draw_points(abbe_chart_panel *p, size_t index) {
  const abbe_chart_series *s = &p->chart->series[index];
  for (size_t i = 0; i < s->count; i++) {
    double x = abbe_chart_panel_x(p, s->x[i]), y = abbe_chart_panel_y(p, s->y[i]);
    if (isfinite(x + y)) abbe_chart_draw_dot(p, index, x, y);
  }
}

static void draw_bars(abbe_chart_panel *p, const abbe_chart_series *s) {
  cairo_set_dash(p->cr, NULL, 0, 0);
  cairo_set_line_width(p->cr, 1.2);
  for (size_t i = 0; i < s->count; i++) {
    double x = abbe_chart_panel_x(p, s->x[i]), low = abbe_chart_panel_y(p, s->low[i]),
           high = abbe_chart_panel_y(p, s->high[i]);
    if (isfinite(x + high) && isnan(low)) low = p->plot_bottom; /* below a logarithmic axis */
    if (!isfinite(x + low + high)) continue;
    abbe_chart_draw_line(p->cr, x, low, x, high);
    abbe_chart_draw_line(p->cr, x - 4, low, x + 4, low);
    abbe_chart_draw_line(p->cr, x - 4, high, x + 4, high);
  }
}

void abbe_chart_draw_series(abbe_chart_panel *p, size_t index) {
  const abbe_chart_series *s = &p->chart->series[index];
  if (s->count == 0) return;
  abbe_chart_set_pen(p, index, s->style == ABBE_CHART_BAND ? 0.25 : 1);
  if (s->style == ABBE_CHART_BAND) {
    draw_band(p, s);
    return;
  }
  if (s->low != NULL) draw_bars(p, s);
  abbe_chart_set_pen(p, index, 1);
  if (s->style != ABBE_CHART_POINTS) draw_line(p, s);
  if (s->style == ABBE_CHART_POINTS || s->style == ABBE_CHART_JOINED_POINTS) draw_points(p, index);
}

double abbe_chart_shade_grey(const abbe_chart *c, size_t index) {
  size_t labels = 0;
  for (size_t i = 0; i <= index; i++) labels += c->shade[i].label != NULL;
  return labels > 0 && labels % 2 == 0 ? 0.86 : 0.92;
}

void abbe_chart_draw_shades(abbe_chart_panel *p) {
  for (size_t i = 0; i < p->chart->shade_count; i++) {
    const abbe_chart_shade *s = &p->chart->shade[i];
    double x[2] = {p->left, p->right}, y[2] = {p->plot_top, p->plot_bottom};
    for (int k = 0; k < 2; k++) {
      double value = k == 0 ? s->from : s->to;
      if (s->of_y)
        y[k] = abbe_chart_panel_y(p, value);
      else
        x[k] = abbe_chart_panel_x(p, value);
    }
    if (!isfinite(x[0] + x[1] + y[0] + y[1])) continue;
    abbe_chart_set_grey(p->cr, abbe_chart_shade_grey(p->chart, i));
    cairo_rectangle(p->cr, x[0], y[0], x[1] - x[0], y[1] - y[0]);
    cairo_fill(p->cr);
  }
}
