/* shaft_grid.h: light in media, for camera's rays that come to it bent or mirrored: of each a grid
 * over its box, of what is scattered there, and of light's mean direction. It is as fine as its
 * cells. Internal to gl/.
 */
#ifndef ABBE_GL_BEAMS_SHAFT_GRID_H
#define ABBE_GL_BEAMS_SHAFT_GRID_H

#include "gl/beams/beam_list.h"

/* Of one medium. */
typedef struct abbe_shaft_volume {
  const struct abbe_shaft_grid *grid;
  abbe_beam_list beams;
  GLuint sums; /* buffer of cells */
  size_t cells[3];
  size_t first_layer;     /* of twice as many as there are cells up */
  double low[3], high[3]; /* m */
  double unit;            /* of sums, W */
} abbe_shaft_volume;

/* Zeroed: the plan has no shafts. Not to be copied. */
typedef struct abbe_shaft_grid {
  const abbe_gpu_scene *scene;
  GLuint add, resolve; /* programs */
  GLuint texture;      /* array of all media's layers */
  size_t size[2], layers;
  abbe_shaft_volume volume[ABBE_PLAN_MOST_SHAFTS]; /* as the plan's */
} abbe_shaft_grid;

/* Of a plan that has shafts. ABBE_GL, ABBE_NO_MEMORY. */
abbe_result abbe_shaft_grid_make(abbe_caustics *caustics, const abbe_shader_variant *variant,
                                 abbe_shaft_grid *out, abbe_error *error);
void abbe_shaft_grid_free(abbe_shaft_grid *grid);
/* Follows the photons once more, also for `with` (NULL: none). Light layers are drawn by then. */
abbe_result abbe_shaft_grid_run(abbe_shaft_grid *grid, const abbe_beam_use *with,
                                abbe_error *error);
/* For a program that is in use. */
void abbe_shaft_grid_set(const abbe_shaft_grid *grid, GLuint program);

#endif
