/* lit_window.h: the part of the picture in which a light may fall on a receiver.
 *
 * A narrow light leaves most of a picture dark, and there no shader needs it. This bounds
 * what a view of the light holds of a parallelogram by a rectangle of the picture; what hides it
 * from either is not looked at. Internal to gl/.
 */
#ifndef ABBE_GL_PLAN_EXAMINE_LIT_WINDOW_H
#define ABBE_GL_PLAN_EXAMINE_LIT_WINDOW_H

#include "scenes/scene.h"
#include "scenes/view/view.h"

#include <stdbool.h>
#include <stddef.h>

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
