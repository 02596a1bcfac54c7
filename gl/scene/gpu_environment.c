#include "gl/scene/gpu_scene.h"

#include "base/maths.h"
#include "colorimetry/upsampling.h"
#include "colorimetry/weights.h"
#include "gl/device/bindings.h"
#include "gl/device/float4.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Lights with a size, as the camera's paths see them. */

static bool same_surface(const abbe_light *a, const abbe_light *b) {
  return a->points > 0 && b->points > 0 && a->kind == b->kind && a->radius == b->radius &&
         memcmp(a->centre, b->centre, sizeof a->centre) == 0 &&
         memcmp(a->direction, b->direction, sizeof a->direction) == 0 &&
         memcmp(a->edge, b->edge, sizeof a->edge) == 0;
}

/* The points of a disk or rectangle follow each other; views of the same light again come after all
 * lights. */
static bool is_first(const abbe_gpu_scene *scene, size_t light) {
  const abbe_light *all = scene->local->light;
  return all[light].points > 0 && scene->plan->light_view[light].light == light &&
         (light == 0 || !same_surface(&all[light], &all[light - 1]));
}

size_t abbe_gpu_area_lights_count(const abbe_gpu_scene *scene) {
  size_t count = 0;
  for (size_t i = 0; i < scene->plan->light_view_count; i++) count += is_first(scene, i);
  return count;
}

size_t abbe_gpu_area_lights_of(const abbe_gpu_scene *scene, size_t light) {
  size_t number = 0;
  for (size_t i = 0; i < scene->plan->light_view_count; i++) {
    if (!is_first(scene, i)) continue;
    number++;
    if (same_surface(&scene->local->light[i], &scene->local->light[light])) return number;
  }
  return 0;
}

static GLint uniform_place(const abbe_gl *gl, GLuint program, const char *what, size_t index) {
  char name[40];
  snprintf(name, sizeof name, "%s[%zu]", what, index);
  return gl->GetUniformLocation(program, name);
}

/* Half a side over its square: how far a place is along it, in halves. Of a disk: radii. */
static void set_edges(const abbe_gl *gl, GLuint program, size_t index, const abbe_light *light) {
  double edge[2][3];
  memcpy(edge, light->edge, sizeof edge);
  if (light->kind == ABBE_LIGHT_DISK) {
    const double *n = light->direction, x[3] = {fabs(n[0]) < 0.6, fabs(n[0]) >= 0.6, 0};
    abbe_vector_cross(n, x, edge[0]);
    abbe_vector_normalise(edge[0]);
    abbe_vector_cross(n, edge[0], edge[1]);
    for (int k = 0; k < 6; k++) edge[k / 3][k % 3] *= light->radius;
  }
  for (size_t i = 0; i < 2; i++) {
    const double scale = 1 / abbe_vector_dot(edge[i], edge[i]);
    gl->Uniform3f(uniform_place(gl, program, "area_light_edge", 2 * index + i),
                  (float)(scale * edge[i][0]), (float)(scale * edge[i][1]),
                  (float)(scale * edge[i][2]));
  }
}

void abbe_gpu_area_lights_set(const abbe_gpu_scene *scene, GLuint program) {
  const abbe_gl *gl = scene->gpu->gl;
  size_t disk = 0;
  if (uniform_place(gl, program, "area_light_place", 0) < 0) return;
  for (size_t i = 0; i < scene->plan->light_view_count; i++) {
    const abbe_light *l = &scene->local->light[i];
    if (!is_first(scene, i)) continue;
    const double area = abbe_light_area(l);
    double xyz[3];
    float rgb[3];
    abbe_weights_white(scene->plan->desc.observer, &l->illuminant, scene->plan->desc.min_nm,
                       scene->plan->desc.max_nm, xyz);
    const double scale = l->power * (double)l->points / area;
    for (int k = 0; k < 3; k++)
      rgb[k] = (float)(scale * ((double)scene->rgb_from_xyz[k] * xyz[0] +
                                (double)scene->rgb_from_xyz[3 + k] * xyz[1] +
                                (double)scene->rgb_from_xyz[6 + k] * xyz[2]));
    gl->Uniform4f(uniform_place(gl, program, "area_light_place", disk), (float)l->centre[0],
                  (float)l->centre[1], (float)l->centre[2],
                  l->kind == ABBE_LIGHT_DISK ? (float)l->radius : 0);
    set_edges(gl, program, disk, l);
    gl->Uniform2i(uniform_place(gl, program, "area_light_points", disk), (GLint)i,
                  (GLint)l->points);
    gl->Uniform3f(uniform_place(gl, program, "area_light_facing", disk), (float)l->direction[0],
                  (float)l->direction[1], (float)l->direction[2]);
    gl->Uniform3f(uniform_place(gl, program, "area_light_radiance", disk), rgb[0], rgb[1], rgb[2]);
    disk++;
  }
}

abbe_result abbe_gpu_environment_colours(const abbe_illuminant *illuminant, abbe_rgb_space space,
                                         const abbe_render_desc *desc, double matrix[9],
                                         abbe_error *error) {
  abbe_upsampling up;
  ABBE_TRY(
      abbe_upsampling_make_by(desc->observer, illuminant, desc->min_nm, desc->max_nm, &up, error));
  double from_xyz[9];
  abbe_rgb_space_from_xyz(space, from_xyz);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      matrix[3 * i + j] = 0;
      for (int k = 0; k < 3; k++) matrix[3 * i + j] += from_xyz[3 * i + k] * up.to_xyz[3 * k + j];
    }
  return ABBE_OK;
}

/* Converts `count` colours, with alpha 1. */
static float *convert(const double matrix[9], const float *rgb, size_t count, abbe_error *error) {
  float *out = malloc(count * 4 * sizeof *out);
  if (out == NULL) {
    abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the environment");
    return NULL;
  }
  for (size_t i = 0; i < count; i++) {
    double colour[3] = {(double)rgb[3 * i], (double)rgb[3 * i + 1], (double)rgb[3 * i + 2]};
    abbe_rgb_space_apply(matrix, colour, colour);
    abbe_float4_store(colour, 1, out + 4 * i);
  }
  return out;
}

static abbe_result make_texture(abbe_gpu *gpu, const abbe_radiance_map *map, const double matrix[9],
                                GLuint *out, abbe_error *error) {
  const abbe_gl *gl = gpu->gl;
  ABBE_TRY(abbe_gpu_make_texture(gpu, GL_RGBA32F, map->width, map->height, 0, true, out, error));
  float *texel = convert(matrix, map->rgb, map->width * map->height, error);
  if (texel == NULL) return ABBE_NO_MEMORY;
  gl->BindTexture(GL_TEXTURE_2D, *out);
  gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
  gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, (GLsizei)map->width, (GLsizei)map->height, GL_RGBA,
                    GL_FLOAT, texel);
  free(texel);
  return abbe_gl_check(gl, "the upload of the environment", error);
}

/* Where a level's first face begins, in texels; cube_mean.glsl has the same. */
static void place_of(size_t side, size_t level, size_t at[2]) {
  at[0] = 6 * (level > 0 ? side - 2 * (side >> level) + 2 * (level - 1) : 0);
  at[1] = level > 0 ? side + 2 : 0;
}

abbe_result abbe_gpu_environment_cube(abbe_gpu *gpu, const abbe_radiance_cube *cube,
                                      const double matrix[9], GLuint *out, abbe_error *error) {
  const abbe_gl *gl = gpu->gl;
  const size_t side = cube->side, height = side + 2 + side / 2 + 2;
  size_t end[2];
  place_of(side, cube->level_count, end);
  const size_t width = end[0] > 6 * (side + 2) ? end[0] : 6 * (side + 2);
  abbe_result result = abbe_gpu_make_texture(gpu, GL_RGBA32F, width, height, 0, true, out, error);
  if (result != ABBE_OK) return result;
  float *rgb = malloc(3 * (side + 2) * (side + 2) * sizeof *rgb);
  if (rgb == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the environment");
  gl->BindTexture(GL_TEXTURE_2D, *out);
  for (size_t i = 0; i < 6 * cube->level_count && result == ABBE_OK; i++) {
    const size_t face = i % 6, level = i / 6, across = (side >> level) + 2;
    for (size_t k = 0; k < across * across; k++)
      abbe_radiance_cube_bordered(cube, level, face, k % across, k / across, rgb + 3 * k);
    float *texel = convert(matrix, rgb, across * across, error);
    if (texel == NULL) {
      result = ABBE_NO_MEMORY;
      break;
    }
    place_of(side, level, end);
    gl->TexSubImage2D(GL_TEXTURE_2D, 0, (GLint)(end[0] + face * across), (GLint)end[1],
                      (GLsizei)across, (GLsizei)across, GL_RGBA, GL_FLOAT, texel);
    free(texel);
  }
  free(rgb);
  return result == ABBE_OK ? abbe_gl_check(gl, "the upload of the environment", error) : result;
}

/* Its texels are the power of two nearest to as wide as the map's. */
static abbe_result make_cube(abbe_gpu *gpu, const abbe_radiance_map *map, const double matrix[9],
                             GLuint *out, abbe_error *error) {
  ABBE_OWNED(abbe_radiance_cube, cube) = {0};
  size_t side = 1;
  while (side < ABBE_RADIANCE_CUBE_MAX_SIDE && 6 * side <= map->width) side *= 2;
  ABBE_TRY(abbe_radiance_cube_make(map, side, &cube, error));
  return abbe_gpu_environment_cube(gpu, &cube, matrix, out, error);
}

static abbe_result make_soft_light(abbe_gpu *gpu, const abbe_irradiance_map *map,
                                   const double matrix[9], GLuint *out, abbe_error *error) {
  enum { NODES = ABBE_IRRADIANCE_MAP_ROWS * ABBE_IRRADIANCE_MAP_COLUMNS };
  ABBE_FREED float *node = convert(matrix, &map->rgb[0][0][0], NODES, error);
  if (node == NULL) return ABBE_NO_MEMORY;
  return abbe_gpu_make_buffer(gpu, NODES * 4 * sizeof *node, node, out, error);
}

abbe_result abbe_gpu_environment_make(abbe_gpu *gpu, const abbe_scene *scene, abbe_rgb_space space,
                                      const abbe_render_desc *desc, abbe_gpu_environment *out,
                                      abbe_error *error) {
  *out = (abbe_gpu_environment){0};
  const abbe_environment *e = scene->environment;
  if (e == NULL) return ABBE_OK;
  double matrix[9];
  ABBE_TRY(abbe_gpu_environment_colours(&e->illuminant, space, desc, matrix, error));
  ABBE_TRY(make_texture(gpu, &e->map, matrix, &out->texture, error));
  ABBE_TRY(make_cube(gpu, &e->map, matrix, &out->cube, error));
  if (scene->soft_light != NULL)
    ABBE_TRY(make_soft_light(gpu, scene->soft_light, matrix, &out->soft_light, error));
  return ABBE_OK;
}

void abbe_gpu_environment_free(abbe_gpu *gpu, abbe_gpu_environment *environment) {
  abbe_gpu_drop_textures(gpu, 1, &environment->texture);
  abbe_gpu_drop_textures(gpu, 1, &environment->cube);
  abbe_gpu_drop_buffers(gpu, 1, &environment->soft_light);
}

void abbe_gpu_environment_set(abbe_gpu *gpu, const abbe_scene *scene,
                              const abbe_gpu_environment *environment, double unit,
                              GLuint program) {
  if (environment->texture == 0) return;
  const abbe_gl *gl = gpu->gl;
  const double *m = scene->environment->to_map;
  float matrix[9];
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 3; column++)
      matrix[3 * column + row] = (float)m[3 * row + column];
  abbe_gpu_set_float(gpu, program, "environment_scale", 1 / unit);
  const GLint at = gl->GetUniformLocation(program, "environment_from_world");
  if (at < 0) return;
  gl->UniformMatrix3fv(at, 1, GL_FALSE, matrix);
  gl->ActiveTexture(GL_TEXTURE0 + UNIT_ENVIRONMENT);
  gl->BindTexture(GL_TEXTURE_2D, environment->texture);
  gl->ActiveTexture(GL_TEXTURE0 + UNIT_ENVIRONMENT_CUBE);
  gl->BindTexture(GL_TEXTURE_2D, environment->cube);
}
