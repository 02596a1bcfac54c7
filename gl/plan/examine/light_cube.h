/* light_cube.h: the six square pyramids that share out the directions around a point among them.
 *
 * A point light whose refractors do not fit one view looks through some of these. Faces are numbered
 * +x, -x, +y, -y, +z, -z, along the world's axes. Every direction belongs to exactly one (the
 * shaders' cube_face in view.glsl is the same rule). This knows where objects lie; it knows no GL.
 */
#ifndef ABBE_GL_PLAN_EXAMINE_LIGHT_CUBE_H
#define ABBE_GL_PLAN_EXAMINE_LIGHT_CUBE_H

#include "scenes/scene.h"
#include "scenes/view/view.h"

#include <stdbool.h>

#define ABBE_LIGHT_CUBE_FACES 6
#define ABBE_LIGHT_CUBE_ALL 63u /* a bit a face */

/* That of the greatest of |x|, |y|, |z|; of equal ones, the first. */
int abbe_light_cube_face(const double direction[3]);

/* An empty view from origin along the face's axis. */
void abbe_light_cube_look(const double origin[3], int face, abbe_view *out);

/* Grows the window of a view made by abbe_light_cube_look around the part of the object that lies in
 * the face's pyramid; never beyond -1 to 1. False, and nothing done, where it has no part there. */
bool abbe_light_cube_fit(abbe_view *view, const abbe_object *object);

/* Faces through which the light may reach the object, a bit each; what stands in between is not
 * looked at. A spot's cone leaves faces out that lie beside it. */
unsigned abbe_light_cube_reached(const abbe_light *light, const abbe_object *object);

#endif
