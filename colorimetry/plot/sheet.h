/* sheet.h: printed pages of text, pictures and charts as PDF, drawn by cairo.
 *
 * The caller places everything, in points (1/72 inch) from the upper left. A file that is not
 * finished is not left behind. */
#ifndef ABBE_COLORIMETRY_PLOT_SHEET_H
#define ABBE_COLORIMETRY_PLOT_SHEET_H

#include "base/error.h"
#include "colorimetry/image/image.h"
#include "colorimetry/plot/chart.h"

#include <stdbool.h>
#include <stddef.h>

#define ABBE_SHEET_A4_WIDTH 595.276
#define ABBE_SHEET_A4_HEIGHT 841.89

typedef struct abbe_sheet abbe_sheet;

/* Begins a file of A4 pages, upright. ABBE_INVALID_ARGUMENT for a name that does not end with .pdf,
 * ABBE_IO, ABBE_NO_MEMORY. */
abbe_result abbe_sheet_make(const char *path, abbe_sheet **out, abbe_error *error);

/* UTF-8; its base line begins at (x, y), or ends there where `right`. grey: 0 black to 1 white. */
void abbe_sheet_text(abbe_sheet *sheet, double x, double y, double size, bool bold, bool right,
                     double grey, const char *text);
void abbe_sheet_line(abbe_sheet *sheet, double x0, double y0, double x1, double y1, double grey);
/* The first three channels of a picture that is encoded for a screen, into a rectangle. */
abbe_result abbe_sheet_picture(abbe_sheet *sheet, double x, double y, double width, double height,
                               const abbe_image *image, abbe_error *error);
/* Its letters are `scale` times those of a picture. Errors as abbe_chart_write. */
abbe_result abbe_sheet_chart(abbe_sheet *sheet, double x, double y, double width, double height,
                             double scale, const abbe_chart *chart, abbe_error *error);
/* Begins another page. */
void abbe_sheet_turn(abbe_sheet *sheet);

/* Writes the file and frees the sheet, whatever comes of it. ABBE_IO, ABBE_NO_MEMORY. */
abbe_result abbe_sheet_finish(abbe_sheet *sheet, abbe_error *error);
/* Frees it without a file. Safe on NULL. */
void abbe_sheet_free(abbe_sheet *sheet);

#endif
