/* wand2003.h: caustics of surroundings as they were published: each pixel of a receiver sees the
 * surroundings through samples of the mirrors. Internal to gl/.
 */
#ifndef ABBE_GL_WAND2003_WAND2003_H
#define ABBE_GL_WAND2003_WAND2003_H

#include "colorimetry/image/image.h"
#include "gl/methods/image_space/image_view.h"
#include "gl/methods/pinholes/pinhole_samples.h"
#include "gl/scene/camera_view.h"
#include "gl/scene/shader_variant.h"
#include "scenes/view/map_layout.h"

typedef struct abbe_wand2003 {
  const abbe_gpu_scene *scene;
  abbe_map_layout layout; /* of no map: there is none */
  abbe_pinhole_samples samples;
  abbe_pinhole_sky sky;
  double (*colour)[3]; /* of each mirror */
  abbe_camera_view camera;
  abbe_image_view view;
  GLuint surroundings, receivers, pinholes, mirrors; /* programs */
  GLuint picture, depth;
} abbe_wand2003;

abbe_result abbe_wand2003_make(const abbe_gpu_scene *scene, const abbe_shader_variant *variant,
                               abbe_wand2003 *out, abbe_error *error);
void abbe_wand2003_free(abbe_wand2003 *wand);
/* A frame, all passes. ABBE_GL. */
abbe_result abbe_wand2003_run(abbe_wand2003 *wand, abbe_error *error);
/* As of abbe_renderer_read. */
abbe_result abbe_wand2003_read(const abbe_wand2003 *wand, abbe_image *out, abbe_error *error);

#endif
