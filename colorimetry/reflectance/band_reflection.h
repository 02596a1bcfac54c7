/* band_reflection.h: what a surface reflects of light that a prism has spread, of which XYZ alone
 * is known.
 *
 * A prism sends a band of the light's own spectrum to each place: the wavelengths between two ends,
 * or all but those. For every chromaticity there is one such band, from the light's white (all of
 * it) to the spectral locus (one wavelength) and the line of purples. The share of X, Y and Z that
 * a surface reflects of that band is tabulated by where the chromaticity lies as seen from the
 * white: in which direction, and at which share of the distance to the locus. Near the white, where
 * tints of glass lie and bands are nearly all of the spectrum, the mixture of three functions takes
 * its place (reflected_light.h), and the change is gradual. White light and what greys reflect are
 * exact. */
#ifndef ABBE_COLORIMETRY_REFLECTANCE_BAND_REFLECTION_H
#define ABBE_COLORIMETRY_REFLECTANCE_BAND_REFLECTION_H

#include "colorimetry/reflectance/reflected_light.h"

/* Directions by |x| + |y| = 1 from the white, counter-clockwise from +x: a fourth of them a
 * quadrant. Rings from the white, 0, to the locus, ABBE_BAND_REFLECTION_RINGS. */
#define ABBE_BAND_REFLECTION_TURNS 128
#define ABBE_BAND_REFLECTION_RINGS 12
#define ABBE_BAND_REFLECTION_CELLS (ABBE_BAND_REFLECTION_TURNS * (ABBE_BAND_REFLECTION_RINGS + 1))

/* Fills cell[ABBE_BAND_REFLECTION_CELLS], ring by ring of each direction: factors of X, Y and Z,
 * and how far the locus lies in that direction in x, y. The reflectance is `measured`, or where
 * that is NULL of Rec.709 rgb (reflected_light.h). Linear in the reflectance. ABBE_NO_MEMORY. */
abbe_result abbe_band_reflection_fill(const abbe_reflected_light *light,
                                      const abbe_spectrum *measured, const double rgb[3],
                                      float (*cell)[4], abbe_error *error);

/* XYZ reflected of light of that XYZ, between the table's cells; `white` is the light's own XYZ. */
void abbe_band_reflection_apply(const float (*cell)[4], const double white[3], const double xyz[3],
                                double out[3]);

#endif
