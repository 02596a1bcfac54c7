/* animated_png.h: PNG files of one kind, one after another, as one that moves (APNG, [PNG2025]).
 *
 * Frames are whole PNGs of one size and depth; their compressed pixels are taken as they are, and
 * the colour chunks of the first hold for all. Viewers that know no animation show the first. */
#ifndef ABBE_COLORIMETRY_IMAGE_ANIMATED_PNG_H
#define ABBE_COLORIMETRY_IMAGE_ANIMATED_PNG_H

#include "base/error.h"

#include <stddef.h>

#define ABBE_ANIMATED_PNG_MAX_FRAME ((size_t)1 << 30) /* bytes of a frame's file */

/* Writes path, beside and renamed, from the files frame[count], 1 to 1e6, at so many frames a
 * second, 0.1 to 1000; it repeats for ever. ABBE_INVALID_ARGUMENT for a count or a rate out of
 * range and a frame of another kind than the first, ABBE_PARSE for what is no PNG; ABBE_IO. */
abbe_result abbe_animated_png_write(const char *path, const char *const *frame, size_t count,
                                    double per_second, abbe_error *error);

#endif
