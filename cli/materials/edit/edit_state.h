/* edit_state.h: what the editor's screen shows, between two keys.
 * Internal to cli/materials/edit/. */
#ifndef ABBE_CLI_MATERIALS_EDIT_EDIT_STATE_H
#define ABBE_CLI_MATERIALS_EDIT_EDIT_STATE_H

#include "cli/materials/edit/edit_screen.h"

#include <stdbool.h>
#include <stddef.h>

enum { ABBE_EDIT_MAX_INPUT = 400 };

typedef struct abbe_edit_state {
  const abbe_edit_screen *screen;
  abbe_record_draft *draft;
  size_t selected, first; /* field; the first one on the screen */
  bool editing, asking, helping, plain, left;
  char input[ABBE_EDIT_MAX_INPUT]; /* while editing */
  size_t length, cursor;           /* bytes */
  char message[1024];
  abbe_material preview; /* the record with what is being typed */
  bool has_preview;
} abbe_edit_state;

/* The record as it would be with what is being typed; NULL where that is no material. */
static inline const abbe_material *abbe_edit_state_shown(const abbe_edit_state *a) {
  return a->has_preview ? &a->preview : abbe_record_draft_material(a->draft);
}

/* The editor's screen, drawn: fields, plots, numbers, warnings, keys. */

/* Scrolls so that the selected field is seen. */
void abbe_edit_view_draw(abbe_edit_state *state);

/* Text and colours in the cells of the editor's screen. */

/* Curses' pairs of colours, which the screen makes. */
enum { ABBE_EDIT_WARNING = 1, ABBE_EDIT_CHANGED, ABBE_EDIT_CURVE };

#endif
