/* wyman_photons.h: a photon a pixel of the light's grid, one wavelength and one view at a time:
 * where it meets its first diffuse surface, from where, and how much of it. Internal to gl/.
 */
#ifndef ABBE_GL_WYMAN2006_WYMAN_PHOTONS_H
#define ABBE_GL_WYMAN2006_WYMAN_PHOTONS_H

#include "gl/image_space/image_places.h"

typedef struct abbe_wyman_photons {
  const abbe_gpu_scene *scene;
  const abbe_image_places *light;
  double background[4]; /* the plane that mirrors send light to, as printed: n . x = w */
  GLuint program;
  GLuint places, incident; /* of the wavelength that was run last; wyman_photons.frag */
} abbe_wyman_photons;

/* definitions: of image_tables.h. */
abbe_result abbe_wyman_photons_make(const abbe_gpu_scene *scene, const abbe_image_places *light,
                                    const abbe_shader_variant *variant, const char *definitions,
                                    abbe_wyman_photons *out, abbe_error *error);
void abbe_wyman_photons_free(abbe_wyman_photons *photons);
/* The light's places are drawn by then; face: of its views of objects. ABBE_GL. */
abbe_result abbe_wyman_photons_run(const abbe_wyman_photons *photons, size_t wavelength,
                                   size_t face, abbe_error *error);

#endif
