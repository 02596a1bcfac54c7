#include "scenes/volume/volume_body.h"

#include "base/maths.h"
#include "base/number.h"

#include <stdio.h>
#include <string.h>

/* Share of its size: what a file of a mesh rounds. */
static const double tolerance = 1e-4;

static bool is_ball(const abbe_object *o) {
  const abbe_microfacets *m = &o->brushing.facets;
  return o->exact.kind == ABBE_EXACT_SPHERE && !(m->x < m->y || m->y < m->x);
}

/* The mean of all vertices: it turns with them, as the middle of bounds does not. */
static void find_centre(const abbe_object *o, double centre[3]) {
  memset(centre, 0, 3 * sizeof *centre);
  for (size_t i = 0; i < o->mesh.vertex_count; i++)
    for (int k = 0; k < 3; k++) centre[k] += o->mesh.position[i][k] / (double)o->mesh.vertex_count;
  if (is_ball(o)) memcpy(centre, o->exact.centre, 3 * sizeof *centre);
}

static void name_material(const abbe_object *o, char *out, size_t size) {
  const abbe_material *m = o->mirror ? o->conductor : o->material;
  if (m != NULL)
    snprintf(out, size, "%s", m->name);
  else
    abbe_number_format(out, size, "mirror %.6g", o->mirror_reflectance);
  const size_t used = strlen(out);
  if (abbe_brushing_is_rough(&o->brushing))
    abbe_number_format(out + used, size - used, ", rough %.6g %.6g", o->brushing.facets.x,
                       o->brushing.facets.y);
}

/* Far from the centre, from the line through it and the first, from the plane through it and both.
 */
static void choose_anchors(const abbe_object *o, const double centre[3], abbe_volume_body *b) {
  double across[3] = {0};
  for (int a = 0; a < 3; a++) {
    double most = -1;
    for (size_t i = 0; i < o->mesh.vertex_count; i++) {
      double p[3], other[3], far;
      abbe_vector_subtract(o->mesh.position[i], centre, p);
      abbe_vector_cross(b->anchor_at[0], p, other);
      far = a == 0   ? abbe_vector_length(p)
            : a == 1 ? abbe_vector_length(other)
                     : fabs(abbe_vector_dot(across, p));
      if (!(far > most)) continue;
      most = far;
      b->anchor[a] = i;
    }
    abbe_vector_subtract(o->mesh.position[b->anchor[a]], centre, b->anchor_at[a]);
    if (a == 1) abbe_vector_cross(b->anchor_at[0], b->anchor_at[1], across);
  }
}

abbe_result abbe_volume_body_make(const abbe_object *object, abbe_volume_body *out,
                                  abbe_error *error) {
  *out = (abbe_volume_body){.ball = is_ball(object),
                            .radius = object->exact.radius,
                            .vertices = object->mesh.vertex_count,
                            .faces = object->mesh.face_count};
  if (abbe_object_kind_of(object) == ABBE_OBJECT_RECEIVER)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "the object '%s' is a receiver: it bends no light, so it has no caustic",
                          object->name);
  snprintf(out->name, sizeof out->name, "%s", object->name);
  name_material(object, out->material, sizeof out->material);
  if (out->ball) return ABBE_OK;
  double centre[3], across[3];
  find_centre(object, centre);
  choose_anchors(object, centre, out);
  out->radius = abbe_vector_length(out->anchor_at[0]);
  abbe_vector_cross(out->anchor_at[0], out->anchor_at[1], across);
  if (abbe_vector_length(across) > 1e-6 * out->radius * out->radius) return ABBE_OK;
  return abbe_error_set(error, ABBE_INVALID_ARGUMENT, "the object '%s' lies on one line",
                        object->name);
}

static void turn_by_anchors(const abbe_volume_body *body, double now[3][3], double turn[9]) {
  double from[9], to[9];
  abbe_vector_frame(body->anchor_at[0], body->anchor_at[1], 1, from);
  abbe_vector_frame(now[0], now[1], 1, to);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      turn[3 * i + j] = 0;
      for (int k = 0; k < 3; k++) turn[3 * i + j] += to[3 * i + k] * from[3 * j + k];
    }
}

static abbe_result check_kind(const abbe_volume_body *b, const abbe_object *o, abbe_error *error) {
  char material[sizeof b->material];
  if (abbe_object_kind_of(o) == ABBE_OBJECT_RECEIVER)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the volume holds the caustics of '%s'; the object '%s' is a receiver",
                          b->name, o->name);
  name_material(o, material, sizeof material);
  if (strcmp(material, b->material) != 0)
    return abbe_error_set(error, ABBE_UNSUPPORTED,
                          "the volume's object is of '%s' and '%s' of '%s': make a volume anew",
                          b->material, o->name, material);
  if (b->ball == is_ball(o) && b->vertices == o->mesh.vertex_count &&
      b->faces == o->mesh.face_count)
    return ABBE_OK;
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "the volume's object has %zu vertices and %zu faces, '%s' %zu and %zu: "
                        "make a volume anew",
                        b->vertices, b->faces, o->name, o->mesh.vertex_count, o->mesh.face_count);
}

abbe_result abbe_volume_body_find(const abbe_volume_body *body, const abbe_object *object,
                                  abbe_volume_place *out, abbe_error *error) {
  *out = (abbe_volume_place){.turn = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  abbe_result result = check_kind(body, object, error);
  if (result != ABBE_OK) return result;
  find_centre(object, out->centre);
  double off = fabs(object->exact.radius - body->radius), now[3][3];
  if (!body->ball) {
    for (int a = 0; a < 3; a++)
      if (body->anchor[a] >= object->mesh.vertex_count)
        return abbe_error_set(error, ABBE_UNSUPPORTED, "the volume's object is another shape");
    for (int a = 0; a < 3; a++)
      abbe_vector_subtract(object->mesh.position[body->anchor[a]], out->centre, now[a]);
    turn_by_anchors(body, now, out->turn);
    off = 0;
    for (int a = 0; a < 3; a++)
      for (int i = 0; i < 3; i++)
        off = fmax(off, fabs(abbe_vector_dot(&out->turn[3 * i], body->anchor_at[a]) - now[a][i]));
  }
  if (off <= tolerance * body->radius) return ABBE_OK;
  return abbe_error_set(error, ABBE_UNSUPPORTED,
                        "the object '%s' is not the volume's moved and turned: its shape is off by "
                        "%.3g m of %.3g; make a volume anew",
                        object->name, off, body->radius);
}
