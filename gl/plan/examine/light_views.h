/* light_views.h: from where refractors are seen: which lights and whether the camera meet them, in
 * how many views. Internal to gl/. */
#ifndef ABBE_GL_PLAN_EXAMINE_LIGHT_VIEWS_H
#define ABBE_GL_PLAN_EXAMINE_LIGHT_VIEWS_H

#include "base/error.h"
#include "gl/plan/facts/plan_facts.h"
#include "scenes/scene.h"
#include "scenes/view/view.h"

#include <stdbool.h>

/* Which lights and whether the camera may meet a refractor; what none of them meets takes no light
 * and costs nothing. */
void abbe_light_views_reach(const abbe_scene *scene, abbe_plan *plan);

/* A view of each light around all refractors or, where none holds them, views through the faces of
 * a cube; which receivers lie outside. ABBE_UNSUPPORTED where the thesis would need a cube, all
 * lights together more views than there are maps, or a seam would cut a mesh known by its layers.
 */
abbe_result abbe_light_views_choose(const abbe_scene *scene, abbe_plan *plan, abbe_error *error);

/* The view of the light around all refractors. False where it does not hold them all; `off`: the
 * first that it does not (may be NULL). */
bool abbe_light_views_fit(const abbe_scene *scene, const abbe_light *light, const abbe_plan *plan,
                          abbe_view *out, size_t *off);

/* The six square pyramids that share out the directions around a point among them.
 *
 * A point light whose refractors do not fit one view looks through some of these. Faces are
 * numbered +x, -x, +y, -y, +z, -z, along the world's axes. Every direction belongs to exactly one
 * (the shaders' cube_face in view.glsl is the same rule). This knows where objects lie; it knows
 * no GL. */

#define ABBE_LIGHT_CUBE_FACES 6
#define ABBE_LIGHT_CUBE_ALL 63u /* a bit a face */

/* That of the greatest of |x|, |y|, |z|; of equal ones, the first. */
int abbe_light_cube_face(const double direction[3]);

/* An empty view from origin along the face's axis. */
void abbe_light_cube_look(const double origin[3], int face, abbe_view *out);

/* Grows the window of a view made by abbe_light_cube_look around the part of the object that lies
 * in the face's pyramid; never beyond -1 to 1. False, and nothing done, where it has no part there.
 */
bool abbe_light_cube_fit(abbe_view *view, const abbe_object *object);

/* Faces through which the light may reach the object, a bit each; what stands in between is not
 * looked at. A spot's cone leaves faces out that lie beside it. */
unsigned abbe_light_cube_reached(const abbe_light *light, const abbe_object *object);

#endif
