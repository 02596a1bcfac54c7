/* denoise_part.h: a part of a traced picture whose noise is of one kind, filtered as brightness and
 * colour apart.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_DENOISE_PART_H
#define ABBE_VALIDATION_TRACE_DENOISE_PART_H

#include "colorimetry/image/image.h"
#include "validation/trace/nl_means.h"

#include <stdbool.h>

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
