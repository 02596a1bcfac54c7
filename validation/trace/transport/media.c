#include "validation/trace/transport/media.h"

#include "base/maths.h"
#include "scenes/geometry/digest.h"
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
  const double along = abbe_vector_dot(p->axis, q->axis),
               along_x = abbe_vector_dot(p->axis_x, q->axis_x);
  return p->material == q->material &&
         (!abbe_material_is_crystal(p->material) || fabs(along) > 1 - 1e-12) &&
         (!abbe_material_is_biaxial(p->material) || fabs(along_x) > 1 - 1e-12);
}

/* The indices of a crystal, what it absorbs and its axes. */
static abbe_result fill_crystal(const abbe_geometry *g, const double *lambda_nm, abbe_media *m,
                                size_t i, abbe_error *error) {
  const abbe_object *o = object_of(g, i);
  m->crystal[i] = abbe_material_is_crystal(o->material);
  m->biaxial[i] = abbe_material_is_biaxial(o->material);
  m->pleochroic[i] = abbe_material_is_pleochroic(o->material);
  memcpy(m->axis[i], o->axis, sizeof m->axis[i]);
  memcpy(m->frame[i][0], o->axis_x, sizeof o->axis_x);
  memcpy(m->frame[i][2], o->axis, sizeof o->axis);
  abbe_vector_cross(o->axis, o->axis_x, m->frame[i][1]);
  for (size_t k = 0; m->crystal[i] && k <= m->steps; k++) {
    const size_t at = i * (m->steps + 1) + k;
    for (int axis = 0; axis < 3; axis++) {
      double n = 0;
      ABBE_TRY(abbe_material_n_along(o->material, axis, lambda_nm[k], &n, error));
      float *principal = m->principal + 3 * (i * (m->steps + 1)) + axis;
      principal[3 * k] = (float)n;
      m->dispersive[i] = m->dispersive[i] || principal[3 * k] != principal[0];
      m->pleochroism[3 * at + (size_t)axis] =
          (float)(abbe_material_attenuation_along(o->material, axis, lambda_nm[k]) * g->unit);
    }
    m->extraordinary[at] = m->principal[3 * at + 2];
  }
  return ABBE_OK;
}

static void free_crystals(abbe_media *m) {
  free(m->extraordinary);
  free(m->crystal);
  free(m->axis);
  free(m->principal);
  free(m->frame);
  free(m->biaxial);
  free(m->pleochroic);
  free(m->pleochroism);
  m->extraordinary = m->principal = m->pleochroism = NULL;
  m->crystal = m->biaxial = m->pleochroic = NULL;
  m->axis = NULL;
  m->frame = NULL;
}

/* Room for what crystals need; false where there is none. */
static bool make_crystals(abbe_media *m) {
  const size_t values = (m->refractors + 1) * (m->steps + 1), count = m->refractors + 1;
  m->extraordinary = calloc(values, sizeof *m->extraordinary);
  m->principal = calloc(3 * values, sizeof *m->principal);
  m->pleochroism = calloc(3 * values, sizeof *m->pleochroism);
  m->crystal = calloc(count, sizeof *m->crystal);
  m->biaxial = calloc(count, sizeof *m->biaxial);
  m->pleochroic = calloc(count, sizeof *m->pleochroic);
  m->axis = calloc(count, sizeof *m->axis);
  m->frame = calloc(count, sizeof *m->frame);
  return m->extraordinary != NULL && m->principal != NULL && m->pleochroism != NULL &&
         m->crystal != NULL && m->biaxial != NULL && m->pleochroic != NULL && m->axis != NULL &&
         m->frame != NULL;
}

/* Without what no medium needs. */
static void drop_idle(abbe_media *m) {
  bool crystals = false, biaxial = false, pleochroic = false;
  for (size_t i = 0; i < m->refractors; i++) {
    crystals = crystals || m->crystal[i];
    biaxial = biaxial || m->biaxial[i];
    pleochroic = pleochroic || m->pleochroic[i];
  }
  if (!pleochroic) {
    free(m->pleochroism);
    m->pleochroism = NULL;
  }
  if (!biaxial) {
    free(m->principal);
    m->principal = NULL;
  }
  if (!crystals) free_crystals(m);
}

static abbe_result fill(const abbe_geometry *g, const double *lambda_nm, abbe_media *m,
                        bool *absorbs, abbe_error *error) {
  for (size_t i = 0; i < m->refractors; i++) {
    const abbe_material *material = object_of(g, i)->material;
    for (m->stuff[i] = 0; m->stuff[i] < i; m->stuff[i]++)
      if (is_same(g, m->stuff[i], i)) break;
    for (size_t k = 0; k <= m->steps; k++) {
      double n = 0;
      ABBE_TRY(abbe_material_n(material, lambda_nm[k], &n, error));
      size_t at = i * (m->steps + 1) + k;
      m->n[at] = (float)n;
      m->attenuation[at] = (float)(abbe_material_attenuation(material, lambda_nm[k]) * g->unit);
      *absorbs = *absorbs || m->attenuation[at] > 0;
      m->dispersive[i] = m->dispersive[i] || m->n[at] != m->n[i * (m->steps + 1)];
    }
    ABBE_TRY(fill_crystal(g, lambda_nm, m, i, error));
  }
  return ABBE_OK;
}

/* The rough facets of each; none where no refractor has any. */
static abbe_result find_rough(const abbe_geometry *g, abbe_media *m, abbe_error *error) {
  for (size_t i = 0; i < m->refractors; i++) {
    const abbe_coatings *rough = object_of(g, i)->roughness;
    if (rough == NULL) continue;
    if (m->rough == NULL) m->rough = calloc(m->refractors, sizeof *m->rough);
    if (m->rough == NULL) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for facets");
    m->rough[i] = rough;
    m->films.key = abbe_digest(m->films.key, &i, sizeof i);
    for (size_t k = 0; k < rough->count; k++)
      m->films.key = abbe_digest_array(m->films.key, &rough->coating[k].alpha, 1, sizeof(double));
    m->films.key = abbe_digest_array(m->films.key, rough->face, rough->face_count, 1);
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
  bool absorbs = false;
  const bool room = make_crystals(&m);
  abbe_result result =
      m.n == NULL || m.attenuation == NULL || m.dispersive == NULL || m.stuff == NULL || !room
          ? abbe_error_set(error, ABBE_NO_MEMORY, "no memory for tables of %zu media", m.refractors)
          : fill(geometry, lambda_nm, &m, &absorbs, error);
  if (!absorbs) {
    free(m.attenuation);
    m.attenuation = NULL;
  }
  if (result == ABBE_OK) drop_idle(&m);
  if (result == ABBE_OK)
    result = abbe_haze_make(geometry, lambda_nm, steps, m.attenuation, false, &m.haze, error);
  if (result == ABBE_OK) result = abbe_films_make(geometry, lambda_nm, steps, &m.films, error);
  if (result == ABBE_OK) result = find_rough(geometry, &m, error);
  /* the mean over the axes may be grey where each axis has a colour */
  for (size_t i = 0; i < m.refractors && m.pleochroism != NULL && abbe_haze_is(&m.haze); i++)
    m.haze.coloured[i] = m.haze.coloured[i] || m.pleochroic[i];
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
  abbe_films_free(&m->films);
  free(m->rough);
  *m = (abbe_media){0};
}

void abbe_media_axes(const abbe_media *m, int i, uint32_t k, float f, abbe_biaxial *out) {
  const float *n = m->principal + 3 * ((size_t)i * (m->steps + 1) + k);
  for (int axis = 0; axis < 3; axis++)
    out->n[axis] = (double)(n[axis] + f * (n[3 + axis] - n[axis]));
  memcpy(out->axis, m->frame[i], sizeof out->axis);
}

/* By the field of the ray's wave. */
static double biaxial_attenuation(const abbe_media *m, int i, uint32_t k, float f,
                                  const double d[3], uint8_t wave) {
  const float *a = m->pleochroism + 3 * ((size_t)i * (m->steps + 1) + k);
  double along[3];
  abbe_biaxial crystal;
  abbe_biaxial_state state;
  abbe_media_axes(m, i, k, f, &crystal);
  abbe_biaxial_of_ray(&crystal, (abbe_biaxial_mode)wave, d, &state);
  for (int axis = 0; axis < 3; axis++)
    along[axis] = (double)(a[axis] + f * (a[3 + axis] - a[axis]));
  return abbe_biaxial_attenuation(&crystal, along, state.field);
}

float abbe_media_attenuation_along(const abbe_media *m, int i, uint32_t k, float f,
                                   const float d[3], uint8_t wave) {
  const size_t at = (size_t)i * (m->steps + 1) + k;
  const float *a = m->pleochroism + 3 * at, *n = m->extraordinary + at;
  const double a_o = (double)(a[0] + f * (a[3] - a[0])), ray[3] = {d[0], d[1], d[2]};
  if (abbe_media_is_biaxial(m, i)) return (float)biaxial_attenuation(m, i, k, f, ray, wave);
  if (wave == ABBE_UNIAXIAL_ORDINARY) return (float)a_o;
  return (float)abbe_uniaxial_attenuation(
      (double)abbe_media_n(m, i, k, f), (double)(n[0] + f * (n[1] - n[0])), a_o,
      (double)(a[2] + f * (a[5] - a[2])), abbe_vector_dot(ray, m->axis[i]));
}

void abbe_media_polish(abbe_media *m) {
  free(m->rough);
  m->rough = NULL;
}
