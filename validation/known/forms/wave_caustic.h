/* wave_caustic.h: what light that falls straight onto a sinusoidal surface makes on a level plane
 * in the water, by Snell's and Fresnel's laws.
 *
 * The surface is z = amplitude cos(2 pi x / wavelength), light comes down along -z, and the plane
 * lies at z = -depth. A ray is one number, where it enters, so irradiance is a sum over branches of
 * T / |dX/dx|. Double precision; it knows nothing of scenes, the tracer or the renderer.
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_KNOWN_FORMS_WAVE_CAUSTIC_H
#define ABBE_VALIDATION_KNOWN_FORMS_WAVE_CAUSTIC_H

#include <stddef.h>

typedef struct abbe_wave_caustic {
  double amplitude, wavelength, depth; /* m */
  double index;                        /* index of the water */
  double attenuation_per_m;            /* natural, along the slanting path */
} abbe_wave_caustic;

/* Where light that enters at x meets the bottom, m, and in *passed (may be NULL) which share of it
 * does. */
double abbe_wave_caustic_landing(const abbe_wave_caustic *w, double x, double *passed);

/* Depth below the crest at which the rays beside it meet: n / ((n - 1) a k^2). */
double abbe_wave_caustic_focus(const abbe_wave_caustic *w);

/* Mean irradiance from x = from to x = to on the plane, of 1 W/m2 above, by `rays` even steps of
 * where light enters. */
double abbe_wave_caustic_mean(const abbe_wave_caustic *w, double from, double to, size_t rays);

/* By how many rays the place x is lit, counted over `rays` even steps. */
size_t abbe_wave_caustic_branches(const abbe_wave_caustic *w, double x, size_t rays);

#endif
