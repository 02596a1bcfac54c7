/* exit_points.h: points that light first meets an object at, spread evenly over its surface, each
 * with a wavelength and with the numbers that decide for its ray [Roberts2018].
 *
 * Internal to validation/: it is not installed.
 */
#ifndef ABBE_VALIDATION_VOLUME_EXIT_POINTS_H
#define ABBE_VALIDATION_VOLUME_EXIT_POINTS_H

#include "scenes/volume/light_exits.h"
#include "validation/volume/exit_walk.h"
#include "validation/volume/lone_object.h"

typedef struct abbe_exit_point {
  float place[3], normal[3]; /* frame; of the face, outwards */
  uint32_t bin;              /* of ABBE_LIGHT_EXITS_BINS */
  float chance[ABBE_EXIT_WALK_CHANCES];
} abbe_exit_point;

typedef struct abbe_exit_points {
  size_t count;
  abbe_exit_point *point; /* [count] */
  double area;            /* of the whole surface, m2: of an open mirror both sides */
} abbe_exit_points;

/* Of `count` points on all of the surface those that lie where the symmetry brings them, at least
 * one. Wavelengths by abbe_light_exits_chances. ABBE_GEOMETRY for a surface without area,
 * ABBE_NO_MEMORY. */
abbe_result abbe_exit_points_make(const abbe_lone_object *lone, const abbe_body_symmetry *symmetry,
                                  size_t count, double min_nm, double max_nm, uint32_t seed,
                                  abbe_exit_points *out, abbe_error *error);
void abbe_exit_points_free(abbe_exit_points *points);

#endif
