/* finer_scene.h: a scene whose refractors have more faces, to see how times grow with them. */
#ifndef ABBE_LIBRARY_CHOICE_FINER_SCENE_H
#define ABBE_LIBRARY_CHOICE_FINER_SCENE_H

#include "scenes/scene.h"
#include "validation/trace/transport/physics.h"

/* Of the refractors. */
size_t abbe_finer_scene_faces(const abbe_scene *scene);

/* Cuts every face of the refractors in four, flat. ABBE_NO_MEMORY: some of them may be cut. */
abbe_result abbe_finer_scene_cut(abbe_scene *scene, abbe_error *error);

/* A number that tells whether two measurements saw one scene. */

/* Of all that light meets: camera, lights, meshes, surfaces and materials. */
unsigned long long abbe_scene_hash(const abbe_scene *scene);

/* What the tracer has to leave out to model what the renderer's plan does, and
 * no more. */

/* The physics of the default profile over that range of wavelengths (0, 0: the default one). Errors
 * of abbe_plan_make. */
abbe_result abbe_matched_physics(const abbe_scene *scene, double min_nm, double max_nm,
                                 abbe_physics *out, abbe_error *error);

#endif
