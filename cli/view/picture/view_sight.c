#include "cli/view/picture/view_sight.h"

#include "scenes/geometry/vector.h"
#include "spectral/optics.h"

#include <math.h>
#include <string.h>

/* Along a ray to a triangle [MollerTrumbore1997], or infinity. */
static double distance_to(const double origin[3], const double direction[3], const double a[3],
                          const double b[3], const double c[3]) {
  double u[3], v[3], across[3], from[3], q[3];
  abbe_vector_subtract(b, a, u);
  abbe_vector_subtract(c, a, v);
  abbe_vector_cross(direction, v, across);
  const double whole = abbe_vector_dot(u, across);
  if (whole == 0) return INFINITY;
  abbe_vector_subtract(origin, a, from);
  const double s = abbe_vector_dot(from, across) / whole;
  abbe_vector_cross(from, u, q);
  const double t = abbe_vector_dot(direction, q) / whole;
  const double distance = abbe_vector_dot(v, q) / whole;
  return s >= 0 && t >= 0 && s + t <= 1 ? distance : INFINITY;
}

void abbe_view_meet(const abbe_scene *scene, const double origin[3], const double direction[3],
                    double from, bool bending, abbe_view_met *out) {
  *out = (abbe_view_met){.distance = INFINITY};
  for (size_t i = 0; i < scene->object_count; i++) {
    const abbe_object *object = &scene->object[i];
    const abbe_mesh *m = &object->mesh;
    const bool may = !bending || abbe_object_kind_of(object) != ABBE_OBJECT_RECEIVER;
    for (size_t f = 0; may && f < m->face_count; f++) {
      const uint32_t *at = m->face[f];
      const double d = distance_to(origin, direction, m->position[at[0]], m->position[at[1]],
                                   m->position[at[2]]);
      if (d > from && d < out->distance) *out = (abbe_view_met){object, i, f, d};
    }
  }
}

void abbe_view_met_normal(const abbe_object *object, size_t face, double out[3]) {
  const abbe_mesh *m = &object->mesh;
  const uint32_t *at = m->face[face];
  abbe_vector_triangle(m->position[at[0]], m->position[at[1]], m->position[at[2]], out);
  abbe_vector_normalise(out);
}

/* On the side that the ray comes from. True: the ray enters the object. */
static bool face_ray(const abbe_view_met *met, const double place[3], const double direction[3],
                     double n[3]) {
  const abbe_exact *exact = &met->object->exact;
  abbe_view_met_normal(met->object, met->face, n);
  if (exact->kind == ABBE_EXACT_SPHERE) {
    abbe_vector_subtract(place, exact->centre, n);
    abbe_vector_normalise(n);
  }
  const bool enters = abbe_vector_dot(direction, n) < 0;
  for (int k = 0; k < 3 && !enters; k++) n[k] = -n[k];
  return enters;
}

/* The stronger of the two ways on. */
static bool turn(const abbe_view_met *met, const double place[3], double nm, double direction[3]) {
  double n[3], back[3], index = 1, on[3];
  const bool enters = face_ray(met, place, direction, n);
  for (int k = 0; k < 3; k++) back[k] = -direction[k];
  if (met->object->material != NULL &&
      abbe_material_n(met->object->material, nm, &index, NULL) != ABBE_OK)
    return false;
  const double eta = enters ? 1 / index : index;
  const bool reflects =
      met->object->mirror || abbe_optics_fresnel(abbe_vector_dot(back, n), eta) > 0.5;
  if (reflects || !abbe_optics_refract(back, n, eta, on)) abbe_optics_reflect(back, n, on);
  memcpy(direction, on, 3 * sizeof *direction);
  return true;
}

void abbe_view_sight_follow(const abbe_scene *scene, const double eye[3], const double direction[3],
                            double nm, abbe_view_sight *out) {
  double at[3], along[3], from = 0;
  memcpy(at, eye, sizeof at);
  memcpy(along, direction, sizeof along);
  *out = (abbe_view_sight){.nm = nm};
  while (out->count < ABBE_VIEW_SIGHT_PLACES) {
    abbe_view_met met;
    abbe_view_meet(scene, at, along, from, false, &met);
    if (met.object == NULL) return;
    for (int k = 0; k < 3; k++) at[k] += met.distance * along[k];
    out->length += met.distance;
    memcpy(out->place[out->count++], at, sizeof at);
    out->lands = abbe_object_kind_of(met.object) == ABBE_OBJECT_RECEIVER;
    if (out->lands || !turn(&met, at, nm, along)) return;
    from = 1e-9 * out->length; /* not the place where it is again */
  }
}
