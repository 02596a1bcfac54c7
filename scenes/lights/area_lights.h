/* area_lights.h: lights with a size as points on them, for a renderer whose lights have none.
 *
 * A disk or rectangle becomes points of equal shares of its area, each with the cosine to its
 * normal: so its flux and what it sends along its normal are right, and its irradiance close by as
 * nearly as the points fill it. A disk's lie on rings, a rectangle's in the middles of equal parts.
 * Shadows are as many sharp ones, caustics as many sharp ones in one another's midst.
 */
#ifndef ABBE_SCENES_LIGHTS_AREA_LIGHTS_H
#define ABBE_SCENES_LIGHTS_AREA_LIGHTS_H

#include "scenes/scene.h"

/* Whether a light of the scene has a size and is not points yet. */
bool abbe_area_lights_any(const abbe_scene *scene);

/* A copy of the scene that owns nothing of it but its array of lights (free it alone): each disk
 * and rectangle is replaced by at most `points` lights that keep its name and kind, with `points`
 * for how many they are and W/sr for power; `room` lights at most in all, but one each at the
 * least. ABBE_NO_MEMORY. */
abbe_result abbe_area_lights_add(const abbe_scene *scene, size_t points, size_t room,
                                 abbe_scene *out, abbe_error *error);

#endif
