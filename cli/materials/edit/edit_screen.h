/* edit_screen.h: the full screen of `abbe materials edit`: draws a record's draft and takes keys.
 *
 * Every number that it shows comes from the library's functions, the same that `show` uses. The
 * terminal is put back as it was on every way out, signals and crashes included. Internal to cli/.
 */
#ifndef ABBE_CLI_MATERIALS_EDIT_EDIT_SCREEN_H
#define ABBE_CLI_MATERIALS_EDIT_EDIT_SCREEN_H

#include "spectral/dispersion/index_points.h"
#include "spectral/editing/record_draft.h"
#include "spectral/materials/material_table.h"

/* What the residual is to; all absent: the record as it was opened. */
typedef struct abbe_edit_source {
  const abbe_index_points *points; /* measured */
  const abbe_material *material;   /* a row of another table */
  const char *name;                /* name of either, for its caption */
} abbe_edit_source;

typedef struct abbe_edit_screen {
  const char *path; /* path of the table, for the title */
  abbe_record_draft *draft;
  abbe_edit_source source;
  const abbe_material_table *known; /* for the warnings; may be NULL */
} abbe_edit_screen;

typedef enum abbe_edit_end {
  ABBE_EDIT_QUIT,
  ABBE_EDIT_INTERRUPTED, /* by a signal, or the terminal is gone */
  ABBE_EDIT_NO_TERMINAL  /* there is none that can be drawn on */
} abbe_edit_end;

/* Runs until the user leaves. */
abbe_edit_end abbe_edit_screen_run(const abbe_edit_screen *screen);

#endif
