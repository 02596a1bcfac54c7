#include "validation/transport/media.h"

#include <stdlib.h>

static abbe_result fill(const abbe_geometry *g, const double *lambda_nm, abbe_media *m,
                        bool *absorbs, abbe_error *error) {
  for (size_t i = 0; i < m->refractors; i++) {
    const abbe_material *material = g->scene->object[g->refractor_object[i]].material;
    for (m->stuff[i] = 0; m->stuff[i] < i; m->stuff[i]++)
      if (g->scene->object[g->refractor_object[m->stuff[i]]].material == material) break;
    for (size_t k = 0; k <= m->steps; k++) {
      double n = 0;
      abbe_result result = abbe_material_n(material, lambda_nm[k], &n, error);
      if (result != ABBE_OK) return result;
      size_t at = i * (m->steps + 1) + k;
      m->n[at] = (float)n;
      m->attenuation[at] = (float)(abbe_material_attenuation(material, lambda_nm[k]) * g->unit);
      *absorbs = *absorbs || m->attenuation[at] > 0;
      m->dispersive[i] = m->dispersive[i] || m->n[at] != m->n[i * (m->steps + 1)];
    }
  }
  return ABBE_OK;
}

abbe_result abbe_media_make(const abbe_geometry *geometry, const double *lambda_nm, size_t steps,
                            abbe_media *out, abbe_error *error) {
  ABBE_REQUIRE(geometry && lambda_nm && out, error);
  abbe_media m = {.refractors = geometry->refractor_count, .steps = steps};
  *out = m;
  size_t values = (m.refractors + 1) * (steps + 1);
  m.n = calloc(values, sizeof *m.n);
  m.attenuation = calloc(values, sizeof *m.attenuation);
  m.dispersive = calloc(m.refractors + 1, sizeof *m.dispersive);
  m.stuff = calloc(m.refractors + 1, sizeof *m.stuff);
  bool absorbs = false;
  abbe_result result =
      m.n == NULL || m.attenuation == NULL || m.dispersive == NULL || m.stuff == NULL
          ? abbe_error_set(error, ABBE_NO_MEMORY, "no memory for tables of %zu media", m.refractors)
          : fill(geometry, lambda_nm, &m, &absorbs, error);
  if (!absorbs) {
    free(m.attenuation);
    m.attenuation = NULL;
  }
  if (result != ABBE_OK) abbe_media_free(&m);
  *out = m;
  return result;
}

void abbe_media_free(abbe_media *m) {
  if (m == NULL) return;
  free(m->n);
  free(m->attenuation);
  free(m->dispersive);
  free(m->stuff);
  *m = (abbe_media){0};
}
