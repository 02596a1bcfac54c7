/* map_fit.h: windows and warps of maps by where light falls. It knows no GL. Internal to gl/.
 */
#ifndef ABBE_GL_CAUSTICS_MAP_FIT_H
#define ABBE_GL_CAUSTICS_MAP_FIT_H

#include "gl/light/receiver_atlas.h"
#include "gl/photons/trace_pass.h"
#include "scenes/view/map_layout.h"

#include <stddef.h>

enum { ABBE_FIT_BINS = 1 << 15 };

/* Flux by window coordinate, in whole parts whose sums do not depend on the order of photons. */
typedef struct abbe_map_fit {
  const abbe_view *view; /* whose window */
  double part;           /* W; 0: nothing is lit yet */
  double total, outside; /* flux of all hits; flux outside of the window; parts */
  double bin[2][ABBE_FIT_BINS];
} abbe_map_fit;

/* Adds hits of the light's map, not those on tiles; [count / stride][stride][4] by wavelength, with
 * their paths. Light lies between the wavelengths of a path. */
void abbe_map_fit_add(abbe_map_fit *fit, const abbe_receiver_atlas *atlas, const float *hit,
                      const GLuint *path, size_t count, size_t stride);
/* The layout of the fit's view, wider by a share on each side. Where nothing was lit the layout
 * stays. */
void abbe_map_fit_layout(const abbe_map_fit *fit, double wider, abbe_map_layout *layout);
/* Whether the window holds nearly all of this light, and is filled by it for a good part. */
bool abbe_map_fit_serves(const abbe_map_fit *fit);

/* A light's photon grid no finer than its map resolves. */

/* Traces a batch of wavelengths and makes the light's grid coarser, each axis by itself, where the
 * images of nearly all cells are thinner than two texels. The map is fitted by then. */
abbe_result abbe_cell_fit_run(abbe_trace_pass *trace, abbe_photon_lights *views, size_t light,
                              abbe_error *error);

#endif
