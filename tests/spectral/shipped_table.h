/* shipped_table.h: tables of materials for tests. The default one is loaded once for a program:
 * GROUP(shipped_load, shipped_free). */
#ifndef ABBE_TESTS_SPECTRAL_SHIPPED_TABLE_H
#define ABBE_TESTS_SPECTRAL_SHIPPED_TABLE_H

#include "tests/check.h"

#include "spectral/formats/material_import.h"

static inline abbe_material_table load_table(const char *path) {
  abbe_material_table table;
  OK(abbe_material_table_load(path, &table, &error));
  return table;
}

static inline const abbe_material *find_material(const abbe_material_table *table,
                                                 const char *name) {
  const abbe_material *m = NULL;
  OK(abbe_material_table_find(table, name, &m, &error));
  return m;
}

static abbe_material_table shipped;

static inline void shipped_load(void) {
  OK(abbe_material_table_load(NULL, &shipped, &error));
}

static inline void shipped_free(void) {
  abbe_material_table_free(&shipped);
}

/* Rows of it that are no conductors. */
static inline size_t shipped_glasses(void) {
  size_t count = 0;
  for (size_t i = 0; i < shipped.count; i++)
    count += !abbe_material_is_conductor(&shipped.material[i]);
  return count;
}

static inline const abbe_material *shipped_material(const char *name) {
  return find_material(&shipped, name);
}

#endif
