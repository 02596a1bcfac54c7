/* medium.h: what scatters and absorbs light along its path: mist, or what is afloat in water.
 *
 * Homogeneous: coefficients by wavelength and a phase function after Henyey and Greenstein,
 * alike everywhere in a region. How often light is scattered is for the tracer and the renderer. */
#ifndef ABBE_SCENES_MEDIUM_MEDIUM_H
#define ABBE_SCENES_MEDIUM_MEDIUM_H

#include "base/error.h"
#include "base/yaml/yaml.h"
#include "spectral/spectrum.h"

#include <stdbool.h>

typedef struct abbe_medium {
  abbe_spectrum *scattering; /* 1/m, natural; owned; NULL: none */
  abbe_spectrum *absorption; /* the same; in a refractor NULL, for its material has it */
  double g;                  /* mean cosine of the angle by which light is turned; 0: isotropic */
  double min[3], max[3];     /* the air's region, world, m; of a refractor's medium of no meaning */
} abbe_medium;

/* A medium that the caller owns; of NULL, NULL. ABBE_NO_MEMORY. */
abbe_result abbe_medium_copy(const abbe_medium *medium, abbe_medium **out, abbe_error *error);
void abbe_medium_free(abbe_medium *medium);

/* 1/m at lambda_nm; of NULL, 0. */
double abbe_medium_scattering(const abbe_medium *medium, double lambda_nm);
double abbe_medium_absorption(const abbe_medium *medium, double lambda_nm);

/* Whether coefficients vary over [low_nm, high_nm]. */
bool abbe_medium_is_coloured(const abbe_medium *medium, double low_nm, double high_nm);

/* Share of the scattered light a steradian, 1/sr, where its direction turns by the angle of that
 * cosine; over all directions 1. [HenyeyGreenstein1941] */
double abbe_medium_phase(double g, double cosine);

/* The `medium` of a scene file: of the air, and of what refracts. */

/* A coefficient, 1/m, may be this large. */
#define ABBE_MEDIUM_MOST_PER_M 1e6

/* The value under the key 'medium' of the scene (air: with absorption and a box) or of an object
 * that refracts; NULL without the key. ABBE_SCHEMA with file and line, ABBE_NO_MEMORY; *out is then
 * NULL. */
abbe_result abbe_medium_file_read(abbe_yaml *yaml, abbe_yaml_node mapping, bool air,
                                  abbe_medium **out, abbe_error *error);

#endif
