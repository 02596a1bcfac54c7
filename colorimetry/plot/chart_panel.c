#include "colorimetry/plot/chart_panel.h"

#include "base/utf8.h"

#include <cairo.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;
static const double FONT = 13, TITLE_FONT = 15, SMALL_FONT = 11;
static const double TICK = 5, GAP = 6, BAR_WIDTH = 18, LINE_HEIGHT = 18, SAMPLE = 26;

/* Blue, vermilion, green, purple, orange, sky blue, black, yellow [OkabeIto2008]. */
static const double palette[ABBE_CHART_COLOURS][3] = {
    {0, 0.447, 0.698}, {0.835, 0.369, 0},     {0, 0.620, 0.451}, {0.800, 0.475, 0.655},
    {0.902, 0.624, 0}, {0.337, 0.706, 0.914}, {0, 0, 0},         {0.941, 0.894, 0.259}};

/* ---- axes ---- */

typedef struct extent {
  double min, max;
} extent;

static void include(extent *e, double value, bool log) {
  if (!isfinite(value) || (log && value <= 0)) return;
  if (value < e->min) e->min = value;
  if (value > e->max) e->max = value;
}

static bool inside(const abbe_chart_axis *axis, double value) {
  return (axis->min == 0 && axis->max == 0) || (value >= axis->min && value <= axis->max);
}

static extent extent_of(const abbe_chart *c, bool of_y) {
  extent e = {INFINITY, -INFINITY};
  for (size_t s = 0; s < c->series_count; s++) {
    const abbe_chart_series *q = &c->series[s];
    for (size_t i = 0; i < q->count; i++) {
      if (!of_y) include(&e, q->x[i], c->x.log);
      if (!of_y || !inside(&c->x, q->x[i])) continue;
      if (q->y != NULL) include(&e, q->y[i], c->y.log);
      if (q->low != NULL) include(&e, q->low[i], c->y.log);
      if (q->high != NULL) include(&e, q->high[i], c->y.log);
    }
  }
  return e;
}

static abbe_result make_axis(const abbe_chart *c, bool of_y, abbe_axis *out, abbe_error *error) {
  const abbe_chart_axis *axis = of_y ? &c->y : &c->x;
  if (axis->min == 0 && axis->max == 0) {
    extent e = extent_of(c, of_y);
    double margin = of_y ? 0.05 : 0, size = 0;
    for (size_t s = 0; s < c->series_count && !of_y; s++)
      if (c->series[s].style == ABBE_CHART_POINTS || c->series[s].style == ABBE_CHART_JOINED_POINTS)
        margin = 0.03;
    bool reversed = axis->reversed;
    if (c->field != NULL) {
      size = (double)(of_y ? c->field->height : c->field->width);
      e = (extent){0, size};
      margin = 0;
      reversed = of_y ? !reversed : reversed; /* rows run downwards */
    }
    *out = abbe_axis_make(e.min, e.max, margin, axis->log && c->field == NULL, reversed);
    return ABBE_OK;
  }
  *out = (abbe_axis){axis->min, axis->max, axis->log, axis->reversed};
  if (isfinite(axis->min) && isfinite(axis->max) && axis->min < axis->max &&
      (!axis->log || axis->min > 0) && isfinite(axis->max - axis->min))
    return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "the %s axis of a chart cannot run from %g to %g%s", of_y ? "y" : "x",
                        axis->min, axis->max, axis->log ? " in decades" : "");
}

static abbe_result make_scale(const abbe_chart_field *f, abbe_axis *out, abbe_error *error) {
  if (f->value == NULL || f->width == 0 || f->height == 0 || f->width > ABBE_CHART_MAX_SIDE ||
      f->height > ABBE_CHART_MAX_SIDE)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a chart's field of %zu x %zu numbers; the sides may be 1 to %d",
                          f->width, f->height, ABBE_CHART_MAX_SIDE);
  extent e = {f->min, f->max};
  if (f->min == 0 && f->max == 0) {
    e = (extent){INFINITY, -INFINITY};
    for (size_t i = 0; i < f->width * f->height; i++) include(&e, (double)f->value[i], f->log);
    if (f->map == ABBE_COLOUR_MAP_DIFFERENCE && e.min <= e.max && !f->log) {
      double size = fmax(fabs(e.min), fabs(e.max));
      e = (extent){-size, size};
    }
    *out = abbe_axis_make(e.min, e.max, 0, f->log, false);
    return ABBE_OK;
  }
  *out = (abbe_axis){e.min, e.max, f->log, false};
  if (isfinite(e.max - e.min) && e.min < e.max && (!f->log || e.min > 0)) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "the colours of a chart cannot run from %g to %g%s", e.min, e.max,
                        f->log ? " in decades" : "");
}

abbe_result abbe_chart_panel_make(const abbe_chart *chart, abbe_chart_panel *out,
                                  abbe_error *error) {
  *out = (abbe_chart_panel){.chart = chart};
  for (size_t i = 0; i < chart->series_count; i++) {
    const abbe_chart_series *s = &chart->series[i];
    bool band = s->style == ABBE_CHART_BAND;
    if (s->count > 0 &&
        (s->x == NULL || (s->y == NULL && !band) || (band && (s->low == NULL || s->high == NULL)) ||
         (s->low == NULL) != (s->high == NULL)))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "series %zu of a chart lacks its x, its y, or an end of its bars", i);
    if (s->colour < 0 || s->colour > ABBE_CHART_COLOURS)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "series %zu of a chart has the colour %d; there are 1 to %d", i,
                            s->colour, ABBE_CHART_COLOURS);
  }
  abbe_result result = make_axis(chart, false, &out->x, error);
  if (result == ABBE_OK) result = make_axis(chart, true, &out->y, error);
  if (result == ABBE_OK && chart->field != NULL)
    result = make_scale(chart->field, &out->scale, error);
  return result;
}

/* ---- text ---- */

static void set_font(cairo_t *cr, double size, bool bold) {
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

static double text_width(cairo_t *cr, const char *text) {
  cairo_text_extents_t e;
  char shown[MAX_TEXT];
  cairo_text_extents(cr, drawable(text, shown), &e);
  return e.x_advance;
}

/* text with its anchor at (x, y): across 0 left, 0.5 middle, 1 right; down 0 top to 1 baseline. */
static void put_text(cairo_t *cr, const char *text, double x, double y, double across,
                     double down) {
  cairo_font_extents_t f;
  cairo_font_extents(cr, &f);
  cairo_move_to(cr, x - across * text_width(cr, text), y + (1 - down) * (f.ascent - f.descent));
  char shown[MAX_TEXT];
  cairo_show_text(cr, drawable(text, shown));
}

static void ink(cairo_t *cr, double grey) {
  cairo_set_source_rgb(cr, grey, grey, grey);
}

/* ---- layout ---- */

static bool has_ticks(const abbe_chart *c) {
  return c->field == NULL || c->x.label != NULL || c->y.label != NULL;
}

static double widest(cairo_t *cr, const abbe_axis_tick *tick, size_t count) {
  double width = 0;
  for (size_t i = 0; i < count; i++) width = fmax(width, text_width(cr, tick[i].label));
  return width;
}

void abbe_chart_panel_measure(abbe_chart_panel *p, double *left, double *right) {
  const abbe_chart *c = p->chart;
  set_font(p->cr, FONT, false);
  p->plot_top = p->top + (c->title != NULL ? 34 : 16);
  p->plot_bottom = p->bottom - (has_ticks(c) ? 26 : 12) - (c->x.label != NULL ? 20 : 0);
  double height = p->plot_bottom - p->plot_top;
  *left = 16;
  *right = 24;
  if (has_ticks(c)) {
    p->y_count = abbe_axis_ticks(&p->y, (size_t)fmax(2, height / 45), p->y_tick, &p->y_exponent);
    *left = 16 + TICK + GAP + widest(p->cr, p->y_tick, p->y_count);
    if (c->y.label != NULL) *left += 24;
  }
  if (p->y_exponent != 0 && c->title == NULL) p->plot_top += 12; /* room for its note */
  if (c->field != NULL) {
    p->scale_count =
        abbe_axis_ticks(&p->scale, (size_t)fmax(2, height / 45), p->scale_tick, &p->scale_exponent);
    *right = 3 * GAP + BAR_WIDTH + TICK + widest(p->cr, p->scale_tick, p->scale_count) + 16;
    if (c->field->label != NULL) *right += 24;
  }
}

static double to_x(const abbe_chart_panel *p, double value) {
  double x = p->left + (p->right - p->left) * abbe_axis_at(&p->x, value);
  return x < -1e5 ? -1e5 : x > 1e5 ? 1e5 : x; /* cairo's own numbers are small; NaN stays */
}

static double to_y(const abbe_chart_panel *p, double value) {
  double y = p->plot_bottom - (p->plot_bottom - p->plot_top) * abbe_axis_at(&p->y, value);
  return y < -1e5 ? -1e5 : y > 1e5 ? 1e5 : y;
}

/* Square pixels: the plot shrinks about its middle. */
static void square(abbe_chart_panel *p) {
  const abbe_chart *c = p->chart;
  if (c->field == NULL || c->x.max != 0 || c->y.max != 0 || c->x.min != 0 || c->y.min != 0) return;
  double width = p->right - p->left, height = p->plot_bottom - p->plot_top;
  double size = fmin(width / (double)c->field->width, height / (double)c->field->height);
  double spare[2] = {width - size * (double)c->field->width,
                     height - size * (double)c->field->height};
  p->left += spare[0] / 2;
  p->right -= spare[0] / 2;
  p->plot_top += spare[1] / 2;
  p->plot_bottom -= spare[1] / 2;
}

/* ---- ticks and frame ---- */

static void line(cairo_t *cr, double x0, double y0, double x1, double y1) {
  cairo_move_to(cr, x0, y0);
  cairo_line_to(cr, x1, y1);
  cairo_stroke(cr);
}

static double sharp(double at) {
  return floor(at) + 0.5;
}

static void draw_grid(abbe_chart_panel *p) {
  cairo_set_line_width(p->cr, 1);
  ink(p->cr, 0.9);
  for (size_t i = 0; i < p->x_count; i++)
    if (p->x_tick[i].major)
      line(p->cr, sharp(to_x(p, p->x_tick[i].value)), p->plot_top,
           sharp(to_x(p, p->x_tick[i].value)), p->plot_bottom);
  for (size_t i = 0; i < p->y_count; i++)
    if (p->y_tick[i].major)
      line(p->cr, p->left, sharp(to_y(p, p->y_tick[i].value)), p->right,
           sharp(to_y(p, p->y_tick[i].value)));
}

static void note_exponent(cairo_t *cr, int exponent, double x, double y, double across) {
  char power[40], text[48];
  if (exponent == 0) return;
  snprintf(text, sizeof text, "×%s", abbe_axis_power(exponent, power));
  put_text(cr, text, x, y, across, 1);
}

static void draw_ticks(abbe_chart_panel *p) {
  cairo_t *cr = p->cr;
  set_font(cr, FONT, false);
  ink(cr, 0.15);
  cairo_set_line_width(cr, 1);
  for (size_t i = 0; i < p->x_count; i++) {
    double x = to_x(p, p->x_tick[i].value), size = p->x_tick[i].major ? TICK : TICK / 2;
    line(cr, sharp(x), p->plot_bottom, sharp(x), p->plot_bottom + size);
    put_text(cr, p->x_tick[i].label, x, p->plot_bottom + TICK + GAP, 0.5, 0);
  }
  for (size_t i = 0; i < p->y_count; i++) {
    double y = to_y(p, p->y_tick[i].value), size = p->y_tick[i].major ? TICK : TICK / 2;
    line(cr, p->left - size, sharp(y), p->left, sharp(y));
    put_text(cr, p->y_tick[i].label, p->left - TICK - GAP, y, 1, 0.5);
  }
  note_exponent(cr, p->y_exponent, p->left, p->plot_top - GAP, 0);
  note_exponent(cr, p->x_exponent, p->right, p->plot_bottom + TICK + 3 * GAP + FONT, 1);
}

static void put_upright(cairo_t *cr, const char *text, double x, double y) {
  cairo_save(cr);
  cairo_translate(cr, x, y);
  cairo_rotate(cr, -PI / 2);
  put_text(cr, text, 0, 0, 0.5, 0);
  cairo_restore(cr);
}

static void draw_frame(abbe_chart_panel *p, double label_left) {
  cairo_t *cr = p->cr;
  const abbe_chart *c = p->chart;
  ink(cr, 0.15);
  cairo_set_line_width(cr, 1);
  double left = sharp(p->left), top = sharp(p->plot_top);
  cairo_rectangle(cr, left, top, sharp(p->right) - left, sharp(p->plot_bottom) - top);
  cairo_stroke(cr);
  set_font(cr, FONT, false);
  double middle = (p->left + p->right) / 2;
  if (c->x.label != NULL) put_text(cr, c->x.label, middle, p->bottom - 6, 0.5, 1);
  if (c->y.label != NULL)
    put_upright(cr, c->y.label, label_left, (p->plot_top + p->plot_bottom) / 2);
  set_font(cr, TITLE_FONT, true);
  if (c->title != NULL) put_text(cr, c->title, middle, p->plot_top - 12, 0.5, 1);
}

/* ---- the field ---- */

static uint32_t pixel_of(const abbe_chart_panel *p, double value) {
  double rgb[3];
  double at = p->chart->field->log && value <= 0 ? 0 : abbe_axis_at(&p->scale, value);
  abbe_colour_map_at(p->chart->field->map, at, rgb);
  uint32_t pixel = 0;
  for (int i = 0; i < 3; i++) pixel = pixel << 8 | (uint32_t)(rgb[i] * 255 + 0.5);
  return pixel;
}

/* Pixels of the caller's own making, stretched over a rectangle. */
static void stretch(cairo_t *cr, cairo_surface_t *image, double x, double y, double width,
                    double height) {
  cairo_save(cr);
  cairo_translate(cr, x, y);
  cairo_scale(cr, width / cairo_image_surface_get_width(image),
              height / cairo_image_surface_get_height(image));
  cairo_set_source_surface(cr, image, 0, 0);
  cairo_pattern_set_filter(cairo_get_source(cr), CAIRO_FILTER_NEAREST);
  cairo_pattern_set_extend(cairo_get_source(cr), CAIRO_EXTEND_PAD);
  cairo_rectangle(cr, 0, 0, cairo_image_surface_get_width(image),
                  cairo_image_surface_get_height(image));
  cairo_fill(cr);
  cairo_restore(cr);
}

static void draw_field(abbe_chart_panel *p) {
  const abbe_chart_field *f = p->chart->field;
  cairo_surface_t *image =
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)f->width, (int)f->height);
  unsigned char *data = cairo_image_surface_get_data(image);
  size_t stride = (size_t)cairo_image_surface_get_stride(image);
  cairo_surface_flush(image);
  for (size_t row = 0; data != NULL && row < f->height; row++)
    for (size_t i = 0; i < f->width; i++) {
      uint32_t pixel = pixel_of(p, (double)f->value[row * f->width + i]);
      memcpy(data + row * stride + 4 * i, &pixel, 4);
    }
  cairo_surface_mark_dirty(image);
  if (data != NULL)
    stretch(p->cr, image, p->left, p->plot_top, p->right - p->left, p->plot_bottom - p->plot_top);
  cairo_surface_destroy(image);
}

static void draw_scale(abbe_chart_panel *p) {
  enum { STEPS = 256 };
  cairo_t *cr = p->cr;
  double x = p->right + 3 * GAP, height = p->plot_bottom - p->plot_top;
  cairo_surface_t *image = cairo_image_surface_create(CAIRO_FORMAT_RGB24, 1, STEPS);
  unsigned char *data = cairo_image_surface_get_data(image);
  size_t stride = (size_t)cairo_image_surface_get_stride(image);
  cairo_surface_flush(image);
  for (size_t i = 0; data != NULL && i < STEPS; i++) {
    double rgb[3];
    abbe_colour_map_at(p->chart->field->map, 1 - (double)i / (STEPS - 1), rgb);
    uint32_t pixel = 0;
    for (int k = 0; k < 3; k++) pixel = pixel << 8 | (uint32_t)(rgb[k] * 255 + 0.5);
    memcpy(data + i * stride, &pixel, 4);
  }
  cairo_surface_mark_dirty(image);
  if (data != NULL) stretch(cr, image, x, p->plot_top, BAR_WIDTH, height);
  cairo_surface_destroy(image);
  ink(cr, 0.15);
  cairo_set_line_width(cr, 1);
  cairo_rectangle(cr, sharp(x), sharp(p->plot_top), BAR_WIDTH, floor(height));
  cairo_stroke(cr);
  set_font(cr, FONT, false);
  for (size_t i = 0; i < p->scale_count; i++) {
    double y = p->plot_bottom - height * abbe_axis_at(&p->scale, p->scale_tick[i].value);
    double size = p->scale_tick[i].major ? TICK : TICK / 2;
    line(cr, x + BAR_WIDTH, sharp(y), x + BAR_WIDTH + size, sharp(y));
    put_text(cr, p->scale_tick[i].label, x + BAR_WIDTH + TICK + GAP, y, 0, 0.5);
  }
  note_exponent(cr, p->scale_exponent, x, p->plot_top - GAP, 0);
  double labels = widest(cr, p->scale_tick, p->scale_count);
  if (p->chart->field->label != NULL)
    put_upright(cr, p->chart->field->label, x + BAR_WIDTH + TICK + 2 * GAP + labels + 4,
                (p->plot_top + p->plot_bottom) / 2);
}

/* ---- series ---- */

static int colour_of(const abbe_chart *c, size_t index, int *turn) {
  int next = 0;
  for (size_t i = 0; i < index; i++) next += c->series[i].colour == 0;
  *turn = c->series[index].colour == 0 ? next / ABBE_CHART_COLOURS : 0;
  return c->series[index].colour > 0 ? c->series[index].colour - 1 : next % ABBE_CHART_COLOURS;
}

static void set_pen(const abbe_chart_panel *p, size_t index, double alpha) {
  int turn;
  const double *rgb = palette[colour_of(p->chart, index, &turn)];
  bool dashed = p->chart->series[index].style == ABBE_CHART_DASHED;
  const double dash[2] = {dashed ? 6 : 10, dashed ? 4 : 2 + 2 * (double)turn};
  cairo_set_source_rgba(p->cr, rgb[0], rgb[1], rgb[2], alpha);
  cairo_set_line_width(p->cr, 1.8);
  cairo_set_line_join(p->cr, CAIRO_LINE_JOIN_ROUND);
  cairo_set_dash(p->cr, dash, dashed || turn > 0 ? 2 : 0, 0);
}

static void dot(cairo_t *cr, double x, double y) {
  cairo_new_sub_path(cr);
  cairo_arc(cr, x, y, 3.2, 0, 2 * PI);
  cairo_fill(cr);
}

static void draw_band(abbe_chart_panel *p, const abbe_chart_series *s) {
  for (size_t i = 0; i + 1 < s->count; i++) {
    double x[2] = {to_x(p, s->x[i]), to_x(p, s->x[i + 1])};
    double low[2] = {to_y(p, s->low[i]), to_y(p, s->low[i + 1])};
    double high[2] = {to_y(p, s->high[i]), to_y(p, s->high[i + 1])};
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
    double x = to_x(p, s->x[i]), y = to_y(p, s->y[i]);
    if (isfinite(x + y) && down) cairo_line_to(p->cr, x, y);
    if (isfinite(x + y) && !down) cairo_move_to(p->cr, x, y);
    down = isfinite(x + y);
  }
  cairo_stroke(p->cr);
}

static void draw_points(abbe_chart_panel *p, const abbe_chart_series *s) {
  cairo_set_dash(p->cr, NULL, 0, 0);
  for (size_t i = 0; i < s->count; i++) {
    double x = to_x(p, s->x[i]), y = to_y(p, s->y[i]);
    if (isfinite(x + y)) dot(p->cr, x, y);
  }
}

static void draw_bars(abbe_chart_panel *p, const abbe_chart_series *s) {
  cairo_set_dash(p->cr, NULL, 0, 0);
  cairo_set_line_width(p->cr, 1.2);
  for (size_t i = 0; i < s->count; i++) {
    double x = to_x(p, s->x[i]), low = to_y(p, s->low[i]), high = to_y(p, s->high[i]);
    if (isfinite(x + high) && isnan(low)) low = p->plot_bottom; /* below a logarithmic axis */
    if (!isfinite(x + low + high)) continue;
    line(p->cr, x, low, x, high);
    line(p->cr, x - 4, low, x + 4, low);
    line(p->cr, x - 4, high, x + 4, high);
  }
}

static void draw_series(abbe_chart_panel *p, size_t index) {
  const abbe_chart_series *s = &p->chart->series[index];
  if (s->count == 0) return;
  set_pen(p, index, s->style == ABBE_CHART_BAND ? 0.25 : 1);
  if (s->style == ABBE_CHART_BAND) {
    draw_band(p, s);
    return;
  }
  if (s->low != NULL) draw_bars(p, s);
  set_pen(p, index, 1);
  if (s->style != ABBE_CHART_POINTS) draw_line(p, s);
  if (s->style == ABBE_CHART_POINTS || s->style == ABBE_CHART_JOINED_POINTS) draw_points(p, s);
}

/* Each label has its grey; the ranges without one that follow it are more of the same. */
static double grey_of_shade(const abbe_chart *c, size_t index) {
  size_t labels = 0;
  for (size_t i = 0; i <= index; i++) labels += c->shade[i].label != NULL;
  return labels > 0 && labels % 2 == 0 ? 0.86 : 0.92;
}

static void draw_shades(abbe_chart_panel *p) {
  for (size_t i = 0; i < p->chart->shade_count; i++) {
    const abbe_chart_shade *s = &p->chart->shade[i];
    double x[2] = {p->left, p->right}, y[2] = {p->plot_top, p->plot_bottom};
    for (int k = 0; k < 2; k++) {
      double value = k == 0 ? s->from : s->to;
      if (s->of_y)
        y[k] = to_y(p, value);
      else
        x[k] = to_x(p, value);
    }
    if (!isfinite(x[0] + x[1] + y[0] + y[1])) continue;
    ink(p->cr, grey_of_shade(p->chart, i));
    cairo_rectangle(p->cr, x[0], y[0], x[1] - x[0], y[1] - y[0]);
    cairo_fill(p->cr);
  }
}

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
  double w = text_width(p->cr, name), h = SMALL_FONT;
  const double place[4][2] = {
      {x + 6, y - h / 2}, {x - 6 - w, y - h / 2}, {x - w / 2, y - 6 - h}, {x - w / 2, y + 6}};
  for (int k = 0; k < 4; k++) {
    box b = {place[k][0], place[k][1], place[k][0] + w, place[k][1] + h};
    if (!is_free(p, b, taken, *count)) continue;
    taken[(*count)++] = b;
    put_text(p->cr, name, b.x0, b.y0 + 1, 0, 0);
    return;
  }
}

static bool has_names(const abbe_chart_series *s) {
  return s->text != NULL && s->y != NULL;
}

/* No name covers a point or another name, of whatever series; the last series' come first. */
static void draw_names(abbe_chart_panel *p) {
  enum { MAX_NAMES = 4096 };
  size_t total = 0, count = 0;
  for (size_t k = 0; k < p->chart->series_count; k++)
    if (has_names(&p->chart->series[k])) total += p->chart->series[k].count;
  box *taken = total == 0 || total > MAX_NAMES ? NULL : calloc(2 * total, sizeof *taken);
  if (taken == NULL) return;
  set_font(p->cr, SMALL_FONT, false);
  ink(p->cr, 0.2);
  for (int round = 0; round < 2; round++)
    for (size_t k = p->chart->series_count; k-- > 0;) {
      const abbe_chart_series *s = &p->chart->series[k];
      for (size_t i = 0; has_names(s) && i < s->count; i++) {
        double x = to_x(p, s->x[i]), y = to_y(p, s->y[i]);
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
      double x0 = to_x(p, s->x[i]), y0 = to_y(p, y[i]);
      if (joined) hits += crossed(b, x0, y0, to_x(p, s->x[next]), to_y(p, y[next]));
      if (!joined) hits += 8 * (crossed(b, x0, y0, x0, y0) > 0);
      if (s->low != NULL) hits += crossed(b, x0, to_y(p, s->low[i]), x0, to_y(p, s->high[i]));
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

static void draw_sample(abbe_chart_panel *p, size_t index, double x, double y) {
  const abbe_chart_series *s = &p->chart->series[index];
  bool band = s->style == ABBE_CHART_BAND;
  set_pen(p, index, band ? 0.25 : 1);
  if (band) {
    cairo_rectangle(p->cr, x, y - 5, SAMPLE, 10);
    cairo_fill(p->cr);
  } else if (s->style != ABBE_CHART_POINTS) {
    line(p->cr, x, y, x + SAMPLE, y);
  }
  if (s->style == ABBE_CHART_POINTS || s->style == ABBE_CHART_JOINED_POINTS)
    dot(p->cr, x + SAMPLE / 2, y);
}

/* The label of entry i: the series first, then the shaded ranges. */
static const char *entry(const abbe_chart *c, size_t i) {
  return i < c->series_count ? c->series[i].label : c->shade[i - c->series_count].label;
}

static void draw_legend(abbe_chart_panel *p) {
  const abbe_chart *c = p->chart;
  size_t total = c->series_count + c->shade_count, count = 0, done = 0;
  double widest_label = 0;
  set_font(p->cr, FONT, false);
  for (size_t i = 0; i < total; i++) {
    if (entry(c, i) == NULL) continue;
    widest_label = fmax(widest_label, text_width(p->cr, entry(c, i)));
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
      ink(p->cr, grey_of_shade(c, i - c->series_count));
      cairo_rectangle(p->cr, x, y - 6, SAMPLE, 12);
      cairo_fill(p->cr);
    }
    cairo_set_dash(p->cr, NULL, 0, 0);
    ink(p->cr, 0.15);
    put_text(p->cr, entry(c, i), x + SAMPLE + GAP, y, 0, 0.5);
    done++;
  }
}

/* ---- all of it ---- */

void abbe_chart_panel_draw(abbe_chart_panel *p) {
  const abbe_chart *c = p->chart;
  double left = p->left;
  if (p->right - left < 20 || p->plot_bottom - p->plot_top < 20) return; /* no room for a plot */
  square(p);
  if (has_ticks(c))
    p->x_count = abbe_axis_ticks(&p->x, (size_t)fmax(2, (p->right - p->left) / 90), p->x_tick,
                                 &p->x_exponent);
  cairo_save(p->cr);
  cairo_rectangle(p->cr, p->left, p->plot_top, p->right - p->left, p->plot_bottom - p->plot_top);
  cairo_clip(p->cr);
  draw_shades(p);
  if (c->field != NULL)
    draw_field(p);
  else
    draw_grid(p);
  for (size_t i = 0; i < c->series_count; i++) draw_series(p, i);
  cairo_set_dash(p->cr, NULL, 0, 0);
  draw_names(p);
  cairo_restore(p->cr);
  draw_legend(p);
  if (has_ticks(c)) draw_ticks(p);
  draw_frame(p, p->left - left + 10);
  if (c->field != NULL) draw_scale(p);
}
