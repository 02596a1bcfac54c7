/* reach.h: what light, a view ray or another object may meet, to judge by bounds.
 *
 * Judged by the object's bounds, and never wrongly no: what stands in between is not looked at.
 * Internal to gl/.
 */
#ifndef ABBE_GL_PLAN_EXAMINE_REACH_H
#define ABBE_GL_PLAN_EXAMINE_REACH_H

#include "scenes/scene.h"

#include <stdbool.h>
#include <stddef.h>

/* False where the light is a spot whose cone misses the ball around the object's bounds. */
bool abbe_reach_light(const abbe_light *light, const abbe_object *object);

/* False where no part of the box around `behind` lies in the shadow of the object's ball: within
 * the square pyramid (a prism for a directional light) around it from the light, and no nearer than
 * the ball begins. Light that goes on nearly straight through the object then meets nothing there.
 */
bool abbe_reach_through(const abbe_light *light, const abbe_object *object,
                        const abbe_object *behind);

/* False where the box around the object is behind the camera or beside a picture of width x height
 * pixels and one pixel more all round. */
bool abbe_reach_eye(const abbe_camera *camera, size_t width, size_t height,
                    const abbe_object *object);

/* Whether two refractors may overlap. */
bool abbe_reach_overlap(const abbe_object *a, const abbe_object *b);

/* Whether a receiver may reach into a refractor; whether some of the scene's may. */
bool abbe_reach_into(const abbe_object *receiver, const abbe_object *refractor);
bool abbe_reach_is_entered(const abbe_scene *scene, const abbe_object *refractor);

/* Whether their bounds are nearer to one another than the refractor's are long. */
bool abbe_reach_is_near(const abbe_object *receiver, const abbe_object *refractor);

/* Signed distance of a point from the plane of a parallelogram (corner, edges u and v), m. */
double abbe_reach_side(const double parallelogram[9], const double at[3]);

#endif
