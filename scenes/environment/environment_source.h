/* environment_source.h: surroundings that are computed: what each kind of source adds to a map.
 *
 * Directions are the map's own. Where a source has edges or is small, texels are means by their
 * shares (radiance_map.h), and the source as a whole is scaled so that the map holds its exact
 * solid angle x radiance. A source that is smaller than a texel is as large as one there, and as
 * strong as it should be.
 */
#ifndef ABBE_SCENES_ENVIRONMENT_ENVIRONMENT_SOURCE_H
#define ABBE_SCENES_ENVIRONMENT_ENVIRONMENT_SOURCE_H

#include "base/error.h"
#include "scenes/environment/radiance_map.h"
#include "scenes/environment/sky.h"

#include <stddef.h>

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
