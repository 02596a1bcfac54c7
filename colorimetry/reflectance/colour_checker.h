/* colour_checker.h: the 24 patches of the ColorChecker chart: their reflectances over wavelength.
 *
 * As N. Ohta measured one chart, 380 to 780 nm in steps of 5 nm [Ohta1997]; ISO 17321-1 prints the
 * same. Charts differ from each other by a few units of the third decimal in x and y.
 */
#ifndef ABBE_COLORIMETRY_REFLECTANCE_COLOUR_CHECKER_H
#define ABBE_COLORIMETRY_REFLECTANCE_COLOUR_CHECKER_H

#include "base/error.h"
#include "spectral/spectrum.h"

#include <stddef.h>

#define ABBE_COLOUR_CHECKER_COUNT 24

/* "dark skin" … "cyan", "white", "neutral 8", "neutral 6.5", "neutral 5", "neutral 3.5", "black",
 * row by row; NULL from ABBE_COLOUR_CHECKER_COUNT on. */
const char *abbe_colour_checker_name(size_t patch);

/* The patch of that name (any case), its reflectance 0 to 1, linear between the points; freed with
 * abbe_spectrum_free. ABBE_NOT_FOUND names the nearest; ABBE_NO_MEMORY. */
abbe_result abbe_colour_checker_make(const char *name, abbe_spectrum **out, abbe_error *error);

#endif
