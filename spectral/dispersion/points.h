/* points.h: measured or tabulated points over wavelength while they are being read.
 *
 * A list that grows, is put in order, and becomes a spectrum. Its numbers carry no unit of their
 * own. It does not read files. Internal to spectral/.
 */
#ifndef ABBE_SPECTRAL_DISPERSION_POINTS_H
#define ABBE_SPECTRAL_DISPERSION_POINTS_H

#include "base/error.h"
#include "spectral/spectrum.h"

#include <stddef.h>

typedef struct abbe_point {
  double lambda_nm, value;
  double error; /* standard uncertainty of value, in its unit; 0 where it is not known */
} abbe_point;

/* Zero-initialise. */
typedef struct abbe_points {
  size_t count, capacity;
  abbe_point *point;
} abbe_points;

void abbe_points_free(abbe_points *points);

/* Adds a point at the end. ABBE_INVALID_ARGUMENT past ABBE_SPECTRUM_MAX_COUNT points. */
abbe_result abbe_points_add(abbe_points *points, abbe_point point, abbe_error *error);

/* Puts the points in the order of their wavelengths; of several at one wavelength the one that came
 * first stays, and *dropped counts the others; with dropped NULL all stay, in the order in which
 * they came. Wavelengths must be numbers. ABBE_NO_MEMORY. */
abbe_result abbe_points_sort(abbe_points *points, size_t *dropped, abbe_error *error);

/* The values as a spectrum; the points must be in order. ABBE_INVALID_ARGUMENT as
 * abbe_spectrum_make has it. */
abbe_result abbe_points_spectrum(const abbe_points *points, abbe_interpolation interpolation,
                                 abbe_spectrum **out, abbe_error *error);

#endif
