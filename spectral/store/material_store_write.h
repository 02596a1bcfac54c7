/* material_store_write.h: a table of materials into a store (spectral/store/material_store.h). */
#ifndef ABBE_SPECTRAL_STORE_MATERIAL_STORE_WRITE_H
#define ABBE_SPECTRAL_STORE_MATERIAL_STORE_WRITE_H

#include "base/error.h"
#include "spectral/materials/material_table.h"

#include <stdbool.h>
#include <stdio.h>

/* Whether a file of this name is to be a store: it ends in .sqlite. */
bool abbe_material_store_is_name(const char *path);

/* Writes the table to the stream; it is made in memory before. ABBE_INVALID_ARGUMENT for a material
 * that abbe_material_check does not pass and for a name that stands twice (whatever the case);
 * ABBE_IO where the stream fails; ABBE_NO_MEMORY. */
abbe_result abbe_material_store_write(const abbe_material_table *table, FILE *to,
                                      abbe_error *error);

#endif
