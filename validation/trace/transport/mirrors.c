#include "validation/trace/transport/mirrors.h"

#include "base/maths.h"

#include <stdlib.h>

static void fill_lobe(const abbe_geometry *g, const abbe_brushing *b, abbe_mirror_lobe *out) {
  out->x = (float)b->facets.x;
  out->y = (float)b->facets.y;
  out->around = b->around ? 1 : 0;
  abbe_geometry_to_frame(g, b->centre, out->centre);
  for (int k = 0; k < 3; k++) out->axis[k] = (float)b->axis[k];
}

static abbe_result fill(const abbe_geometry *g, const double *lambda_nm, abbe_mirrors *m,
                        abbe_error *error) {
  for (size_t i = 0; i < m->count; i++) {
    const abbe_object *o = &g->scene->object[g->mirror_object[i]];
    m->reflectance[i] = o->conductor != NULL ? -1 : (float)o->mirror_reflectance;
    fill_lobe(g, &o->brushing, &m->lobe[i]);
    for (size_t k = 0; k <= m->steps && o->conductor != NULL; k++) {
      double nk[2];
      ABBE_TRY(abbe_material_nk(o->conductor, lambda_nm[k], &nk[0], &nk[1], error));
      for (int c = 0; c < 2; c++) m->nk[i * (m->steps + 1) + k][c] = (float)nk[c];
    }
  }
  return ABBE_OK;
}

abbe_result abbe_mirrors_make(const abbe_geometry *geometry, const double *lambda_nm, size_t steps,
                              abbe_mirrors *out, abbe_error *error) {
  abbe_mirrors m = {.count = geometry->mirror_count, .steps = steps};
  m.reflectance = calloc(m.count + 1, sizeof *m.reflectance);
  m.nk = calloc(m.count * (steps + 1) + 1, sizeof *m.nk);
  m.lobe = calloc(m.count + 1, sizeof *m.lobe);
  abbe_result result =
      m.reflectance == NULL || m.nk == NULL || m.lobe == NULL
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
  free(m->lobe);
  *m = (abbe_mirrors){0};
}

void abbe_mirrors_meet(const abbe_mirrors *m, size_t mirror, const float p[3], const float n[3],
                       const float d[3], abbe_rough_hit *out) {
  const abbe_mirror_lobe *l = &m->lobe[mirror];
  const double least = 1e-6, at[3] = {(double)p[0], (double)p[1], (double)p[2]};
  abbe_brushing b = {.facets = {(double)l->x, (double)l->y}, .around = l->around > 0};
  double back[3];
  for (int k = 0; k < 3; k++) {
    b.axis[k] = (double)l->axis[k];
    b.centre[k] = (double)l->centre[k];
    out->n[k] = (double)n[k];
    back[k] = -(double)d[k];
  }
  out->facets = b.facets;
  abbe_vector_normalise(out->n);
  abbe_brushing_grain(&b, at, out->n, out->x);
  abbe_vector_cross(out->n, out->x, out->y);
  out->wo[0] = abbe_vector_dot(back, out->x);
  out->wo[1] = abbe_vector_dot(back, out->y);
  out->wo[2] = fmax(abbe_vector_dot(back, out->n), least);
  abbe_vector_normalise(out->wo);
}

float abbe_mirrors_scatter(const abbe_rough_hit *hit, const float u[2], float out[3], float *pdf,
                           float *cos_h) {
  const double random[2] = {(double)u[0], (double)u[1]};
  double h[3], wi[3];
  const double share = abbe_microfacets_sample(&hit->facets, hit->wo, random, h, wi);
  for (int k = 0; k < 3; k++)
    out[k] = (float)(wi[0] * hit->x[k] + wi[1] * hit->y[k] + wi[2] * hit->n[k]);
  *pdf = (float)abbe_microfacets_pdf(&hit->facets, hit->wo, wi);
  *cos_h = (float)fmin(fmax(abbe_vector_dot(hit->wo, h), 0), 1);
  return (float)share;
}

float abbe_mirrors_lobe(const abbe_rough_hit *hit, const float to[3], float *pdf, float *cos_h) {
  const double d[3] = {(double)to[0], (double)to[1], (double)to[2]};
  double wi[3] = {abbe_vector_dot(d, hit->x), abbe_vector_dot(d, hit->y),
                  abbe_vector_dot(d, hit->n)},
         h[3];
  for (int k = 0; k < 3; k++) h[k] = wi[k] + hit->wo[k];
  abbe_vector_normalise(h);
  *pdf = (float)abbe_microfacets_pdf(&hit->facets, hit->wo, wi);
  *cos_h = (float)fmin(fmax(abbe_vector_dot(hit->wo, h), 0), 1);
  return (float)abbe_microfacets_reflect(&hit->facets, wi, hit->wo);
}
