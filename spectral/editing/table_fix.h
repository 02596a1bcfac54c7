/* table_fix.h: the fixes that a check is certain of, put into a table's text.
 *
 * Only what spectral/editing/check.h is certain of is changed, and only the bytes of the values
 * concerned (spectral/editing/table_edit.h). Nothing is written to a file here.
 */
#ifndef ABBE_SPECTRAL_EDITING_TABLE_FIX_H
#define ABBE_SPECTRAL_EDITING_TABLE_FIX_H

#include "base/error.h"
#include "spectral/editing/table_edit.h"
#include "spectral/materials/material_table.h"

#include <stddef.h>

typedef struct abbe_table_fix {
  size_t fixed;     /* values that were set */
  size_t refused;   /* that could not be, since a name stands twice or the text cannot carry it */
  char why[400];    /* the first that was refused; "" without */
  char warned[400]; /* names of fixed rows that have a warning, which may no longer hold: "a, b" */
} abbe_table_fix;

/* Fixes until nothing certain is left: one fix may bring out the next fault. ABBE_PARSE,
 * ABBE_SCHEMA, ABBE_NO_MEMORY as the table's reading has them; what is refused is not a failure. */
abbe_result abbe_table_fix_make(abbe_table_edit *edit, const abbe_material_table *known,
                                abbe_table_fix *out, abbe_error *error);

#endif
