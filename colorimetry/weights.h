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
#include "colorimetry/observer.h"
#include "colorimetry/rgb_space.h"
#include "spectral/wavelengths.h"

#include <stddef.h>

typedef struct abbe_weights {
  size_t count;
  double (*weight)[3]; /* [count], in the requested space */
  double sum[3];       /* sum of all weights: the illuminant's white, in that space */
} abbe_weights;

/* Weights of the samples under the illuminant. For several hundred samples a band is narrower
 * than the tables' step; the integrals are exact for the stated interpolations all the same.
 * ABBE_INVALID_ARGUMENT where the range holds no light (the white would be black). */
abbe_result abbe_weights_make(const abbe_wavelengths *wavelengths,
                              const abbe_illuminant *illuminant, abbe_rgb_space space,
                              abbe_weights *out, abbe_error *error);
/* The same for any observer; RGB is then its XYZ through the space's matrix. */
abbe_result abbe_weights_make_by(abbe_observer observer, const abbe_wavelengths *wavelengths,
                                 const abbe_illuminant *illuminant, abbe_rgb_space space,
                                 abbe_weights *out, abbe_error *error);
void abbe_weights_free(abbe_weights *weights);

/* An illuminant over a range of wavelengths, and what the bands of that range are divided by. A
 * caller that needs many bands makes it once. */
typedef struct abbe_weights_range {
  abbe_observer observer;
  const abbe_illuminant *illuminant; /* not owned: it outlives the range */
  double min_nm, max_nm;
  double white_y; /* integral of ybar x power over the range, nm x the illuminant's unit, >= 0 */
} abbe_weights_range;

/* Fills *out. Of the range only 360 to 830 nm count, where the observer's tables lie. A range that
 * is empty (max_nm <= min_nm) or holds no light that the eye sees is no error: its white_y is 0. */
void abbe_weights_range_make(const abbe_illuminant *illuminant, double min_nm, double max_nm,
                             abbe_weights_range *out);
/* The same for any observer. */
void abbe_weights_range_make_by(abbe_observer observer, const abbe_illuminant *illuminant,
                                double min_nm, double max_nm, abbe_weights_range *out);
/* CIE XYZ of the light in the band [from_nm, to_nm], over the Y of the whole range: what a weight
 * of abbe_weights_make is in XYZ, without unit, none negative. Bands that tile the range add up to
 * its white, whose Y is 1. What of a band lies outside the range is left out. No errors: an empty
 * band, one outside the range and every band of a range whose white_y is 0 are black. */
void abbe_weights_range_xyz(const abbe_weights_range *range, double from_nm, double to_nm,
                            double xyz[3]);

/* abbe_weights_range_xyz of the range [min_nm, max_nm], for one band alone: it integrates the whole
 * range, too. */
void abbe_weights_band_xyz(const abbe_illuminant *illuminant, double min_nm, double max_nm,
                           double from_nm, double to_nm, double xyz[3]);

/* XYZ of all of an illuminant over [min_nm, max_nm] for that observer: Y is 1, or 0 where the range
 * holds no light that the eye sees. */
void abbe_weights_white(abbe_observer observer, const abbe_illuminant *illuminant, double min_nm,
                        double max_nm, double xyz[3]);

/* Share, 0 to 1, of the illuminant's power over [min_nm, max_nm] that lies in [from_nm, to_nm],
 * seen or not. What of the band lies outside the range is left out; 0 where the range holds no
 * power. */
double abbe_weights_band_power(const abbe_illuminant *illuminant, double min_nm, double max_nm,
                               double from_nm, double to_nm);

/* The thesis's seven samples: nodes 380, 430, … 680 nm, and as linear RGB the values that its
 * shaders add (appendix A: 0.3 0 0.8 … 1 0 0; sums 3.5), not those of its Table 2 / 255. */
#define ABBE_WEIGHTS_THESIS_COUNT 7
extern const double abbe_weights_thesis_lambda_nm[ABBE_WEIGHTS_THESIS_COUNT];
extern const double abbe_weights_thesis_rgb[ABBE_WEIGHTS_THESIS_COUNT][3];

#endif
