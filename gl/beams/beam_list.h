/* beam_list.h: beams of the light that refractors and mirrors throw: along its paths through a
 * medium, from interface to interface and beyond, as wide as neighbouring photons and wavelengths
 * stand apart. Photons are followed once more; beams are listed as they lie in a picture, or in the
 * world. It draws nothing. Internal to gl/.
 */
#ifndef ABBE_GL_BEAMS_BEAM_LIST_H
#define ABBE_GL_BEAMS_BEAM_LIST_H

#include "gl/caustics/caustics.h"
#include "gl/scene/local_scene.h"

typedef struct abbe_beam_list {
  abbe_caustics *caustics;
  const abbe_camera_view *camera; /* NULL: in the world */
  int medium;                     /* the refractor that beams are in; -1: the air */
  double cell_m;                  /* in the world: what is less than this apart is one beam */
  GLuint program;
  GLuint colours;      /* buffer: [light views][intervals][parts] x RGB of unit power */
  GLuint haze;         /* buffer: [intervals][parts] what the medium takes and scatters, 1/m */
  GLuint tints;        /* buffer: [refractors][intervals][parts] what these take, by amount */
  GLuint beams;        /* a list, with a capacity of `room` */
  size_t room, chunks; /* the photons are listed in so many chunks */
} abbe_beam_list;

/* Into the struct whose first four fields are set. ABBE_GL, ABBE_NO_MEMORY. */
abbe_result abbe_beam_list_make(const abbe_shader_variant *variant, abbe_beam_list *list,
                                abbe_error *error);
void abbe_beam_list_free(abbe_beam_list *list);

/* What is done with so many beams that are listed. */
typedef struct abbe_beam_use {
  abbe_beam_list *list;
  abbe_result (*use)(void *user, size_t beams, abbe_error *error);
  void *user;
} abbe_beam_use;

/* Follows the photons of all lights once, for so many lists of the same caustics, and has their
 * beams used, list after list. Light layers are drawn by then. ABBE_GL, ABBE_NO_MEMORY,
 * ABBE_CANCELLED. */
abbe_result abbe_beam_list_run(const abbe_beam_use *to, size_t count, abbe_error *error);

/* Light in media, for camera's rays that come to it bent or mirrored: of each a grid over its box,
 * of what is scattered there, and of light's mean direction. It is as fine as its cells. */

/* The grid of one medium. */
typedef struct abbe_shaft_volume {
  const struct abbe_shaft_grid *grid;
  abbe_beam_list beams;
  GLuint sums; /* buffer of cells */
  size_t cells[3];
  size_t first_layer;     /* first of twice as many layers as there are cells up */
  double low[3], high[3]; /* m */
  double unit;            /* unit of sums, W */
} abbe_shaft_volume;

/* Zeroed: the plan has no shafts. Not to be copied. */
typedef struct abbe_shaft_grid {
  const abbe_gpu_scene *scene;
  GLuint add, resolve; /* programs */
  GLuint texture;      /* array of all media's layers */
  size_t size[2], layers;
  abbe_shaft_volume volume[ABBE_PLAN_MOST_SHAFTS]; /* as the plan's */
} abbe_shaft_grid;

/* Makes the grid of a plan that has shafts. ABBE_GL, ABBE_NO_MEMORY. */
abbe_result abbe_shaft_grid_make(abbe_caustics *caustics, const abbe_shader_variant *variant,
                                 abbe_shaft_grid *out, abbe_error *error);
void abbe_shaft_grid_free(abbe_shaft_grid *grid);
/* Follows the photons once more, also for `with` (NULL: none). Light layers are drawn by then. */
abbe_result abbe_shaft_grid_run(abbe_shaft_grid *grid, const abbe_beam_use *with,
                                abbe_error *error);
/* For a program that is in use. */
void abbe_shaft_grid_set(const abbe_shaft_grid *grid, GLuint program);

#endif
