/* pinhole_sky.h: what is around a scene as a cube map with levels, for pinholes to show
 * (pinholes.glsl). Internal to gl/.
 */
#ifndef ABBE_GL_PINHOLES_PINHOLE_SKY_H
#define ABBE_GL_PINHOLES_PINHOLE_SKY_H

#include "gl/scene/gpu_scene.h"
#include "scenes/environment/radiance_map.h"

#include <stddef.h>

enum { ABBE_PINHOLE_SKY_UNIT = 6 };

typedef struct abbe_pinhole_sky {
  GLuint texture; /* W/(m2 sr), working space, by the map's own directions */
  size_t side;
} abbe_pinhole_sky;

/* Of a map in the place of the scene's environment's, a cube of side x side texels a face. ABBE_GL,
 * errors of abbe_radiance_cube_make and abbe_upsampling_make. */
abbe_result abbe_pinhole_sky_make(const abbe_gpu_scene *scene, const abbe_radiance_map *map,
                                  size_t side, abbe_pinhole_sky *out, abbe_error *error);
void abbe_pinhole_sky_free(abbe_gpu *gpu, abbe_pinhole_sky *sky);

/* Into the program that is in use, at a texture unit. */
void abbe_pinhole_sky_set(const abbe_gpu_scene *scene, const abbe_pinhole_sky *sky, int unit,
                          GLuint program);

#endif
