/* edit_view.h: the editor's screen, drawn: fields, plots, numbers, warnings, keys.
 * Internal to cli/materials/edit/. */
#ifndef ABBE_CLI_MATERIALS_EDIT_EDIT_VIEW_H
#define ABBE_CLI_MATERIALS_EDIT_EDIT_VIEW_H

#include "cli/materials/edit/edit_state.h"

/* Scrolls so that the selected field is seen. */
void abbe_edit_view_draw(abbe_edit_state *state);

#endif
