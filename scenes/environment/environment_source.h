/* environment_source.h: surroundings that are computed: what each kind of source adds to a map.
 *
 * Directions are the map's own. Where a source has edges or is small, texels are means by their
 * shares (radiance_map.h), and the source as a whole is scaled so that the map holds its exact
 * solid angle x radiance. A source that is smaller than a texel is as large as one there, and as
 * strong as it should be. Internal to scenes/.
 */
#ifndef ABBE_SCENES_ENVIRONMENT_ENVIRONMENT_SOURCE_H
#define ABBE_SCENES_ENVIRONMENT_ENVIRONMENT_SOURCE_H

#include "base/error.h"
#include "scenes/environment/radiance_map.h"

#include <stdbool.h>
#include <stddef.h>

/* The CIE's standard skies: how bright the sky is in each direction, relative to its zenith
 * [CIES011].
 *
 * Types 1 to 15 are the standard general sky: a gradation from zenith to horizon times a
 * scattering about the sun. 16 is the traditional overcast sky, (1 + 2 sin elevation) / 3. The
 * standard speaks of luminance; here the same holds for radiance, of one spectrum everywhere. The
 * sun itself is not in it. */

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

#define ABBE_SOURCE_LEAST_RAD 8.7e-4 /* radius, half width, standard deviation: 0.05 degrees */

typedef enum abbe_source_kind {
  ABBE_SOURCE_UNIFORM,
  ABBE_SOURCE_SKY,       /* above the horizon; radiance is the zenith's */
  ABBE_SOURCE_DOME,      /* by elevation alone */
  ABBE_SOURCE_DISK,      /* a cone of directions about the centre */
  ABBE_SOURCE_RECTANGLE, /* a flat rectangle, seen across its middle */
  ABBE_SOURCE_SPOT       /* a bell about the centre: exp(-angle^2 / (2 sigma^2)) */
} abbe_source_kind;

/* One knot of a dome: linear between knots in elevation, black outside them. Two at one elevation
 * are a step. */
typedef struct abbe_dome_knot {
  double elevation_rad; /* -pi/2 to pi/2 */
  double rgb[3];
} abbe_dome_knot;

typedef struct abbe_environment_source {
  abbe_source_kind kind;
  double radiance[3]; /* linear Rec.709 relative to the illuminant, W/(m2 sr), >= 0: the greatest of
                         a spot, a factor of a dome */
  double centre[3];   /* unit; disk, rectangle, spot */
  double up[3];       /* unit, across centre: rectangle, the direction of its height */
  double radius_rad;  /* disk: of the cone; spot: sigma */
  double half_width_rad, half_height_rad; /* rectangle, each below pi / 2 */
  abbe_sky sky;
  size_t knot_count;
  const abbe_dome_knot *knot; /* dome: rising; not owned */
} abbe_environment_source;

/* The integral of the source over the sphere by its radiance, sr: of a disk 2 pi (1 - cos radius),
 * of a rectangle 4 asin(sin half_width sin half_height). 0 for a sky and a dome, whose integrals
 * are the map's. */
double abbe_environment_source_solid_angle(const abbe_environment_source *source);

/* Adds the source to the map. ABBE_INVALID_ARGUMENT for sizes outside of the above, ABBE_NO_MEMORY;
 * the map is then as it was. */
abbe_result abbe_environment_source_add(const abbe_environment_source *source,
                                        abbe_radiance_map *map, abbe_error *error);

/* The radiance of a disk of that radius that makes this irradiance on a plane across its middle:
 * irradiance / (pi sin^2 radius). */
double abbe_environment_source_disk_radiance(double irradiance, double radius_rad);

/* sigma of the spot of that solid angle, sr, up to 1: to 1e-9. */
double abbe_environment_source_spot_sigma(double solid_angle);

#endif
