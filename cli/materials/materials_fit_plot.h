/* materials_fit_plot.h: the picture of a fit: the curve through its points, its residuals below. */
#ifndef ABBE_CLI_MATERIALS_MATERIALS_FIT_PLOT_H
#define ABBE_CLI_MATERIALS_MATERIALS_FIT_PLOT_H

#include "spectral/dispersion/fit.h"

/* Writes the picture to path, whose ending says .png or .svg; of is what was fitted. */
abbe_result abbe_materials_fit_plot(const char *path, const char *of,
                                    const abbe_index_points *points, const abbe_fit *fit,
                                    abbe_error *error);

#endif
