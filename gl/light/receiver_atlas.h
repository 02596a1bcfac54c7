/* receiver_atlas.h: which lights have tiles, maps on receivers beside their own map, and where; the
 * tables for shaders. Internal to gl/.
 */
#ifndef ABBE_GL_LIGHT_RECEIVER_ATLAS_H
#define ABBE_GL_LIGHT_RECEIVER_ATLAS_H

#include "gl/light/photon_lights.h"
#include "gl/scene/receiver_tiles.h"
#include "gl/scene/shader_variant.h"

#include <stdbool.h>
#include <stddef.h>

/* Rows of each tile, where tiles are found; of charts: to their coordinates, and which side of one
 * each face is. */
enum { ABBE_TILE_ROWS, ABBE_TILE_INDEX, ABBE_CHART_ROWS, ABBE_SIDE_OF_FACE, ABBE_TILE_TABLES };

typedef struct abbe_receiver_atlas {
  const abbe_photon_lights *views;
  bool used; /* some light has tiles, or they are yet to be chosen */
  bool fits; /* they are yet to be chosen */
  abbe_receiver_tiles tiles[ABBE_SCENE_MAX_LIGHTS];
  size_t layer[ABBE_SCENE_MAX_LIGHTS]; /* layer of the map, where the light has tiles */
  GLuint table[ABBE_TILE_TABLES], texture[ABBE_TILE_TABLES];
} abbe_receiver_atlas;

/* Without tiles yet; where the plan needs some, shaders of this variant can choose them. */
abbe_result abbe_receiver_atlas_make(const abbe_photon_lights *views, abbe_shader_variant *variant,
                                     abbe_receiver_atlas *out, abbe_error *error);
void abbe_receiver_atlas_free(abbe_receiver_atlas *atlas);
void abbe_receiver_atlas_bind(const abbe_receiver_atlas *atlas);

/* Sorts a batch of hits in as long as the tiles are yet to be chosen, fluxes in whole parts; light:
 * of both sides of each chart, made where it is NULL. */
abbe_result abbe_receiver_atlas_sort(const abbe_receiver_atlas *atlas, const float *hit,
                                     const GLuint *path, size_t count, double part,
                                     abbe_tile_light **light, abbe_error *error);
/* What lands on charts beside `held`, what lands in the map: sets the light's tiles.
 * ABBE_UNSUPPORTED where they leave out more than --share allows, with the receiver's name. */
abbe_result abbe_receiver_atlas_choose(abbe_receiver_atlas *atlas, size_t light,
                                       abbe_tile_light *const *found, double held,
                                       abbe_error *error);
/* All lights' tiles are chosen: their tables, or a variant without. */
abbe_result abbe_receiver_atlas_keep(abbe_receiver_atlas *atlas, abbe_shader_variant *variant,
                                     abbe_error *error);

/* Places hits as the device keeps them, ABBE_HIT_BYTES each, places and fluxes side by side; those
 * on tiles come to texels and the tile's number. `words` of a signature. */
void abbe_receiver_atlas_place(const abbe_receiver_atlas *atlas, size_t light, float *hit,
                               const GLuint *signature, size_t words, size_t count);
/* Whether a hit of that path lies on a tile. */
bool abbe_receiver_atlas_holds(const abbe_receiver_atlas *atlas, GLuint path);
/* Where such a hit lies, m; of a mesh, on the rectangle that bounds its chart. */
void abbe_receiver_atlas_world(const abbe_receiver_atlas *atlas, size_t light, const float *hit,
                               double out[3]);
/* Layers of the map: one a light, and one for each that has tiles. */
size_t abbe_receiver_atlas_layers(const abbe_receiver_atlas *atlas);

/* Where a photon meets a receiver, as shaders keep it (outgoing_segment.glsl): place and flux in
 * four floats, then the interface that the light left. */

enum { ABBE_HIT_BYTES = 32 };

#endif
