/* png_file.h: display-encoded PNG out, textures in, through libpng. */
#ifndef ABBE_COLORIMETRY_PNG_FILE_H
#define ABBE_COLORIMETRY_PNG_FILE_H

#include "colorimetry/image.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Writes the first three channels (or one, as grey), values clamped to [0, 1] and already
 * encoded for the display, with bits = 8 or 16. Not-a-number is written as 0. Beside and renamed. */
abbe_result abbe_png_write(const char *path, const abbe_image *image, int bits,
                           abbe_error *error);
/* Reads a PNG as encoded values in [0, 1]: channels "R", "G", "B" (grey and palettes expanded,
 * alpha dropped). At most 16384 a side. */
abbe_result abbe_png_read(const char *path, abbe_image *out, abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
