/* material_query.h: which rows of a table, in which order.
 *
 * It chooses and sorts; it neither prints nor changes the table.
 */
#ifndef ABBE_SPECTRAL_MATERIALS_MATERIAL_QUERY_H
#define ABBE_SPECTRAL_MATERIALS_MATERIAL_QUERY_H

#include "base/error.h"
#include "spectral/materials/material_table.h"

#include <stdbool.h>
#include <stddef.h>

/* X(code, name): what rows may be sorted by. */
#define ABBE_MATERIAL_KEYS(X)                                                                      \
  X(FILE, "file") /* the order of the file */                                                      \
  X(NAME, "name") /* whatever the case */                                                          \
  X(ND, "n_d")                                                                                     \
  X(VD, "v_d")                                                                                     \
  X(BG, "b_g")                                                                                     \
  X(PGF, "p_gF")                                                                                   \
  X(FROM, "from") /* the shortest wavelength with data */                                          \
  X(TO, "to")     /* the longest */                                                                \
  X(SOURCE, "source")

typedef enum abbe_material_key {
#define ABBE_MATERIAL_KEY_ENUM(code, name) ABBE_MATERIAL_KEY_##code,
  ABBE_MATERIAL_KEYS(ABBE_MATERIAL_KEY_ENUM)
#undef ABBE_MATERIAL_KEY_ENUM
      ABBE_MATERIAL_KEY_COUNT
} abbe_material_key;

/* Zero asks for every row in the file's order. */
typedef struct abbe_material_query {
  const char *name;        /* part of the name, or a pattern with * ? [ ] for the whole of it */
  const char *source;      /* the same for the source */
  double n_d_min, n_d_max; /* ends included; both 0: any */
  double v_d_min, v_d_max;
  abbe_material_key sort;
  bool descending; /* rows without the number come last either way */
} abbe_material_query;

/* The rows' places in the table into *rows (malloc'd; NULL for none) and their *count. Letters
 * match whatever their case. A row without n_d or V_d is in no range of them. ABBE_NO_MEMORY;
 * ABBE_INVALID_ARGUMENT for a key that is none. */
abbe_result abbe_material_query_run(const abbe_material_table *table,
                                    const abbe_material_query *query, size_t **rows, size_t *count,
                                    abbe_error *error);

const char *abbe_material_key_name(abbe_material_key key);

#endif
