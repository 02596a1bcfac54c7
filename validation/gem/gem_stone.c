#include "validation/gem/gem_stone.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void abbe_gem_stone_free(abbe_gem_stone *stone) {
  if (stone == NULL) return;
  free(stone->solid.plane[0]);
  free(stone->plane);
  free(stone->vertex);
  free(stone->n);
  free(stone->attenuation);
  memset(stone, 0, sizeof *stone);
}

static abbe_result allocate(abbe_gem_stone *s, abbe_error *error) {
  const size_t filled =
      (s->plane_count + ABBE_SOLID_LANES - 1) / ABBE_SOLID_LANES * ABBE_SOLID_LANES;
  float *room = aligned_alloc(64, 4 * filled * sizeof *room);
  for (size_t i = 0; i < 4; i++) s->solid.plane[i] = room == NULL ? NULL : room + i * filled;
  s->solid.count = filled;
  s->plane = malloc(s->plane_count * sizeof *s->plane);
  s->vertex = malloc(s->vertex_count * sizeof *s->vertex);
  s->n = malloc(s->wavelengths * sizeof *s->n);
  s->attenuation = malloc(s->wavelengths * sizeof *s->attenuation);
  if (room != NULL && s->plane != NULL && s->vertex != NULL && s->n != NULL &&
      s->attenuation != NULL)
    return ABBE_OK;
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a stone of %zu planes",
                        s->plane_count);
}

/* About the middle of its bounds; returns how many of the cut's units make one of the stone's. */
static double place_corners(const abbe_cut_polyhedron *p, abbe_gem_stone *s, double middle[3]) {
  double radius = 0;
  for (int k = 0; k < 3; k++) middle[k] = 0.5 * (p->min[k] + p->max[k]);
  for (size_t i = 0; i < p->vertex_count; i++) {
    double square = 0;
    for (int k = 0; k < 3; k++) {
      s->vertex[i][k] = p->vertex[i][k] - middle[k];
      square += s->vertex[i][k] * s->vertex[i][k];
    }
    radius = fmax(radius, sqrt(square));
  }
  for (size_t i = 0; i < p->vertex_count; i++)
    for (int k = 0; k < 3; k++) s->vertex[i][k] /= radius;
  return radius;
}

/* What fills the lanes up is never met. */
static void place_planes(const abbe_cut *cut, const abbe_cut_polyhedron *p, const double middle[3],
                         double radius, abbe_gem_stone *s) {
  for (size_t j = 0; j < s->solid.count; j++) {
    double plane[4] = {0, 0, 0, 1};
    if (j < s->plane_count) {
      const abbe_cut_facet *f = &cut->facet[p->face[j].facet];
      plane[3] = f->d;
      for (int k = 0; k < 3; k++) plane[3] -= (plane[k] = f->n[k]) * middle[k];
      plane[3] /= radius;
      memcpy(s->plane[j], plane, sizeof plane);
    }
    for (int k = 0; k < 4; k++) s->solid.plane[k][j] = (float)plane[k];
  }
}

static abbe_result take_material(const abbe_material *m, const abbe_wavelengths *w,
                                 abbe_gem_stone *s, abbe_error *error) {
  for (size_t i = 0; i < w->count; i++) {
    double n;
    abbe_result result = abbe_material_n(m, w->lambda_nm[i], &n, error);
    if (result != ABBE_OK) return result;
    if (!(n > 1))
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%s has index %.4g at %.4g nm; a stone's is above 1", m->name, n,
                            w->lambda_nm[i]);
    s->n[i] = (float)n;
    s->attenuation[i] = (float)(abbe_material_attenuation(m, w->lambda_nm[i]) * s->unit_m);
  }
  return ABBE_OK;
}

abbe_result abbe_gem_stone_make(const abbe_cut *cut, const abbe_cut_polyhedron *polyhedron,
                                const abbe_material *material, const abbe_wavelengths *wavelengths,
                                double width_m, abbe_gem_stone *out, abbe_error *error) {
  memset(out, 0, sizeof *out);
  if (!(width_m > 0) || !isfinite(width_m))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a stone %g m wide; the width is above 0 and finite", width_m);
  if (polyhedron->face_count < 4 || wavelengths->count < 1)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a stone of %zu faces at %zu wavelengths; it takes 4 and 1 at least",
                          polyhedron->face_count, wavelengths->count);
  out->plane_count = polyhedron->face_count;
  out->vertex_count = polyhedron->vertex_count;
  out->wavelengths = wavelengths->count;
  abbe_result result = allocate(out, error);
  if (result == ABBE_OK) {
    double middle[3], radius = place_corners(polyhedron, out, middle);
    const double across =
        fmin(polyhedron->max[0] - polyhedron->min[0], polyhedron->max[1] - polyhedron->min[1]);
    out->unit_m = width_m * radius / across;
    place_planes(cut, polyhedron, middle, radius, out);
    result = take_material(material, wavelengths, out, error);
  }
  if (result != ABBE_OK) abbe_gem_stone_free(out);
  return result;
}
