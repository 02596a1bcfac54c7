#include "validation/transport/mirrors.h"

#include <stdlib.h>

static abbe_result fill(const abbe_geometry *g, const double *lambda_nm, abbe_mirrors *m,
                        abbe_error *error) {
  for (size_t i = 0; i < m->count; i++) {
    const abbe_object *o = &g->scene->object[g->mirror_object[i]];
    m->reflectance[i] = o->conductor != NULL ? -1 : (float)o->mirror_reflectance;
    for (size_t k = 0; k <= m->steps && o->conductor != NULL; k++) {
      double nk[2];
      abbe_result result = abbe_material_nk(o->conductor, lambda_nm[k], &nk[0], &nk[1], error);
      if (result != ABBE_OK) return result;
      for (int c = 0; c < 2; c++) m->nk[i * (m->steps + 1) + k][c] = (float)nk[c];
    }
  }
  return ABBE_OK;
}

abbe_result abbe_mirrors_make(const abbe_geometry *geometry, const double *lambda_nm, size_t steps,
                              abbe_mirrors *out, abbe_error *error) {
  ABBE_REQUIRE(geometry && lambda_nm && out, error);
  abbe_mirrors m = {.count = geometry->mirror_count, .steps = steps};
  m.reflectance = calloc(m.count + 1, sizeof *m.reflectance);
  m.nk = calloc(m.count * (steps + 1) + 1, sizeof *m.nk);
  abbe_result result =
      m.reflectance == NULL || m.nk == NULL
          ? abbe_error_set(error, ABBE_NO_MEMORY, "no memory for tables of %zu mirrors", m.count)
          : fill(geometry, lambda_nm, &m, error);
  if (result != ABBE_OK) abbe_mirrors_free(&m);
  *out = m;
  return result;
}

void abbe_mirrors_free(abbe_mirrors *m) {
  if (m == NULL) return;
  free(m->reflectance);
  free(m->nk);
  *m = (abbe_mirrors){0};
}
