/* support.h: what the renderer does not model, refused by name.
 *
 * Of scenes whose refractors single precision does not resolve, see gl/plan/examine/models.h.
 * Internal to gl/plan/.
 */
#ifndef ABBE_GL_PLAN_SUPPORT_H
#define ABBE_GL_PLAN_SUPPORT_H

#include "base/error.h"
#include "gl/plan/facts/plan_facts.h"
#include "scenes/scene.h"

/* ABBE_UNSUPPORTED for a rough mirror but by the transport of pinholes in the default profile. */
abbe_result abbe_support_roughness(const abbe_scene *scene, const abbe_plan *plan,
                                   abbe_error *error);
/* ABBE_UNSUPPORTED for a mirror where the thesis's profiles or the model 'layers' is asked for. */
abbe_result abbe_support_mirrors(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error);
/* ABBE_UNSUPPORTED for a refractor that lies in another, or partly, where the model 'layers' is
 * asked for: by some of their vertices, so that a thin overlap may be let through. */
abbe_result abbe_support_nesting(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error);

/* What the transport by pinholes follows, in wand2003 and in the default profile: an environment,
 * and mirrors or refractors. ABBE_UNSUPPORTED. */
abbe_result abbe_support_pinholes(const abbe_scene *scene, const abbe_plan *plan,
                                  abbe_error *error);
/* ABBE_UNSUPPORTED for what a published method does not know, where it is asked for. */
abbe_result abbe_support_published(const abbe_scene *scene, const abbe_plan *plan,
                                   abbe_error *error);

/* ABBE_UNSUPPORTED for what a volume of caustics does not hold, where one is asked for: other
 * objects that bend light, another shape; but of printed ones also lights that are near, that meet
 * a part of the object, or are of another colour. */
abbe_result abbe_support_volume(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error);

/* ABBE_UNSUPPORTED for a medium that scatters in a published method, and where light is looked up.
 */
abbe_result abbe_support_haze(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error);

/* ABBE_INVALID_ARGUMENT for a given map layout that is not the layout of its light's map. */
abbe_result abbe_support_layout(const abbe_scene *scene, const abbe_plan *plan, abbe_error *error);

#endif
