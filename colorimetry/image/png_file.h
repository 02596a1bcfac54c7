/* png_file.h: display-encoded PNG out, textures in, through libpng; both state their colour. */
#ifndef ABBE_COLORIMETRY_IMAGE_PNG_FILE_H
#define ABBE_COLORIMETRY_IMAGE_PNG_FILE_H

#include "colorimetry/image/image.h"

/* Writes the first three channels (or one, as grey), and a fourth that is called A as alpha,
 * straight and linear; values clamped to [0, 1] and already encoded for the display, with bits = 8
 * or 16. Not-a-number is written as 0. Beside and renamed. The file states what image->xy and
 * image->curve are: sRGB by its chunk (with gAMA and cHRM for old readers), another encoding by an
 * ICC profile, PQ and HLG (image->transfer) by cICP, nothing where they are not known. Of the
 * image's attributes it has ABBE_PNG_TEXT. ABBE_INVALID_ARGUMENT for PQ and HLG in 8 bits, whose
 * steps would be seen, and for primaries that cICP has no code for. */
abbe_result abbe_png_write(const char *path, const abbe_image *image, int bits, abbe_error *error);
#define ABBE_PNG_TEXT "abbe:made" /* as a tEXt chunk */
/* What a PNG carries as ABBE_PNG_TEXT, malloc'd; NULL where it carries none before its pixels, or
 * more than 64 KiB. ABBE_IO, ABBE_PARSE for what is no PNG. */
abbe_result abbe_png_read_text(const char *path, char **out, abbe_error *error);

/* Pixels of so many bytes are read from however small a file; above, see
 * abbe_image_check_expansion. */
#define ABBE_PNG_FREE_BYTES ((size_t)256 << 20)

/* Reads a PNG as sRGB-encoded values in [0, 1]: channels "R", "G", "B" (grey and palettes expanded,
 * alpha dropped). At most 16384 a side. A file with another encoding by cICP, iCCP, or gAMA and
 * cHRM is converted, relative to white; what sRGB cannot hold is clipped. A file with none of
 * these, or a gAMA of 1/2.2 alone, is in sRGB. ABBE_PARSE for a broken file, ABBE_UNSUPPORTED for
 * pixels that are too many for the file and for a cICP that is none of an SDR display's RGB,
 * ABBE_COLOUR for a profile that cannot be used. */
abbe_result abbe_png_read(const char *path, abbe_image *out, abbe_error *error);
/* The same, and what is transparent is laid over white paper, in light. */
abbe_result abbe_png_read_over_white(const char *path, abbe_image *out, abbe_error *error);

#endif
