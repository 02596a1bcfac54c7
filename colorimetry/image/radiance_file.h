/* radiance_file.h: Radiance pictures (.hdr, .pic): four bytes a pixel with one exponent for three
 * mantissas [RadianceFormats].
 *
 * Reads RGBE and XYZE pixels, flat, in the old run-length coding and in the new one, lines in any
 * of the eight directions. Mantissas are whole steps, as most programs read them; Radiance's own
 * library takes the middles of steps (docs/colour.md). It writes none.
 */
#ifndef ABBE_COLORIMETRY_IMAGE_RADIANCE_FILE_H
#define ABBE_COLORIMETRY_IMAGE_RADIANCE_FILE_H

#include "colorimetry/image/image.h"

#define ABBE_RADIANCE_MAX_BYTES ((size_t)1 << 30) /* limit of the file */
/* Pixels of so many bytes are read from however small a file; above, see
 * abbe_image_check_expansion. */
#define ABBE_RADIANCE_FREE_BYTES ((size_t)1 << 30)

/* Reads path: linear channels "R", "G", "B", divided by what the header's EXPOSURE and COLORCORR
 * lines multiplied them by. xy is from PRIMARIES, or for XYZE pixels the primaries of XYZ; 0 where
 * the header is silent. Lines that run upwards, leftwards or along columns are put in order.
 * ABBE_IO for a file that cannot be read; ABBE_PARSE for one that is no Radiance picture, is cut
 * off, holds a broken run or an exposure that is not above 0; ABBE_UNSUPPORTED for another FORMAT
 * and for pixels that are too many for the file. */
abbe_result abbe_radiance_read(const char *path, abbe_image *out, abbe_error *error);

#endif
