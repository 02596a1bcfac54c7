/* volume_pages.h: caustics of rays that leave an object as maps on receivers, on the device
 * (scenes/volume/exits/exit_pages.h), where all receivers are parallelograms. Internal to gl/.
 */
#ifndef ABBE_GL_VOLUME_VOLUME_PAGES_H
#define ABBE_GL_VOLUME_VOLUME_PAGES_H

#include "gl/scene/gpu_scene.h"
#include "scenes/volume/volume_body.h"

typedef struct abbe_volume_pages {
  const abbe_gpu_scene *scene; /* NULL: the plan has none */
  size_t count;                /* of a light */
  GLuint texture;              /* two layers a page: whole and window */
  float (*window)[4];          /* [lights][count] */
} abbe_volume_pages;

/* [plan's parallelogram_count and one more] of all receivers, as the shaders count them; malloc'd.
 * NULL: no memory. */
double (*abbe_volume_pages_sheets(const abbe_gpu_scene *scene))[9];

/* For the lights and the object where they are now. ABBE_GL, ABBE_NO_MEMORY. */
abbe_result abbe_volume_pages_make(const abbe_gpu_scene *scene, const abbe_volume_place *place,
                                   abbe_volume_pages *out, abbe_error *error);
void abbe_volume_pages_free(abbe_volume_pages *pages);
/* Into the program that is in use, at that unit (volume_pages.glsl). */
void abbe_volume_pages_set(const abbe_volume_pages *pages, GLuint program, int unit);

#endif
