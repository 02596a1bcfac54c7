/* object_motion.h: an object of a scene moved, turned or scaled as a whole, triangles and exact
 * surface alike.
 */
#ifndef ABBE_SCENES_OBJECT_MOTION_H
#define ABBE_SCENES_OBJECT_MOTION_H

#include "scenes/scene.h"

/* By a column-major 4x4 matrix (scenes/geometry/transform.h) that keeps shapes: rotation, one scale
 * above 0 in all directions, translation, no mirror. What a scene as a whole must keep, such as a
 * light outside of refractors, abbe_scene_check says. ABBE_INVALID_ARGUMENT for any other matrix or
 * where the object would have no finite place; the object is then as it was. */
abbe_result abbe_object_move(abbe_object *object, const double matrix[16], abbe_error *error);

#endif
