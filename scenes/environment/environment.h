/* environment.h: the light from all around a scene: radiance by direction, no distance, no shadow
 * of its own.
 *
 * A latitude-longitude map (radiance_map.h), turned as a whole, of linear Rec.709 RGB relative to
 * one illuminant (colorimetry/upsampling.h lifts it to spectra): radiance in W/(m2 sr) over the
 * rendered wavelengths, where RGB (L, L, L) is L of the illuminant's own light. Directions point
 * from the scene to where the light comes from. It holds what arrives from there; what hides it,
 * and pictures of it, are the renderer's and the tracer's.
 *
 * Make one: fill path, map, to_map, illuminant, illuminant_path, then abbe_environment_prepare,
 * which makes the rest. Internal to scenes/. */
#ifndef ABBE_SCENES_ENVIRONMENT_ENVIRONMENT_H
#define ABBE_SCENES_ENVIRONMENT_ENVIRONMENT_H

#include "base/error.h"
#include "colorimetry/illuminant.h"
#include "scenes/environment/radiance_map.h"

#include <stddef.h>
#include <stdint.h>

/* Draws from a list of shares in constant time [Walker1977] [Vose1991]. */

/* An entry of equal width is kept by its own index up to `keep`, and goes to `other` above. */
typedef struct abbe_alias_table {
  size_t count;
  double *keep;    /* [count], 0 to 1: of a bright entry among many only its last bits matter */
  uint32_t *other; /* [count] */
} abbe_alias_table;

/* Weights, any scale: finite, >= 0, their sum > 0 and finite; else ABBE_INVALID_ARGUMENT. An entry
 * of weight 0 is never drawn. ABBE_NO_MEMORY. */
abbe_result abbe_alias_table_make(const double *weight, size_t count, abbe_alias_table *out,
                                  abbe_error *error);
void abbe_alias_table_free(abbe_alias_table *table);

/* The entry of u in [0, 1), which has all bits of a double: each entry's chance is then right to
 * 2^-52. Fewer bits leave few values of the fraction that decides, and so wrong chances. */
size_t abbe_alias_table_draw(const abbe_alias_table *table, double u);

#define ABBE_ENVIRONMENT_MOST 1e12 /* W/(m2 sr), of one texel */
#define ABBE_ENVIRONMENT_MAX_LEVELS 12

typedef struct abbe_environment {
  char *path; /* the picture that it is of, or NULL */
  abbe_radiance_map map;
  double to_map[9]; /* row-major rotation from world directions to the map's */
  abbe_illuminant illuminant;
  char *illuminant_path; /* the file that it is of, or NULL */

  uint64_t map_digest;     /* digest of the map's texels (scenes/geometry/digest.h) */
  double mean[3];          /* mean radiance over the sphere */
  double luminance;        /* integral over the sphere of Rec.709's luminance of the RGB, > 0 */
  abbe_alias_table texels; /* drawn by luminance x solid angle */
  size_t level_count;      /* levels in level[] */
  abbe_radiance_map level[ABBE_ENVIRONMENT_MAX_LEVELS]; /* each half of the one before; the first
                                                           half of map; the last 2 or 3 high */
} abbe_environment;

/* Makes what is derived from the map. ABBE_INVALID_ARGUMENT, with the texel and its value, for one
 * that is not finite, negative or above ABBE_ENVIRONMENT_MOST, and for a map that is black
 * everywhere; ABBE_NO_MEMORY. The environment is then as it was. */
abbe_result abbe_environment_prepare(abbe_environment *environment, abbe_error *error);
void abbe_environment_free(abbe_environment *environment);

/* to_map of surroundings that are turned by rotate_rad about +z (what was at azimuth a is at
 * a + rotate, from +x towards +y), then by tilt_rad about the axis, right-handed. axis NULL: no
 * tilt. */
void abbe_environment_turn(double rotate_rad, const double axis[3], double tilt_rad,
                           double to_map[9]);

/* Radiance from a unit world direction; of level[index - 1] for an index above 0, of the last for
 * one beyond. */
void abbe_environment_radiance(const abbe_environment *environment, const double direction[3],
                               double rgb[3]);
void abbe_environment_radiance_of_level(const abbe_environment *environment, size_t index,
                                        const double direction[3], double rgb[3]);

/* A unit world direction for u in [0, 1)^3, the radiance from there, and its density, 1/sr, which
 * is the luminance of the radiance from there over its integral: radiance of one hue over pdf is
 * the same everywhere. Never one from which no light comes. */
void abbe_environment_sample(const abbe_environment *environment, const double u[3],
                             double direction[3], double *pdf, double rgb[3]);
/* The density of abbe_environment_sample at a unit world direction, 1/sr. */
double abbe_environment_pdf(const abbe_environment *environment, const double direction[3]);

#endif
