#include "gl/pinholes/pinhole_sky.h"

#include "scenes/environment/radiance_cube.h"

abbe_result abbe_pinhole_sky_make(const abbe_gpu_scene *scene, const abbe_radiance_map *map,
                                  size_t side, abbe_pinhole_sky *out, abbe_error *error) {
  const abbe_render_desc *d = &scene->plan->desc;
  double matrix[9];
  abbe_radiance_cube cube;
  *out = (abbe_pinhole_sky){.side = side};
  const abbe_environment *around = scene->local->environment;
  abbe_result result = abbe_gpu_environment_colours(
      around != NULL ? &around->illuminant : abbe_scene_illuminant(scene->local),
      abbe_gpu_scene_working_space(scene), d, matrix, error);
  if (result == ABBE_OK) result = abbe_radiance_cube_make(map, side, &cube, error);
  if (result != ABBE_OK) return result;
  result = abbe_gpu_environment_cube(scene->gpu, &cube, matrix, &out->texture, error);
  abbe_radiance_cube_free(&cube);
  return result;
}

void abbe_pinhole_sky_free(abbe_gpu *gpu, abbe_pinhole_sky *sky) {
  abbe_gpu_drop_textures(gpu, 1, &sky->texture);
  *sky = (abbe_pinhole_sky){0};
}

void abbe_pinhole_sky_set(const abbe_gpu_scene *scene, const abbe_pinhole_sky *sky, int unit,
                          GLuint program) {
  abbe_gpu *gpu = scene->gpu;
  abbe_gpu_set_int(gpu, program, "pinhole_sky", unit);
  abbe_gpu_set_float(gpu, program, "sky_side", (double)sky->side);
  gpu->gl->ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
  gpu->gl->BindTexture(GL_TEXTURE_CUBE_MAP, sky->texture);
}
