/* scene_hash.h: a number that tells whether two measurements saw one scene. Internal to library/.
 */
#ifndef ABBE_LIBRARY_CHOICE_SCENE_HASH_H
#define ABBE_LIBRARY_CHOICE_SCENE_HASH_H

#include "scenes/scene.h"

/* Of all that light meets: camera, lights, meshes, surfaces and materials. */
unsigned long long abbe_scene_hash(const abbe_scene *scene);

#endif
