/* spectral_sampling.h: the continuous spectrum of the tracer's paths.
 *
 * A path has one wavelength, drawn from a density that follows what the camera sees of the lights,
 * mixed with a uniform one so that no part of the range starves. The density is constant over each
 * of `steps` intervals of equal probability; a path carries the mean colour of its interval, so
 * the mean over all paths is the light's white exactly. What fluorescent materials emit has its
 * part of the density, and each light a second row: of what glows in its light. Where bands are
 * requested, every edge of a band is an edge of steps: each band has a whole number of them.
 * Internal to validation/.
 */
#ifndef ABBE_VALIDATION_TRACE_TRANSPORT_SPECTRAL_SAMPLING_H
#define ABBE_VALIDATION_TRACE_TRANSPORT_SPECTRAL_SAMPLING_H

#include "base/error.h"
#include "colorimetry/observer.h"
#include "colorimetry/rgb_space.h"
#include "scenes/scene.h"

#include <stddef.h>
#include <stdint.h>

#define ABBE_SPECTRAL_SAMPLING_STEPS 4096u

typedef struct abbe_spectral_sampling {
  abbe_observer observer; /* whose XYZ it is */
  size_t steps;           /* ABBE_SPECTRAL_SAMPLING_STEPS */
  double *lambda_nm;  /* [steps + 1], ascending: the ends of the steps; the first and last are the
                         range */
  size_t lights;      /* the scene's, and its environment last, if it has one */
  size_t rows;        /* lights, or where something is fluorescent twice as many: row lights + l
                         is of what glows in light l, its power 1 and its XYZ those of a watt of
                         that wavelength, of which the light's own watt has Y = 1 */
  double (*white)[3]; /* [lights] XYZ of a light of power 1: Y = 1 */
  float (*xyz)[3];    /* [rows][steps] XYZ that a path of power 1 carries; mean over steps: white */
  float *power;       /* [rows][steps] power that a path carries, per watt of the light; mean 1 */
} abbe_spectral_sampling;

typedef struct abbe_spectral_sampling_desc {
  abbe_observer observer;
  double min_nm, max_nm;
  double uniform; /* part of the density, 0.01 to 1 */
  size_t bands;   /* bands of equal width over the range, up to a sixteenth of the steps; 0: none */
} abbe_spectral_sampling_desc;

/* For the scene's lights. ABBE_INVALID_ARGUMENT where a light is dark there, or invisible. */
abbe_result abbe_spectral_sampling_make(const abbe_scene *scene,
                                        const abbe_spectral_sampling_desc *desc,
                                        abbe_spectral_sampling *out, abbe_error *error);
void abbe_spectral_sampling_free(abbe_spectral_sampling *s);

/* The colours in an RGB space: rgb[rows][steps][3]. */
void abbe_spectral_sampling_colours(const abbe_spectral_sampling *s, abbe_rgb_space space,
                                    float (*rgb)[3]);

/* The largest Y that a watt has, at least 1 (in UV light what glows is by far brighter). */
double abbe_spectral_sampling_brightest(const abbe_spectral_sampling *s);

/* The step of 32 uniform bits, a fraction of 2^32, and the place within it in [0, 1). */
static inline uint32_t abbe_spectral_sampling_step(uint32_t bits, float *within) {
  const uint32_t size = (uint32_t)(0x1p32 / ABBE_SPECTRAL_SAMPLING_STEPS);
  *within = (float)(bits % size) * (float)(1.0 / size);
  return bits / size;
}

/* The wavelength at a place within a step, nm. */
static inline double abbe_spectral_sampling_lambda(const abbe_spectral_sampling *s, uint32_t step,
                                                   float within) {
  return s->lambda_nm[step] + (double)within * (s->lambda_nm[step + 1] - s->lambda_nm[step]);
}

#endif
