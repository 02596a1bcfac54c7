/* environment_lights.h: an environment as a few directional lights, for a renderer whose lights have
 * no size.
 *
 * The sphere is cut into as many parts as there are to be lights, greedily, where that leaves least
 * light out [ViriyothaiDebevec2009]: a part's light shines along the sum of its radiance times
 * direction, whose length is its irradiance. On a plane that all of a part shines on, that is the
 * part's irradiance exactly; a part that is wide, or lies across the plane's horizon, is not. What
 * shadows and caustics of such lights look like is those of sharp lights: the more of them, the
 * softer.
 */
#ifndef ABBE_SCENES_ENVIRONMENT_LIGHTS_H
#define ABBE_SCENES_ENVIRONMENT_ENVIRONMENT_LIGHTS_H

#include "scenes/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A copy of the scene that owns nothing of it but its array of lights: after the scene's own come at
 * most `count` of its environment, named "environment 1" and so on, brightest first, as many as
 * ABBE_SCENE_MAX_LIGHTS has room for; out->environment_lights says how many. Spectra are over
 * [min_nm, max_nm]. A scene without an environment is copied as it is. ABBE_NO_MEMORY, and errors of
 * abbe_upsampling_make. */
abbe_result abbe_environment_lights_add(const abbe_scene *scene, size_t count, double min_nm,
                                        double max_nm, abbe_scene *out, abbe_error *error);
/* Frees such a copy; the scene stays. */
void abbe_environment_lights_drop(abbe_scene *copy);

#ifdef __cplusplus
}
#endif
#endif
