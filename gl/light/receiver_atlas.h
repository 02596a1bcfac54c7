/* receiver_atlas.h: which lights have pages, maps on receivers beside their own map, and where; the
 * tables that tell shaders. Internal to gl/.
 */
#ifndef ABBE_GL_LIGHT_RECEIVER_ATLAS_H
#define ABBE_GL_LIGHT_RECEIVER_ATLAS_H

#include "gl/light/photon_lights.h"
#include "gl/scene/receiver_pages.h"
#include "gl/scene/shader_variant.h"

#include <stdbool.h>
#include <stddef.h>

/* Rows of each page, where pages are found; of charts: to their coordinates, and which side of one
 * each face is. */
enum { ABBE_PAGE_ROWS, ABBE_PAGE_INDEX, ABBE_CHART_ROWS, ABBE_SIDE_OF_FACE, ABBE_PAGE_TABLES };

typedef struct abbe_receiver_atlas {
  const abbe_photon_lights *views;
  bool used; /* some light has pages, or they are yet to be chosen */
  bool fits; /* they are yet to be chosen */
  abbe_receiver_pages pages[ABBE_SCENE_MAX_LIGHTS];
  size_t layer[ABBE_SCENE_MAX_LIGHTS]; /* of the map, where the light has pages */
  GLuint table[ABBE_PAGE_TABLES], texture[ABBE_PAGE_TABLES];
} abbe_receiver_atlas;

/* Without pages yet; where the plan asks for some, shaders of this variant can choose them. */
abbe_result abbe_receiver_atlas_make(const abbe_photon_lights *views, abbe_shader_variant *variant,
                                     abbe_receiver_atlas *out, abbe_error *error);
void abbe_receiver_atlas_free(abbe_receiver_atlas *atlas);
void abbe_receiver_atlas_bind(const abbe_receiver_atlas *atlas);

/* Sorts a batch of hits in as long as the pages are yet to be chosen, fluxes in whole parts; light:
 * of both sides of each chart, made where it is NULL. */
abbe_result abbe_receiver_atlas_sort(const abbe_receiver_atlas *atlas, const float *hit,
                                     const GLuint *path, size_t count, double part,
                                     abbe_page_light **light, abbe_error *error);
/* What lands on charts beside `held`, what lands in the map: sets the light's pages.
 * ABBE_UNSUPPORTED where they leave out more than --share allows, with the receiver's name. */
abbe_result abbe_receiver_atlas_choose(abbe_receiver_atlas *atlas, size_t light,
                                       abbe_page_light *const *found, double held,
                                       abbe_error *error);
/* All lights' pages are chosen: their tables, or a variant without. */
abbe_result abbe_receiver_atlas_keep(abbe_receiver_atlas *atlas, abbe_shader_variant *variant,
                                     abbe_error *error);

/* Of hits as the device keeps them, ABBE_HIT_BYTES each, places and fluxes side by side; those on
 * pages come to texels and the page's number. `words` of a signature. */
void abbe_receiver_atlas_place(const abbe_receiver_atlas *atlas, size_t light, float *hit,
                               const GLuint *signature, size_t words, size_t count);
/* Whether a hit of that path lies on a page. */
bool abbe_receiver_atlas_holds(const abbe_receiver_atlas *atlas, GLuint path);
/* Where such a hit lies, m; of a mesh, on the rectangle that bounds its chart. */
void abbe_receiver_atlas_world(const abbe_receiver_atlas *atlas, size_t light, const float *hit,
                               double out[3]);
/* Layers of the map: one a light, and one for each that has pages. */
size_t abbe_receiver_atlas_layers(const abbe_receiver_atlas *atlas);

#endif
