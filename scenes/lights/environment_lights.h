/* environment_lights.h: an environment as directional lights and what they leave, for a renderer
 * whose lights have no size.
 *
 * Lights stand for compact sources: places all around each other that are brighter than three times
 * the mean of what does not stand out, or, where those are wide, than twice, four times, … that,
 * until their light comes from within about 12 degrees of its middle. What of a source is above
 * that bound shines along the sum of its radiance times direction, whose length is its irradiance,
 * as one light, with shadows and caustics. Sources of less than 2 % of all light are none. All else
 * is soft light: irradiance by the direction that a receiver faces, without shadows and caustics,
 * as clear objects and mirrors leave it where it is alike all around. Lights and soft light
 * together give an open receiver its irradiance exactly, but for colours that differ within a
 * source. */
#ifndef ABBE_SCENES_LIGHTS_ENVIRONMENT_LIGHTS_H
#define ABBE_SCENES_LIGHTS_ENVIRONMENT_LIGHTS_H

#include "colorimetry/observer.h"
#include "scenes/scene.h"

typedef struct abbe_environment_lights_desc {
  size_t count;           /* at the most */
  double min_nm, max_nm;  /* range of their spectra */
  abbe_observer observer; /* to whom a light of one watt is as bright as any other */
} abbe_environment_lights_desc;

/* A copy of the scene that owns nothing of it but its array of lights and its soft light: after the
 * scene's own come at most `count` of its environment, none where nothing stands out, named
 * "environment 1" and so on, brightest first, up to ABBE_SCENE_MAX_LIGHTS in all;
 * out->environment_lights is their number. A scene without an environment is copied as it is.
 * before, if not NULL, is an earlier such copy: what was found for such an environment is taken
 * from it. ABBE_NO_MEMORY, ABBE_CANCELLED, and errors of abbe_upsampling_make_by. */
abbe_result abbe_environment_lights_add(const abbe_scene *scene,
                                        const abbe_environment_lights_desc *desc,
                                        const abbe_scene *before, abbe_scene *out,
                                        abbe_error *error);
/* What the `count` brightest of its lights leave of an environment, as radiance: a map as large as
 * its own, in which the texels of their compact sources are cut down to where these begin to stand
 * out. With as many as the copy above has it is the radiance of its soft light. ABBE_NO_MEMORY. */
abbe_result abbe_environment_lights_leave(const abbe_environment *environment, size_t count,
                                          abbe_radiance_map *out, abbe_error *error);
/* Frees such a copy; the scene stays. */
void abbe_environment_lights_drop(abbe_scene *copy);

/* Lights with a size as points on them, for a renderer whose lights have none.
 *
 * A disk or rectangle becomes points of equal shares of its area, each with the cosine to its
 * normal: so its flux and what it sends along its normal are right, and its irradiance close by as
 * nearly as the points fill it. A disk's lie on rings, a rectangle's in the middles of equal
 * parts. Shadows are as many sharp ones, caustics as many sharp ones in one another's midst. */

/* Whether a light of the scene has a size and is not points yet. */
bool abbe_area_lights_any(const abbe_scene *scene);

/* A copy of the scene that owns nothing of it but its array of lights (free it alone): each disk
 * and rectangle is replaced by at most `points` lights that keep its name and kind, with `points`
 * for how many they are and W/sr for power; `room` lights at most in all, but one each at the
 * least. ABBE_NO_MEMORY. */
abbe_result abbe_area_lights_add(const abbe_scene *scene, size_t points, size_t room,
                                 abbe_scene *out, abbe_error *error);

#endif
