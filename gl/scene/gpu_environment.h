/* gpu_environment.h: what is around a scene, on the device: a texture by longitude and latitude, a
 * cube with levels for rays that stand for many directions, and irradiance by normal of what the
 * scene's lights leave of it. Internal to gl/.
 */
#ifndef ABBE_GL_SCENE_GPU_ENVIRONMENT_H
#define ABBE_GL_SCENE_GPU_ENVIRONMENT_H

#include "colorimetry/rgb_space.h"
#include "gl/device/gpu.h"
#include "gl/plan/facts/render_desc.h"
#include "scenes/environment/radiance_cube.h"
#include "scenes/scene.h"

typedef struct abbe_gpu_environment {
  GLuint texture;    /* W/(m2 sr); 0: there is none */
  GLuint cube;       /* the same, texels about as wide, and means over wider ones */
  GLuint soft_light; /* W/m2, by the nodes of an abbe_irradiance_map */
} abbe_gpu_environment;

/* Of a scene with lights for its environment (environment_lights.h), over the request's range, for
 * its observer, in `space`; zeros where the scene has none. ABBE_GL, ABBE_NO_MEMORY, errors of
 * abbe_upsampling_make_by. */
abbe_result abbe_gpu_environment_make(abbe_gpu *gpu, const abbe_scene *scene, abbe_rgb_space space,
                                      const abbe_render_desc *desc, abbe_gpu_environment *out,
                                      abbe_error *error);
/* To `space` from the RGB of an environment, which is relative to its illuminant; row-major. Errors
 * of abbe_upsampling_make_by. */
abbe_result abbe_gpu_environment_colours(const abbe_illuminant *illuminant, abbe_rgb_space space,
                                         const abbe_render_desc *desc, double matrix[9],
                                         abbe_error *error);
/* A cube's levels, by the matrix. ABBE_GL, ABBE_NO_MEMORY. */
abbe_result abbe_gpu_environment_cube(abbe_gpu *gpu, const abbe_radiance_cube *cube,
                                      const double matrix[9], GLuint *out, abbe_error *error);
void abbe_gpu_environment_free(abbe_gpu *gpu, abbe_gpu_environment *environment);

/* Into the program that is in use, where it asks for it. `unit`: W in one of the scene's lights. */
void abbe_gpu_environment_set(abbe_gpu *gpu, const abbe_scene *scene,
                              const abbe_gpu_environment *environment, double unit, GLuint program);

#endif
