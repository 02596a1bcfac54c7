/* weights.h: what one wavelength sample adds to a colour.
 *
 * The weight of sample i is the integral over its own band of observer x illuminant, normalised
 * so that the sum over all samples is the illuminant's white with Y = 1. In XYZ no weight is
 * negative; in RGB spaces negatives are kept. The set `thesis` is the thesis's seven RGB triples.
 */
#ifndef ABBE_COLORIMETRY_WEIGHTS_H
#define ABBE_COLORIMETRY_WEIGHTS_H

#include "base/error.h"
#include "colorimetry/illuminant.h"
#include "colorimetry/rgb_space.h"
#include "spectral/wavelengths.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct abbe_weights {
  size_t count;
  double (*weight)[3]; /* [count], in the space that was asked for */
  double sum[3];       /* of all weights: the illuminant's white, in that space */
} abbe_weights;

/* Weights of the samples under the illuminant. For several hundred samples a band is narrower
 * than the tables' step; the integrals are exact for the stated interpolations all the same.
 * ABBE_INVALID_ARGUMENT where the range holds no light (the white would be black). */
abbe_result abbe_weights_make(const abbe_wavelengths *wavelengths,
                              const abbe_illuminant *illuminant, abbe_rgb_space space,
                              abbe_weights *out, abbe_error *error);
void abbe_weights_free(abbe_weights *weights);

/* An illuminant over a range of wavelengths, and the Y of its white there, for whoever asks for many
 * bands of it. The illuminant outlives it. */
typedef struct abbe_weights_range {
  const abbe_illuminant *illuminant;
  double min_nm, max_nm;
  double white_y; /* relative */
} abbe_weights_range;

void abbe_weights_range_make(const abbe_illuminant *illuminant, double min_nm, double max_nm,
                             abbe_weights_range *out);
/* As abbe_weights_band_xyz. */
void abbe_weights_range_xyz(const abbe_weights_range *range, double from_nm, double to_nm,
                            double xyz[3]);

/* XYZ of the band [from_nm, to_nm] alone, normalised as the weights over the range
 * [min_nm, max_nm] are: bands that tile the range add up to its white. */
void abbe_weights_band_xyz(const abbe_illuminant *illuminant, double min_nm, double max_nm,
                           double from_nm, double to_nm, double xyz[3]);

/* Share of the illuminant's power over [min_nm, max_nm] that lies in [from_nm, to_nm]. */
double abbe_weights_band_power(const abbe_illuminant *illuminant, double min_nm, double max_nm,
                               double from_nm, double to_nm);

/* The thesis's seven samples: nodes 380, 430, … 680 nm, and as linear RGB the values that its
 * shaders add (appendix A: 0.3 0 0.8 … 1 0 0; sums 3.5), not those of its Table 2 / 255. */
#define ABBE_WEIGHTS_THESIS_COUNT 7
extern const double abbe_weights_thesis_lambda_nm[ABBE_WEIGHTS_THESIS_COUNT];
extern const double abbe_weights_thesis_rgb[ABBE_WEIGHTS_THESIS_COUNT][3];
/* Table 2 as printed, 0 to 255. */
extern const double abbe_weights_thesis_table2[ABBE_WEIGHTS_THESIS_COUNT][3];

#ifdef __cplusplus
}
#endif
#endif
