/* check.h: what is wrong, or may be wrong, with the records of a material table.
 *
 * Each finding names its row, gives the evidence in numbers and a fix. It judges the numbers by
 * themselves, by what the record says that its source prints, and by known materials: the record's
 * namesake where there is one, else all of them; all of it inside the record's own range alone. It
 * changes nothing: a certain fix comes as a key and a value for whoever edits the file.
 */
#ifndef ABBE_SPECTRAL_EDITING_CHECK_H
#define ABBE_SPECTRAL_EDITING_CHECK_H

#include "base/error.h"
#include "spectral/editing/check_parts.h"
#include "spectral/materials/material_table.h"

/* Adds the findings about one material. known may be NULL or hold the material itself.
 * ABBE_NO_MEMORY; finding nothing is ABBE_OK. */
abbe_result abbe_check_material(const abbe_material *material, const abbe_material_table *known,
                                abbe_findings *findings, abbe_error *error);

/* Adds the findings about every row, and about rows that are alike. Tables read with
 * abbe_material_table_load_lenient may be checked. */
abbe_result abbe_check_table(const abbe_material_table *table, const abbe_material_table *known,
                             abbe_findings *findings, abbe_error *error);

/* The first material of known that is called as this one is: whatever the case, the punctuation
 * and Schott's "N-"; NULL where there is none. */
const abbe_material *abbe_check_namesake(const abbe_material_table *known, const char *name);

#endif
