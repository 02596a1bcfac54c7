#include "colorimetry/plot/sheet.h"

#include "base/file.h"
#include "colorimetry/plot/chart_panel.h"

#include <assert.h>
#include <cairo-pdf.h>
#include <cairo.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

struct abbe_sheet {
  abbe_file_writer writer;
  cairo_surface_t *surface;
  cairo_t *cr;
};

/* What does not reach the file shows in ferror when it is committed, with the reason. */
static cairo_status_t write_bytes(void *closure, const unsigned char *data, unsigned int length) {
  fwrite(data, 1, length, closure);
  return CAIRO_STATUS_SUCCESS;
}

static abbe_result state_of(cairo_status_t status, abbe_error *error) {
  if (status == CAIRO_STATUS_SUCCESS) return ABBE_OK;
  return abbe_error_set(error, status == CAIRO_STATUS_NO_MEMORY ? ABBE_NO_MEMORY : ABBE_IO,
                        "the pages could not be drawn: %s", cairo_status_to_string(status));
}

abbe_result abbe_sheet_make(const char *path, abbe_sheet **out, abbe_error *error) {
  *out = NULL;
  const size_t length = strlen(path);
  if (length < 5 || strcasecmp(path + length - 4, ".pdf") != 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "%s: pages want a name that ends with .pdf",
                          path);
  abbe_sheet *sheet = calloc(1, sizeof *sheet);
  if (sheet == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %s", path);
  abbe_result result = abbe_file_writer_open(&sheet->writer, path, error);
  if (result != ABBE_OK) {
    free(sheet);
    return result;
  }
  sheet->surface = cairo_pdf_surface_create_for_stream(write_bytes, sheet->writer.stream,
                                                       ABBE_SHEET_A4_WIDTH, ABBE_SHEET_A4_HEIGHT);
  /* From 1.5 on newer versions of cairo pack a file's structure, which then no text tool reads. */
  cairo_pdf_surface_restrict_to_version(sheet->surface, CAIRO_PDF_VERSION_1_4);
  sheet->cr = cairo_create(sheet->surface);
  result = state_of(cairo_status(sheet->cr), error);
  if (result == ABBE_OK)
    *out = sheet;
  else
    abbe_sheet_free(sheet);
  return result;
}

void abbe_sheet_free(abbe_sheet *sheet) {
  if (sheet == NULL) return;
  if (sheet->cr != NULL) cairo_destroy(sheet->cr);
  if (sheet->surface != NULL) cairo_surface_destroy(sheet->surface);
  abbe_file_writer_discard(&sheet->writer);
  free(sheet);
}

void abbe_sheet_text(abbe_sheet *s, double x, double y, double size, bool bold, bool right,
                     double grey, const char *text) {
  abbe_chart_set_font(s->cr, size, bold);
  abbe_chart_set_grey(s->cr, grey);
  abbe_chart_put_text(s->cr, text, x, y, right ? 1 : 0, 1);
}

void abbe_sheet_line(abbe_sheet *s, double x0, double y0, double x1, double y1, double grey) {
  abbe_chart_set_grey(s->cr, grey);
  cairo_set_line_width(s->cr, 0.5);
  abbe_chart_draw_line(s->cr, x0, y0, x1, y1);
}

static uint32_t byte_of(float value) {
  return (uint32_t)lround(255 * fmin(fmax((double)value, 0), 1));
}

abbe_result abbe_sheet_picture(abbe_sheet *s, double x, double y, double width, double height,
                               const abbe_image *image, abbe_error *error) {
  assert(image->data);
  if (image->channels < 3)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a picture of %zu channels; it takes 3",
                          image->channels);
  cairo_surface_t *picture =
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)image->width, (int)image->height);
  abbe_result result = state_of(cairo_surface_status(picture), error);
  if (result == ABBE_OK) {
    unsigned char *data = cairo_image_surface_get_data(picture);
    const size_t stride = (size_t)cairo_image_surface_get_stride(picture);
    for (size_t i = 0; i < image->width * image->height; i++) {
      const float *p = image->data + i * image->channels;
      const uint32_t pixel = byte_of(p[0]) << 16 | byte_of(p[1]) << 8 | byte_of(p[2]);
      memcpy(data + i / image->width * stride + i % image->width * 4, &pixel, 4);
    }
    cairo_surface_mark_dirty(picture);
    cairo_save(s->cr);
    cairo_translate(s->cr, x, y);
    cairo_scale(s->cr, width / (double)image->width, height / (double)image->height);
    cairo_set_source_surface(s->cr, picture, 0, 0);
    cairo_paint(s->cr);
    cairo_restore(s->cr);
    result = state_of(cairo_status(s->cr), error);
  }
  cairo_surface_destroy(picture);
  return result;
}

abbe_result abbe_sheet_chart(abbe_sheet *s, double x, double y, double width, double height,
                             double scale, const abbe_chart *chart, abbe_error *error) {
  abbe_chart_panel panel;
  if (!(scale > 0))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "a chart at %g times its size", scale);
  ABBE_TRY(abbe_chart_panel_make(chart, &panel, error));
  double left, right;
  cairo_save(s->cr);
  cairo_translate(s->cr, x, y);
  cairo_scale(s->cr, scale, scale);
  panel.cr = s->cr;
  panel.top = 0;
  panel.bottom = height / scale;
  panel.left = 0;
  panel.right = width / scale;
  abbe_chart_panel_measure(&panel, &left, &right);
  panel.left = left;
  panel.right = width / scale - right;
  abbe_chart_panel_draw(&panel);
  cairo_restore(s->cr);
  return state_of(cairo_status(s->cr), error);
}

void abbe_sheet_turn(abbe_sheet *sheet) {
  cairo_show_page(sheet->cr);
}

abbe_result abbe_sheet_finish(abbe_sheet *sheet, abbe_error *error) {
  cairo_show_page(sheet->cr);
  cairo_status_t status = cairo_status(sheet->cr);
  cairo_surface_finish(sheet->surface); /* the file is written here */
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(sheet->surface);
  abbe_result result = state_of(status, error);
  result = abbe_file_writer_end(&sheet->writer, result, error);
  abbe_sheet_free(sheet);
  return result;
}
