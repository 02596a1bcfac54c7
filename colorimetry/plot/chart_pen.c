#include "colorimetry/plot/chart_panel.h"

#include "base/maths.h"
#include "base/utf8.h"

#include <cairo.h>
#include <math.h>
#include <string.h>

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
