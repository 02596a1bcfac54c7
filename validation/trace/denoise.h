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
#include "validation/trace/nl_means.h"

#include <stdbool.h>

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

/* A part of a traced picture whose noise is of one kind, filtered as brightness and
 * colour apart. */

enum { ABBE_DENOISE_FEATURES = 7 };

/* What both parts share. */
typedef struct abbe_denoise_work {
  size_t width, height, pixels, threads, passes;
  double luminance[3]; /* Y of the picture's R, G, B */
  abbe_noisy_plane feature[ABBE_DENOISE_FEATURES];
} abbe_denoise_work;

/* Planes of brightness, and of what R and B, in units of the part's mean colour, are above it. */
typedef struct abbe_denoise_part {
  const abbe_denoise_work *work;
  bool photons;              /* its variance follows its brightness */
  double share[3], white[3]; /* share of brightness; the mean colour times its unit */
  float *room;
  float *value[3], *variance[3];
  float *out[3], *error[3]; /* filtered; mean square of its error */
} abbe_denoise_part;

/* The part `name` ("photons", "eye") of the picture whose colours are called colour[3].
 * ABBE_INVALID_ARGUMENT where a layer is missing, ABBE_NO_MEMORY. */
abbe_result abbe_denoise_part_make(const abbe_denoise_work *work, const abbe_image *picture,
                                   const char *name, const char *const colour[3],
                                   abbe_denoise_part *out, abbe_error *error);
void abbe_denoise_part_free(abbe_denoise_part *part);

abbe_result abbe_denoise_part_filter(abbe_denoise_part *part, abbe_error *error);

/* R, G, B of a pixel, and the mean square of their errors. */
void abbe_denoise_part_colour(const abbe_denoise_part *part, size_t pixel, double rgb[3],
                              double square[3]);

/* R, G, B of a pixel as it was. */
void abbe_denoise_part_raw(const abbe_denoise_part *part, size_t pixel, double rgb[3]);

/* The channel prefix + name, what is not finite as 0. ABBE_INVALID_ARGUMENT where it is missing. */
abbe_result abbe_denoise_take(const abbe_image *picture, const char *prefix, const char *name,
                              float *out, abbe_error *error);

#endif
