#include "colorimetry/plot/chart.h"

#include "base/file.h"
#include "colorimetry/plot/chart_panel.h"

#include <cairo-svg.h>
#include <cairo.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MAX_CHARTS = 64 };

static bool ends_with(const char *path, const char *ending) {
  size_t length = strlen(path), tail = strlen(ending);
  return length > tail && strcasecmp(path + length - tail, ending) == 0;
}

/* What does not reach the file shows in ferror when it is committed, with the reason. */
static cairo_status_t write_bytes(void *closure, const unsigned char *data, unsigned int length) {
  fwrite(data, 1, length, closure);
  return CAIRO_STATUS_SUCCESS;
}

typedef struct png_stream {
  FILE *file;
  size_t left; /* bytes left of a PNG's signature and header, which are always its first 33 */
} png_stream;

/* Cairo does not state that its colours are sRGB: the chunk that does comes behind the header. */
static cairo_status_t write_png(void *closure, const unsigned char *data, unsigned int length) {
  static const unsigned char srgb[] = {0, 0, 0, 1, 's', 'R', 'G', 'B', 1, 0xd9, 0xc9, 0x2c, 0x7f};
  png_stream *stream = closure;
  const unsigned head = length < stream->left ? length : (unsigned)stream->left;
  write_bytes(stream->file, data, head);
  stream->left -= head;
  if (head > 0 && stream->left == 0) write_bytes(stream->file, srgb, sizeof srgb);
  return write_bytes(stream->file, data + head, length - head);
}

typedef struct grid {
  abbe_chart_panel *panel; /* [count], a row after another */
  size_t count, columns, width, height;
} grid;

static double share_of(const abbe_chart_panel *panel) {
  return panel->chart->share > 0 ? panel->chart->share : 1;
}

/* A column's panels one above the other; the labels of all decide where the plots begin and end. */
static void draw_column(cairo_t *cr, const grid *g, size_t column) {
  const double width = (double)g->width / (double)g->columns;
  double total = 0, left = 0, right = 0, top = 0;
  for (size_t i = column; i < g->count; i += g->columns) total += share_of(&g->panel[i]);
  for (size_t i = column; i < g->count; i += g->columns) {
    abbe_chart_panel *p = &g->panel[i];
    double own[2];
    p->cr = cr;
    p->top = top;
    p->bottom = top += (double)g->height * share_of(p) / total;
    p->left = 0;
    p->right = width;
    abbe_chart_panel_measure(p, &own[0], &own[1]);
    if (own[0] > left) left = own[0];
    if (own[1] > right) right = own[1];
  }
  for (size_t i = column; i < g->count; i += g->columns) {
    g->panel[i].left = left;
    g->panel[i].right = width - right;
    abbe_chart_panel_draw(&g->panel[i]);
  }
}

static void draw(cairo_t *cr, const grid *g) {
  cairo_set_source_rgb(cr, 1, 1, 1);
  cairo_paint(cr);
  for (size_t column = 0; column < g->columns; column++) {
    cairo_save(cr);
    cairo_translate(cr, (double)g->width * (double)column / (double)g->columns, 0);
    draw_column(cr, g, column);
    cairo_restore(cr);
  }
}

static abbe_result write_surface(cairo_surface_t *surface, const grid *g, FILE *png,
                                 const char *path, abbe_error *error) {
  cairo_t *cr = cairo_create(surface);
  draw(cr, g);
  cairo_status_t status = cairo_status(cr);
  cairo_destroy(cr);
  png_stream stream = {.file = png, .left = 33};
  if (status == CAIRO_STATUS_SUCCESS && png != NULL)
    status = cairo_surface_write_to_png_stream(surface, write_png, &stream);
  cairo_surface_finish(surface); /* an SVG is written here */
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface);
  cairo_surface_destroy(surface);
  if (status == CAIRO_STATUS_SUCCESS) return ABBE_OK;
  return abbe_error_set(
      error, status == CAIRO_STATUS_NO_MEMORY ? ABBE_NO_MEMORY : ABBE_INVALID_ARGUMENT,
      "%s: the chart could not be drawn: %s", path, cairo_status_to_string(status));
}

static abbe_result write_panels(const char *path, const grid *g, abbe_error *error) {
  abbe_file_writer writer;
  ABBE_TRY(abbe_file_writer_open(&writer, path, error));
  bool svg = ends_with(path, ".svg");
  cairo_surface_t *surface =
      svg ? cairo_svg_surface_create_for_stream(write_bytes, writer.stream, (double)g->width,
                                                (double)g->height)
          : cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)g->width, (int)g->height);
  abbe_result result = write_surface(surface, g, svg ? NULL : writer.stream, path, error);
  return abbe_file_writer_end(&writer, result, error);
}

static abbe_result check_grid(const char *path, const grid *g, abbe_error *error) {
  if (!ends_with(path, ".png") && !ends_with(path, ".svg"))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: a chart wants a name that ends with .png or .svg", path);
  if (g->width < 64 || g->height < 64 || g->width > ABBE_CHART_MAX_SIDE ||
      g->height > ABBE_CHART_MAX_SIDE)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%s: a chart of %zu x %zu pixels; the sides may be 64 to %d", path,
                          g->width, g->height, ABBE_CHART_MAX_SIDE);
  if (g->count < 1 || g->count > MAX_CHARTS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: %zu charts in a picture of 1 to %d",
                          path, g->count, MAX_CHARTS);
  if (g->columns < 1 || g->count % g->columns != 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: %zu charts do not fill %zu columns",
                          path, g->count, g->columns);
  return ABBE_OK;
}

abbe_result abbe_chart_write_grid(const char *path, const abbe_chart *charts, size_t count,
                                  size_t columns, size_t width, size_t height, abbe_error *error) {
  grid g = {.count = count,
            .columns = columns,
            .width = width == 0 ? 960 : width,
            .height = height == 0 ? 600 : height};
  abbe_result result = check_grid(path, &g, error);
  if (result != ABBE_OK) return result;
  g.panel = calloc(count, sizeof *g.panel);
  if (g.panel == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "%s: no memory", path);
  for (size_t i = 0; i < count && result == ABBE_OK; i++)
    result = abbe_chart_panel_make(&charts[i], &g.panel[i], error);
  if (result == ABBE_OK) result = write_panels(path, &g, error);
  free(g.panel);
  return result;
}

abbe_result abbe_chart_write(const char *path, const abbe_chart *charts, size_t count, size_t width,
                             size_t height, abbe_error *error) {
  return abbe_chart_write_grid(path, charts, count, 1, width, height, error);
}
