/* reflectance.h: what receivers reflect, over wavelength: a measured spectrum, or linear Rec.709,
 * by a texture where they have one, as colorimetry/reflectance/reflected_light.h lifts it.
 *
 * A path of one wavelength is reflected by the reflectance there; light of all wavelengths by the
 * mean over them, with the colour of each: so both have the same mean, in every space.
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRANSPORT_REFLECTANCE_H
#define ABBE_VALIDATION_TRACE_TRANSPORT_REFLECTANCE_H

#include "colorimetry/rgb_space.h"
#include "validation/trace/transport/bands.h"
#include "validation/trace/transport/environment_light.h"
#include "validation/trace/transport/geometry.h"
#include "validation/trace/transport/spectral_sampling.h"

#include <stdint.h>

/* Tables of every set of three channels: the first set is Rec.709's, each further one a measured
 * spectrum's, whose first channel alone is not 0. */
typedef struct abbe_reflectance {
  const abbe_geometry *geometry;
  size_t sets, steps, lights, bands;
  uint32_t *set;        /* [objects] */
  float (*step)[3];     /* [sets][steps] by channel */
  float (*white)[3][3]; /* [sets][lights] by channel: the light, in the picture's space */
  float (*band)[3];     /* [sets][lights][bands] by channel: mean over the band */
  float (
      *lifted)[3][3][3]; /* [sets] by channel, by the environment's RGB: in the picture's space */
  float whiten[9]; /* row-major: what makes white of the first light, a factor each of X, Y, Z */
} abbe_reflectance;

/* A reflectance at a place: how much of each channel. */
typedef struct abbe_reflected {
  float share[3];
  uint32_t set;
} abbe_reflected;

/* `environment` may be zeroed; `space` is the picture's. ABBE_NO_MEMORY. */
abbe_result abbe_reflectance_make(const abbe_geometry *geometry,
                                  const abbe_spectral_sampling *sampling, const abbe_bands *bands,
                                  const abbe_environment_light *environment, abbe_rgb_space space,
                                  abbe_reflectance *out, abbe_error *error);
void abbe_reflectance_free(abbe_reflectance *reflectance);

/* Finds the reflectance of a receiver at a place on a face. */
void abbe_reflectance_find(const abbe_reflectance *r, uint32_t surface, uint32_t face, float u,
                           float v, abbe_reflected *out);
/* At a step of the sampling. */
float abbe_reflectance_at_step(const abbe_reflectance *r, const abbe_reflected *of, uint32_t step);
/* Mean over a band, of that light. */
float abbe_reflectance_in_band(const abbe_reflectance *r, const abbe_reflected *of, size_t light,
                               size_t band);
/* Colour of the light of power 1 that is reflected. */
void abbe_reflectance_of_white(const abbe_reflectance *r, const abbe_reflected *of, size_t light,
                               float out[3]);
/* The same of the environment's RGB. */
void abbe_reflectance_of_lifted(const abbe_reflectance *r, const abbe_reflected *of,
                                const float rgb[3], float out[3]);
/* The first light's colour becomes white. */
void abbe_reflectance_whiten(const abbe_reflectance *r, const float colour[3], float out[3]);

#endif
