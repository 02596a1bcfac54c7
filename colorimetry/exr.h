/* exr.h: images as OpenEXR files, through OpenEXR's C core API.
 *
 * Writes one scan-line part, float32 (or half), ZIP compressed, named layers as channel-name
 * prefixes, chromaticities and text attributes in the header. Reads any single-part scan-line or
 * tiled flat file that the library can decode; sizes are checked before allocating.
 */
#ifndef ABBE_COLORIMETRY_EXR_H
#define ABBE_COLORIMETRY_EXR_H

#include "colorimetry/image.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Writes image to path (beside and renamed). ABBE_IO names the path and the reason. */
abbe_result abbe_exr_write(const char *path, const abbe_image *image, abbe_error *error);
/* Reads path. ABBE_PARSE for a broken or truncated file; ABBE_UNSUPPORTED for deep data. */
abbe_result abbe_exr_read(const char *path, abbe_image *out, abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
