/* avif_file.h: display-encoded AVIF out, through libavif: small files that browsers show, HDR ones
 * too.
 *
 * What is written is near what a PNG would hold, not equal to it: to compare numbers, write a PNG.
 * It reads nothing.
 */
#ifndef ABBE_COLORIMETRY_IMAGE_AVIF_FILE_H
#define ABBE_COLORIMETRY_IMAGE_AVIF_FILE_H

#include "colorimetry/image/image.h"

#include <stdbool.h>

/* Whether this build has libavif. */
bool abbe_avif_is_there(void);

/* Whether a file of that name is meant to be AVIF: it ends with .avif, in whatever case. */
bool abbe_avif_is_meant(const char *path);

/* Writes the first three channels, encoded for the display and clamped to [0, 1], with bits = 10 or
 * 12, in full range and without sharing of colour among pixels (4:4:4). Not-a-number is 0. Beside
 * and renamed. PQ and HLG (image->transfer), sRGB and P3 with sRGB's curve are stated by CICP
 * [H273], another encoding that is known by an ICC profile. ABBE_UNSUPPORTED where the build has no
 * libavif, ABBE_INVALID_ARGUMENT for other bits, fewer channels, and HDR primaries that have no
 * code; ABBE_IO where it cannot be written or encoded. */
abbe_result abbe_avif_write(const char *path, const abbe_image *image, int bits, abbe_error *error);

#endif
