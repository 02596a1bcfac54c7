/* denoise.h: a traced picture with less noise, and how far off it still is.
 *
 * Non-local means [RousselleKnausZwicker2012], guided by albedo, normal and depth
 * [RousselleManziZwicker2013], of the picture that the tracer gives with guides. Two parts are
 * filtered apart, for their noise is of two kinds: the caustic that the camera sees straight, which
 * is photons, and all that paths from the camera bring. Of each, brightness and colour are filtered
 * apart too: photons of single wavelengths make noise that is mostly colour, where the light itself
 * has little. What the filter loses of the light around a pixel is given back there. Spectral bands
 * are not filtered.
 */
#ifndef ABBE_VALIDATION_TRACE_DENOISE_H
#define ABBE_VALIDATION_TRACE_DENOISE_H

#include "base/error.h"
#include "colorimetry/image/image.h"

#define ABBE_DENOISE_MAX_THREADS 256

/* A zeroed request is valid. */
typedef struct abbe_denoise_desc {
  size_t threads; /* 0: all cores; the result is the same */
} abbe_denoise_desc;

/* R, G, B (or X, Y, Z), caustic.* and stderr.* filtered: stderr.* is the root of the expected
 * square of what is still wrong, noise and blur together, estimated by Stein's formula. Then raw.R
 * …, raw.caustic.R … and stderr.raw.R … as they were, albedo.*, normal.*, depth.Z, and the bands
 * with their errors, if there are any. Attributes are kept, with abbe:filter. ABBE_INVALID_ARGUMENT
 * where the picture lacks a layer that abbe_tracer_picture gives with guides after two passes or
 * more, ABBE_NO_MEMORY. */
abbe_result abbe_denoise_picture(const abbe_image *picture, const abbe_denoise_desc *desc,
                                 abbe_image *out, abbe_error *error);

#endif
