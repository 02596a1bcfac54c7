/* photon_start.h: where photons start: cells of each light's grid that may show a refractor, coarse
 * levels first, and of those what is lit. A pass of frames that follow the light, and of the fits.
 * Internal to gl/.
 */
#ifndef ABBE_GL_LIGHT_PHOTON_START_H
#define ABBE_GL_LIGHT_PHOTON_START_H

#include "gl/light/light_layers.h"
#include "gl/scene/shader_variant.h"

enum { ABBE_CELL_LEVELS = 3, ABBE_PHOTON_HEADER = 8 * 4, ABBE_PHOTON_BYTES = 16 };

/* Cells whose place in a view some texture covers. */
typedef struct abbe_photon_cells {
  abbe_gpu *gpu;
  GLuint place, groups;          /* programs */
  GLuint list[ABBE_CELL_LEVELS]; /* last level last: its header is a dispatch's and a draw's too */
} abbe_photon_cells;

/* For grids of up to `side` cells a side. */
abbe_result abbe_photon_cells_make(abbe_gpu *gpu, size_t side, abbe_photon_cells *out,
                                   abbe_error *error);
void abbe_photon_cells_free(abbe_photon_cells *cells);
/* Lists those of a grid that the layer of the texture covers: its alpha is above 0. */
abbe_result abbe_photon_cells_run(abbe_photon_cells *cells, const size_t grid[2], GLuint coverage,
                                  int layer, abbe_error *error);

/* Photon of photons.glsl. */
typedef struct abbe_photon {
  uint32_t cell;
  float flux;
  uint32_t offset, extent;
} abbe_photon;

typedef struct abbe_photon_start {
  const abbe_photon_lights *views;
  const abbe_light_layers *layers;
  abbe_photon_cells cells;
  GLuint cover;                   /* program */
  GLuint photons, photon_of_cell; /* + 1; 0: none */
} abbe_photon_start;

abbe_result abbe_photon_start_make(const abbe_photon_lights *views, const abbe_light_layers *layers,
                                   const abbe_shader_variant *variant, abbe_photon_start *out,
                                   abbe_error *error);
void abbe_photon_start_free(abbe_photon_start *start);

/* A photon for each cell of the light's grid that is lit and shows a refractor, in some part. */
abbe_result abbe_photon_start_run(abbe_photon_start *start, size_t light, abbe_error *error);
void abbe_photon_start_bind(const abbe_photon_start *start);
/* Waits for the device: how many there are now. */
size_t abbe_photon_start_count(const abbe_photon_start *start);

#endif
