/* shaft_grid.h: light in the medium of a refractor, for camera's rays that come to it bent or
 * mirrored: a grid over its box of the light that passes, and of its mean direction. It is as fine
 * as its cells. Internal to gl/.
 */
#ifndef ABBE_GL_BEAMS_SHAFT_GRID_H
#define ABBE_GL_BEAMS_SHAFT_GRID_H

#include "gl/beams/beam_list.h"

/* Zeroed: the plan has no shafts. */
typedef struct abbe_shaft_grid {
  const abbe_gpu_scene *scene;
  abbe_beam_list beams;
  GLuint add, resolve;  /* programs */
  GLuint sums, texture; /* buffer of cells; array of twice as many layers as there are cells up */
  size_t cells[3];
  double low[3], high[3]; /* m */
  double unit;            /* of sums, W m */
} abbe_shaft_grid;

/* Of a plan that has shafts. ABBE_GL, ABBE_NO_MEMORY. */
abbe_result abbe_shaft_grid_make(abbe_caustics *caustics, const abbe_shader_variant *variant,
                                 abbe_shaft_grid *out, abbe_error *error);
void abbe_shaft_grid_free(abbe_shaft_grid *grid);
/* Follows the photons once more. Light layers are drawn by then. */
abbe_result abbe_shaft_grid_run(abbe_shaft_grid *grid, abbe_error *error);
/* For a program that is in use. */
void abbe_shaft_grid_set(const abbe_shaft_grid *grid, GLuint program);

#endif
