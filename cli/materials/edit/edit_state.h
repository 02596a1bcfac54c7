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
  abbe_material preview; /* of what is being typed */
  bool has_preview;
} abbe_edit_state;

/* The record as it would be with what is being typed; NULL where that is no material. */
static inline const abbe_material *abbe_edit_state_shown(const abbe_edit_state *a) {
  return a->has_preview ? &a->preview : abbe_record_draft_material(a->draft);
}

#endif
