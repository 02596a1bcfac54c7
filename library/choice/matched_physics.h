/* matched_physics.h: what the tracer has to leave out to model what the renderer's plan does, and
 * no more.
 */
#ifndef ABBE_LIBRARY_CHOICE_MATCHED_PHYSICS_H
#define ABBE_LIBRARY_CHOICE_MATCHED_PHYSICS_H

#include "scenes/scene.h"
#include "validation/trace/transport/physics.h"

/* The physics of the default profile over that range of wavelengths (0, 0: the default one). Errors
 * of abbe_plan_make. */
abbe_result abbe_matched_physics(const abbe_scene *scene, double min_nm, double max_nm,
                                 abbe_physics *out, abbe_error *error);

#endif
