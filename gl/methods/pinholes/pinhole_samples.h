/* pinhole_samples.h: samples of a scene's mirrors and refractors, as shaders read them
 * (pinholes.glsl). Internal to gl/.
 */
#ifndef ABBE_GL_PINHOLES_PINHOLE_SAMPLES_H
#define ABBE_GL_PINHOLES_PINHOLE_SAMPLES_H

#include "gl/scene/gpu_scene.h"
#include "scenes/environment/radiance_map.h"

#include <stdbool.h>
#include <stddef.h>

/* Rows of four floats: of each sample, and of each node of their tree (surface_samples.h). */
enum { ABBE_PINHOLE_ROWS = 4, ABBE_PINHOLE_NODE_ROWS = 3 };

typedef struct abbe_pinhole_samples {
  GLuint rows, nodes; /* nodes: 0 as published */
  size_t count, node_count;
  double area, spacing; /* area of all surfaces, m2; root of a sample's mean share, m */
} abbe_pinhole_samples;

/* Other samples for each place of the photons' grid, so that the mean of frames that shift it comes
 * to the mean of all samples. The same ones with a history, whose maps alone are such a mean: what
 * stands still stays as it is. */
uint64_t abbe_pinhole_samples_seed(const abbe_render_desc *request);

/* As the plan's request says, of all mirrors and refractors together. As published: each stands for
 * the same area, and there is no tree. Else each stands for what is nearest to it, the two sides of
 * a sheet apart, and a tree has clusters of them for who is far and parts for who is near. Errors
 * of abbe_surface_samples_make; ABBE_GL. */
abbe_result abbe_pinhole_samples_make(const abbe_gpu_scene *scene, bool published,
                                      abbe_pinhole_samples *out, abbe_error *error);
void abbe_pinhole_samples_free(abbe_gpu *gpu, abbe_pinhole_samples *samples);

/* What a mirror of the plan reflects of the environment's white at normal incidence, in the working
 * space; 1 of a refractor. ABBE_NO_MEMORY, errors of abbe_camera_bands_fill. */
abbe_result abbe_pinhole_samples_colours(const abbe_gpu_scene *scene, double (**out)[3],
                                         abbe_error *error);

/* Into the program that is in use: `pinholes` and `pinhole_nodes`, at units below
 * ABBE_GPU_TEXEL_UNITS. */
void abbe_pinhole_samples_bind(const abbe_gpu_scene *scene, const abbe_pinhole_samples *samples,
                               GLuint program);

/* What is around a scene as a cube map with levels, for pinholes to show (pinholes.glsl). */

enum { ABBE_PINHOLE_SKY_UNIT = 6 };

typedef struct abbe_pinhole_sky {
  GLuint texture; /* W/(m2 sr), working space, by the map's own directions */
  size_t side;
} abbe_pinhole_sky;

/* Makes the sky of a map in the place of the scene's environment's, a cube of side x side texels a
 * face. ABBE_GL, errors of abbe_radiance_cube_make and abbe_upsampling_make. */
abbe_result abbe_pinhole_sky_make(const abbe_gpu_scene *scene, const abbe_radiance_map *map,
                                  size_t side, abbe_pinhole_sky *out, abbe_error *error);
void abbe_pinhole_sky_free(abbe_gpu *gpu, abbe_pinhole_sky *sky);

/* Into the program that is in use, at a texture unit. */
void abbe_pinhole_sky_set(const abbe_gpu_scene *scene, const abbe_pinhole_sky *sky, int unit,
                          GLuint program);

#endif
