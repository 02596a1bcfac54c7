#include "gl/scene/gpu_environment.h"

#include "colorimetry/upsampling.h"
#include "gl/device/bindings.h"
#include "gl/device/float4.h"

#include <stdlib.h>

/* From the environment's RGB, which is relative to its illuminant. */
static abbe_result find_colours(const abbe_illuminant *illuminant, abbe_rgb_space space,
                                double min_nm, double max_nm, double matrix[9], abbe_error *error) {
  abbe_upsampling up;
  abbe_result result = abbe_upsampling_make(illuminant, min_nm, max_nm, &up, error);
  if (result != ABBE_OK) return result;
  double from_xyz[9];
  abbe_rgb_space_from_xyz(space, from_xyz);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      matrix[3 * i + j] = 0;
      for (int k = 0; k < 3; k++) matrix[3 * i + j] += from_xyz[3 * i + k] * up.to_xyz[3 * k + j];
    }
  return ABBE_OK;
}

abbe_result abbe_gpu_environment_make(abbe_gpu *gpu, const abbe_environment *environment,
                                      abbe_rgb_space space, double min_nm, double max_nm,
                                      GLuint *texture, abbe_error *error) {
  *texture = 0;
  if (environment == NULL) return ABBE_OK;
  const abbe_gl *gl = gpu->gl;
  const abbe_radiance_map *map = &environment->map;
  double matrix[9];
  abbe_result result = find_colours(&environment->illuminant, space, min_nm, max_nm, matrix, error);
  if (result == ABBE_OK)
    result =
        abbe_gpu_make_texture(gpu, GL_RGBA32F, map->width, map->height, 0, true, texture, error);
  if (result != ABBE_OK) return result;
  float *texel = malloc(map->width * map->height * 4 * sizeof *texel);
  if (texel == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the environment");
  for (size_t i = 0; i < map->width * map->height; i++) {
    double rgb[3] = {(double)map->rgb[3 * i], (double)map->rgb[3 * i + 1],
                     (double)map->rgb[3 * i + 2]};
    abbe_rgb_space_apply(matrix, rgb, rgb);
    abbe_float4_store(rgb, 1, texel + 4 * i);
  }
  gl->BindTexture(GL_TEXTURE_2D, *texture);
  gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
  gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, (GLsizei)map->width, (GLsizei)map->height, GL_RGBA,
                    GL_FLOAT, texel);
  free(texel);
  return abbe_gl_check(gl, "the upload of the environment", error);
}

void abbe_gpu_environment_set(abbe_gpu *gpu, const abbe_environment *environment, GLuint texture,
                              GLuint program) {
  if (texture == 0) return;
  const abbe_gl *gl = gpu->gl;
  const double *m = environment->to_map;
  float matrix[9];
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++)
      matrix[3 * column + row] = (float)m[3 * row + column];
  const GLint at = gl->GetUniformLocation(program, "environment_from_world");
  if (at < 0) return;
  gl->UniformMatrix3fv(at, 1, GL_FALSE, matrix);
  gl->ActiveTexture(GL_TEXTURE0 + UNIT_ENVIRONMENT);
  gl->BindTexture(GL_TEXTURE_2D, texture);
}
