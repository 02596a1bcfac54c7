/* adaptive_pass.h: receivers seen by more rays where their first samples differ most from what lies
 * between their neighbours: the mean of the rays takes the sample's place. Internal to gl/.
 */
#ifndef ABBE_GL_EYE_ADAPTIVE_PASS_H
#define ABBE_GL_EYE_ADAPTIVE_PASS_H

#include "gl/eye/receivers_pass.h"
#include "gl/eye/refraction_pass.h"

typedef struct abbe_adaptive_pass {
  const abbe_receivers_pass *receivers;
  const abbe_refraction_pass *refraction;
  GLuint list, resample; /* programs; 0: the plan has no such pass */
  GLuint samples;        /* list */
} abbe_adaptive_pass;

/* Reads where refractors are seen and writes what receivers show. ABBE_GL, ABBE_NO_MEMORY. */
abbe_result abbe_adaptive_pass_make(const abbe_receivers_pass *receivers,
                                    const abbe_refraction_pass *refraction,
                                    const abbe_shader_variant *variant, abbe_adaptive_pass *out,
                                    abbe_error *error);
void abbe_adaptive_pass_free(abbe_adaptive_pass *pass);
/* After the receivers and the refractors' faces, before what these show. ABBE_CANCELLED, ABBE_GL.
 */
abbe_result abbe_adaptive_pass_run(abbe_adaptive_pass *pass, abbe_error *error);

#endif
