/* thesis.h: the thesis's profiles: passes of their own, from the light's layers to the picture.
 * Internal to gl/.
 */
#ifndef ABBE_GL_THESIS_THESIS_H
#define ABBE_GL_THESIS_THESIS_H

#include "colorimetry/image/image.h"
#include "gl/image_space/image_view.h"
#include "gl/light/photon_start.h"
#include "gl/scene/camera_view.h"
#include "gl/scene/shader_variant.h"
#include "gl/thesis/thesis_tables.h"
#include "scenes/view/map_layout.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct abbe_thesis {
  const abbe_gpu_scene *scene;
  abbe_camera_view camera;
  abbe_map_layout layout; /* of the light's one frustum */
  abbe_photon_cells cells;
  size_t photon_count; /* of the last frame with statistics */
  GLuint layers, depth_only, splat, fill, receivers, refraction;
  GLuint light_normals, light_depths, light_receiver_depth, map, filled;
  GLuint eye_normals, eye_depths, eye_receiver_depth, eye_receivers, picture;
  abbe_image_view light, eye;
  abbe_thesis_tables tables;
  bool cie;
} abbe_thesis;

abbe_result abbe_thesis_make(const abbe_gpu_scene *scene, const abbe_shader_variant *variant,
                             abbe_thesis *out, abbe_error *error);
void abbe_thesis_free(abbe_thesis *thesis);
/* A frame, all passes. ABBE_GL. */
abbe_result abbe_thesis_run(abbe_thesis *thesis, abbe_error *error);

/* The picture; the light's map, before or after the fill. As of abbe_renderer_read and _read_map.
 */
abbe_result abbe_thesis_read(const abbe_thesis *thesis, abbe_image *out, abbe_error *error);
abbe_result abbe_thesis_read_map(const abbe_thesis *thesis, bool filled, abbe_image *out,
                                 abbe_error *error);

#endif
