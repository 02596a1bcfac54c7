/* alias_table.h: draws from a list of shares in constant time [Walker1977] [Vose1991]. */
#ifndef ABBE_SCENES_ENVIRONMENT_ALIAS_TABLE_H
#define ABBE_SCENES_ENVIRONMENT_ALIAS_TABLE_H

#include "base/error.h"

#include <stddef.h>
#include <stdint.h>

/* An entry of equal width is kept by its own index up to `keep`, and goes to `other` above. */
typedef struct abbe_alias_table {
  size_t count;
  double *keep;    /* [count], 0 to 1: of a bright entry among many only its last bits tell */
  uint32_t *other; /* [count] */
} abbe_alias_table;

/* Weights, any scale: finite, >= 0, their sum > 0 and finite; else ABBE_INVALID_ARGUMENT. An entry
 * of weight 0 is never drawn. ABBE_NO_MEMORY. */
abbe_result abbe_alias_table_make(const double *weight, size_t count, abbe_alias_table *out,
                                  abbe_error *error);
void abbe_alias_table_free(abbe_alias_table *table);

/* The entry of u in [0, 1), which has all bits of a double: each entry's chance is then right to
 * 2^-52. Fewer bits leave few values of the fraction that decides, and so wrong chances. */
size_t abbe_alias_table_draw(const abbe_alias_table *table, double u);

#endif
