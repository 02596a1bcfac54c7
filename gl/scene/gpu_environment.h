/* gpu_environment.h: what is around a scene, on the device: a texture by longitude and latitude.
 * Internal to gl/.
 */
#ifndef ABBE_GL_SCENE_GPU_ENVIRONMENT_H
#define ABBE_GL_SCENE_GPU_ENVIRONMENT_H

#include "colorimetry/rgb_space.h"
#include "gl/device/gpu.h"
#include "scenes/environment/environment.h"

/* Radiance over [min_nm, max_nm] in `space`; 0 in *texture where environment is NULL. ABBE_GL,
 * ABBE_NO_MEMORY, errors of abbe_upsampling_make. */
abbe_result abbe_gpu_environment_make(abbe_gpu *gpu, const abbe_environment *environment,
                                      abbe_rgb_space space, double min_nm, double max_nm,
                                      GLuint *texture, abbe_error *error);

/* Into the program that is in use, where it asks for it. */
void abbe_gpu_environment_set(abbe_gpu *gpu, const abbe_environment *environment, GLuint texture,
                              GLuint program);

#endif
