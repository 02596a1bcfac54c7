/* material_chart.h: pictures of materials: their index over wavelength, and the map of glasses.
 *
 * What is drawn comes from the records as they stand: a curve is whole where its data reach, dashed
 * where the record allows it to be continued, and absent beyond. The pictures are chart.h's.
 */
#ifndef ABBE_COLORIMETRY_PLOT_MATERIAL_CHART_H
#define ABBE_COLORIMETRY_PLOT_MATERIAL_CHART_H

#include "base/error.h"
#include "spectral/dispersion/index_points.h"
#include "spectral/materials/material_table.h"

#include <stdbool.h>
#include <stddef.h>

enum { ABBE_MATERIAL_CHART_MAX = 64, ABBE_MATERIAL_MAP_MAX_TABLES = 8 };

/* Zero but for the materials: 380 to 780 nm, curves alone. */
typedef struct abbe_material_chart {
  size_t count; /* 1 to ABBE_MATERIAL_CHART_MAX */
  const abbe_material *const *material;
  double min_nm, max_nm;           /* both 0: 380 to 780 */
  bool fits;                       /* the recorded Cauchy fits too, and below them n - fit */
  const abbe_index_points *points; /* measured ones too, and below them n - that of the first
                                      material; or NULL */
  size_t width, height;            /* as chart.h has them */
} abbe_material_chart;

/* n over wavelength to path (.png or .svg), of a conductor n and k. ABBE_OUT_OF_RANGE where none of
 * the materials has data in the range; ABBE_UNSUPPORTED for a conductor with fits or points; else
 * as abbe_chart_write has it. */
abbe_result abbe_material_chart_write(const char *path, const abbe_material_chart *chart,
                                      abbe_error *error);

typedef struct abbe_material_map {
  size_t table_count; /* 1 to ABBE_MATERIAL_MAP_MAX_TABLES */
  const abbe_material_table *const *table;
  size_t marked_count; /* materials in a colour of their own, with their names */
  const abbe_material *const *marked;
  size_t width, height;
  bool partial; /* P_gF in the place of n_d */
} abbe_material_map;

/* n_d over V_d, which runs from right to left as glass makers draw it; names where there is space.
 * Materials without finite n_d and V_d in their range are left out, their number in *left_out (may
 * be NULL; conductors are counted where they are highlighted). ABBE_NOT_FOUND where that leaves
 * none. */
abbe_result abbe_material_map_write(const char *path, const abbe_material_map *map,
                                    size_t *left_out, abbe_error *error);

#endif
