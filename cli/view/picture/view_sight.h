/* view_sight.h: what a ray meets, and where a look into refractors ends: one ray at one wavelength,
 * at each interface the way that takes more light. Meshes as they are: it knows no normals but
 * their triangles' and exact spheres', no absorption and no surroundings.
 */
#ifndef ABBE_CLI_VIEW_PICTURE_VIEW_SIGHT_H
#define ABBE_CLI_VIEW_PICTURE_VIEW_SIGHT_H

#include "scenes/scene.h"

#include <stdbool.h>
#include <stddef.h>

enum { ABBE_VIEW_SIGHT_PLACES = 24 };

typedef struct abbe_view_met {
  const abbe_object *object; /* NULL: nothing */
  size_t index, face;        /* of the scene; of its mesh */
  double distance;           /* infinite where nothing is met */
} abbe_view_met;

/* The nearest surface on a ray (unit direction) beyond `from` m; bending: of refractors and mirrors
 * alone. */
void abbe_view_meet(const abbe_scene *scene, const double origin[3], const double direction[3],
                    double from, bool bending, abbe_view_met *out);
/* Outward, of the triangle; unit. */
void abbe_view_met_normal(const abbe_object *object, size_t face, double out[3]);

typedef struct abbe_view_sight {
  double nm;
  size_t count; /* interfaces that were met, then where it ends */
  double place[ABBE_VIEW_SIGHT_PLACES][3];
  double length; /* of the whole way, m */
  bool lands;    /* on a receiver: the last place */
} abbe_view_sight;

/* From the eye along a unit direction. Where the way does not end within so many interfaces, or
 * leaves the scene, it does not land. */
void abbe_view_sight_follow(const abbe_scene *scene, const double eye[3], const double direction[3],
                            double nm, abbe_view_sight *out);

#endif
