#include "colorimetry/plot/chart_panel.h"

#include "base/maths.h"
#include "base/text.h"

#include <cairo.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const double FONT = 13, SMALL_FONT = 11, GAP = 6, LINE_HEIGHT = 18, SAMPLE = 26;

/* ---- names beside points ---- */

typedef struct box {
  double x0, y0, x1, y1;
} box;

static bool overlap(box a, box b) {
  return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
}

static bool is_free(const abbe_chart_panel *p, box b, const box *taken, size_t count) {
  if (b.x0 < p->left || b.x1 > p->right || b.y0 < p->plot_top || b.y1 > p->plot_bottom)
    return false;
  for (size_t i = 0; i < count; i++)
    if (overlap(b, taken[i])) return false;
  return true;
}

/* A name goes right, left, above or below its point, or nowhere. */
static void draw_name(abbe_chart_panel *p, const char *name, double x, double y, box *taken,
                      size_t *count) {
  double w = abbe_chart_text_width(p->cr, name), h = SMALL_FONT;
  const double place[4][2] = {
      {x + 6, y - h / 2}, {x - 6 - w, y - h / 2}, {x - w / 2, y - 6 - h}, {x - w / 2, y + 6}};
  for (int k = 0; k < 4; k++) {
    box b = {place[k][0], place[k][1], place[k][0] + w, place[k][1] + h};
    if (!is_free(p, b, taken, *count)) continue;
    taken[(*count)++] = b;
    abbe_chart_put_text(p->cr, name, b.x0, b.y0 + 1, 0, 0);
    return;
  }
}

static bool has_names(const abbe_chart_series *s) {
  return s->text != NULL && s->y != NULL;
}

/* No name covers a point or another name, of whatever series; the last series' come first. */
void abbe_chart_draw_names(abbe_chart_panel *p) {
  enum { MAX_NAMES = 4096 };
  size_t total = 0, count = 0;
  for (size_t k = 0; k < p->chart->series_count; k++)
    if (has_names(&p->chart->series[k])) total += p->chart->series[k].count;
  box *taken = total == 0 || total > MAX_NAMES ? NULL : calloc(2 * total, sizeof *taken);
  if (taken == NULL) return;
  abbe_chart_set_font(p->cr, SMALL_FONT, false);
  abbe_chart_set_grey(p->cr, 0.2);
  for (int round = 0; round < 2; round++)
    for (size_t k = p->chart->series_count; k-- > 0;) {
      const abbe_chart_series *s = &p->chart->series[k];
      for (size_t i = 0; has_names(s) && i < s->count; i++) {
        double x = abbe_chart_panel_x(p, s->x[i]), y = abbe_chart_panel_y(p, s->y[i]);
        if (!isfinite(x + y)) continue;
        if (round == 0)
          taken[count++] = (box){x - 3, y - 3, x + 3, y + 3};
        else if (s->text[i] != NULL)
          draw_name(p, s->text[i], x, y, taken, &count);
      }
    }
  free(taken);
}

/* ---- legend ---- */

/* How many of the steps along a stroke lie in the box. */
static size_t crossed(box b, double x0, double y0, double x1, double y1) {
  enum { PIECES = 8 };
  size_t hits = 0;
  for (int i = 0; i < PIECES; i++) {
    double x = x0 + (x1 - x0) * i / PIECES, y = y0 + (y1 - y0) * i / PIECES;
    hits += x > b.x0 && x < b.x1 && y > b.y0 && y < b.y1;
  }
  return hits;
}

/* How much of the data lies in the box: points, the lines between them, and their bars. */
static size_t covered(const abbe_chart_panel *p, box b) {
  size_t hits = 0;
  for (size_t k = 0; k < p->chart->series_count; k++) {
    const abbe_chart_series *s = &p->chart->series[k];
    const double *y = s->y != NULL ? s->y : s->high;
    size_t stride = 1 + s->count / 256; /* a long series is as well judged by some of it */
    for (size_t i = 0; i < s->count; i += stride) {
      size_t next = i + stride < s->count ? i + stride : s->count - 1;
      bool joined = s->style != ABBE_CHART_POINTS;
      double x0 = abbe_chart_panel_x(p, s->x[i]), y0 = abbe_chart_panel_y(p, y[i]);
      if (joined)
        hits +=
            crossed(b, x0, y0, abbe_chart_panel_x(p, s->x[next]), abbe_chart_panel_y(p, y[next]));
      if (!joined) hits += 8 * (crossed(b, x0, y0, x0, y0) > 0);
      if (s->low != NULL)
        hits +=
            crossed(b, x0, abbe_chart_panel_y(p, s->low[i]), x0, abbe_chart_panel_y(p, s->high[i]));
    }
  }
  return hits;
}

/* The place that hides least; of equal ones that nearest to a corner, the upper right one first. */
static box place_legend(const abbe_chart_panel *p, double width, double height) {
  enum { STEPS = 8 };
  static const int order[STEPS + 1] = {8, 0, 7, 1, 6, 2, 5, 3, 4};
  box best = {0};
  size_t least = SIZE_MAX;
  for (int sum = 0; sum <= 2 * STEPS; sum++)
    for (int i = 0; i <= sum; i++) {
      if (i > STEPS || sum - i > STEPS) continue;
      double across = order[sum - i] / (double)STEPS, down = 1 - order[i] / (double)STEPS;
      double x = p->left + 10 + across * (p->right - p->left - 20 - width);
      double y = p->plot_top + 10 + down * (p->plot_bottom - p->plot_top - 20 - height);
      box b = {x, y, x + width, y + height};
      size_t hits = covered(p, b);
      if (hits >= least) continue;
      least = hits;
      best = b;
    }
  return best;
}

/* Blue, vermilion, green, purple, orange, sky blue, black, yellow [OkabeIto2008]. */
static const double palette[ABBE_CHART_COLOURS][3] = {
    {0, 0.447, 0.698}, {0.835, 0.369, 0},     {0, 0.620, 0.451}, {0.800, 0.475, 0.655},
    {0.902, 0.624, 0}, {0.337, 0.706, 0.914}, {0, 0, 0},         {0.941, 0.894, 0.259}};

static int colour_of(const abbe_chart *c, size_t index, int *turn) {
  int next = 0;
  for (size_t i = 0; i < index; i++) next += c->series[i].colour == 0;
  if (c->series[index].colour > 0) next = c->series[index].colour - 1;
  *turn = next / ABBE_CHART_COLOURS;
  return next % ABBE_CHART_COLOURS;
}

static void chart_draw_dot(const abbe_chart_panel *p, size_t index, double x, double y) {
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

/* The pen of a series: its colour, of that opacity, and its dashes. */
static void chart_set_pen(const abbe_chart_panel *p, size_t index, double alpha) {
  int turn;
  const double *rgb = palette[colour_of(p->chart, index, &turn)];
  bool dashed = p->chart->series[index].style == ABBE_CHART_DASHED;
  const double dash[2] = {dashed ? 6 : 10, dashed ? 4 : 2 + 2 * (double)turn};
  cairo_set_source_rgba(p->cr, rgb[0], rgb[1], rgb[2], alpha);
  cairo_set_line_width(p->cr, 1.8);
  cairo_set_line_join(p->cr, CAIRO_LINE_JOIN_ROUND);
  cairo_set_dash(p->cr, dash, dashed || turn > 0 ? 2 : 0, 0);
}

static void draw_sample(abbe_chart_panel *p, size_t index, double x, double y) {
  const abbe_chart_series *s = &p->chart->series[index];
  bool band = s->style == ABBE_CHART_BAND;
  chart_set_pen(p, index, band ? 0.25 : 1);
  if (band) {
    cairo_rectangle(p->cr, x, y - 5, SAMPLE, 10);
    cairo_fill(p->cr);
  } else if (s->style != ABBE_CHART_POINTS) {
    abbe_chart_draw_line(p->cr, x, y, x + SAMPLE, y);
  }
  if (s->style == ABBE_CHART_POINTS || s->style == ABBE_CHART_JOINED_POINTS)
    chart_draw_dot(p, index, x + SAMPLE / 2, y);
}

/* The label of entry i: the series first, then the shaded ranges. */
static const char *entry(const abbe_chart *c, size_t i) {
  return i < c->series_count ? c->series[i].label : c->shade[i - c->series_count].label;
}

/* Each label has its grey; the ranges without one that follow it are more of the same. */
static double chart_shade_grey(const abbe_chart *c, size_t index) {
  size_t labels = 0;
  for (size_t i = 0; i <= index; i++) labels += c->shade[i].label != NULL;
  return labels > 0 && labels % 2 == 0 ? 0.86 : 0.92;
}

void abbe_chart_draw_legend(abbe_chart_panel *p) {
  const abbe_chart *c = p->chart;
  size_t total = c->series_count + c->shade_count, count = 0, done = 0;
  double widest_label = 0;
  abbe_chart_set_font(p->cr, FONT, false);
  for (size_t i = 0; i < total; i++) {
    if (entry(c, i) == NULL) continue;
    widest_label = fmax(widest_label, abbe_chart_text_width(p->cr, entry(c, i)));
    count++;
  }
  double room = p->plot_bottom - p->plot_top - 30, column = SAMPLE + 3 * GAP + widest_label;
  size_t rows = (size_t)fmax(1, floor(room / LINE_HEIGHT));
  if (count == 0 || room < LINE_HEIGHT) return;
  if (rows > count) rows = count;
  double width = column * ceil((double)count / (double)rows) + GAP;
  double height = LINE_HEIGHT * (double)rows + GAP;
  box b = place_legend(p, width, height);
  cairo_set_source_rgba(p->cr, 1, 1, 1, 0.85);
  cairo_rectangle(p->cr, b.x0, b.y0, width, height);
  cairo_fill(p->cr);
  for (size_t i = 0; i < total; i++) {
    if (entry(c, i) == NULL) continue;
    double x = b.x0 + GAP + column * (double)(done / rows);
    double y = b.y0 + GAP / 2 + LINE_HEIGHT * ((double)(done % rows) + 0.5);
    if (i < c->series_count) {
      draw_sample(p, i, x, y);
    } else {
      abbe_chart_set_grey(p->cr, chart_shade_grey(c, i - c->series_count));
      cairo_rectangle(p->cr, x, y - 6, SAMPLE, 12);
      cairo_fill(p->cr);
    }
    cairo_set_dash(p->cr, NULL, 0, 0);
    abbe_chart_set_grey(p->cr, 0.15);
    abbe_chart_put_text(p->cr, entry(c, i), x + SAMPLE + GAP, y, 0, 0.5);
    done++;
  }
}

double abbe_chart_panel_x(const abbe_chart_panel *p, double value) {
  double x = p->left + (p->right - p->left) * abbe_axis_at(&p->x, value);
  return x < -1e5 ? -1e5 : x > 1e5 ? 1e5 : x; /* cairo's own numbers are small; NaN stays */
}

double abbe_chart_panel_y(const abbe_chart_panel *p, double value) {
  double y = p->plot_bottom - (p->plot_bottom - p->plot_top) * abbe_axis_at(&p->y, value);
  return y < -1e5 ? -1e5 : y > 1e5 ? 1e5 : y;
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
    if (isfinite(x + y)) chart_draw_dot(p, index, x, y);
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
  chart_set_pen(p, index, s->style == ABBE_CHART_BAND ? 0.25 : 1);
  if (s->style == ABBE_CHART_BAND) {
    draw_band(p, s);
    return;
  }
  if (s->low != NULL) draw_bars(p, s);
  chart_set_pen(p, index, 1);
  if (s->style != ABBE_CHART_POINTS) draw_line(p, s);
  if (s->style == ABBE_CHART_POINTS || s->style == ABBE_CHART_JOINED_POINTS) draw_points(p, index);
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
    abbe_chart_set_grey(p->cr, chart_shade_grey(p->chart, i));
    cairo_rectangle(p->cr, x[0], y[0], x[1] - x[0], y[1] - y[0]);
    cairo_fill(p->cr);
  }
}

void abbe_chart_set_font(cairo_t *cr, double size, bool bold) {
  cairo_select_font_face(cr, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cr, size);
}

enum { MAX_TEXT = 512 };

/* A label may be any file's name; cairo draws none of a chart in which one is no UTF-8. */
static const char *drawable(const char *text, char out[MAX_TEXT]) {
  abbe_utf8_printable(text, strlen(text), false, out, MAX_TEXT);
  return out;
}

double abbe_chart_text_width(cairo_t *cr, const char *text) {
  cairo_text_extents_t e;
  char shown[MAX_TEXT];
  cairo_text_extents(cr, drawable(text, shown), &e);
  return e.x_advance;
}

void abbe_chart_put_text(cairo_t *cr, const char *text, double x, double y, double across,
                         double down) {
  cairo_font_extents_t f;
  cairo_font_extents(cr, &f);
  cairo_move_to(cr, x - across * abbe_chart_text_width(cr, text),
                y + (1 - down) * (f.ascent - f.descent));
  char shown[MAX_TEXT];
  cairo_show_text(cr, drawable(text, shown));
}

void abbe_chart_set_grey(cairo_t *cr, double grey) {
  cairo_set_source_rgb(cr, grey, grey, grey);
}

void abbe_chart_draw_line(cairo_t *cr, double x0, double y0, double x1, double y1) {
  cairo_move_to(cr, x0, y0);
  cairo_line_to(cr, x1, y1);
  cairo_stroke(cr);
}

double abbe_chart_sharp(double at) {
  return floor(at) + 0.5;
}

void abbe_chart_put_upright(cairo_t *cr, const char *text, double x, double y) {
  cairo_save(cr);
  cairo_translate(cr, x, y);
  cairo_rotate(cr, -ABBE_PI / 2);
  abbe_chart_put_text(cr, text, 0, 0, 0.5, 0);
  cairo_restore(cr);
}
