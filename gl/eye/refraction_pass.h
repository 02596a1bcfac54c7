/* refraction_pass.h: refractors as the camera sees them: front faces, then a path a pixel and band
 * through them to what is behind. Internal to gl/.
 */
#ifndef ABBE_GL_EYE_REFRACTION_PASS_H
#define ABBE_GL_EYE_REFRACTION_PASS_H

#include "gl/eye/lighting.h"
#include "gl/eye/receivers_pass.h"
#include "gl/scene/refractor_faces.h"
#include "gl/scene/shader_variant.h"

#include <stdbool.h>

typedef struct abbe_refraction_pass {
  const abbe_lighting *lighting;
  const abbe_refractor_faces *faces;
  const abbe_receivers_pass *receivers;
  GLuint list, refract, refract_refined; /* programs */
  GLuint layers, owner, depth;           /* front, and back where meshes end at it */
  GLuint colour; /* where samples are resolved; else refractors are written over receivers */
  GLuint pixels, refined_pixels; /* lists */
  size_t pixel_threads;          /* threads of a pixel */
} abbe_refraction_pass;

/* Of a plan whose camera sees no refractor it has only the picture that is resolved. */
abbe_result abbe_refraction_pass_make(const abbe_lighting *lighting,
                                      const abbe_refractor_faces *faces,
                                      const abbe_receivers_pass *receivers,
                                      const abbe_shader_variant *variant, abbe_refraction_pass *out,
                                      abbe_error *error);
void abbe_refraction_pass_free(abbe_refraction_pass *pass);
/* The faces as the camera sees them first: layers and owners. ABBE_GL. */
abbe_result abbe_refraction_pass_draw(abbe_refraction_pass *pass, abbe_error *error);
/* What they show. Tells who watches from a half to the whole. ABBE_CANCELLED, ABBE_GL. */
abbe_result abbe_refraction_pass_run(abbe_refraction_pass *pass, abbe_error *error);

#endif
