#include "validation/transport/media.h"

#include "spectral/uniaxial.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

static const abbe_object *object_of(const abbe_geometry *g, size_t refractor) {
  return &g->scene->object[g->refractor_object[refractor]];
}

/* The axes of crystals have to be alike too, whichever way they point. */
static bool is_same(const abbe_geometry *g, size_t a, size_t b) {
  const abbe_object *p = object_of(g, a), *q = object_of(g, b);
  double along = 0;
  for (int k = 0; k < 3; k++) along += p->axis[k] * q->axis[k];
  return p->material == q->material &&
         (!abbe_material_is_uniaxial(p->material) || fabs(along) > 1 - 1e-12);
}

/* The other index of a crystal, and its axis. */
static abbe_result fill_crystal(const abbe_geometry *g, const double *lambda_nm, abbe_media *m,
                                size_t i, abbe_error *error) {
  const abbe_object *o = object_of(g, i);
  m->crystal[i] = abbe_material_is_uniaxial(o->material);
  memcpy(m->axis[i], o->axis, sizeof m->axis[i]);
  for (size_t k = 0; m->crystal[i] && k <= m->steps; k++) {
    double n = 0;
    abbe_result result = abbe_material_n_extraordinary(o->material, lambda_nm[k], &n, error);
    if (result != ABBE_OK) return result;
    const size_t at = i * (m->steps + 1) + k;
    m->extraordinary[at] = (float)n;
    m->dispersive[i] =
        m->dispersive[i] || m->extraordinary[at] != m->extraordinary[i * (m->steps + 1)];
    for (int axis = 0; axis < 3; axis++)
      m->pleochroism[3 * at + (size_t)axis] =
          (float)(abbe_material_attenuation_along(o->material, axis, lambda_nm[k]) * g->unit);
  }
  return ABBE_OK;
}

static void free_crystals(abbe_media *m) {
  free(m->extraordinary);
  free(m->crystal);
  free(m->axis);
  free(m->pleochroism);
  m->extraordinary = NULL;
  m->crystal = NULL;
  m->axis = NULL;
  m->pleochroism = NULL;
}

static abbe_result fill(const abbe_geometry *g, const double *lambda_nm, abbe_media *m,
                        bool *absorbs, abbe_error *error) {
  for (size_t i = 0; i < m->refractors; i++) {
    const abbe_material *material = object_of(g, i)->material;
    for (m->stuff[i] = 0; m->stuff[i] < i; m->stuff[i]++)
      if (is_same(g, m->stuff[i], i)) break;
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
    abbe_result result = fill_crystal(g, lambda_nm, m, i, error);
    if (result != ABBE_OK) return result;
  }
  return ABBE_OK;
}

abbe_result abbe_media_make(const abbe_geometry *geometry, const double *lambda_nm, size_t steps,
                            abbe_media *out, abbe_error *error) {
  assert(geometry->scene);
  abbe_media m = {.refractors = geometry->refractor_count, .steps = steps};
  *out = m;
  size_t values = (m.refractors + 1) * (steps + 1);
  m.n = calloc(values, sizeof *m.n);
  m.attenuation = calloc(values, sizeof *m.attenuation);
  m.dispersive = calloc(m.refractors + 1, sizeof *m.dispersive);
  m.stuff = calloc(m.refractors + 1, sizeof *m.stuff);
  m.extraordinary = calloc(values, sizeof *m.extraordinary);
  m.crystal = calloc(m.refractors + 1, sizeof *m.crystal);
  m.axis = calloc(m.refractors + 1, sizeof *m.axis);
  m.pleochroism = calloc(3 * values, sizeof *m.pleochroism);
  bool absorbs = false, crystals = false, pleochroic = false;
  abbe_result result =
      m.n == NULL || m.attenuation == NULL || m.dispersive == NULL || m.stuff == NULL ||
              m.extraordinary == NULL || m.crystal == NULL || m.axis == NULL ||
              m.pleochroism == NULL
          ? abbe_error_set(error, ABBE_NO_MEMORY, "no memory for tables of %zu media", m.refractors)
          : fill(geometry, lambda_nm, &m, &absorbs, error);
  if (!absorbs) {
    free(m.attenuation);
    m.attenuation = NULL;
  }
  for (size_t i = 0; i < m.refractors && result == ABBE_OK; i++) {
    crystals = crystals || m.crystal[i];
    pleochroic = pleochroic || abbe_material_is_pleochroic(object_of(geometry, i)->material);
  }
  if (!pleochroic) {
    free(m.pleochroism);
    m.pleochroism = NULL;
  }
  if (!crystals) free_crystals(&m);
  if (result == ABBE_OK)
    result = abbe_haze_make(geometry, lambda_nm, steps, m.attenuation, &m.haze, error);
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
  free_crystals(m);
  abbe_haze_free(&m->haze);
  *m = (abbe_media){0};
}

float abbe_media_attenuation_along(const abbe_media *m, int i, uint32_t k, float f,
                                   const float d[3], uint8_t wave) {
  const size_t at = (size_t)i * (m->steps + 1) + k;
  const float *a = m->pleochroism + 3 * at, *n = m->extraordinary + at;
  const double a_o = (double)(a[0] + f * (a[3] - a[0]));
  if (wave == ABBE_UNIAXIAL_ORDINARY) return (float)a_o;
  double cos_ray = 0;
  for (int c = 0; c < 3; c++) cos_ray += (double)d[c] * m->axis[i][c];
  return (float)abbe_uniaxial_attenuation((double)abbe_media_n(m, i, k, f),
                                          (double)(n[0] + f * (n[1] - n[0])), a_o,
                                          (double)(a[2] + f * (a[5] - a[2])), cos_ray);
}

void abbe_media_forget_axes(abbe_media *m) {
  free_crystals(m);
}
