/* finer_scene.h: a scene whose refractors have more faces, to see how times grow with them.
 * Internal to library/. */
#ifndef ABBE_LIBRARY_CHOICE_FINER_SCENE_H
#define ABBE_LIBRARY_CHOICE_FINER_SCENE_H

#include "scenes/scene.h"

/* Of the refractors. */
size_t abbe_finer_scene_faces(const abbe_scene *scene);

/* Cuts every face of the refractors in four, flat. ABBE_NO_MEMORY: some of them may be cut. */
abbe_result abbe_finer_scene_cut(abbe_scene *scene, abbe_error *error);

/* A number that tells whether two measurements saw one scene. */

/* Of all that light meets: camera, lights, meshes, surfaces and materials. */
unsigned long long abbe_scene_hash(const abbe_scene *scene);

#endif
