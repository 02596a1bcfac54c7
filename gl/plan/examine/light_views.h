/* light_views.h: from where refractors are seen: which lights and whether the camera meet them, in
 * how many views. Internal to gl/. */
#ifndef ABBE_GL_PLAN_EXAMINE_LIGHT_VIEWS_H
#define ABBE_GL_PLAN_EXAMINE_LIGHT_VIEWS_H

#include "base/error.h"
#include "gl/plan/facts/plan_facts.h"
#include "scenes/scene.h"
#include "scenes/view/view.h"

#include <stdbool.h>
#include <stddef.h>

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

/* The part of the picture in which a light may fall on a receiver.
 *
 * A narrow light leaves most of a picture dark, and there no shader needs it. This bounds what a
 * view of the light holds of a parallelogram by a rectangle of the picture; what hides it from
 * either is not looked at. */

/* Widest cone that has a view of its own, radians off its axis. */
#define ABBE_LIT_WINDOW_MAX_CONE 1.2

/* A view around a spot's cone. False for a cone that is wider, and for another kind of light, which
 * may reach everything. Near and far are not set. */
bool abbe_lit_window_cone(const abbe_light *light, abbe_view *out);

/* The rectangle around those of width x height pixels of the camera's window that show something of
 * the parallelogram (corner, U, V) within the window of the light's view: left, bottom, right, top;
 * right and top excluded. Two pixels wider on every side. False where there are none. */
bool abbe_lit_window(const abbe_view *light, const abbe_view *eye, const double parallelogram[9],
                     size_t width, size_t height, int out[4]);

#endif
