/* light_layers.h: what each light's near view shows of the refractors: front and back faces. A pass
 * of frames that follow the light; the fit of the near views uses it too. Internal to gl/.
 */
#ifndef ABBE_GL_LIGHT_LIGHT_LAYERS_H
#define ABBE_GL_LIGHT_LIGHT_LAYERS_H

#include "gl/light/photon_lights.h"
#include "gl/scene/seen/seen_meshes.h"
#include "gl/scene/shader_variant.h"
#include "scenes/scene.h"

/* What separates a view from another one. */
typedef struct abbe_drawn_view {
  double matrix[16], from[3], forward[3];
} abbe_drawn_view;

typedef struct abbe_light_layers {
  const abbe_photon_lights *views;
  const abbe_refractor_faces *faces;
  GLuint layers, owner, depth; /* front and back of each light; whose the front is */
  size_t side;
  abbe_drawn_view drawn[ABBE_SCENE_MAX_LIGHTS]; /* view of each light; all zero: none */
} abbe_light_layers;

abbe_result abbe_light_layers_make(const abbe_photon_lights *views,
                                   const abbe_refractor_faces *faces, abbe_light_layers *out,
                                   abbe_error *error);
void abbe_light_layers_free(abbe_light_layers *layers);

/* Draws the layers of one light, then of all whose light may meet a refractor. What is there
 * already is drawn again only where passes are timed. */
abbe_result abbe_light_layers_draw(abbe_light_layers *layers, size_t light, abbe_error *error);
abbe_result abbe_light_layers_run(abbe_light_layers *layers, abbe_error *error);

/* The textures, into the program that is in use. */
void abbe_light_layers_set(const abbe_light_layers *layers, GLuint program);

/* Near views shrunk to the rays that reach a refractor, once, before photons are placed. */

typedef struct abbe_light_fit {
  abbe_photon_lights *views;
  abbe_light_layers *layers;
  GLuint program, found;
} abbe_light_fit;

/* Fits the views of all lights whose light may meet a refractor; layers are drawn for it where
 * meshes are traversed. ABBE_GL, ABBE_NO_MEMORY. */
abbe_result abbe_light_fit_run(abbe_photon_lights *views, abbe_light_layers *layers,
                               const abbe_shader_variant *variant, abbe_error *error);

#endif
