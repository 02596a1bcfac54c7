/* no_culling.h: a plan with all that is optional switched on, whether a fact asks for it or not.
 *
 * It is there to measure what the plan saves. The picture stays the same within sampling, so
 * models stay as planned: receivers by their depth, refractors by their triangles or in turn are
 * other pictures. The default profile only; the thesis's passes all run anyway.
 */
#ifndef ABBE_GL_PLAN_NO_CULLING_H
#define ABBE_GL_PLAN_NO_CULLING_H

#include "gl/plan/facts/plan_facts.h"
#include "scenes/scene.h"

/* asked: the request as it came; what it says itself stays. */
void abbe_no_culling_apply(const abbe_scene *scene, const abbe_render_desc *asked, abbe_plan *plan);

#endif
