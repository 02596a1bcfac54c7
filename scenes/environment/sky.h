/* sky.h: the CIE's standard skies: how bright the sky is in each direction, relative to its zenith
 * [CIES011].
 *
 * Types 1 to 15 are the standard general sky: a gradation from zenith to horizon times a scattering
 * about the sun. 16 is the traditional overcast sky, (1 + 2 sin elevation) / 3. The standard speaks
 * of luminance; here the same holds for radiance, of one spectrum everywhere. The sun itself is not
 * in it.
 */
#ifndef ABBE_SCENES_ENVIRONMENT_SKY_H
#define ABBE_SCENES_ENVIRONMENT_SKY_H

#include <stdbool.h>

enum {
  ABBE_SKY_OVERCAST_STEEP = 1, /* "CIE standard overcast sky, steep luminance gradation" */
  ABBE_SKY_CLEAR = 12,         /* "CIE standard clear sky, low luminance turbidity" */
  ABBE_SKY_CLEAR_POLLUTED = 13,
  ABBE_SKY_OVERCAST = 16,
  ABBE_SKY_TYPES = 16
};

typedef struct abbe_sky {
  int type;      /* 1 to ABBE_SKY_TYPES */
  double sun[3]; /* unit direction to the sun, z >= 0; for types that need it */
} abbe_sky;

/* Whether that type is brighter about the sun. */
bool abbe_sky_needs_sun(int type);

/* Radiance from a unit direction over the zenith's; 0 at the horizon and below. */
double abbe_sky_relative(const abbe_sky *sky, const double direction[3]);

/* Irradiance on an unshadowed horizontal plane over the zenith's radiance, sr: 7 pi / 9 of the
 * overcast sky. To 1e-5. */
double abbe_sky_horizontal(const abbe_sky *sky);

#endif
