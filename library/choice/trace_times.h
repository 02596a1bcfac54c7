/* trace_times.h: the tracer's picture by so many passes, and how long that takes once the scene
 * stands.
 *
 * What is made once for a scene (geometry, tables, where lights aim) is not in the times, as what a
 * renderer prepares is not. It compares nothing but the picture with its own first half.
 */
#ifndef ABBE_LIBRARY_CHOICE_TRACE_TIMES_H
#define ABBE_LIBRARY_CHOICE_TRACE_TIMES_H

#include "colorimetry/image/image.h"
#include "scenes/scene.h"
#include "validation/trace/transport/physics.h"

#include <stdbool.h>

/* The seed of all pictures that are timed; references have other noise. */
#define ABBE_TRACE_TIMES_SEED 20261u

typedef struct abbe_trace_times_desc {
  size_t passes;                             /* at least 1, with the filter 2 */
  size_t photons;                            /* a side: a pass has photons x photons of them */
  bool filtered;                             /* by abbe_denoise_picture */
  size_t width, height;                      /* pixels; 0: the scene's */
  size_t frames;                             /* behind the median; 0: 5 */
  double enough_ms;                          /* three frames suffice where they took more; 0: all */
  bool (*progress)(void *user, double done); /* false stops; or NULL */
  void *user;
} abbe_trace_times_desc;

typedef struct abbe_trace_times {
  double frame_ms, fastest_ms, light_ms, eye_ms; /* of the median frame, and the least */
  /* Of an even number of passes that are not filtered, else NaN: how noisy the picture is beside
   * another scene's. The mean CIEDE2000 between it and the mean of the first half of its passes, in
   * its caustic and nine pixels around. What presets are told by; of rare bright specks it is far
   * less than the error, which pass_error.h tells. NaN where nothing is lit through refractors. */
  double own_de;
} abbe_trace_times;

/* picture may be NULL. ABBE_INVALID_ARGUMENT for too few passes or photons; ABBE_CANCELLED; errors
 * of abbe_tracer_make and abbe_tracer_pass. */
abbe_result abbe_trace_times_measure(const abbe_scene *scene, const abbe_trace_times_desc *desc,
                                     abbe_trace_times *out, abbe_image *picture, abbe_error *error);

/* A number that tells whether two measurements saw one scene: of all that light meets, camera,
 * lights, meshes, surfaces and materials. */
unsigned long long abbe_scene_hash(const abbe_scene *scene);

/* What the tracer has to leave out to model what the renderer's plan does, and no more: the physics
 * of the default profile over that range of wavelengths (0, 0: the default one). Errors of
 * abbe_plan_make. */
abbe_result abbe_matched_physics(const abbe_scene *scene, double min_nm, double max_nm,
                                 abbe_physics *out, abbe_error *error);

#endif
