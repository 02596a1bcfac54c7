/* sweep_hash.h: numbers by which two sweeps are of one scene, and of one reference.
 * Internal to validation/sweep/. */
#ifndef ABBE_VALIDATION_SWEEP_SWEEP_MEASURE_HASH_H
#define ABBE_VALIDATION_SWEEP_SWEEP_MEASURE_HASH_H

#include "colorimetry/image/image.h"
#include "scenes/scene.h"

/* The hash of all that light meets: camera, lights, meshes, surfaces and materials. */
unsigned long long abbe_sweep_hash_scene(const abbe_scene *scene);
/* Either may be NULL. */
unsigned long long abbe_sweep_hash_images(const abbe_image *picture, const abbe_image *map);

#endif
