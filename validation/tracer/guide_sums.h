/* guide_sums.h: what a filter of the picture reads, summed over passes: the photons' part and the
 * eye's apart, how their noise goes together in colour, and what shows where.
 *
 * Internal to validation/: it is not installed.
 */
#ifndef ABBE_VALIDATION_TRACER_GUIDE_SUMS_H
#define ABBE_VALIDATION_TRACER_GUIDE_SUMS_H

#include "validation/tracer/accumulator.h"
#include "validation/walks/eye_walk.h"

/* Values of a pixel. The last ones are products, whose sums tell covariances. */
enum {
  ABBE_GUIDE_PHOTONS = 0, /* R, G, B of the caustic that the eye sees straight */
  ABBE_GUIDE_EYE = 3,     /* R, G, B of all that paths from the eye bring */
  ABBE_GUIDE_ALBEDO = 6,
  ABBE_GUIDE_NORMAL = 9,
  ABBE_GUIDE_DEPTH = 12,
  ABBE_GUIDE_MEANS = 13,
  ABBE_GUIDE_SQUARES = 13,  /* of each mean; of two digits, as the products are */
  ABBE_GUIDE_PRODUCTS = 39, /* RG, RB, GB of the photons, then of the eye */
  ABBE_GUIDE_VALUES = 51
};

/* A zeroed one is of no pixels. */
typedef struct abbe_guide_sums {
  size_t pixels;
  double unit;         /* of the colours: the picture's sums' */
  float *adding;       /* [pixels][10] the pass that is under way, but for the photons */
  abbe_whole_sum *sum; /* [pixels][ABBE_GUIDE_VALUES] over passes, in units (whole_sum.h) */
} abbe_guide_sums;

/* picture_unit: abbe_accumulator's of the picture. */
abbe_result abbe_guide_sums_make(size_t pixels, double picture_unit, abbe_guide_sums *out,
                                 abbe_error *error);
void abbe_guide_sums_free(abbe_guide_sums *g);

/* The pass's sample of a pixel, whose colour is rgb; what is not finite counts as nothing. */
void abbe_guide_sums_set(abbe_guide_sums *g, size_t pixel, const float rgb[3],
                         const abbe_eye_sample *sample);
/* Adds the pass, before it ends in the picture's sums, which have `channels` values a pixel and
 * begin with R, G, B: what is not the eye's there is the photons'. */
void abbe_guide_sums_end_pass(abbe_guide_sums *g, const abbe_accumulator *picture, size_t channels);

/* A mean over so many passes. */
double abbe_guide_sums_mean(const abbe_guide_sums *g, size_t passes, size_t pixel, size_t mean);
/* Of the means over so many passes, at least two: a mean's square of standard error, and the
 * covariance that product 0 to 5 tells. */
double abbe_guide_sums_variance(const abbe_guide_sums *g, size_t passes, size_t pixel, size_t mean);
double abbe_guide_sums_covariance(const abbe_guide_sums *g, size_t passes, size_t pixel,
                                  size_t product);

#endif
