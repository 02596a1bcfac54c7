/* refraction_pass.h: refractors as the camera sees them: front faces, then a path a pixel and band
 * through them to what is behind. Internal to gl/.
 */
#ifndef ABBE_GL_EYE_REFRACTION_PASS_H
#define ABBE_GL_EYE_REFRACTION_PASS_H

#include "gl/eye/lighting.h"
#include "gl/eye/receivers_pass.h"
#include "gl/scene/seen/seen_meshes.h"
#include "gl/scene/shader_variant.h"

#include <stdbool.h>

/* What it has found that stays as it is while the camera, the refractors and the receivers do,
 * whatever lights do: the faces as the camera sees them, and what rays through them show of
 * receivers, as places whose light is looked up anew. */
typedef struct abbe_refraction_kept {
  bool whole;                                  /* all of it is there */
  GLuint layers, owner, depth, pixels, merged; /* as below */
  GLuint colour, sights, sight_pixels;
  size_t sight_room, sight_bytes;
} abbe_refraction_kept;

typedef struct abbe_refraction_pass {
  const abbe_lighting *lighting;
  const abbe_refractor_faces *faces;
  const abbe_receivers_pass *receivers;
  GLuint list, refract, refract_refined; /* programs */
  GLuint layers, owner, depth;           /* front, and back where meshes end at it */
  GLuint colour; /* where samples are resolved; else refractors are written over receivers */
  GLuint shown;  /* then: what receivers show, for rays to look up */
  GLuint pixels, refined_pixels; /* lists */
  GLuint merged;        /* list of pixels, where receivers have one sample for all of a pixel's */
  size_t pixel_threads; /* threads of a pixel */
  bool here;            /* paths are followed by the processor's own threads */
  size_t eye_bands;     /* bands of a pixel, at the most */
  bool keeps;           /* places of receivers: */
  GLuint look_up;       /* program */
  GLuint sights, sight_pixels;
  size_t sight_room; /* places; bytes of the other */
  size_t sight_bytes;
  bool whole; /* they are found, and so are the faces and lists */
} abbe_refraction_pass;

/* For a plan whose camera sees no refractor it has only the picture that is resolved. What *kept
 * holds is taken over, and *kept becomes zero. */
abbe_result
abbe_refraction_pass_make(const abbe_lighting *lighting, const abbe_refractor_faces *faces,
                          const abbe_receivers_pass *receivers, const abbe_shader_variant *variant,
                          abbe_refraction_kept *kept, abbe_refraction_pass *out, abbe_error *error);
/* Leaves what can be kept to *out, which is zero; its owner drops it. */
void abbe_refraction_pass_leave(abbe_refraction_pass *pass, abbe_refraction_kept *out);
void abbe_refraction_kept_free(abbe_gpu *gpu, abbe_refraction_kept *kept);
void abbe_refraction_pass_free(abbe_refraction_pass *pass);
/* The faces as the camera sees them first: layers and owners. ABBE_GL. */
abbe_result abbe_refraction_pass_draw(abbe_refraction_pass *pass, abbe_error *error);
/* What they show. Reports progress from a half to the whole. ABBE_CANCELLED, ABBE_GL. */
abbe_result abbe_refraction_pass_run(abbe_refraction_pass *pass, abbe_error *error);

#endif
