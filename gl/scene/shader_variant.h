/* shader_variant.h: what shaders are compiled for: counts and facts of the scene, which each pass
 * may copy and complete. Facts become #defines, and so do counts that size an array. The others
 * become uniforms of the program (shaders/counts.glsl), so that it serves other counts too; of
 * some, a range is defined as well: the capacity of tables and stacks, whether exits are many.
 * Internal to gl/.
 */
#ifndef ABBE_GL_SCENE_SHADER_VARIANT_H
#define ABBE_GL_SCENE_SHADER_VARIANT_H

#include "gl/scene/gpu_scene.h"
#include "gl/scene/spectra/camera_bands.h"

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
  X(glows, GLOWS, p->glowing)                                                                      \
  X(films, FILMS, p->filmed)                                                                       \
  X(textured, TEXTURED, p->textured)                                                               \
  X(environment, ENVIRONMENT, scene->environment.texture != 0)                                     \
  X(caustics, CAUSTICS, p->caustics)                                                               \
  X(volume, VOLUME, p->volume) /* caustics are looked up in the plan's */                          \
  X(walk, WALK, p->multi_refractor_paths)                                                          \
  X(mirrors, MIRRORS, p->mirror_count > 0)                                                         \
  X(soft_shadows, SOFT_SHADOWS, abbe_gpu_shadows_soft(scene))                                      \
  X(rough, ROUGH, p->rough)                                                                        \
  X(cubes, CUBES, p->cubes)                                                                        \
  X(haze, HAZE, p->hazy)                      /* in the air, or around the eye */                  \
  X(haze_beyond, HAZE_BEYOND, p->haze_beyond) /* in the air, for bent rays of the camera */        \
  X(pinholes, PINHOLES, p->desc.transport == ABBE_TRANSPORT_PINHOLE) /* receivers have pages */    \
  X(page_charts, PINHOLE_CHARTS, p->page_charts) /* also those that are meshes */

/* Counts that are uniforms of every program (shaders/counts.glsl): X(field, at first); those of 0
 * are for passes to complete. */
#define ABBE_VARIANT_COUNTS(X)                                                                     \
  X(wavelengths, p->desc.wavelengths)                                                              \
  X(bands, scene->band_count)                                                                      \
  X(band_levels, scene->band_levels)                                                               \
  X(eye_bands, 0) /* bands of a pixel at the most, where they are not refined */                   \
  X(exits, p->desc.exits)                                                                          \
  X(slots, p->hit_slots)                                                                           \
  X(hit_stride, 0) /* 0: the program follows no photons */                                         \
  X(nodes, 0)                                                                                      \
  X(map_levels, 0)                                                                                 \
  X(tile_blocks, 0)                                                                                \
  X(chart_sides, 0)                                                                                \
  X(crystals, abbe_camera_bands_crystals(p))                                                       \
  X(glow, abbe_camera_bands_glow(p))                                                               \
  X(receiver_root, scene->receiver_root)

typedef struct abbe_shader_variant {
#define ABBE_VARIANT_FLAG(field, define, value) bool field;
#define ABBE_VARIANT_COUNT(field, value) size_t field;
  ABBE_VARIANT_FLAGS(ABBE_VARIANT_FLAG)
  ABBE_VARIANT_COUNTS(ABBE_VARIANT_COUNT)
#undef ABBE_VARIANT_FLAG
#undef ABBE_VARIANT_COUNT
  /* the scene */
  size_t lights, area_lights, refractors, receivers, surfaces, reflections, planes;
  size_t tints, part_surfaces, bvh_stack, shadow_planes;
  bool one_shadow, receiver_colours;
  abbe_volume_kind volume_kind; /* kind of a volume */
  abbe_region_kind volume_region;
  size_t volume_pages; /* tiles of a light, in place of cells */
  size_t shafts;       /* media with light for these, */
  size_t shaft_steps;  /* and steps of a way through it */
  bool copies;         /* a software rasteriser: tables are copied first (copies.glsl) */
  /* the picture */
  size_t pixel_threads; /* threads of a pixel (refraction_threads.glsl) */
  size_t tiles;         /* capacity for those of a light; 0: none has any */
  size_t steps;         /* steps of photons */
  bool bridge, doubts_bridges;
} abbe_shader_variant;

void abbe_shader_variant_make(const abbe_gpu_scene *scene, abbe_shader_variant *out);

/* #defines of programs that follow light as a crystal's two waves (crystals.glsl). */
const char *abbe_shader_variant_waves(const abbe_plan *plan);

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
