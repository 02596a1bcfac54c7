/* material_write.h: materials as records of our own YAML tables.
 *
 * What is written reads back the same (spectral/materials/material_table.h), but for two things that a record
 * in memory no longer knows: a colour at a distance, a transmittance and k are written as the
 * attenuation that they became, and comments of the file (#) are not kept. To change one record of
 * a file and leave the rest, see spectral/editing/table_edit.h.
 */
#ifndef ABBE_SPECTRAL_FORMATS_MATERIAL_WRITE_H
#define ABBE_SPECTRAL_FORMATS_MATERIAL_WRITE_H

#include "base/error.h"
#include "spectral/materials/material_table.h"

#include <stdio.h>

/* The record as an item of the list `materials:`, each line indented by two spaces or more, to the
 * stream. ABBE_INVALID_ARGUMENT for a record that could not be read again (abbe_material_check),
 * before anything is written; ABBE_IO where the stream fails. */
abbe_result abbe_material_write(const abbe_material *material, FILE *to, abbe_error *error);

/* The whole table. ABBE_INVALID_ARGUMENT also where it is too large for a reader of YAML (a store
 * holds it: spectral/store/material_store_write.h); nothing is written then. */
abbe_result abbe_material_table_write(const abbe_material_table *table, FILE *to,
                                      abbe_error *error);

#endif
