/* colour_temperature.h: Planckian radiators and daylight, and how near to them a colour is.
 *
 * Correlated colour temperature is that of the Planckian radiator whose colour is nearest in the
 * CIE 1960 diagram (u = u', v = 2/3 v') of the 1931 observer [CIE15]; it is found by search on the
 * locus itself, not by a table or a formula fitted to it. The distance Duv has the sign that
 * [Ohno2014] gives it: above the locus, towards green, it is positive.
 */
#ifndef ABBE_COLORIMETRY_COLOUR_TEMPERATURE_H
#define ABBE_COLORIMETRY_COLOUR_TEMPERATURE_H

#include <stdbool.h>

#define ABBE_COLOUR_TEMPERATURE_MIN 1000.0 /* K */
#define ABBE_COLOUR_TEMPERATURE_MAX 1e6
/* Beyond this distance from the locus a correlated colour temperature has no meaning [CIE15]. */
#define ABBE_COLOUR_TEMPERATURE_MAX_DUV 0.05

/* Spectral radiance of a Planckian radiator at lambda_nm, relative: 100 at 560 nm; c2 is 1.4388e7
 * nm K. 0 where lambda_nm or kelvin is not above 0. */
double abbe_colour_temperature_planck(double kelvin, double lambda_nm);
/* x, y of it, for the 1931 observer. */
void abbe_colour_temperature_planck_xy(double kelvin, double xy[2]);
/* x, y of daylight of that correlated colour temperature, 4000 to 25000 K [CIE15]; false (xy
 * untouched) outside. D65 is 6504 K, not 6500: c2 has changed since. */
bool abbe_colour_temperature_daylight_xy(double kelvin, double xy[2]);

/* x, y of a white that text names: a chromaticity "0.3127,0.3290", or a temperature in K "5000":
 * daylight from 4000 K on, a Planckian radiator below, from ABBE_COLOUR_TEMPERATURE_MIN to
 * ABBE_COLOUR_TEMPERATURE_MAX_DAYLIGHT. False (xy untouched) for anything else. */
#define ABBE_COLOUR_TEMPERATURE_MAX_DAYLIGHT 25000.0
bool abbe_colour_temperature_read_white(const char *text, double xy[2]);

/* Correlated colour temperature (K) and Duv of a colour. False, and both NaN, where nothing from
 * ABBE_COLOUR_TEMPERATURE_MIN to _MAX is nearest, and where the nearest is further than
 * ABBE_COLOUR_TEMPERATURE_MAX_DUV. */
bool abbe_colour_temperature_find(const double xy[2], double *kelvin, double *duv);

#endif
