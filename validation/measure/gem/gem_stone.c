#include "validation/measure/gem/gem_stone.h"

#include "base/maths.h"
#include "base/number.h"
#include "scenes/object_motion.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void abbe_gem_stone_free(abbe_gem_stone *stone) {
  if (stone == NULL) return;
  free(stone->solid.plane[0]);
  free(stone->plane);
  free(stone->vertex);
  abbe_media_free(&stone->media);
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
  if (room != NULL && s->plane != NULL && s->vertex != NULL) return ABBE_OK;
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

static abbe_result check_index(const abbe_material *m, const abbe_wavelengths *w,
                               abbe_error *error) {
  for (int axis = 0; axis < (abbe_material_is_crystal(m) ? 3 : 1); axis++)
    for (size_t i = 0; i < w->count; i++) {
      double n;
      ABBE_TRY(abbe_material_n_along(m, axis, w->lambda_nm[i], &n, error));
      if (!(n > 1))
        return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                              "%s has index %.4g at %.4g nm; a stone's is above 1", m->name, n,
                              w->lambda_nm[i]);
    }
  return ABBE_OK;
}

/* As the media of a scene that has the stone alone. */
static abbe_result take_material(const abbe_material *m, const abbe_wavelengths *w,
                                 abbe_gem_stone *s, abbe_error *error) {
  uint32_t first = 0;
  abbe_object object = {.material = m, .axis = {0, 0, 1}, .axis_x = {1, 0, 0}};
  abbe_scene scene = {.object = &object, .object_count = 1};
  const abbe_geometry geometry = {
      .scene = &scene, .unit = s->unit_m, .refractor_count = 1, .refractor_object = &first};
  ABBE_TRY(check_index(m, w, error));
  return abbe_media_make(&geometry, w->lambda_nm, w->count - 1, &s->media, error);
}

abbe_result abbe_gem_axes_read(const char *text, abbe_gem_axes *out, abbe_error *error) {
  double *const number[] = {&out->z[0], &out->z[1], &out->z[2], &out->x[0], &out->x[1], &out->x[2]};
  size_t count = 0;
  const char *at = text, *end = text;
  *out = (abbe_gem_axes){0};
  while (count < 6) {
    const bool read = abbe_number_read(at, &end, number[count]) && isfinite(*number[count]);
    count = read ? count + 1 : 0;
    if (!read || *end != ',') break;
    at = end + 1;
  }
  if ((count != 3 && count != 6) || *end != '\0' || !(abbe_vector_length(out->z) > 0))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "'%s': a crystal's axis is X,Y,Z, such as 1,0,0 for one that lies, or "
                          "six numbers for its axes z and x",
                          text);
  return ABBE_OK;
}

abbe_result abbe_gem_stone_turn(abbe_gem_stone *s, const abbe_gem_axes *axes, abbe_error *error) {
  abbe_object o = {.axis = {0, 0, 1}, .axis_x = {1, 0, 0}};
  if (!abbe_media_is_crystal(&s->media, 0))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the stone has one index in all directions, and no axis to turn");
  const bool both = abbe_vector_length(axes->x) > 0;
  if (abbe_vector_length(axes->z) > 0) memcpy(o.axis, axes->z, sizeof o.axis);
  if (both) memcpy(o.axis_x, axes->x, sizeof o.axis_x);
  if (!abbe_vector_normalise(o.axis) || !abbe_vector_normalise(o.axis_x) ||
      (abbe_object_square_axes(&o) < ABBE_AXES_SQUARE && both))
    return abbe_error_set(
        error, ABBE_INVALID_ARGUMENT,
        "the crystal's axes x and z are parallel; they are to be at right angles");
  memcpy(s->media.axis[0], o.axis, sizeof o.axis);
  memcpy(s->media.frame[0][0], o.axis_x, sizeof o.axis_x);
  abbe_vector_cross(o.axis, o.axis_x, s->media.frame[0][1]);
  memcpy(s->media.frame[0][2], o.axis, sizeof o.axis);
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
    const double radius = out->radius = place_corners(polyhedron, out, out->middle);
    const double across =
        fmin(polyhedron->max[0] - polyhedron->min[0], polyhedron->max[1] - polyhedron->min[1]);
    out->unit_m = width_m * radius / across;
    place_planes(cut, polyhedron, out->middle, radius, out);
    result = take_material(material, wavelengths, out, error);
  }
  if (result != ABBE_OK) abbe_gem_stone_free(out);
  return result;
}
