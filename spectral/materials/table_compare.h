/* table_compare.h: what differs between two material tables, row by row.
 *
 * Rows are matched by name, whatever the case; of those left, rows with the same curve over the
 * same range are taken for renamed. What a row means is compared, not how its file writes it: for
 * that see text_diff.h.
 */
#ifndef ABBE_SPECTRAL_MATERIALS_TABLE_COMPARE_H
#define ABBE_SPECTRAL_MATERIALS_TABLE_COMPARE_H

#include "base/error.h"
#include "spectral/dispersion/index_points.h"
#include "spectral/materials/material_table.h"

#include <stddef.h>

typedef enum abbe_row_kind {
  ABBE_ROW_ONLY_IN_FIRST,
  ABBE_ROW_ONLY_IN_SECOND,
  ABBE_ROW_RENAMED, /* the curve is the same, the name is not */
  ABBE_ROW_CHANGED,
  ABBE_ROW_SAME
} abbe_row_kind;

/* X(code, name): the parts of a record that can differ. */
#define ABBE_ROW_PARTS(X)                                                                          \
  X(DESCRIPTION, "description")                                                                    \
  X(MODEL, "model")                                                                                \
  X(COEFFICIENTS, "coefficients")                                                                  \
  X(POINTS, "points")                                                                              \
  X(RANGE, "range_nm")                                                                             \
  X(EXTRAORDINARY, "extraordinary")                                                                \
  X(EXTRAPOLATE, "extrapolate")                                                                    \
  X(TEMPERATURE, "temperature_c")                                                                  \
  X(ABSOLUTE, "n_absolute")                                                                        \
  X(PUBLISHED, "n_d and v_d")                                                                      \
  X(SOURCE, "source")                                                                              \
  X(WARNING, "warning")                                                                            \
  X(COMMENT, "comment")                                                                            \
  X(ABSORPTION, "absorption")                                                                      \
  X(FLUORESCENCE, "fluorescence")                                                                  \
  X(CATALOGUE, "catalogue")                                                                        \
  X(FIT, "fit")

typedef enum abbe_row_part {
#define ABBE_ROW_PART_ENUM(code, name) ABBE_ROW_PART_##code,
  ABBE_ROW_PARTS(ABBE_ROW_PART_ENUM)
#undef ABBE_ROW_PART_ENUM
      ABBE_ROW_PART_COUNT
} abbe_row_part;

typedef struct abbe_row_difference {
  abbe_row_kind kind;
  const abbe_material *first, *second; /* the tables'; NULL where there is none */
  unsigned parts;                      /* bit 1 << abbe_row_part for each that differs */
  double min_nm, max_nm;               /* the range that both vouch for; NaN: none */
  abbe_index_difference index;         /* n of second - n of first over it; NaN: none */
} abbe_row_difference;

typedef struct abbe_table_difference {
  size_t count; /* rows in the first table's order, then those only in the second */
  abbe_row_difference *row;
  size_t kinds[ABBE_ROW_SAME + 1]; /* rows of each kind */
} abbe_table_difference;

/* Compares; the result points into both tables. ABBE_NO_MEMORY. */
abbe_result abbe_table_compare(const abbe_material_table *first, const abbe_material_table *second,
                               abbe_table_difference *out, abbe_error *error);
void abbe_table_difference_free(abbe_table_difference *difference);

const char *abbe_row_part_name(abbe_row_part part);

#endif
