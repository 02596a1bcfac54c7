/* wyman2006.h: photons in image space as they were published, and in units: passes of their own,
 * from the light's grid to the picture. Internal to gl/.
 */
#ifndef ABBE_GL_WYMAN2006_WYMAN2006_H
#define ABBE_GL_WYMAN2006_WYMAN2006_H

#include "colorimetry/image/image.h"
#include "gl/image_space/image_eye.h"
#include "gl/wyman2006/wyman_target.h"
#include "scenes/view/map_layout.h"

typedef struct abbe_wyman2006 {
  const abbe_gpu_scene *scene;
  abbe_map_layout layout; /* of the light's one frustum; of a cube, its first face's */
  abbe_image_places light;
  abbe_image_eye eye;
  abbe_wyman_photons photons;
  abbe_wyman_target map, picture; /* the light's image; the camera's, where photons go there */
  float (*colour)[3];             /* [wavelengths] XYZ, or RGB as printed; of unit light */
  size_t photon_count;            /* of the last frame: pixels that show objects */
} abbe_wyman2006;

abbe_result abbe_wyman2006_make(const abbe_gpu_scene *scene, const abbe_shader_variant *variant,
                                abbe_wyman2006 *out, abbe_error *error);
void abbe_wyman2006_free(abbe_wyman2006 *wyman);
/* Whether a camera that moves leaves what the light's passes make as it is: the light's image, or
 * with one wavelength and view the buffer of photons that go to the camera's; where it holds no
 * frames before. */
bool abbe_wyman2006_keeps_light(const abbe_render_desc *desc);
/* A frame; lit: what is kept is there. ABBE_GL. */
abbe_result abbe_wyman2006_run(abbe_wyman2006 *wyman, bool lit, abbe_error *error);

/* Hands out the frames that it has drawn, before it is freed. */
void abbe_wyman2006_leave(abbe_wyman2006 *wyman, abbe_wyman_history *out);
/* Goes on with them, where images are alike; what is not needed is left in `before`. */
void abbe_wyman2006_follow(abbe_wyman2006 *wyman, abbe_wyman_history *before);

/* As of abbe_renderer_read and _read_map; the map is drawn for it where photons go to the camera.
 */
abbe_result abbe_wyman2006_read(const abbe_wyman2006 *wyman, abbe_image *out, abbe_error *error);
abbe_result abbe_wyman2006_read_map(abbe_wyman2006 *wyman, abbe_image *out, abbe_error *error);

#endif
