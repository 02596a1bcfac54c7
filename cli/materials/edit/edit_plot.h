/* edit_plot.h: the editor's two plots: the index over wavelength, and its difference to the source.
 */
#ifndef ABBE_CLI_MATERIALS_EDIT_EDIT_PLOT_H
#define ABBE_CLI_MATERIALS_EDIT_EDIT_PLOT_H

#include "cli/materials/edit/edit_state.h"

/* Part of the screen, in characters. */
typedef struct abbe_edit_area {
  int top, rows, left, columns;
} abbe_edit_area;

void abbe_edit_plot_draw(const abbe_edit_state *state, abbe_edit_area area);

#endif
