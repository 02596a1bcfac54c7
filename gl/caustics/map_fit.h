/* map_fit.h: windows and warps of maps by where light falls. It knows no GL. Internal to gl/.
 */
#ifndef ABBE_GL_CAUSTICS_MAP_FIT_H
#define ABBE_GL_CAUSTICS_MAP_FIT_H

#include "gl/light/receiver_atlas.h"
#include "scenes/view/map_layout.h"

#include <stddef.h>

enum { ABBE_FIT_BINS = 1 << 15 };

/* Flux by window coordinate, in whole parts whose sums do not depend on the order of photons. */
typedef struct abbe_map_fit {
  double part;  /* W; 0: nothing is lit yet */
  double total; /* of all hits, parts */
  double bin[2][ABBE_FIT_BINS];
} abbe_map_fit;

/* Adds the hits in the light's map as it is now, not those on tiles; [count][4], with their paths.
 */
void abbe_map_fit_add(abbe_map_fit *fit, const abbe_receiver_atlas *atlas, size_t light,
                      const float *hit, const GLuint *path, size_t count);
/* Where nothing was lit the layout stays. */
void abbe_map_fit_layout(const abbe_map_fit *fit, abbe_map_layout *layout);

#endif
