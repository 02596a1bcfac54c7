/* nl_means.h: non-local means of planes whose pixels have variances of their own.
 *
 * A pixel becomes a mean of the pixels around whose surroundings differ from its own by no more
 * than their noise [RousselleKnausZwicker2012], and which show the same thing
 * [RousselleManziZwicker2013]. It knows of no colours and no files.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_NL_MEANS_H
#define ABBE_VALIDATION_TRACE_NL_MEANS_H

#include "base/error.h"

#include <stddef.h>

enum { ABBE_NL_MEANS_PLANES = 12 };

/* A picture of one value a pixel with its variance: [height][width] each. */
typedef struct abbe_noisy_plane {
  const float *value, *variance;
} abbe_noisy_plane;

typedef struct abbe_nl_means {
  size_t width, height;
  size_t window, patch; /* pixels to each side: of what is averaged, of what is compared */
  float noise;          /* differences of so many standard deviations are taken for noise: k */
  size_t compared, features, filtered;
  abbe_noisy_plane compare[ABBE_NL_MEANS_PLANES]; /* patches of these */
  abbe_noisy_plane feature[ABBE_NL_MEANS_PLANES]; /* pixels of these: a difference of 1 is no
                                                     difference yet, nor is one within the noise */
  abbe_noisy_plane filter[ABBE_NL_MEANS_PLANES];
  float *out[ABBE_NL_MEANS_PLANES];          /* [filtered] the means */
  float *out_variance[ABBE_NL_MEANS_PLANES]; /* [filtered] theirs, were the weights no chance */
  float *own;                                /* the pixel's own share of its mean */
} abbe_nl_means;

/* ABBE_NO_MEMORY. The same result for any number of threads. */
abbe_result abbe_nl_means_run(const abbe_nl_means *job, size_t threads, abbe_error *error);

/* Means over squares of pixels.
 * */

/* out (not from) of width x height pixels: means over squares of `reach` pixels to each side, less
 * where they leave the plane. `room` is another plane. */
void abbe_plane_mean(const float *from, size_t width, size_t height, size_t reach, size_t threads,
                     float *room, float *out);

#endif
