/* spectrum.h: a tabulated function of wavelength with a stated interpolation.
 *
 * Used for tabulated indices, attenuation, illuminants and reflectances. It carries no unit of
 * its own. Values outside the table are the caller's decision: see abbe_spectrum_at.
 */
#ifndef ABBE_SPECTRAL_SPECTRUM_H
#define ABBE_SPECTRAL_SPECTRUM_H

#include "base/error.h"

#include <stddef.h>

typedef enum abbe_interpolation {
  ABBE_INTERPOLATION_LINEAR,
  ABBE_INTERPOLATION_MONOTONE, /* Steffen's method: no overshoot [Steffen1990] */
  ABBE_INTERPOLATION_SPLINE    /* natural cubic */
} abbe_interpolation;

/* As files have it: "linear", "monotone", "spline"; "unknown" for any other. */
const char *abbe_interpolation_name(abbe_interpolation interpolation);

#define ABBE_SPECTRUM_MAX_COUNT 65536

/* The wavelengths, nm, that records and files of points may speak of: wide enough for any optical
 * data, and narrow enough that no formula overflows. */
#define ABBE_SPECTRUM_LOW_NM 1.0
#define ABBE_SPECTRUM_HIGH_NM 1e6

typedef struct abbe_spectrum abbe_spectrum;

/* A spectrum through count points. ABBE_INVALID_ARGUMENT unless the wavelengths are finite,
 * positive and strictly ascending, the values finite, and the count at least 1 (a single point is
 * a constant), at most ABBE_SPECTRUM_MAX_COUNT; two points are interpolated linearly whatever was
 * asked, as the other two methods need three. The arrays are copied. */
abbe_result abbe_spectrum_make(const double *lambda_nm, const double *value, size_t count,
                               abbe_interpolation interpolation, abbe_spectrum **out,
                               abbe_error *error);
void abbe_spectrum_free(abbe_spectrum *spectrum);

/* The value at lambda_nm; outside the table, the value at its nearer end. Thread-safe. */
double abbe_spectrum_at(const abbe_spectrum *spectrum, double lambda_nm);

/* The integral over [from_nm, to_nm] of the interpolated function (ends held outside the table),
 * in the value's unit times nm; exact for the chosen interpolation. Requires from_nm <= to_nm. */
double abbe_spectrum_integral(const abbe_spectrum *spectrum, double from_nm, double to_nm);

size_t abbe_spectrum_count(const abbe_spectrum *spectrum);
const double *abbe_spectrum_lambda_nm(const abbe_spectrum *spectrum);
const double *abbe_spectrum_value(const abbe_spectrum *spectrum);
/* The interpolation that was asked for. */
abbe_interpolation abbe_spectrum_interpolation(const abbe_spectrum *spectrum);

#endif
