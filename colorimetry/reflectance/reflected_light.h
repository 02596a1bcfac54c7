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

/* Reflectance of each channel at lambda_nm. measured is NULL for Rec.709; else its ends hold beyond
 * its table, and the other two channels are 0. */
void abbe_reflectance_channels(const abbe_spectrum *measured, double lambda_nm, double out[3]);

/* An illuminant over a range, in steps of a nanometre at the most. */
typedef struct abbe_reflected_light abbe_reflected_light;

/* ABBE_INVALID_ARGUMENT where the range is empty, ABBE_NO_MEMORY. The illuminant may be freed
 * before. */
abbe_result abbe_reflected_light_make(const abbe_illuminant *illuminant, double min_nm,
                                      double max_nm, abbe_reflected_light **out, abbe_error *error);
/* The same for any observer, whose XYZ all of it is. A Rec.709 colour stays the same reflectance. */
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

#endif
