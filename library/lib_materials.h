/* lib_materials.h: a table of materials as a program outside reads it: names, sources, indices.
 *
 * Wavelengths are in nm, in air. It edits no table: `abbe materials` does.
 */
#ifndef ABBE_LIBRARY_LIB_MATERIALS_H
#define ABBE_LIBRARY_LIB_MATERIALS_H

#include "base/error.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct abbe_lib_materials abbe_lib_materials;

/* table: "default" (also NULL), "thesis", or a file of YAML or SQLite. ABBE_IO, ABBE_PARSE,
 * ABBE_SCHEMA, ABBE_NO_MEMORY. */
abbe_result abbe_lib_materials_load(const char *table, abbe_lib_materials **out, abbe_error *error);
void abbe_lib_materials_free(abbe_lib_materials *materials);

size_t abbe_lib_materials_count(const abbe_lib_materials *materials);
/* NULL past the last one. */
const char *abbe_lib_materials_name(const abbe_lib_materials *materials, size_t index);
/* Whatever the case. ABBE_NOT_FOUND names the nearest. */
abbe_result abbe_lib_materials_find(const abbe_lib_materials *materials, const char *name,
                                    size_t *index, abbe_error *error);

/* "description", "source", "warning" or "comment" of a material; NULL where it has none. */
const char *abbe_lib_materials_text(const abbe_lib_materials *materials, size_t index,
                                    const char *what);
/* The wavelengths that its index is known at. ABBE_INVALID_ARGUMENT past the last material; so the
 * next one. */
abbe_result abbe_lib_materials_range(const abbe_lib_materials *materials, size_t index,
                                     double *min_nm, double *max_nm, abbe_error *error);
/* The complex index n + i k at count wavelengths, into n[count] and k[count] (may be NULL): of a
 * metal as published, of any other material k from its attenuation, attenuation x wavelength / 4
 * pi; of a uniaxial crystal the ordinary index. ABBE_OUT_OF_RANGE outside the range, unless the
 * record allows it. */
abbe_result abbe_lib_materials_index(const abbe_lib_materials *materials, size_t index,
                                     const double *lambda_nm, size_t count, double *n, double *k,
                                     abbe_error *error);

#ifdef __cplusplus
}
#endif
#endif
