/* air_light.h: light that comes straight from a light or the surroundings to the haze in the air
 * and is scattered there once, towards the origin of a ray.
 *
 * One place on the ray and one of the light at a time, unbiased. What a refractor or mirror sends
 * there is not among it: photons bring it (haze_grid.h).
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_MEDIUM_AIR_LIGHT_H
#define ABBE_VALIDATION_TRACE_MEDIUM_AIR_LIGHT_H

#include "validation/trace/transport/environment_light.h"
#include "validation/trace/transport/geometry.h"
#include "validation/trace/transport/haze.h"

#include <stdint.h>

/* The interval [from, to] of the ray from o along unit d that lies in the haze of the air, and the
 * wavelength: all in the frame. */
typedef struct abbe_air_ray {
  const abbe_geometry *geometry;
  const abbe_haze *haze;
  float o[3], d[3], from, to;
  uint32_t step;
  float within;
} abbe_air_ray;

/* Radiance at o of the light of that index, W/(m2 sr), of u in [0, 1)^3; adds the rays that it
 * requested. Along the ray places are chosen by equal angles about the light [KullaFajardo2012], of
 * a directional light by what is scattered. */
float abbe_air_light_lamp(const abbe_air_ray *ray, size_t light, const float u[3], uint32_t *rays);

/* The same of the environment, RGB relative to its illuminant, of u in [0, 1)^6: one direction by
 * its radiance and one by the phase function, weighted by the balance heuristic [VeachGuibas1995].
 */
void abbe_air_light_surroundings(const abbe_air_ray *ray, const abbe_environment_light *light,
                                 const double u[6], float rgb[3], uint32_t *rays);

/* Where [*from, *to] of the ray o + t d, d unit, is in the cone with its tip at `tip` about the
 * unit `axis`, half angle below a quarter turn; false where it is not. Cuts what *from and *to are.
 */
bool abbe_air_light_cone(const double tip[3], const double axis[3], double half_angle,
                         const double o[3], const double d[3], double *from, double *to);

#endif
