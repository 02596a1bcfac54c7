/* receivers_pass.h: receivers as the camera sees them straight, lit by lights and by the spectral
 * map. Internal to gl/.
 */
#ifndef ABBE_GL_EYE_RECEIVERS_PASS_H
#define ABBE_GL_EYE_RECEIVERS_PASS_H

#include "gl/eye/lighting.h"
#include "gl/scene/shader_variant.h"

#include <stddef.h>

/* Part of the picture: samples of a receiver that light may reach. */
typedef struct abbe_lit_part {
  size_t receiver;
  int rect[4]; /* left, bottom, right, top; the ends excluded */
} abbe_lit_part;

typedef struct abbe_receivers_pass {
  const abbe_lighting *lighting;
  GLuint surroundings;            /* program; 0: nothing is around the scene */
  GLuint lit, unlit;              /* programs; unlit: 0 where most of the picture may be lit */
  GLuint rays;                    /* program in place of both; 0: they are drawn */
  GLuint area_lights;             /* program; 0: there are none, or rays meet them */
  GLuint colour, direct, caustic; /* an array of one layer: radiance, distance; by request */
  GLuint depth;
  abbe_lit_part *part;
  size_t part_count;
} abbe_receivers_pass;

/* ABBE_UNSUPPORTED for a picture larger than this OpenGL draws. */
abbe_result abbe_receivers_pass_make(const abbe_lighting *lighting,
                                     const abbe_shader_variant *variant, abbe_receivers_pass *out,
                                     abbe_error *error);
void abbe_receivers_pass_free(abbe_receivers_pass *pass);
abbe_result abbe_receivers_pass_run(abbe_receivers_pass *pass, abbe_error *error);

#endif
