/* body_symmetry.h: the turns and reflections that bring an object onto itself, found by testing,
 * and the part of all directions that is enough: light from any other is brought there by one of
 * them.
 *
 * It reads an object and holds maps; what depends on the direction of light it does not know.
 * Internal to scenes/volume/.
 */
#ifndef ABBE_SCENES_VOLUME_BODY_SYMMETRY_H
#define ABBE_SCENES_VOLUME_BODY_SYMMETRY_H

#include "scenes/scene.h"

#define ABBE_BODY_SYMMETRY_MOST 512        /* maps */
#define ABBE_BODY_SYMMETRY_MOST_MARKS 8192 /* faces of a solid of planes, vertices of another */

typedef struct abbe_body_symmetry {
  size_t count;     /* 0 of one that was not made; else the first is the unit map */
  double (*map)[9]; /* [count] orthogonal, row-major, around the object's centre */
} abbe_body_symmetry;

/* Of the planes of a convex solid, of the vertices and normals of another mesh, within 1e-5 of its
 * radius around `centre`. An object of more marks, of more maps, or of a crystal, whose axis they
 * would turn, has the unit map alone; so has a ball. ABBE_NO_MEMORY. */
abbe_result abbe_body_symmetry_find(const abbe_object *object, const double centre[3],
                                    double radius, abbe_body_symmetry *out, abbe_error *error);
/* Of maps that are there, copied. ABBE_INVALID_ARGUMENT where one is not orthogonal, within 1e-6,
 * where the first is not the unit map, and for more than ABBE_BODY_SYMMETRY_MOST;
 * ABBE_NO_MEMORY. */
abbe_result abbe_body_symmetry_make(size_t count, const double (*map)[9], abbe_body_symmetry *out,
                                    abbe_error *error);
void abbe_body_symmetry_free(abbe_body_symmetry *symmetry);

/* Which map brings a direction to where it is enough to know it, and there. The same place for all
 * directions that the maps bring onto each other. */
size_t abbe_body_symmetry_bring(const abbe_body_symmetry *symmetry, const double direction[3],
                                double out[3]);

#endif
