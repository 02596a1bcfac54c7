/* transports.h: how caustics come to receivers other than by photons: looked up in a caustic
 * volume, or shown through samples of mirrors and refractors as pinholes. Whichever the plan
 * chooses is made, run and set; without one nothing is done. Internal to gl/.
 */
#ifndef ABBE_GL_METHODS_TRANSPORTS_TRANSPORTS_H
#define ABBE_GL_METHODS_TRANSPORTS_TRANSPORTS_H

#include "gl/methods/pinholes/pinhole_pages.h"
#include "gl/methods/volume/volume_light.h"

typedef struct abbe_transports {
  abbe_volume_light volume;
  abbe_pinhole_pages pinholes;
} abbe_transports;

/* Where pinholes' pages are there, they stay. Errors of the parts. */
abbe_result abbe_transports_make(const abbe_gpu_scene *scene, const abbe_shader_variant *variant,
                                 abbe_transports *out, abbe_error *error);
/* A zeroed one too; pages_stay: of pinholes. */
void abbe_transports_free(abbe_transports *transports, bool pages_stay);
/* Runs what is not drawn yet of the light's passes. ABBE_GL, ABBE_CANCELLED. */
abbe_result abbe_transports_run(abbe_transports *transports, abbe_error *error);
/* Bound, and set in the program that is in use. */
void abbe_transports_set(const abbe_transports *transports, GLuint program);
/* The next run draws all anew. */
void abbe_transports_redraw(abbe_transports *transports);

#endif
