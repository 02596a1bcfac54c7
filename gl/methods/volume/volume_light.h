/* volume_light.h: caustics that were computed beforehand, on the device: the values of the nodes
 * that lights are looked up at, and what a shader needs to look there. Nothing is traced.
 * Internal to gl/.
 */
#ifndef ABBE_GL_VOLUME_VOLUME_LIGHT_H
#define ABBE_GL_VOLUME_VOLUME_LIGHT_H

#include "gl/scene/gpu_scene.h"
#include "scenes/volume/volume_body.h"

/* Caustics of rays that leave an object as maps on receivers, on the device
 * (scenes/volume/exits/exit_pages.h), where all receivers are parallelograms. */

typedef struct abbe_volume_pages {
  const abbe_gpu_scene *scene; /* NULL: the plan has none */
  size_t count;                /* for a light */
  GLuint texture;              /* two layers a tile: whole and window */
  float (*window)[4];          /* [lights][count] */
} abbe_volume_pages;

/* [plan's parallelogram_count and one more] of all receivers, as the shaders count them; malloc'd.
 * NULL: no memory. */
double (*abbe_volume_pages_sheets(const abbe_gpu_scene *scene))[9];

enum { ABBE_VOLUME_LIGHT_SIGHTS = 3 * ABBE_SCENE_MAX_LIGHTS };

typedef struct abbe_volume_light {
  const abbe_gpu_scene *scene; /* NULL: the plan has no volume */
  abbe_volume_pages pages;     /* for rays: in place of cells */
  GLuint cells;                /* values of each light's nodes, then the table of directions */
  float centre[3];
  float turn[ABBE_VOLUME_LIGHT_SIGHTS][9]; /* turns of places into a node's light, column-major */
  float weight[ABBE_VOLUME_LIGHT_SIGHTS];  /* 0: there is no such node */
  float strength[ABBE_SCENE_MAX_LIGHTS];   /* irradiance of unit power at the centre */
} abbe_volume_light;

/* For the lights and the object where they are now; values are handed over for their nodes alone.
 * ABBE_GL, ABBE_NO_MEMORY, errors of abbe_volume_body_find. */
abbe_result abbe_volume_light_make(const abbe_gpu_scene *scene, abbe_volume_light *out,
                                   abbe_error *error);
void abbe_volume_light_free(abbe_volume_light *volume);
/* Bound, and set in the program that is in use; without a volume nothing is done. */
void abbe_volume_light_set(const abbe_volume_light *volume, GLuint program);

#endif
