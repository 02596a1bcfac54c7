/* chromaticity.h: which colour, apart from how much light: diagrams, the spectral locus, dominant
 * wavelength and excitation purity.
 *
 * The locus is that of an observer (observer.h) from 380 to 700 nm (from 390 nm where its table
 * begins there), where chromaticity ends to change [CIE15]; the purple line joins its ends. What is
 * dark has no chromaticity. It displays nothing; colour temperature is colour_temperature.h's.
 */
#ifndef ABBE_COLORIMETRY_CHROMATICITY_H
#define ABBE_COLORIMETRY_CHROMATICITY_H

#include "colorimetry/observer.h"

#include <stdbool.h>

/* x, y of XYZ [CIE15]; false (xy untouched) where X + Y + Z or Y is not above 0 or anything is not
 * finite. */
bool abbe_chromaticity_xy(const double xyz[3], double xy[2]);
/* XYZ of x, y with Y = 1; false (xyz untouched) where y is not above 0. */
bool abbe_chromaticity_xyz(const double xy[2], double xyz[3]);
/* CIE 1976 u', v' of x, y [CIE15], and back. Not finite where there is none. */
void abbe_chromaticity_uv_of_xy(const double xy[2], double uv[2]);

/* x, y of light of one wavelength; what lies outside the locus' ends is at the nearest end. */
void abbe_chromaticity_locus(abbe_observer observer, double lambda_nm, double xy[2]);
/* The wavelengths of the locus' ends. */
void abbe_chromaticity_locus_ends(abbe_observer observer, double *min_nm, double *max_nm);

typedef struct abbe_dominant {
  double lambda_nm;        /* where the line from the white through the colour meets the locus; NaN
                              where it meets the purple line */
  double complementary_nm; /* where the line in the other direction does; NaN likewise */
  double purity; /* excitation purity: from the white to the colour, over the distance to the locus
                    or the purple line; above 1 outside them */
} abbe_dominant;

/* Dominant wavelength and purity of the colour xy with respect to the white [CIE15]. False where
 * the two are one (within 1e-7), where the white is not inside the locus, and where something is
 * not finite; *out is then all NaN, with a purity of 0 where they are one. */
bool abbe_chromaticity_dominant(const double xy[2], const double white[2], abbe_observer observer,
                                abbe_dominant *out);

#endif
