/* thesis.h: the thesis's profiles: passes of their own, from the light's layers to the picture.
 * Internal to gl/.
 */
#ifndef ABBE_GL_THESIS_THESIS_H
#define ABBE_GL_THESIS_THESIS_H

#include "colorimetry/image/image.h"
#include "gl/light/photon_start.h"
#include "gl/methods/image_space/image_view.h"
#include "gl/scene/camera_view.h"
#include "gl/scene/gpu_scene.h"
#include "gl/scene/shader_variant.h"
#include "scenes/view/map_layout.h"

#include <stdbool.h>
#include <stddef.h>

/* Indices, attenuations and colours of the thesis's wavelengths, as printed or by the CIE's
 * observer. */

/* What the thesis's seven colours sum to. */
#define ABBE_THESIS_COLOUR_SUM 3.5

typedef struct abbe_thesis_tables {
  float (*colour)[3];            /* [wavelengths] RGB, or XYZ */
  float *index, *attenuation_of; /* [wavelengths]; 1/m */
  float white[3];                /* XYZ, of all weights; by the CIE alone */
  double attenuation;            /* at 550 nm, 1/m; as printed alone */
} abbe_thesis_tables;

/* The printed seven colours, or as many as asked for along the same curve, with the same sum; cie:
 * XYZ weights, indices and attenuations of the default profile. */
abbe_result abbe_thesis_tables_make(const abbe_gpu_scene *scene, bool cie, abbe_thesis_tables *t,
                                    abbe_error *error);
void abbe_thesis_tables_free(abbe_thesis_tables *tables);

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
