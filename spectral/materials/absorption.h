/* absorption.h: what absorbs light inside a material, from what people have: internal
 * transmittance, extinction coefficient k, or a colour at a distance; and back.
 *
 * All become the natural attenuation coefficient a, in 1/m: the share exp(-a d) of the light is
 * left after d metres. Reflection at surfaces is not absorption and is not in it.
 */
#ifndef ABBE_SPECTRAL_MATERIALS_ABSORPTION_H
#define ABBE_SPECTRAL_MATERIALS_ABSORPTION_H

#include "base/error.h"
#include "spectral/dispersion/points.h"
#include "spectral/materials/material.h"
#include "spectral/spectrum.h"

#include <stdbool.h>
#include <stddef.h>

/* A table prints a transmittance of 0 where it is too small to measure: it is taken as this. */
#define ABBE_ABSORPTION_LEAST_TRANSMITTANCE 1e-6

/* -ln(T) / d for an internal transmittance T in [0, 1] of thickness_m > 0 metres; T below
 * ABBE_ABSORPTION_LEAST_TRANSMITTANCE is raised to it, and T above 1 has none (0). */
double abbe_absorption_from_transmittance(double transmittance, double thickness_m);
/* exp(-a d), in [0, 1]. */
double abbe_absorption_transmittance(double attenuation_per_m, double thickness_m);
/* 4 pi k / lambda [BornWolf1999]. */
double abbe_absorption_from_k(double k, double lambda_nm);
double abbe_absorption_k(double attenuation_per_m, double lambda_nm);

/* Attenuation spectra, linear between the points; their range is that of the points, which must be
 * in order. ABBE_INVALID_ARGUMENT, with what would be right, for a transmittance outside [0, 1], a
 * thickness that is not positive, a negative k, or no points at all. */
abbe_result abbe_absorption_spectrum_of_transmittance(const abbe_points *transmittance,
                                                      double thickness_m, abbe_spectrum **out,
                                                      abbe_error *error);
abbe_result abbe_absorption_spectrum_of_k(const abbe_points *k, abbe_spectrum **out,
                                          abbe_error *error);

/* The simplest spectrum that goes with a colour: linear Rec.709 shares of red, green and blue,
 * each in [1e-6, 1], that are left after distance_m metres. -ln(share) / distance holds at the
 * dominant wavelengths of the primaries (611.4, 549.1, 464.2 nm) and runs straight between them. */
abbe_result abbe_absorption_spectrum_of_colour(const double colour[3], double distance_m,
                                               abbe_spectrum **out, abbe_error *error);
/* The three shares that are left after distance_m metres at those wavelengths: its inverse. */
void abbe_absorption_colour(const abbe_spectrum *attenuation, double distance_m, double colour[3]);

/* The complex index of a metal, n + i k, from measured points.
 *
 * It makes the dispersion of a conductor and separates metals from glasses among imported points.
 * What a conductor does to light is in spectral/optics.h, its record in material.h. */

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
