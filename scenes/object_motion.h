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

/* Turns a crystal's x to be across its z, to any such direction where the sine of their angle is
 * below ABBE_AXES_SQUARE; that sine. */
#define ABBE_AXES_SQUARE 1e-3
double abbe_object_square_axes(abbe_object *object);
/* The crystal's axes, by the direction part of the matrix; x stays across z. */
void abbe_object_turn_axes(abbe_object *object, const double matrix[16]);

/* The refractors of a scene tilted together, with the settings that hold them, as a stone is rocked
 * in the hand while camera, lights and all else stay where they are. */

/* By tilt_rad, right-handed, about the horizontal axis of azimuth axis_rad (from +x towards +y)
 * through the middle of the bounds of all refractors. abbe_scene_check follows.
 * ABBE_INVALID_ARGUMENT where there is no refractor, or an angle is not finite; the scene is as it
 * was then, and is not to be used after any other error. */
abbe_result abbe_refractors_tilt(abbe_scene *scene, double tilt_rad, double axis_rad,
                                 abbe_error *error);

/* The piece, all refractors and mirrors, turned together by turn_rad about the axis through the
 * middle of the refractors' bounds (of the mirrors' where there is none), right-handed, while the
 * rest stays. abbe_scene_check follows. ABBE_INVALID_ARGUMENT where there is no piece, or for an
 * axis or angle that is none; the scene is not to be used after any other error. */
abbe_result abbe_piece_turn(abbe_scene *scene, const double axis[3], double turn_rad,
                            abbe_error *error);

#endif
