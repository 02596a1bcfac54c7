/* reflected_light.h: the colour of light that a surface reflects: of a measured reflectance, or of
 * one that is known as linear Rec.709 alone.
 *
 * A Rec.709 colour r, g, b is the reflectance r B_r + g B_g + b B_b with the three functions of
 * upsampling.h: from 0 to 1 where r, g, b are, and under D65 over 380 to 780 nm of that colour. A
 * reflectance so has three channels, one a function; a measured one has its first alone.
 *
 * Of light whose spectrum is an illuminant's, what is reflected is an integral. Of other light, of
 * which XYZ alone is kept, the spectrum is taken to be the illuminant's times c_r B_r + c_g B_g +
 * c_b B_b of that XYZ: then what is reflected is a matrix times XYZ, whatever the space of a
 * picture.
 */
#ifndef ABBE_COLORIMETRY_REFLECTANCE_REFLECTED_LIGHT_H
#define ABBE_COLORIMETRY_REFLECTANCE_REFLECTED_LIGHT_H

#include "base/error.h"
#include "colorimetry/illuminant.h"
#include "colorimetry/observer.h"
#include "spectral/spectrum.h"

#include <stddef.h>

/* Reflectance of each channel at lambda_nm. measured is NULL for Rec.709; else its ends hold beyond
 * its table, and the other two channels are 0. */
void abbe_reflectance_channels(const abbe_spectrum *measured, double lambda_nm, double out[3]);

/* An illuminant over a range, in steps of a nanometre at the most. */
typedef struct abbe_reflected_light abbe_reflected_light;

/* ABBE_INVALID_ARGUMENT where the range is empty, ABBE_NO_MEMORY. The illuminant may be freed
 * before. */
abbe_result abbe_reflected_light_make(const abbe_illuminant *illuminant, double min_nm,
                                      double max_nm, abbe_reflected_light **out, abbe_error *error);
/* The same for any observer, whose XYZ all of it is. A Rec.709 colour stays the same reflectance.
 */
abbe_result abbe_reflected_light_make_by(abbe_observer observer, const abbe_illuminant *illuminant,
                                         double min_nm, double max_nm, abbe_reflected_light **out,
                                         abbe_error *error);
void abbe_reflected_light_free(abbe_reflected_light *light);

/* XYZ of the illuminant itself, Y = 1 (0 where the eye sees none of it). */
void abbe_reflected_light_white(const abbe_reflected_light *light, double xyz[3]);

/* Its steps, and of each the middle and the XYZ of its light, whose sum is the white. */
size_t abbe_reflected_light_steps(const abbe_reflected_light *light);
void abbe_reflected_light_step(const abbe_reflected_light *light, size_t step, double *lambda_nm,
                               double xyz[3]);

/* XYZ that each channel reflects of the illuminant, whose own Y over the range is 1. */
void abbe_reflected_light_xyz(const abbe_reflected_light *light, const abbe_spectrum *measured,
                              double xyz[3][3]);

/* For each channel the row-major matrix from the XYZ of light to that of what is reflected: of the
 * illuminant's white it makes abbe_reflected_light_xyz. Where the illuminant has too few colours to
 * be lifted, as a line has, it scales X, Y and Z. */
void abbe_reflected_light_matrices(const abbe_reflected_light *light, const abbe_spectrum *measured,
                                   double matrix[3][9]);

/* The 24 patches of the ColorChecker chart: their reflectances over wavelength.
 *
 * As N. Ohta measured one chart, 380 to 780 nm in steps of 5 nm [Ohta1997]; ISO 17321-1 prints the
 * same. Charts differ from each other by a few units of the third decimal in x and y. */

#define ABBE_COLOUR_CHECKER_COUNT 24

/* "dark skin" … "cyan", "white", "neutral 8", "neutral 6.5", "neutral 5", "neutral 3.5", "black",
 * row by row; NULL from ABBE_COLOUR_CHECKER_COUNT on. */
const char *abbe_colour_checker_name(size_t patch);

/* The patch of that name (any case), its reflectance 0 to 1, linear between the points; freed with
 * abbe_spectrum_free. ABBE_NOT_FOUND names the nearest; ABBE_NO_MEMORY. */
abbe_result abbe_colour_checker_make(const char *name, abbe_spectrum **out, abbe_error *error);

/* What a surface reflects of light that a prism has spread, of which XYZ alone is known.
 *
 * A prism sends a band of the light's own spectrum to each place: the wavelengths between two
 * ends, or all but those. For every chromaticity there is one such band, from the light's white
 * (all of it) to the spectral locus (one wavelength) and the line of purples. The share of X, Y
 * and Z that a surface reflects of that band is tabulated by where the chromaticity lies as seen
 * from the white: in which direction, and at which share of the distance to the locus. Near the
 * white, where tints of glass lie and bands are nearly all of the spectrum, the mixture of three
 * functions takes its place (reflected_light.h), and the change is gradual. White light and what
 * greys reflect are exact. */

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
