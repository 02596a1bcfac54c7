/* cell_fit.h: a light's photon grid no finer than its map can tell. Internal to gl/.
 */
#ifndef ABBE_GL_CAUSTICS_CELL_FIT_H
#define ABBE_GL_CAUSTICS_CELL_FIT_H

#include "gl/photons/trace_pass.h"

/* Traces a batch of wavelengths and makes the light's grid coarser, each way by itself, where the
 * images of nearly all cells are thinner than two texels. The map is fitted by then. */
abbe_result abbe_cell_fit_run(abbe_trace_pass *trace, abbe_photon_lights *views, size_t light,
                              abbe_error *error);

#endif
