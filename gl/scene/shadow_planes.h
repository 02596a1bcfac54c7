/* shadow_planes.h: the shadow of a convex solid in a light without size, as planes.
 *
 * What lies in shadow is itself convex: it lies behind every face that the light is in front of, and
 * within the planes through the light and the outline that the light sees. So a place is asked a few
 * products instead of where its ray to the light meets each face. Places in the solid count as in
 * shadow; what else stands in the light is not looked at.
 */
#ifndef ABBE_GL_SCENE_SHADOW_PLANES_H
#define ABBE_GL_SCENE_SHADOW_PLANES_H

#include "base/error.h"
#include "scenes/scene.h"

#include <stdbool.h>
#include <stddef.h>

/* The solid n . x < d of `count` planes, unit n, with a place strictly inside. A place x is in the
 * light's shadow where n . x' < d for all planes of `out`, n of length 1; x' is x from the light's
 * position, or for a directional one x itself. There are the planes of the outline and, if `faces`,
 * those of the lit faces: without them places between the solid and the light count as in shadow
 * too. One plane that holds for no place where the light is in front of no face, as for a light
 * inside. Room in out: twice `count`, and one. ABBE_NO_MEMORY; what is found is *found. */
abbe_result abbe_shadow_planes_make(const double (*plane)[4], size_t count, const double inside[3],
                                    const abbe_light *light, bool faces, double (*out)[4],
                                    size_t *found, abbe_error *error);

/* Whether some part of the object may lie between a convex object and the light: false only where a
 * plane, the object's own or across an axis, has the object on one side and those two on the other, up
 * to 1e-6 of the convex object's size. */
bool abbe_shadow_planes_in_front(const abbe_object *convex, const abbe_light *light,
                                 const abbe_object *object);

#endif
