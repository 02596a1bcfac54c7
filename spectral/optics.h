/* optics.h: Snell, Fresnel and Beer-Lambert for smooth interfaces, in double precision.
 *
 * This is the one piece of physics that the GL renderer's tests and the reference tracer share;
 * it has tests of its own against published numbers. Directions are unit vectors: wi points
 * towards where the light comes from, wt and wo leave the surface, n is the unit normal on wi's
 * side (dot(wi, n) >= 0). A ratio of indices is eta = n_i / n_t. Unpolarised light; no
 * coatings, no polarisation state. Interfaces are between dielectrics but for fresnel_conductor.
 */
#ifndef ABBE_SPECTRAL_OPTICS_H
#define ABBE_SPECTRAL_OPTICS_H

#include <stdbool.h>

/* Cosine of the angle of refraction for cos_i in [0, 1] and eta = n_i / n_t > 0. Returns 0 and
 * sets *total to true at and beyond the critical angle (total may be NULL). [BornWolf1999] */
double abbe_optics_cos_refracted(double cos_i, double eta, bool *total);

/* Unpolarised Fresnel reflectance in [0, 1]; 1 at total internal reflection and at grazing
 * incidence, exactly 0 for eta = 1. Its complement is the transmitted share. [BornWolf1999] */
double abbe_optics_fresnel(double cos_i, double eta);

/* Unpolarised Fresnel reflectance in [0, 1] of a conductor of complex index n + i k in air
 * (n_i = 1); n and k in [0, 1e70]. 1 at grazing incidence and where n = k = 0; exactly 0 for n = 1,
 * k = 0; for k = 0 that of fresnel with eta = 1 / n. What is not reflected is absorbed.
 * [BornWolf1999] */
double abbe_optics_fresnel_conductor(double cos_i, double n, double k);

/* Refracts: writes the unit direction wt and returns true; returns false (wt untouched) at total
 * internal reflection. */
bool abbe_optics_refract(const double wi[3], const double n[3], double eta, double wt[3]);

/* Mirror direction, unit, pointing away from the surface on wi's side. */
void abbe_optics_reflect(const double wi[3], const double n[3], double wo[3]);

/* Share of light left after distance_m metres at attenuation_per_m (natural, 1/m): exp(-a d).
 * 1 for a = 0 or d = 0; 0 for infinite a with d > 0. Both arguments >= 0. */
double abbe_optics_transmittance(double attenuation_per_m, double distance_m);

#endif
