/* picture_file.h: scene-linear pictures by what their files are: OpenEXR, Radiance or ENVI.
 *
 * ENVI is a header in text, FILE.hdr or CUBE.hdr, beside a cube of raw numbers (CUBE; FILE, or FILE
 * with .img, .raw, .dat, .bin, .bsq, .bil or .bip) [ENVI]. Its bands become channels of the
 * spectral layout (spectral_channels.h): "T.550,000000nm" where the header has a reflectance scale
 * factor, else "S0.550,000000nm", or their own names where it has no wavelengths. Other lines of
 * the header become attributes.
 *
 * Radiance pictures (.hdr, .pic) have four bytes a pixel with one exponent for three mantissas
 * [RadianceFormats]: RGBE and XYZE, flat, in the old run-length coding and in the new one, lines in
 * any of the eight directions. Mantissas are whole steps, as most programs read them; Radiance's
 * own library takes the middles of steps (docs/colour.md). Neither is written.
 */
#ifndef ABBE_COLORIMETRY_IMAGE_PICTURE_FILE_H
#define ABBE_COLORIMETRY_IMAGE_PICTURE_FILE_H

#include "colorimetry/image/image.h"

typedef enum abbe_picture_file_kind {
  ABBE_PICTURE_FILE_OTHER,
  ABBE_PICTURE_FILE_EXR,
  ABBE_PICTURE_FILE_RADIANCE,
  ABBE_PICTURE_FILE_ENVI
} abbe_picture_file_kind;

/* By the first bytes, of a path that may name a part (exr.h). Errors of abbe_file_open. */
abbe_result abbe_picture_file_find_kind(const char *path, abbe_picture_file_kind *out,
                                        abbe_error *error);

/* Errors of abbe_exr_read, which takes what is of no other kind, abbe_radiance_read and
 * abbe_envi_read. */
abbe_result abbe_picture_file_read(const char *path, abbe_image *out, abbe_error *error);

#define ABBE_RADIANCE_MAX_BYTES ((size_t)1 << 30) /* limit of the file */
/* Pixels of so many bytes are read from however small a file; above, see
 * abbe_image_check_expansion. */
#define ABBE_RADIANCE_FREE_BYTES ((size_t)1 << 30)

/* Reads a Radiance picture: linear channels "R", "G", "B", divided by what the header's EXPOSURE
 * and COLORCORR lines multiplied them by. xy is from PRIMARIES, or for XYZE pixels the primaries of
 * XYZ; 0 where the header is silent. Lines that run upwards, leftwards or along columns are put in
 * order. ABBE_IO for a file that cannot be read; ABBE_PARSE for one that is no Radiance picture, is
 * cut off, holds a broken run or an exposure that is not above 0; ABBE_UNSUPPORTED for another
 * FORMAT and for pixels that are too many for the file. */
abbe_result abbe_radiance_read(const char *path, abbe_image *out, abbe_error *error);

/* Reads ENVI; path is the header's. Wavelengths may be in any order. A unit that is not stated is
 * nm where all are from 100 to 10000, um from 0.1 to 10. ABBE_PARSE, with the line, for a header
 * that is none, for wavelengths that are no numbers above 0 or stand twice, and for a cube that is
 * too short; ABBE_NOT_FOUND for one that is not there; ABBE_UNSUPPORTED for complex numbers, packed
 * cubes and units that are none of a wavelength; ABBE_INVALID_ARGUMENT for a size that no picture
 * has. */
abbe_result abbe_envi_read(const char *path, abbe_image *out, abbe_error *error);

#endif
