/* plan.h: what a scene requires of the renderer: models, passes, wavelengths, and why.
 *
 * The plan is computed from the scene and the request alone; it needs no GL context. A pass runs
 * only because a fact of the scene asks for it, and every entry says which fact. What the renderer
 * does not model is listed in the plan, or refused with ABBE_UNSUPPORTED.
 */
#ifndef ABBE_GL_PLAN_PLAN_H
#define ABBE_GL_PLAN_PLAN_H

#include "base/error.h"
#include "gl/plan/facts/plan_facts.h"
#include "gl/plan/facts/render_desc.h"
#include "scenes/scene.h"

/* Whether the renderer takes the scene with other lights than it has: it has surroundings, or a
 * light with a size, and no lights for them yet. */
bool abbe_plan_surrounds(const abbe_scene *scene);
/* The scene with points for its lights that have a size, and with directional lights for its
 * environment, as the renderer takes it (scenes/lights/environment_lights.h): for who looks up the
 * plan's lights. before: an earlier such copy that it may take lights over from, or NULL.
 * abbe_environment_lights_drop frees it. */
abbe_result abbe_plan_surround(const abbe_scene *scene, const abbe_render_desc *desc,
                               const abbe_scene *before, abbe_scene *out, abbe_error *error);

/* Makes the plan of a scene as it is loaded, or with lights for its environment already.
 * ABBE_INVALID_ARGUMENT for a request outside its limits, ABBE_OUT_OF_RANGE for an index that is
 * not known over the range, ABBE_UNSUPPORTED for what is not modelled. desc may be NULL. */
abbe_result abbe_plan_make(const abbe_scene *scene, const abbe_render_desc *desc, abbe_plan *out,
                           abbe_error *error);
/* The same plan, in less time where an earlier one was made of such a scene. */
abbe_result abbe_plan_make_after(const abbe_plan *before, const abbe_scene *scene,
                                 const abbe_render_desc *desc, abbe_plan *out, abbe_error *error);

/* A plan with all that is optional switched on, whether a fact needs it or not.
 *
 * It is there to measure what the plan saves. The picture stays the same within sampling, so
 * models stay as planned: receivers by their depth, refractors by their triangles or in turn are
 * other pictures. The default profile only; the thesis's passes all run anyway. */

#endif
