/* path_limits.h: how far light is followed through refractors, from a light and from the eye.
 */
#ifndef ABBE_GL_PLAN_EXAMINE_PATH_LIMITS_H
#define ABBE_GL_PLAN_EXAMINE_PATH_LIMITS_H

#include "gl/plan/facts/plan_facts.h"
#include "scenes/scene.h"

/* Exits at the most, the share of its light at which a path ends, both of the eye's rays, and how
 * many hits of a photon there is room for. asked: the request as it came, or NULL. The
 * wavelengths are counted. */
void abbe_path_limits_choose(const abbe_scene *scene, const abbe_render_desc *asked,
                             abbe_plan *plan);

#endif
