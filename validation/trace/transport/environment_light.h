/* environment_light.h: the environment as a light of the tracer: its spectra, and photons from it.
 *
 * A radiance is linear Rec.709 RGB relative to the environment's illuminant
 * (scenes/environment/environment.h). Its spectrum is the illuminant's times lift . rgb
 * (colorimetry/upsampling.h). Among the tables of the scene's lights the illuminant stands last.
 *
 * Photons start from everywhere around the balls that hold the refractors and mirrors: a direction
 * is drawn by its luminance, and a place on the disk of one of the balls across it.
 *
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRANSPORT_ENVIRONMENT_LIGHT_H
#define ABBE_VALIDATION_TRACE_TRANSPORT_ENVIRONMENT_LIGHT_H

#include "validation/trace/transport/bands.h"
#include "validation/trace/transport/geometry.h"
#include "validation/trace/transport/spectral_sampling.h"

#include <stdbool.h>

/* Zeroed: there is none. */
typedef struct abbe_environment_light {
  const abbe_environment *environment;
  size_t light;       /* its number among the lights of the spectral tables */
  float (*lift)[3];   /* [steps] by RGB: the spectrum at a step over the illuminant's own */
  float (*band)[3];   /* [bands] the same, mean over a band */
  float to_colour[9]; /* from RGB to the picture's space, white Y = 1; row-major */
  size_t ball_count;
  float (*ball)[4]; /* [ball_count] centre and radius, frame */
  double area;      /* area of all disks together, m2 */
  float far;        /* radius of the ball around the frame's origin that holds the scene, frame */
} abbe_environment_light;

/* For the scene's environment, if it has one; `space` is the picture's. ABBE_NO_MEMORY, and errors
 * of abbe_upsampling_make_by. */
abbe_result abbe_environment_light_make(const abbe_geometry *geometry,
                                        const abbe_spectral_sampling *sampling,
                                        const abbe_bands *bands, abbe_rgb_space space,
                                        abbe_environment_light *out, abbe_error *error);
void abbe_environment_light_free(abbe_environment_light *light);

/* Radiance that arrives along the ray's unit direction, W/(m2 sr), RGB. */
void abbe_environment_light_seen(const abbe_environment_light *light, const float d[3],
                                 float rgb[3]);

/* Density of abbe_environment_sample at the ray's unit direction, 1/sr. */
float abbe_environment_light_pdf(const abbe_environment_light *light, const float d[3]);

/* A direction to the environment, of u in [0, 1)^3 (the first of all bits of a double), its
 * density, 1/sr, and the radiance from there. */
void abbe_environment_light_sample(const abbe_environment_light *light, const double u[3],
                                   float d[3], float *pdf, float rgb[3]);

/* A photon's ray of u in [0, 1)^6 (the first and the fourth of all bits of a double): it starts
 * beyond everything, along unit d. rgb: the flux in W if it were the only one. */
void abbe_environment_light_ray(const abbe_environment_light *light, const double u[6], float o[3],
                                float d[3], float rgb[3]);

#endif
