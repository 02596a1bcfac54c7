/* flip.h: FLIP, the difference that an eye sees when two pictures flip in one place.
 *
 * Colours are filtered by the eye's contrast sensitivity at a distance, compared in a uniform
 * space, and weighed by how edges and points differ [Andersson2020]. Pictures with more light than
 * a screen shows are compared at many exposures, tone-mapped, and the greatest counts
 * [Andersson2021]. A pixel's FLIP is from 0 (equal) to 1.
 */
#ifndef ABBE_VALIDATION_COMPARE_FLIP_H
#define ABBE_VALIDATION_COMPARE_FLIP_H

#include "base/error.h"

#include <stddef.h>

/* Pixels a degree of the published default: 0.7 m from a screen of 3840 pixels over 0.7 m. */
#define ABBE_FLIP_PIXELS_PER_DEGREE 67.0206432765823

/* The exposures of a pair of pictures, in stops. */
typedef struct abbe_flip_exposures {
  double first, last;
  size_t count;
} abbe_flip_exposures;

/* Of linear Rec.709, rgb[width * height][3], as a screen shows it: clipped to 0 to 1 (what is not
 * finite is 0). pixels_per_degree 0: the default. out[width * height]. ABBE_INVALID_ARGUMENT for an
 * empty picture, ABBE_NO_MEMORY. */
abbe_result abbe_flip_map(const float (*reference)[3], const float (*test)[3], size_t width,
                          size_t height, double pixels_per_degree, float *out, abbe_error *error);

/* Of linear Rec.709 with any amount of light. Exposures, found from the reference: from the one at
 * which its brightest pixel becomes 0.85 by the tone curve [Narkowicz2015] to the one at which its
 * median does, about a stop apart. A reference without light, or with a median of none, has two. */
abbe_result abbe_flip_hdr_map(const float (*reference)[3], const float (*test)[3], size_t width,
                              size_t height, double pixels_per_degree, float *out,
                              abbe_flip_exposures *exposures, abbe_error *error);

#endif
