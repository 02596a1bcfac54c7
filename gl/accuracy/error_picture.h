/* error_picture.h: a picture's error bars in false colours, with a scale bar.
 *
 * The error of Y a pixel, if its channels err together; black where it is a thousandth of the
 * scale's end or less. It estimates nothing: that is error_bars.h's business.
 */
#ifndef ABBE_GL_ACCURACY_ERROR_PICTURE_H
#define ABBE_GL_ACCURACY_ERROR_PICTURE_H

#include "gl/accuracy/error_bars.h"

/* To path, a .png or .svg. The scale is logarithmic and ends at the 1, 2 or 5 times a power of ten
 * that 99.9 % of the errors stay under. ABBE_NO_MEMORY; errors of abbe_chart_write. */
abbe_result abbe_error_picture_write(const char *path, const abbe_error_bars *bars,
                                     abbe_error *error);

#endif
