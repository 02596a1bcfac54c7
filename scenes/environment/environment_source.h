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

/* Pictures of surroundings into a map: OpenEXR and Radiance files.
 *
 * Latitude-longitude pictures (2:1, as radiance_map.h lays them out) and unfolded cubes: crosses,
 * upright (3:4) or lying (4:3), and OpenEXR's column of faces (1:6). In both crosses the middle of
 * the left, front, right row is the front, +x; above it is the top, +z; left of it the left, +y;
 * below it the bottom. The back is right of the right face in the lying cross, and below the
 * bottom, upside down, in the upright one. The column holds OpenEXR's +X, -X, +Y, -Y, +Z and -Z
 * from above [OpenEXRImages], where +Z is ahead and +Y is up: the left, right, top, bottom, front
 * and back. Colours are taken by the file's chromaticities; a file that says nothing is linear
 * Rec.709. */

typedef enum abbe_environment_layout {
  ABBE_LAYOUT_BY_ASPECT, /* what the picture's sides say */
  ABBE_LAYOUT_LATLONG,
  ABBE_LAYOUT_CUBE
} abbe_environment_layout;

/* Reads path, a file or FILE#PART of an OpenEXR file: R, G, B, or X, Y, Z, or Y alone (grey). What
 * Rec.709 cannot hold of another space is clipped at 0. A cube becomes a map four of its faces
 * wide, up to ABBE_RADIANCE_MAP_MAX_WIDTH, each texel a mean by its share. Errors of abbe_exr_read
 * and abbe_radiance_read; ABBE_UNSUPPORTED for a file of another kind and for one that is too
 * large; ABBE_SCHEMA, with the picture's size, for sides that fit no layout or not the one asked
 * for, and, with the pixel and its value, for one that is negative or not finite; ABBE_NOT_FOUND
 * without such channels. */
abbe_result abbe_environment_picture_read(const char *path, abbe_environment_layout layout,
                                          abbe_radiance_map *out, abbe_error *error);

#endif
