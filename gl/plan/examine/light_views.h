/* light_views.h: from where refractors are seen: which lights and the eye meet them, in how many
 * views.
 */
#ifndef ABBE_GL_PLAN_EXAMINE_LIGHT_VIEWS_H
#define ABBE_GL_PLAN_EXAMINE_LIGHT_VIEWS_H

#include "base/error.h"
#include "gl/plan/facts/plan_facts.h"
#include "scenes/scene.h"
#include "scenes/view/view.h"

/* Which lights and whether the eye may meet a refractor; what none of them meets takes no light and
 * costs nothing. */
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

#endif
