/* shah2007.h: caustics mapping as it was published, and in units: passes of their own, from the
 * light's places to the picture. Internal to gl/.
 */
#ifndef ABBE_GL_SHAH2007_SHAH2007_H
#define ABBE_GL_SHAH2007_SHAH2007_H

#include "colorimetry/image/image.h"
#include "gl/methods/image_space/image_eye.h"
#include "gl/methods/image_space/image_places.h"
#include "scenes/view/map_layout.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct abbe_shah2007 {
  const abbe_gpu_scene *scene;
  abbe_map_layout layout; /* of the light's one frustum; of a cube, its first face's */
  abbe_image_places light;
  abbe_image_eye eye;
  GLuint splat, low_pass; /* programs */
  GLuint map, smoothed;   /* arrays of a cube's faces; smoothed: where the map is filtered */
  float (*colour)[3];     /* [wavelengths] XYZ, or RGB as printed; of unit light */
  size_t photon_count;    /* of the last frame: pixels that show objects */
} abbe_shah2007;

abbe_result abbe_shah2007_make(const abbe_gpu_scene *scene, const abbe_shader_variant *variant,
                               abbe_shah2007 *out, abbe_error *error);
void abbe_shah2007_free(abbe_shah2007 *shah);
/* A frame; lit: the camera's passes alone, for the map is there. ABBE_GL. */
abbe_result abbe_shah2007_run(abbe_shah2007 *shah, bool lit, abbe_error *error);

/* As of abbe_renderer_read and _read_map; a cube's map is not read. */
abbe_result abbe_shah2007_read(const abbe_shah2007 *shah, abbe_image *out, abbe_error *error);
abbe_result abbe_shah2007_read_map(const abbe_shah2007 *shah, abbe_image *out, abbe_error *error);

#endif
