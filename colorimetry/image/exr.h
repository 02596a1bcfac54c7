/* exr.h: images as OpenEXR files, through OpenEXR's C core API.
 *
 * Writes scan lines, float32 or half, ZIP compressed, named layers as channel-name prefixes,
 * chromaticities and text attributes in the header. R, G, B of a space that has one get its
 * colorInteropID [ColorInterop2026]; what is no colour beside them (stderr.*, covariance.*,
 * normal.*, depth.*) is in a second part, "data", that is marked so, and both are read as one
 * picture. Reads any scan-line or tiled flat
 * part that the library can decode (the full-resolution level; float, half and whole numbers become
 * float32). A picture is its display window: pixels for which the file has no data
 * are 0, data outside it are left out. Sizes are checked before allocating.
 */
#ifndef ABBE_COLORIMETRY_IMAGE_EXR_H
#define ABBE_COLORIMETRY_IMAGE_EXR_H

#include "colorimetry/image/image.h"

/* Writes image to path (beside and renamed). ABBE_IO names the path and the reason;
 * ABBE_INVALID_ARGUMENT for two channels of one name and for an attribute whose name OpenEXR keeps
 * for itself ("channels", "compression", …). */
abbe_result abbe_exr_write(const char *path, const abbe_image *image, abbe_error *error);

/* The same in half precision: 11 bits, from 6e-5 to 65504, and fixed steps of 6e-8 below that.
 * Nothing overflows: where the greatest finite magnitude is outside [1, 65504], all values are
 * divided by the power of two that brings it into [2^14, 2^15), and the text attribute
 * "abbe:stored_unit" holds that power; abbe_exr_read multiplies by it again. Other programs see the
 * quotients. Infinities and NaN stay what they are. */
abbe_result abbe_exr_write_half(const char *path, const abbe_image *image, abbe_error *error);

/* Pixels of so many bytes are read from however small a file; above, see
 * abbe_image_check_expansion. */
#define ABBE_EXR_FREE_BYTES ((size_t)1 << 30)

/* Reads path: of several parts the first with R, G and B or X, Y and Z, else with Y, else that is
 * flat, and with it the first part marked as data that has its windows; or FILE#PART, a part alone
 * by its name or by its number, from 1. ABBE_NOT_FOUND where there is no
 * such part; ABBE_PARSE for a broken or truncated file, and for an abbe:stored_unit that is no
 * power of two; ABBE_UNSUPPORTED for deep data, subsampled channels, tiles of PIZ above 16384
 * pixels a side, pixels that are too many for the file, and compression that the OpenEXR that runs
 * cannot decode (DWA before 3.1.8, HTJ2K before 3.4.0), with the version that can. */
abbe_result abbe_exr_read(const char *path, abbe_image *out, abbe_error *error);

/* A file that stays open: what is read of it is of one file, whatever takes its name. */
typedef struct abbe_exr_reader abbe_exr_reader;

/* Reads no pixels. Errors of abbe_exr_read. */
abbe_result abbe_exr_open(const char *path, abbe_exr_reader **out, abbe_error *error);
void abbe_exr_close(abbe_exr_reader *reader);

/* What a part holds whose tiles have levels of detail: a picture and its halves (MIPMAP_LEVELS, or
 * RIPMAP_LEVELS with both sides alike), each of the same display and data window. */
typedef struct abbe_exr_levels {
  size_t count; /* 1: there is the picture alone, or its windows differ */
  size_t width, height, channels;
} abbe_exr_levels;

void abbe_exr_find_levels(const abbe_exr_reader *reader, abbe_exr_levels *out);

/* The pixels of a level, from 0 the finest, in the window x0, y0, x1, y1 of that level, both ends
 * included; NULL: all. Only tiles that lie in it are read. Errors of abbe_exr_read;
 * ABBE_INVALID_ARGUMENT for a level or a window that is not there, and where there are no tiles. */
abbe_result abbe_exr_read_level(abbe_exr_reader *reader, size_t level, const size_t window[4],
                                abbe_image *out, abbe_error *error);

/* The picture as abbe_exr_read has it without its pixels: data is NULL. Errors of abbe_exr_read. */
abbe_result abbe_exr_read_header(abbe_exr_reader *reader, abbe_image *out, abbe_error *error);

/* The first three channels of out, a picture of the file's size and all 0, become the sums of the
 * file's channels channel[count] times weight[count][3]; those behind, if it has count more, these
 * channels times factor[count]. *odd: pixels of which a channel that counts is infinite or NaN,
 * whose sums are so too. Errors of abbe_exr_read. */
abbe_result abbe_exr_read_sums(abbe_exr_reader *reader, size_t count, const size_t *channel,
                               const double (*weight)[3], const double *factor, abbe_image *out,
                               abbe_image_odd *odd, abbe_error *error);

/* The picture as abbe_exr_read has it; but of scan lines with more than so many numbers every n-th
 * chunk alone, about so many numbers, each line between as the one above it. */
abbe_result abbe_exr_read_first(abbe_exr_reader *reader, size_t most, abbe_image *out,
                                abbe_error *error);

/* Reads for so many seconds into that image what it lacks; *share: of its chunks that are there.
 * Errors of abbe_exr_read. */
abbe_result abbe_exr_read_on(abbe_exr_reader *reader, double seconds, abbe_image *image,
                             double *share, abbe_error *error);

/* How many bytes of path name the file: those before the last '#' where there is no file of the
 * whole name, else all. */
size_t abbe_exr_file_length(const char *path);

#endif
