/* haze_pass.h: participating media over the finished picture: what they leave of what the camera
 * sees, the light that lights send straight to the camera's path, and beams of the light that
 * refractors and mirrors throw. Scattered once, along the camera's own ray up to the first surface;
 * what is behind it or mirrored in it is in the picture by then (eye/refraction.comp). Internal to
 * gl/. */
#ifndef ABBE_GL_HAZE_HAZE_PASS_H
#define ABBE_GL_HAZE_HAZE_PASS_H

#include "gl/beams/beam_list.h"
#include "gl/eye/picture.h"

/* Zeroed: there is no haze. */
typedef struct abbe_haze_pass {
  abbe_picture *picture;
  abbe_caustics *caustics;                  /* NULL: no light meets a refractor */
  GLuint over, shine, draw_beams, occluder; /* programs */
  GLuint scattered, depth;                  /* textures of the picture's pixels */
  abbe_beam_list beams;
  bool begun; /* another pass has had beams drawn */
} abbe_haze_pass;

/* Nothing where the plan has no haze. ABBE_GL, ABBE_NO_MEMORY, errors of abbe_weights_make_by. */
abbe_result abbe_haze_pass_make(abbe_picture *picture, abbe_caustics *caustics,
                                const abbe_shader_variant *variant, abbe_haze_pass *out,
                                abbe_error *error);
void abbe_haze_pass_free(abbe_haze_pass *pass);

/* Begins a pass with caustics: for a caller that follows photons for beams anyway, before the
 * picture is drawn; *draws is to be among what abbe_beam_list_run is given. ABBE_GL. */
abbe_result abbe_haze_pass_begin(abbe_haze_pass *pass, abbe_beam_use *draws, abbe_error *error);
/* Over the picture that is drawn by then. Follows the photons once more, where nobody has begun. */
abbe_result abbe_haze_pass_run(abbe_haze_pass *pass, abbe_error *error);

#endif
