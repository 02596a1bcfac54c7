#include "library/lib_materials.h"

#include "base/maths.h"
#include "library/lib_handles.h"
#include "spectral/formats/material_import.h"

#include <stdlib.h>
#include <string.h>

struct abbe_lib_materials {
  abbe_material_table table;
};

abbe_result abbe_lib_materials_load(const char *table, abbe_lib_materials **out,
                                    abbe_error *error) {
  ABBE_REQUIRE(out, error);
  *out = NULL;
  abbe_lib_materials *m = calloc(1, sizeof *m);
  if (m == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "there is no memory for a table");
  abbe_result result = abbe_material_table_load(table, &m->table, error);
  if (result == ABBE_OK)
    *out = m;
  else
    free(m);
  return result;
}

void abbe_lib_materials_free(abbe_lib_materials *m) {
  if (m == NULL) return;
  abbe_material_table_free(&m->table);
  free(m);
}

size_t abbe_lib_materials_count(const abbe_lib_materials *m) {
  return m == NULL ? 0 : m->table.count;
}

const char *abbe_lib_materials_name(const abbe_lib_materials *m, size_t index) {
  return index < abbe_lib_materials_count(m) ? m->table.material[index].name : NULL;
}

abbe_result abbe_lib_materials_find(const abbe_lib_materials *m, const char *name, size_t *index,
                                    abbe_error *error) {
  ABBE_REQUIRE(m && name && index, error);
  const abbe_material *found = NULL;
  ABBE_TRY(abbe_material_table_find(&m->table, name, &found, error));
  *index = (size_t)(found - m->table.material);
  return ABBE_OK;
}

const char *abbe_lib_materials_text(const abbe_lib_materials *m, size_t index, const char *what) {
  if (index >= abbe_lib_materials_count(m) || what == NULL) return NULL;
  const abbe_material *own = &m->table.material[index];
  return strcmp(what, "description") == 0 ? own->description
         : strcmp(what, "source") == 0    ? own->source
         : strcmp(what, "warning") == 0   ? own->warning
         : strcmp(what, "comment") == 0   ? own->comment
                                          : NULL;
}

static abbe_result check_place(const abbe_lib_materials *m, size_t index, abbe_error *error) {
  if (index < m->table.count) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                        "there is no material %zu: the table has %zu, from 0 on", index,
                        m->table.count);
}

abbe_result abbe_lib_materials_range(const abbe_lib_materials *m, size_t index, double *min_nm,
                                     double *max_nm, abbe_error *error) {
  ABBE_REQUIRE(m && min_nm && max_nm, error);
  ABBE_TRY(check_place(m, index, error));
  *min_nm = m->table.material[index].min_nm;
  *max_nm = m->table.material[index].max_nm;
  return ABBE_OK;
}

abbe_result abbe_lib_materials_index(const abbe_lib_materials *m, size_t index,
                                     const double *lambda_nm, size_t count, double *n, double *k,
                                     abbe_error *error) {
  ABBE_REQUIRE(m && ((lambda_nm && n) || count == 0), error);
  abbe_result result = check_place(m, index, error);
  for (size_t i = 0; i < count && result == ABBE_OK; i++) {
    const abbe_material *own = &m->table.material[index];
    double kappa = 0;
    if (abbe_material_is_conductor(own))
      result = abbe_material_nk(own, lambda_nm[i], &n[i], &kappa, error);
    else
      result = abbe_material_n(own, lambda_nm[i], &n[i], error);
    if (result != ABBE_OK || k == NULL) continue;
    if (!abbe_material_is_conductor(own))
      kappa = abbe_material_attenuation(own, lambda_nm[i]) * 1e-9 * lambda_nm[i] / (4 * ABBE_PI);
    k[i] = kappa;
  }
  return result;
}
