#include "colorimetry/plot/chart_panel.h"

#include "colorimetry/image/picture_space.h"

#include <cairo.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double FONT = 13, TITLE_FONT = 15, TICK = 5, GAP = 6, BAR_WIDTH = 18;

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
    if (s->colour < 0 || s->colour > 2 * ABBE_CHART_COLOURS)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "series %zu of a chart has the colour %d; there are 1 to %d", i,
                            s->colour, 2 * ABBE_CHART_COLOURS);
  }
  ABBE_TRY(make_axis(chart, false, &out->x, error));
  ABBE_TRY(make_axis(chart, true, &out->y, error));
  if (chart->field != NULL) ABBE_TRY(make_scale(chart->field, &out->scale, error));
  return ABBE_OK;
}

/* ---- layout ---- */

static bool has_ticks(const abbe_chart *c) {
  return c->field == NULL || c->x.label != NULL || c->y.label != NULL;
}

static double widest(cairo_t *cr, const abbe_axis_tick *tick, size_t count) {
  double width = 0;
  for (size_t i = 0; i < count; i++) width = fmax(width, abbe_chart_text_width(cr, tick[i].label));
  return width;
}

void abbe_chart_panel_measure(abbe_chart_panel *p, double *left, double *right) {
  const abbe_chart *c = p->chart;
  abbe_chart_set_font(p->cr, FONT, false);
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
  if (p->y_exponent != 0 && c->title == NULL) p->plot_top += 12; /* space for its note */
  if (c->field != NULL) {
    p->scale_count =
        abbe_axis_ticks(&p->scale, (size_t)fmax(2, height / 45), p->scale_tick, &p->scale_exponent);
    *right = 3 * GAP + BAR_WIDTH + TICK + widest(p->cr, p->scale_tick, p->scale_count) + 16;
    if (c->field->label != NULL) *right += 24;
  }
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

static void draw_grid(abbe_chart_panel *p) {
  cairo_set_line_width(p->cr, 1);
  abbe_chart_set_grey(p->cr, 0.9);
  for (size_t i = 0; i < p->x_count; i++)
    if (p->x_tick[i].major)
      abbe_chart_draw_line(p->cr, abbe_chart_sharp(abbe_chart_panel_x(p, p->x_tick[i].value)),
                           p->plot_top, abbe_chart_sharp(abbe_chart_panel_x(p, p->x_tick[i].value)),
                           p->plot_bottom);
  for (size_t i = 0; i < p->y_count; i++)
    if (p->y_tick[i].major)
      abbe_chart_draw_line(p->cr, p->left,
                           abbe_chart_sharp(abbe_chart_panel_y(p, p->y_tick[i].value)), p->right,
                           abbe_chart_sharp(abbe_chart_panel_y(p, p->y_tick[i].value)));
}

static void note_exponent(cairo_t *cr, int exponent, double x, double y, double across) {
  char power[40], text[48];
  if (exponent == 0) return;
  snprintf(text, sizeof text, "×%s", abbe_axis_power(exponent, power));
  abbe_chart_put_text(cr, text, x, y, across, 1);
}

static void draw_ticks(abbe_chart_panel *p) {
  cairo_t *cr = p->cr;
  abbe_chart_set_font(cr, FONT, false);
  abbe_chart_set_grey(cr, 0.15);
  cairo_set_line_width(cr, 1);
  for (size_t i = 0; i < p->x_count; i++) {
    double x = abbe_chart_panel_x(p, p->x_tick[i].value),
           size = p->x_tick[i].major ? TICK : TICK / 2;
    abbe_chart_draw_line(cr, abbe_chart_sharp(x), p->plot_bottom, abbe_chart_sharp(x),
                         p->plot_bottom + size);
    abbe_chart_put_text(cr, p->x_tick[i].label, x, p->plot_bottom + TICK + GAP, 0.5, 0);
  }
  for (size_t i = 0; i < p->y_count; i++) {
    double y = abbe_chart_panel_y(p, p->y_tick[i].value),
           size = p->y_tick[i].major ? TICK : TICK / 2;
    abbe_chart_draw_line(cr, p->left - size, abbe_chart_sharp(y), p->left, abbe_chart_sharp(y));
    abbe_chart_put_text(cr, p->y_tick[i].label, p->left - TICK - GAP, y, 1, 0.5);
  }
  note_exponent(cr, p->y_exponent, p->left, p->plot_top - GAP, 0);
  note_exponent(cr, p->x_exponent, p->right, p->plot_bottom + TICK + 3 * GAP + FONT, 1);
}

static void draw_frame(abbe_chart_panel *p, double label_left) {
  cairo_t *cr = p->cr;
  const abbe_chart *c = p->chart;
  abbe_chart_set_grey(cr, 0.15);
  cairo_set_line_width(cr, 1);
  double left = abbe_chart_sharp(p->left), top = abbe_chart_sharp(p->plot_top);
  cairo_rectangle(cr, left, top, abbe_chart_sharp(p->right) - left,
                  abbe_chart_sharp(p->plot_bottom) - top);
  cairo_stroke(cr);
  abbe_chart_set_font(cr, FONT, false);
  double middle = (p->left + p->right) / 2;
  if (c->x.label != NULL) abbe_chart_put_text(cr, c->x.label, middle, p->bottom - 6, 0.5, 1);
  if (c->y.label != NULL)
    abbe_chart_put_upright(cr, c->y.label, label_left, (p->plot_top + p->plot_bottom) / 2);
  abbe_chart_set_font(cr, TITLE_FONT, true);
  if (c->title != NULL) abbe_chart_put_text(cr, c->title, middle, p->plot_top - 12, 0.5, 1);
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
  abbe_chart_set_grey(cr, 0.15);
  cairo_set_line_width(cr, 1);
  cairo_rectangle(cr, abbe_chart_sharp(x), abbe_chart_sharp(p->plot_top), BAR_WIDTH, floor(height));
  cairo_stroke(cr);
  abbe_chart_set_font(cr, FONT, false);
  for (size_t i = 0; i < p->scale_count; i++) {
    double y = p->plot_bottom - height * abbe_axis_at(&p->scale, p->scale_tick[i].value);
    double size = p->scale_tick[i].major ? TICK : TICK / 2;
    abbe_chart_draw_line(cr, x + BAR_WIDTH, abbe_chart_sharp(y), x + BAR_WIDTH + size,
                         abbe_chart_sharp(y));
    abbe_chart_put_text(cr, p->scale_tick[i].label, x + BAR_WIDTH + TICK + GAP, y, 0, 0.5);
  }
  note_exponent(cr, p->scale_exponent, x, p->plot_top - GAP, 0);
  double labels = widest(cr, p->scale_tick, p->scale_count);
  if (p->chart->field->label != NULL)
    abbe_chart_put_upright(cr, p->chart->field->label, x + BAR_WIDTH + TICK + 2 * GAP + labels + 4,
                           (p->plot_top + p->plot_bottom) / 2);
}

/* ---- all of it ---- */

void abbe_chart_panel_draw(abbe_chart_panel *p) {
  const abbe_chart *c = p->chart;
  double left = p->left;
  if (p->right - left < 20 || p->plot_bottom - p->plot_top < 20) return; /* no space for a plot */
  square(p);
  if (has_ticks(c))
    p->x_count = abbe_axis_ticks(&p->x, (size_t)fmax(2, (p->right - p->left) / 90), p->x_tick,
                                 &p->x_exponent);
  cairo_save(p->cr);
  cairo_rectangle(p->cr, p->left, p->plot_top, p->right - p->left, p->plot_bottom - p->plot_top);
  cairo_clip(p->cr);
  abbe_chart_draw_shades(p);
  if (c->field != NULL)
    draw_field(p);
  else
    draw_grid(p);
  for (size_t i = 0; i < c->series_count; i++) abbe_chart_draw_series(p, i);
  cairo_set_dash(p->cr, NULL, 0, 0);
  abbe_chart_draw_names(p);
  cairo_restore(p->cr);
  abbe_chart_draw_legend(p);
  if (has_ticks(c)) draw_ticks(p);
  draw_frame(p, p->left - left + 10);
  if (c->field != NULL) draw_scale(p);
}
