/* local_scene.h: a scene moved and scaled to where single precision serves it.
 *
 * Shaders compute in floats, which carry seven digits of a coordinate: a gem of a decimetre, a
 * hundred kilometres from the origin, would be known to a centimetre. Where the refractors stand
 * that far away in terms of their own size, the renderer works in a copy whose origin is in their
 * middle. Where its brightest light is beyond what floats sum well, all lights are scaled by a
 * power of two. Nothing else changes; textures, materials and topology are the original's.
 * Internal to gl/.
 */
#ifndef ABBE_GL_SCENE_LOCAL_SCENE_H
#define ABBE_GL_SCENE_LOCAL_SCENE_H

#include "base/error.h"
#include "gl/plan/plan.h"
#include "scenes/scene.h"
#include "scenes/view/map_layout.h"
#include "scenes/view/view.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct abbe_local_scene {
  const abbe_scene *scene; /* the original, or the copy below */
  double origin[3];        /* world = origin + local, m; zero where nothing is moved */
  bool moved;
  bool repeated; /* lights are */
  double unit;   /* W of the world in one of the local scene: 1, or a power of two */
  abbe_scene copy;
} abbe_local_scene;

/* Moves the scene where its refractors (without any: its objects) stand more than 256 times the
 * radius of their bounds from the origin. The original outlives it; out may not be copied.
 * ABBE_NO_MEMORY. */
abbe_result abbe_local_scene_make(const abbe_scene *scene, abbe_local_scene *out,
                                  abbe_error *error);
void abbe_local_scene_free(abbe_local_scene *local);

/* Makes the brightest of lights, ambient light and background 1 to 2, where it is below 2^-40 or
 * above 2^40. ABBE_NO_MEMORY. */
abbe_result abbe_local_scene_scale_light(abbe_local_scene *local, abbe_error *error);

/* Appends copies of the scene's lights of these indices to those of the local scene, which is then
 * a copy. ABBE_NO_MEMORY. */
abbe_result abbe_local_scene_repeat_lights(abbe_local_scene *local, const size_t *of, size_t count,
                                           abbe_error *error);

/* A map's layout between the world and the local scene. */
void abbe_local_scene_from_world(const abbe_local_scene *local, abbe_view *view);
void abbe_local_scene_to_world(const abbe_local_scene *local, abbe_view *view);

/* What the scene's camera sees, and the samples of its picture. */

typedef struct abbe_camera_view {
  abbe_view view;    /* whole samples, the last of which may stand for pixels beyond the picture */
  size_t samples[2]; /* across and up; they cover the picture, and less than one of them more */
  size_t receiver_samples[2];       /* the same of receivers */
  size_t room[2], receiver_room[2]; /* texels of their targets: as many, or some more */
} abbe_camera_view;

void abbe_camera_view_fit(const abbe_scene *scene, const abbe_render_desc *desc,
                          abbe_camera_view *out);

#endif
