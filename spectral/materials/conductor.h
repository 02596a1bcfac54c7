/* conductor.h: the complex index of a metal, n + i k, from measured points.
 *
 * It makes the dispersion of a conductor and separates metals from glasses among imported points.
 * What a conductor does to light is in spectral/optics.h, its record in material.h.
 * Internal to spectral/. */
#ifndef ABBE_SPECTRAL_MATERIALS_CONDUCTOR_H
#define ABBE_SPECTRAL_MATERIALS_CONDUCTOR_H

#include "base/error.h"
#include "spectral/dispersion/points.h"
#include "spectral/materials/material.h"

#include <stdbool.h>
#include <stddef.h>

/* The dispersion of a conductor through count points: wavelengths, nm, ascending, n and k in
 * [0, 1e3], both straight between the points. The arrays are copied; *out is freed with
 * abbe_dispersion_free. ABBE_INVALID_ARGUMENT as abbe_spectrum_make and abbe_dispersion_check have
 * it. */
abbe_result abbe_conductor_make(const double *lambda_nm, const double *n, const double *k,
                                size_t count, abbe_dispersion *out, abbe_error *error);

/* Makes a conductor of a tabulated material that was read of the points n and k, where those stand
 * at the same wavelengths and it absorbs within a wavelength in most of what it has of 380 to 780
 * nm (abbe_material_is_opaque), so that no scene could refract by it. Its attenuation, and n_d and
 * V_d that its source prints, go. *made is true where it did. */
abbe_result abbe_conductor_of_metal(const abbe_points *n, const abbe_points *k,
                                    abbe_material *material, bool *made, abbe_error *error);

#endif
