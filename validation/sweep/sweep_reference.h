/* sweep_reference.h: the reference of a sweep: files that are given, or traced and kept beside the
 * table.
 *
 * A traced one is stamped with its scene and request and taken again where both are the same; what
 * was stopped goes on from its checkpoint. Internal to validation/sweep/.
 */
#ifndef ABBE_VALIDATION_SWEEP_SWEEP_REFERENCE_H
#define ABBE_VALIDATION_SWEEP_SWEEP_REFERENCE_H

#include "colorimetry/image/image.h"
#include "gl/device/context.h"
#include "scenes/scene.h"

#define ABBE_SWEEP_PATH 1024

/* How a reference is traced; zero means the default in every field. */
typedef struct abbe_sweep_reference_desc {
  size_t width, height;                      /* pixels; 0: the scene's */
  size_t passes;                             /* 0: ABBE_REFERENCE_PASSES */
  size_t photons;                            /* a pass; 0: the tracer's own number */
  size_t texels;                             /* a side of the map; 0: 256 */
  uint32_t seed;                             /* seed of its noise */
  bool matched;                              /* physics that match the renderer's plan */
  bool (*progress)(void *user, double done); /* false stops; or NULL */
  void *user;
  const volatile int *stop; /* other than 0 stops a pass midway; or NULL */
} abbe_sweep_reference_desc;

/* Paths, and images where they are loaded; a zeroed one is empty. */
typedef struct abbe_sweep_reference {
  abbe_image picture, map;
  char picture_path[ABBE_SWEEP_PATH], map_path[ABBE_SWEEP_PATH];
  char checkpoint_path[ABBE_SWEEP_PATH];
} abbe_sweep_reference;

/* The files beside a table: STEM-reference.exr, or STEM-matched.exr, the map and the checkpoint.
 * ABBE_INVALID_ARGUMENT for a path that is too long. */
abbe_result abbe_sweep_reference_name(const char *table, bool matched, abbe_sweep_reference *out,
                                      abbe_error *error);

/* Loads the named files, or traces them where they are not of this scene and request.
 * ABBE_CANCELLED where it was stopped: the checkpoint holds what is done. Errors of
 * abbe_sweep_fit_layout and abbe_reference_trace. */
abbe_result abbe_sweep_reference_find(abbe_context *context, const abbe_scene *scene,
                                      const abbe_sweep_reference_desc *desc,
                                      abbe_sweep_reference *reference, abbe_error *error);

/* Files that the user names (either may be NULL, and is then not there); *light is the light of the
 * scene whose map it is. */
abbe_result abbe_sweep_reference_load(const abbe_scene *scene, const char *picture, const char *map,
                                      abbe_sweep_reference *out, size_t *light, abbe_error *error);
void abbe_sweep_reference_free(abbe_sweep_reference *reference);

#endif
