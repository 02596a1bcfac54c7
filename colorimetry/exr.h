/* exr.h: images as OpenEXR files, through OpenEXR's C core API.
 *
 * Writes one scan-line part, float32, ZIP compressed, named layers as channel-name prefixes,
 * chromaticities and text attributes in the header. Reads any single-part scan-line or tiled flat
 * file that the library can decode (the full-resolution level; float, half and whole numbers become
 * float32; the data window's origin is not kept); sizes are checked before allocating.
 */
#ifndef ABBE_COLORIMETRY_EXR_H
#define ABBE_COLORIMETRY_EXR_H

#include "colorimetry/image.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Writes image to path (beside and renamed). ABBE_IO names the path and the reason;
 * ABBE_INVALID_ARGUMENT for two channels of one name and for an attribute whose name OpenEXR keeps
 * for itself ("channels", "compression", …). */
abbe_result abbe_exr_write(const char *path, const abbe_image *image, abbe_error *error);
/* Reads path. ABBE_PARSE for a broken or truncated file; ABBE_UNSUPPORTED for deep data, several
 * parts, subsampled channels, and what OpenEXR 3.1's C core cannot decode: DWA, and B44 of other
 * than half channels. */
abbe_result abbe_exr_read(const char *path, abbe_image *out, abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
