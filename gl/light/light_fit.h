/* light_fit.h: near views shrunk to the rays that reach a refractor, once, before photons are
 * placed. Internal to gl/.
 */
#ifndef ABBE_GL_LIGHT_LIGHT_FIT_H
#define ABBE_GL_LIGHT_LIGHT_FIT_H

#include "gl/light/light_layers.h"
#include "gl/scene/shader_variant.h"

typedef struct abbe_light_fit {
  abbe_photon_lights *views;
  abbe_light_layers *layers;
  GLuint program, found;
} abbe_light_fit;

/* Of all lights whose light may meet a refractor; layers are drawn for it where meshes are
 * traversed. ABBE_GL, ABBE_NO_MEMORY. */
abbe_result abbe_light_fit_run(abbe_photon_lights *views, abbe_light_layers *layers,
                               const abbe_shader_variant *variant, abbe_error *error);

#endif
