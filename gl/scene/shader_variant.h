/* shader_variant.h: what shaders are compiled for: counts and facts of the scene, which each pass
 * may copy and complete. Facts become #defines, and so do counts that size an array. The others
 * become uniforms of the program (shaders/counts.glsl), so that it serves other counts too; of
 * some, a range is told as well: the room of tables and stacks, whether exits are many. Internal to
 * gl/.
 */
#ifndef ABBE_GL_SCENE_SHADER_VARIANT_H
#define ABBE_GL_SCENE_SHADER_VARIANT_H

#include "gl/scene/gpu_scene.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct abbe_shader_variant {
  /* the scene */
  size_t lights, area_lights, refractors, receivers, surfaces, reflections, planes;
  size_t wavelengths, bands, band_levels;
  size_t exits, slots, tints;
  size_t bvh_stack, receiver_root, shadow_planes;
  bool spheres, convex, layers, hierarchy, receiver_hierarchy, one_convex, one_shadow;
  bool receiver_shadows, absorbing, band_parts, textured, receiver_colours, environment, caustics, walk,
      mirrors, rough, cubes;
  bool volume; /* caustics are looked up in the plan's, of that kind */
  abbe_volume_kind volume_kind;
  abbe_region_kind volume_region;
  size_t volume_pages; /* of a light, in place of cells */
  bool haze;           /* in the air, or around the eye */
  bool haze_beyond;    /* in the air, for bent rays of the camera */
  size_t shafts;       /* media with light for these, */
  size_t shaft_steps;  /* and steps of a way through it */
  bool pinholes;       /* receivers have pages of what these show */
  bool page_charts;    /* also those that are meshes */
  bool copies;         /* a software rasteriser: tables are copied first (copies.glsl) */
  /* the picture */
  bool aovs;
  size_t eye_bands;     /* of a pixel at the most, where they are not refined */
  size_t pixel_threads; /* threads of a pixel (refraction_threads.glsl) */
  /* the map */
  bool wide;
  size_t map_levels;
  size_t tiles, tile_blocks, chart_sides; /* tiles: room for those of a light; 0: none has any */
  /* photons; hit_stride 0: the program follows none */
  size_t hit_stride, steps, nodes;
  bool bridge, doubts_bridges;
} abbe_shader_variant;

void abbe_shader_variant_make(const abbe_gpu_scene *scene, abbe_shader_variant *out);

/* The #defines, and `more` after them (may be NULL); malloc'd. NULL: no memory. */
char *abbe_shader_variant_text(const abbe_shader_variant *variant, const char *more);

/* A program of one compute shader, or of so many stages; the device's, as of abbe_gpu_program. */
abbe_result abbe_shader_variant_compute(const abbe_shader_variant *variant, abbe_gpu *gpu,
                                        const char *file, const char *more, GLuint *out,
                                        abbe_error *error);
abbe_result abbe_shader_variant_program(const abbe_shader_variant *variant, abbe_gpu *gpu,
                                        const abbe_program_stage *stages, size_t count,
                                        const char *more, GLuint *out, abbe_error *error);

#endif
