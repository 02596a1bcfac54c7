#include "validation/measure/derive/specular_meet.h"

#include "base/maths.h"

#include <math.h>
#include <string.h>

static bool meet_sphere(const abbe_exact *e, const double o[3], const double d[3], bool inside,
                        double least, abbe_meeting *m) {
  double r[3];
  abbe_vector_subtract(o, e->centre, r);
  const double along = abbe_vector_dot(r, d);
  double off[3];
  for (int k = 0; k < 3; k++) off[k] = r[k] - along * d[k];
  const double square = e->radius * e->radius - abbe_vector_dot(off, off);
  if (square <= 0 || (!inside && along >= 0)) return false;
  const double t = inside ? -along + sqrt(square) : -along - sqrt(square);
  if (!(t > (inside ? 0 : least)) || t >= m->t) return false;
  m->t = t;
  m->face = 0;
  for (int k = 0; k < 3; k++) m->n[k] = (r[k] + t * d[k]) / e->radius;
  return true;
}

bool abbe_specular_cross(const abbe_specular_surface *s, const double o[3], const double d[3],
                         double t[2], uint32_t face[2]) {
  double in = -INFINITY, out = INFINITY;
  size_t face_in = 0, face_out = 0;
  bool past = false;
  for (size_t i = 0; i < s->object->exact.count; i++) {
    const double *n = s->object->exact.plane[i];
    const double along = abbe_vector_dot(n, d), above = abbe_vector_dot(n, o) - n[3];
    if (along == 0) {
      past = past || above > 0;
      continue;
    }
    const double at = -above / along;
    if (along > 0 && at < out) out = at, face_out = i;
    if (along < 0 && at > in) in = at, face_in = i;
  }
  t[0] = in;
  t[1] = out;
  face[0] = s->plane[face_in];
  face[1] = s->plane[face_out];
  return !past;
}

static bool meet_planes(const abbe_specular_surface *s, const double o[3], const double d[3],
                        bool inside, double least, abbe_meeting *m) {
  double at[2];
  uint32_t face[2];
  const bool crossed = abbe_specular_cross(s, o, d, at, face);
  if (!inside && (!crossed || at[0] >= at[1] || at[0] <= least)) return false;
  const double t = inside ? fmax(at[1], 0) : at[0];
  if (t >= m->t) return false;
  m->t = t;
  m->face = face[inside];
  memcpy(m->n, s->object->exact.plane[s->numbered[m->face]], sizeof m->n);
  return true;
}

static void find_normal(const abbe_specular_surface *s, abbe_meeting *m) {
  const uint32_t *v = s->object->mesh.face[m->face];
  const double(*normal)[3] = (const double(*)[3])s->object->mesh.normal;
  const double u = m->side[0], w = m->side[1];
  for (int k = 0; k < 3; k++)
    m->n[k] = (1 - u - w) * normal[v[0]][k] + u * normal[v[1]][k] + w * normal[v[2]][k];
  abbe_vector_normalise(m->n);
}

static bool meet_triangles(const abbe_specular_surface *s, const double o[3], const double d[3],
                           double least, abbe_meeting *m) {
  abbe_bvh_hit hit;
  if (!abbe_bvh_trace(&s->bvh, (const double(*)[9])s->triangle, o, d, 0, least, m->t, &hit))
    return false;
  m->t = hit.t;
  m->face = (uint32_t)hit.index;
  m->side[0] = hit.u;
  m->side[1] = hit.v;
  find_normal(s, m);
  return true;
}

uint32_t abbe_specular_face(const abbe_specular *s, uint32_t object, uint32_t face) {
  if (object >= ABBE_SPECULAR_LAMP) return 0;
  const abbe_specular_surface *of = &s->surface[object];
  if (of->triangle == NULL) return face;
  if (abbe_object_kind_of(of->object) == ABBE_OBJECT_RECEIVER)
    return of->object->mesh.face_count <= 2 ? 0 : face;
  return of->sheet != NULL ? of->sheet[face] : face;
}

/* Where the ray meets a light's plane; side: there, of its radius or its half edges. */
static bool meet_lamp_plane(const abbe_light *l, const double o[3], const double d[3],
                            abbe_meeting *m) {
  double off[3], x[3], y[3];
  const double along = abbe_vector_dot(d, l->direction);
  abbe_vector_subtract(l->position, o, off);
  if (along == 0) return false;
  m->t = abbe_vector_dot(off, l->direction) / along;
  for (int k = 0; k < 3; k++) off[k] = o[k] + m->t * d[k] - l->position[k];
  memcpy(m->n, l->direction, sizeof m->n);
  if (l->kind == ABBE_LIGHT_DISK) {
    abbe_light_upright(l->direction, x, y);
    m->side[0] = abbe_vector_dot(off, x) / l->radius;
    m->side[1] = abbe_vector_dot(off, y) / l->radius;
    return true;
  }
  for (int k = 0; k < 2; k++)
    m->side[k] = abbe_vector_dot(off, l->edge[k]) / abbe_vector_dot(l->edge[k], l->edge[k]);
  return true;
}

static void meet_lamps(const abbe_specular *s, const double o[3], const double d[3], double least,
                       abbe_meeting *m) {
  for (size_t i = 0; i < s->scene->light_count; i++) {
    const abbe_light *l = &s->scene->light[i];
    abbe_meeting near;
    if (!abbe_light_has_size(l) || !meet_lamp_plane(l, o, d, &near)) continue;
    const double *at = near.side;
    const bool on = l->kind == ABBE_LIGHT_DISK ? at[0] * at[0] + at[1] * at[1] < 1
                                               : fabs(at[0]) < 1 && fabs(at[1]) < 1;
    if (!on || near.t <= least || near.t >= m->t) continue;
    *m = near;
    m->object = ABBE_SPECULAR_LAMP + (uint32_t)i;
    m->face = 0;
  }
}

static bool is_within(const abbe_specular_surface *of, uint64_t inside) {
  return abbe_object_kind_of(of->object) == ABBE_OBJECT_REFRACTOR &&
         (inside >> of->refractor & 1) != 0;
}

void abbe_specular_meet(const abbe_specular *s, const double o[3], const double d[3],
                        uint64_t inside, bool receivers_alone, uint32_t but, bool lamps,
                        abbe_meeting *m) {
  const double least = ABBE_SPECULAR_LEAVE * s->far;
  m->t = 4 * s->far;
  m->object = ABBE_SPECULAR_NOTHING;
  m->face = 0;
  for (size_t i = 0; i < s->count; i++) {
    const abbe_specular_surface *of = &s->surface[i];
    if (i == but || (receivers_alone && abbe_object_kind_of(of->object) != ABBE_OBJECT_RECEIVER))
      continue;
    const bool within = is_within(of, inside);
    if (of->object->exact.kind == ABBE_EXACT_SPHERE
            ? meet_sphere(&of->object->exact, o, d, within, least, m)
        : abbe_specular_has_planes(of) ? meet_planes(of, o, d, within, least, m)
                                       : meet_triangles(of, o, d, least, m))
      m->object = (uint32_t)i;
  }
  if (lamps) meet_lamps(s, o, d, least, m);
}

/* The triangle's plane. */
static bool meet_triangle(const abbe_specular_surface *s, const double o[3], const double d[3],
                          abbe_meeting *m) {
  const double *t = s->triangle[m->face];
  double b[3], c[3], n[3], p[3], x[3];
  abbe_vector_subtract(t + 3, t, b);
  abbe_vector_subtract(t + 6, t, c);
  abbe_vector_subtract(t, o, p);
  abbe_vector_cross(b, c, n);
  const double along = abbe_vector_dot(n, d), square = abbe_vector_dot(n, n);
  if (along == 0) return false;
  m->t = abbe_vector_dot(n, p) / along;
  for (int k = 0; k < 3; k++) p[k] = m->t * d[k] - p[k];
  abbe_vector_cross(p, c, x);
  m->side[0] = abbe_vector_dot(x, n) / square;
  abbe_vector_cross(b, p, x);
  m->side[1] = abbe_vector_dot(x, n) / square;
  find_normal(s, m);
  return true;
}

bool abbe_specular_meet_face(const abbe_specular *s, uint32_t object, uint32_t face,
                             const double o[3], const double d[3], uint64_t inside,
                             abbe_meeting *m) {
  m->object = object;
  m->face = face;
  m->t = INFINITY;
  if (object == ABBE_SPECULAR_NOTHING) return true;
  if (object >= ABBE_SPECULAR_LAMP)
    return meet_lamp_plane(&s->scene->light[object - ABBE_SPECULAR_LAMP], o, d, m);
  const abbe_specular_surface *of = &s->surface[object];
  if (of->object->exact.kind == ABBE_EXACT_SPHERE)
    return meet_sphere(&of->object->exact, o, d, is_within(of, inside), -INFINITY, m);
  if (!abbe_specular_has_planes(of)) return meet_triangle(of, o, d, m);
  const double *n = of->object->exact.plane[of->numbered[face]];
  const double along = abbe_vector_dot(n, d);
  if (along == 0) return false;
  m->t = (n[3] - abbe_vector_dot(n, o)) / along;
  memcpy(m->n, n, sizeof m->n);
  return true;
}
