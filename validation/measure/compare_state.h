/* compare_state.h: what the parts of a comparison share. Internal to validation/. */
#ifndef ABBE_VALIDATION_MEASURE_COMPARE_STATE_H
#define ABBE_VALIDATION_MEASURE_COMPARE_STATE_H

#include "base/error.h"
#include "validation/measure/compare.h"

#include <stddef.h>

enum { ABBE_COMPARE_BAD_REFERENCE = 1, ABBE_COMPARE_BAD_TEST = 2 };

/* What is compared: REF and TEST; or what is under REF's noise, with the noise of REF's errors on
 * REF's side and none on TEST's, or with that of each on its own. */
typedef enum abbe_compare_sides {
  ABBE_COMPARE_TEST,
  ABBE_COMPARE_NOISE_OF_REFERENCE,
  ABBE_COMPARE_NOISE_OF_BOTH
} abbe_compare_sides;

typedef struct abbe_compare_state {
  const abbe_field *reference, *test;
  const abbe_compare_options *options;
  size_t pixels;
  unsigned char *bad; /* [pixels] 0: both sides are finite */
  abbe_comparison *out;
} abbe_compare_state;

/* Whether a pixel takes part: finite, and in the mask (NULL: anywhere). */
static inline bool abbe_compare_has(const abbe_compare_state *s, const abbe_mask *mask,
                                    size_t pixel) {
  return s->bad[pixel] == 0 && (mask == NULL || mask->in[pixel]);
}

/* REF's unit, the scale and the white, over the whole field. */
abbe_result abbe_compare_find_units(abbe_compare_state *s, abbe_error *error);
/* The metrics of light, of bands and of the Z-test, of one region. */
abbe_result abbe_compare_light(const abbe_compare_state *s, const abbe_mask *mask,
                               abbe_compare_region *region, abbe_error *error);
/* The metrics of colour, of both regions. */
abbe_result abbe_compare_colour(const abbe_compare_state *s, abbe_error *error);
/* XYZ of the two sides at a pixel, REF's in b. */
void abbe_compare_take_sides(const abbe_compare_state *s, abbe_compare_sides who, size_t pixel,
                             double b[3], double a[3]);
/* Whether the files have the standard errors for it. */
bool abbe_compare_knows(const abbe_compare_state *s, abbe_compare_sides who);
/* The metrics that look at a pixel's surroundings, of both regions of a picture. */
abbe_result abbe_compare_structure(const abbe_compare_state *s, abbe_error *error);

/* Structural similarity of two grey pictures.
 *
 * [Wang2004]'s index: windows of 11 x 11 under a Gaussian of 1.5 pixels, K1 = 0.01, K2 = 0.03, for
 * values from 0 to 1. What the values mean is the caller's. */

enum { ABBE_SSIM_REACH = 5 }; /* pixels from a window's middle to its edge */

/* The index, -1 to 1 (equal), of the window about each pixel, into out[width * height], row by row;
 * NaN where the window reaches over the picture's edge, and where it has a value that is not
 * finite. ABBE_NO_MEMORY. */
abbe_result abbe_ssim_map(const float *a, const float *b, size_t width, size_t height, float *out,
                          abbe_error *error);

/* FLIP, the difference that an eye sees when two pictures flip in one place.
 *
 * Colours are filtered by the eye's contrast sensitivity at a distance, compared in a uniform
 * space, and weighed by how edges and points differ [Andersson2020]. Pictures with more light than
 * a screen shows are compared at many exposures, tone-mapped, and the greatest counts
 * [Andersson2021]. A pixel's FLIP is from 0 (equal) to 1. */

/* Pixels a degree of the published default: 0.7 m from a screen of 3840 pixels over 0.7 m. */
#define ABBE_FLIP_PIXELS_PER_DEGREE 67.0206432765823

/* The exposures of a pair of pictures, in stops. */
typedef struct abbe_flip_exposures {
  double first, last;
  size_t count;
} abbe_flip_exposures;

/* FLIP of linear Rec.709, rgb[width * height][3], as a screen shows it: clipped to 0 to 1 (what is
 * not finite is 0). pixels_per_degree 0: the default. out[width * height]. ABBE_INVALID_ARGUMENT
 * for an empty picture, ABBE_NO_MEMORY. */
abbe_result abbe_flip_map(const float (*reference)[3], const float (*test)[3], size_t width,
                          size_t height, double pixels_per_degree, float *out, abbe_error *error);

/* HDR-FLIP of linear Rec.709 with any amount of light. Exposures, found from the reference: from
 * the one at which its brightest pixel becomes 0.85 by the tone curve [Narkowicz2015] to the one at
 * which its median does, about a stop apart. A reference without light, or with a median of none,
 * has two. */
abbe_result abbe_flip_hdr_map(const float (*reference)[3], const float (*test)[3], size_t width,
                              size_t height, double pixels_per_degree, float *out,
                              abbe_flip_exposures *exposures, abbe_error *error);

#endif
