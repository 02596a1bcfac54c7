#include "gl/pinholes/pinhole_sky.h"

#include "gl/device/float4.h"
#include "scenes/environment/radiance_cube.h"

#include <stdlib.h>

enum { UNIT = 6 };

static abbe_result upload(const abbe_gpu_scene *scene, const abbe_radiance_cube *cube,
                          const double matrix[9], abbe_error *error) {
  const abbe_gl *gl = scene->gpu->gl;
  float *texel = malloc(cube->side * cube->side * 4 * sizeof *texel);
  if (texel == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for surroundings");
  for (size_t i = 0; i < 6 * cube->level_count; i++) {
    const size_t face = i % 6, level = i / 6, side = cube->side >> level, count = side * side;
    for (size_t k = 0; k < count; k++) {
      const float *from = cube->level[level] + 3 * (face * count + k);
      double colour[3] = {(double)from[0], (double)from[1], (double)from[2]};
      abbe_rgb_space_apply(matrix, colour, colour);
      abbe_float4_store(colour, 1, texel + 4 * k);
    }
    gl->TexSubImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + (GLenum)face, (GLint)level, 0, 0,
                      (GLsizei)side, (GLsizei)side, GL_RGBA, GL_FLOAT, texel);
  }
  free(texel);
  return abbe_gl_check(gl, "the upload of surroundings", error);
}

abbe_result abbe_pinhole_sky_make(const abbe_gpu_scene *scene, const abbe_radiance_map *map,
                                  size_t side, abbe_pinhole_sky *out, abbe_error *error) {
  const abbe_render_desc *d = &scene->plan->desc;
  double matrix[9];
  abbe_radiance_cube cube;
  *out = (abbe_pinhole_sky){.side = side};
  abbe_result result =
      abbe_gpu_environment_colours(&scene->local->environment->illuminant,
                                   abbe_gpu_scene_working_space(scene), d, matrix, error);
  if (result == ABBE_OK) result = abbe_radiance_cube_make(map, side, &cube, error);
  if (result != ABBE_OK) return result;
  result = abbe_gpu_make_cube(scene->gpu, side, cube.level_count, &out->texture, error);
  if (result == ABBE_OK) result = upload(scene, &cube, matrix, error);
  abbe_radiance_cube_free(&cube);
  return result;
}

void abbe_pinhole_sky_free(abbe_gpu *gpu, abbe_pinhole_sky *sky) {
  abbe_gpu_drop_textures(gpu, 1, &sky->texture);
  *sky = (abbe_pinhole_sky){0};
}

void abbe_pinhole_sky_begin(const abbe_gpu_scene *scene, const abbe_pinhole_sky *sky,
                            GLuint program) {
  abbe_gpu *gpu = scene->gpu;
  abbe_gpu_set_int(gpu, program, "pinhole_sky", UNIT);
  abbe_gpu_set_float(gpu, program, "sky_side", (double)sky->side);
  gpu->gl->ActiveTexture(GL_TEXTURE0 + UNIT);
  gpu->gl->BindTexture(GL_TEXTURE_CUBE_MAP, sky->texture);
  gpu->gl->Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
}

void abbe_pinhole_sky_end(const abbe_gpu_scene *scene) {
  scene->gpu->gl->Disable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
}
