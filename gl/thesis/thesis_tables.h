/* thesis_tables.h: indices, attenuations and colours of the thesis's wavelengths, as printed or by
 * the CIE's observer. Internal to gl/.
 */
#ifndef ABBE_GL_THESIS_THESIS_TABLES_H
#define ABBE_GL_THESIS_THESIS_TABLES_H

#include "gl/scene/gpu_scene.h"

#include <stdbool.h>

/* What the thesis's seven colours sum to. */
#define ABBE_THESIS_COLOUR_SUM 3.5

typedef struct abbe_thesis_tables {
  float (*colour)[3];            /* [wavelengths] RGB, or XYZ */
  float *index, *attenuation_of; /* [wavelengths]; 1/m */
  float white[3];                /* XYZ, of all weights; by the CIE alone */
  double attenuation;            /* at 550 nm, 1/m; as printed alone */
} abbe_thesis_tables;

/* The printed seven colours, or as many as asked for along the same curve, with the same sum; cie:
 * XYZ weights, indices and attenuations of the default profile. */
abbe_result abbe_thesis_tables_make(const abbe_gpu_scene *scene, bool cie, abbe_thesis_tables *t,
                                    abbe_error *error);
void abbe_thesis_tables_free(abbe_thesis_tables *tables);

#endif
