/* shader_variant.h: what shaders are compiled for: counts and facts of the scene, which each pass
 * may copy and complete. Facts become #defines, and so do counts that size an array. The others
 * become uniforms of the program (shaders/counts.glsl), so that it serves other counts too; of
 * some, a range is defined as well: the capacity of tables and stacks, whether exits are many.
 * Internal to gl/.
 */
#ifndef ABBE_GL_SCENE_SHADER_VARIANT_H
#define ABBE_GL_SCENE_SHADER_VARIANT_H

#include "gl/scene/gpu_scene.h"

#include <stdbool.h>
#include <stddef.h>

/* Flags that are a #define: X(field, #define, of the plan p and the scene when a variant is made).
 */
#define ABBE_VARIANT_FLAGS(X)                                                                      \
  X(receiver_shadows, RECEIVER_SHADOWS, p->receiver_shadows)                                       \
  X(wide, WIDE, false) /* the map's */                                                             \
  X(aovs, AOVS, false) /* the picture has them */                                                  \
  X(one_convex, ONE_CONVEX, p->convex && p->refractor_count == 1)                                  \
  X(spheres, SPHERES, p->spheres)                                                                  \
  X(convex, CONVEX, p->convex)                                                                     \
  X(layers, LAYERS, p->layers)                                                                     \
  X(hierarchy, HIERARCHY, p->bvh)                                                                  \
  X(receiver_hierarchy, RECEIVER_HIERARCHY, p->receivers == ABBE_RECEIVER_BVH)                     \
  X(absorbing, ABSORBING, p->absorbing)                                                            \
  X(band_parts, BAND_PARTS, p->band_parts)                                                         \
  X(textured, TEXTURED, p->textured)                                                               \
  X(environment, ENVIRONMENT, scene->environment.texture != 0)                                     \
  X(caustics, CAUSTICS, p->caustics)                                                               \
  X(volume, VOLUME, p->volume) /* caustics are looked up in the plan's */                          \
  X(walk, WALK, p->multi_refractor_paths)                                                          \
  X(mirrors, MIRRORS, p->mirror_count > 0)                                                         \
  X(rough, ROUGH, p->rough)                                                                        \
  X(cubes, CUBES, p->cubes)                                                                        \
  X(haze, HAZE, p->hazy)                      /* in the air, or around the eye */                  \
  X(haze_beyond, HAZE_BEYOND, p->haze_beyond) /* in the air, for bent rays of the camera */        \
  X(pinholes, PINHOLES, p->desc.transport == ABBE_TRANSPORT_PINHOLE) /* receivers have pages */    \
  X(page_charts, PINHOLE_CHARTS, p->page_charts) /* also those that are meshes */

typedef struct abbe_shader_variant {
#define ABBE_VARIANT_FIELD(field, define, value) bool field;
  ABBE_VARIANT_FLAGS(ABBE_VARIANT_FIELD)
#undef ABBE_VARIANT_FIELD
  /* the scene */
  size_t lights, area_lights, refractors, receivers, surfaces, reflections, planes;
  size_t wavelengths, bands, band_levels;
  size_t exits, slots, tints;
  size_t bvh_stack, receiver_root, shadow_planes;
  bool one_shadow, receiver_colours;
  abbe_volume_kind volume_kind; /* kind of a volume */
  abbe_region_kind volume_region;
  size_t volume_pages; /* tiles of a light, in place of cells */
  size_t shafts;       /* media with light for these, */
  size_t shaft_steps;  /* and steps of a way through it */
  bool copies;         /* a software rasteriser: tables are copied first (copies.glsl) */
  /* the picture */
  size_t eye_bands;     /* bands of a pixel at the most, where they are not refined */
  size_t pixel_threads; /* threads of a pixel (refraction_threads.glsl) */
  /* the map */
  size_t map_levels;
  size_t tiles, tile_blocks,
      chart_sides; /* tiles: capacity for those of a light; 0: none has any */
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
