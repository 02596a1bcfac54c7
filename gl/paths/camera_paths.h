/* camera_paths.h: follows the camera's rays through refractors on the processor's own threads, as
 * refraction.comp does on the device where it KEEPS_SIGHTS: clear, isotropic meshes before
 * receivers that are parallelograms. Internal to gl/.
 */
#ifndef ABBE_GL_PATHS_CAMERA_PATHS_H
#define ABBE_GL_PATHS_CAMERA_PATHS_H

#include "gl/scene/gpu_scene.h"

#include <stdbool.h>

enum { ABBE_SIGHT_WORDS = 7, ABBE_SIGHT_PIXEL_WORDS = 9 }; /* sights.glsl, of one thread a pixel */

/* What refraction.comp reads besides the scene, by its names. */
typedef struct abbe_camera_paths {
  const abbe_gpu_scene *scene;
  float eye_view[24], eye_samples[2], share_limit, pixel_angle;
  int eye_bands, exits;
  bool shares_spectrum, interleaves;
  int sample_turn; /* as render_desc.h's lens_turn */
} abbe_camera_paths;

typedef struct abbe_sight_buffers {
  GLuint pixels, sights, sight_pixels;
  size_t sight_room; /* places */
} abbe_sight_buffers;

/* Follows `count` listed pixels from `first` on, which is the first of sight_pixels. Returns how
 * many places it has found; those beyond sight_room are left out. */
size_t abbe_camera_paths_follow(const abbe_camera_paths *paths, const abbe_sight_buffers *to,
                                size_t first, size_t count);

#endif
