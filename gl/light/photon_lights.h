/* photon_lights.h: how each light looks: the near view of its photons and their grid, the map
 * around receivers; and their tables for shaders. A light with a cube has a view a face.
 * Internal to gl/.
 */
#ifndef ABBE_GL_LIGHT_PHOTON_LIGHTS_H
#define ABBE_GL_LIGHT_PHOTON_LIGHTS_H

#include "gl/scene/gpu_scene.h"
#include "scenes/view/map_layout.h"
#include "scenes/view/view.h"

#include <stdbool.h>
#include <stddef.h>

enum { ABBE_WARP_STEPS = ABBE_MAP_LAYOUT_STEPS };

typedef struct abbe_photon_light {
  abbe_view near_view;
  abbe_map_layout map;
  size_t cells[2];     /* cells of the photon grid, across and up */
  double unshifted[4]; /* the near view's window before its grid was shifted */
  size_t photon_count;
  double cell_flux;  /* most that one photon cell can carry, of unit power of the light */
  double white_peak; /* largest of X, Y, Z of the light's white, by its Y */
} abbe_photon_light;

typedef struct abbe_photon_lights {
  const abbe_gpu_scene *scene;
  abbe_photon_light light[ABBE_SCENE_MAX_LIGHTS];
  GLuint lights, warps, warp_texels, texel_sizes;
  size_t map_levels, map_texels; /* halved as long as sides are even; texels of all levels */
  bool wide;                     /* the map's sums have 64 bits, else 32 */
} abbe_photon_lights;

/* Fits every view to the scene: near views tight around the refractors, maps around all receivers
 * or as the request gives them; makes the tables. Not of the thesis's light, which fits its own. */
abbe_result abbe_photon_lights_make(const abbe_gpu_scene *scene, abbe_photon_lights *out,
                                    abbe_error *error);
void abbe_photon_lights_free(abbe_photon_lights *views);
/* Writes the tables anew: after any change of a view, of cells or of what is reached. */
void abbe_photon_lights_upload(abbe_photon_lights *views);
/* Cells a side, at most: the plan's, or so many fewer that all points of a light with a size have
 * as many together. */
size_t abbe_photon_lights_photons(const abbe_gpu_scene *scene, size_t light);
void abbe_photon_lights_bind(const abbe_photon_lights *views);

/* From the light to the refractors, or through its face of the cube; no window is set. */
void abbe_photon_light_look(const abbe_gpu_scene *scene, size_t light, abbe_view *out);

/* Whether the request gives the layout of this light's map. */
bool abbe_photon_lights_map_is_given(const abbe_photon_lights *views, size_t light);
/* Whether the light looks through one face of a cube, and shares its power with the others. */
bool abbe_photon_lights_is_face(const abbe_photon_lights *views, size_t light);
/* A light's map around all receivers, before it is fitted to the photons' hits. */
void abbe_photon_lights_whole_map(const abbe_photon_lights *views, size_t light,
                                  abbe_map_layout *out);
/* The layout with the range of this scene's receivers; `out` is of the light. */
void abbe_photon_lights_take_layout(const abbe_photon_lights *views, const abbe_map_layout *given,
                                    abbe_map_layout *out);
/* Moves the photon grid by this part of a cell from where `unshifted` has it; what is lit stays in
 * the window. */
void abbe_photon_lights_shift_cells(abbe_photon_lights *views, size_t light, const double shift[2]);
void abbe_photon_lights_set_grid(const abbe_photon_lights *views, GLuint program, size_t light);

/* Flux of one unit of a light's map sums, of unit power of the light: what photons carry and maps
 * hold is, so that a light may be dimmed without tracing it again. */
double abbe_photon_lights_map_unit(const abbe_photon_lights *views, size_t light);
/* 32-bit words of a map texel's sums. */
size_t abbe_photon_lights_map_words(const abbe_photon_lights *views);

#endif
