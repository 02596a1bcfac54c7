/* catacaustic.h: what a vertical mirror cylinder throws onto the floor that it stands on.
 *
 * In plan a ray's course does not depend on how steeply it falls, so the floor shows the planar
 * caustic of a circle by reflection: of parallel light a nephroid, of a light on the wall a
 * cardioid. Double precision, whole rays, any number of reflections; the wall reflects all.
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_KNOWN_FORMS_CATACAUSTIC_H
#define ABBE_VALIDATION_KNOWN_FORMS_CATACAUSTIC_H

#include <stddef.h>

/* The cylinder's axis is z, its foot stands in z = 0. */
typedef struct abbe_catacaustic {
  double radius, height; /* m */
  double elevation; /* rad above the horizon, of a sun whose light travels along +x; 0: a light */
  double lamp[3];   /* m, inside in plan, above the floor */
} abbe_catacaustic;

/* Irradiance at the place p of the floor, inside the cylinder, by light that was reflected
 * `bounces` >= 1 times: for a sun of 1 W/m2 across the beam or a light of 1 W/sr. It is infinite at
 * folds. *branches (may be NULL): by how many rays. */
double abbe_catacaustic_irradiance(const abbe_catacaustic *c, const double p[2], size_t bounces,
                                   size_t *branches);

/* Its mean over the square of side 2 half around p, by steps x steps places, for 1 to `bounces`
 * reflections together, each of which leaves the share `reflectance`. *branches: at p. */
double abbe_catacaustic_mean(const abbe_catacaustic *c, const double p[2], double half,
                             size_t steps, double reflectance, size_t bounces, size_t *branches);

#endif
