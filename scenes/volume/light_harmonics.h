/* light_harmonics.h: functions of the direction to a light as sums of spherical harmonics, and
 * their coefficients from values at light nodes by least squares.
 */
#ifndef ABBE_SCENES_VOLUME_LIGHT_HARMONICS_H
#define ABBE_SCENES_VOLUME_LIGHT_HARMONICS_H

#include "scenes/volume/light_nodes.h"

#define ABBE_LIGHT_HARMONICS_MOST 12 /* degree */
#define ABBE_LIGHT_HARMONICS_MOST_COUNT 169

/* Of all degrees up to that one: (degree + 1)^2. */
static inline size_t abbe_light_harmonics_count(size_t degree) {
  return (degree + 1) * (degree + 1);
}

/* The real harmonics of a unit direction, each of unit square over the sphere: value[l (l + 1) +
 * m], m from -l to l. degree: at most ABBE_LIGHT_HARMONICS_MOST. */
void abbe_light_harmonics_at(size_t degree, const double direction[3], double *value);

/* fit[count][nodes->count]: a coefficient is the sum of its row times the values at the nodes. The
 * nodes' spacing is not quite even, so that equal weights would not give a harmonic back; least
 * squares do. ABBE_INVALID_ARGUMENT for more coefficients than nodes, ABBE_NO_MEMORY. */
abbe_result abbe_light_harmonics_fit(const abbe_light_nodes *nodes, size_t degree, double *fit,
                                     abbe_error *error);

#endif
