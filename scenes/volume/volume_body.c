#include "scenes/volume/volume_body.h"

#include "base/maths.h"
#include "base/number.h"
#include "scenes/volume/light_exits.h"

#include <stdio.h>
#include <stdlib.h>
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
  ABBE_TRY(check_kind(body, object, error));
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

static const double body_symmetry_tolerance = 1e-5;
/* The direction that others are brought nearest to: along nothing that shapes are made along. */
static const double pole[3] = {0.8164, 0.4519, 0.3595};
/* The direction along which vertices are sorted, likewise. */
static const double order[3] = {0.3571, 0.7433, 0.5656};
static const double unit_map[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

/* A place of the object and what points somewhere there, both turned by a map. */
typedef struct mark {
  double place[3], way[3], along; /* in radii; unit; place along `order` */
} mark;

typedef struct search {
  mark *mark;
  size_t count;
  const mark *first, *second; /* that define a map, with the centre */
  abbe_body_symmetry *found;
} search;

static int by_along(const void *a, const void *b) {
  const double x = ((const mark *)a)->along, y = ((const mark *)b)->along;
  return x < y ? -1 : x > y;
}

static bool put_mark(search *s, const double place[3], const double way[3]) {
  mark *m = &s->mark[s->count++];
  memcpy(m->place, place, sizeof m->place);
  memcpy(m->way, way, sizeof m->way);
  m->along = abbe_vector_dot(place, order);
  return abbe_vector_finite(place);
}

static bool take_marks(const abbe_object *o, const double centre[3], double radius, search *s) {
  const bool solid = o->exact.kind == ABBE_EXACT_CONVEX;
  const size_t count = solid ? o->exact.count : o->mesh.vertex_count;
  bool whole = count <= ABBE_BODY_SYMMETRY_MOST_MARKS;
  for (size_t i = 0; i < count && whole; i++) {
    double place[3];
    if (solid) {
      const double *n = o->exact.plane[i], far = n[3] - abbe_vector_dot(n, centre);
      for (int k = 0; k < 3; k++) place[k] = n[k] * far / radius;
      whole = put_mark(s, place, n);
    } else {
      for (int k = 0; k < 3; k++) place[k] = (o->mesh.position[i][k] - centre[k]) / radius;
      whole = put_mark(s, place, o->mesh.normal[i]);
    }
  }
  if (whole) qsort(s->mark, s->count, sizeof *s->mark, by_along);
  return whole && s->count >= 3;
}

/* The furthest, and that furthest from the line to it. */
static bool body_symmetry_choose_anchors(search *s) {
  double most = 0;
  for (size_t i = 0; i < s->count; i++)
    if (abbe_vector_length(s->mark[i].place) > most) {
      most = abbe_vector_length(s->mark[i].place);
      s->first = &s->mark[i];
    }
  for (size_t i = 0, seen = 0; i < s->count && s->first != NULL; i++) {
    double across[3];
    abbe_vector_cross(s->first->place, s->mark[i].place, across);
    const double far = abbe_vector_length(across);
    if (seen > 0 && !(far > most)) continue;
    most = far;
    seen = 1;
    s->second = &s->mark[i];
  }
  return s->second != NULL && most > 1e-2;
}

static void apply(const double map[9], const double v[3], double out[3]) {
  for (int i = 0; i < 3; i++) out[i] = abbe_vector_dot(&map[3 * i], v);
}

static double distance(const double a[3], const double b[3]) {
  double off[3];
  abbe_vector_subtract(a, b, off);
  return abbe_vector_length(off);
}

static bool has_mark(const search *s, const double place[3], const double way[3]) {
  const double along = abbe_vector_dot(place, order);
  size_t low = 0, high = s->count;
  while (low < high) {
    const size_t middle = (low + high) / 2;
    if (s->mark[middle].along < along - body_symmetry_tolerance)
      low = middle + 1;
    else
      high = middle;
  }
  for (; low < s->count && s->mark[low].along <= along + body_symmetry_tolerance; low++)
    if (distance(s->mark[low].place, place) <= body_symmetry_tolerance &&
        distance(s->mark[low].way, way) <= 100 * body_symmetry_tolerance)
      return true;
  return false;
}

static bool keeps_all(const search *s, const double map[9]) {
  for (size_t i = 0; i < s->count; i++) {
    double place[3], way[3];
    apply(map, s->mark[i].place, place);
    apply(map, s->mark[i].way, way);
    if (!has_mark(s, place, way)) return false;
  }
  return true;
}

/* A map that is there already: corners of faceted meshes are several vertices in one place. */
static bool is_known(const abbe_body_symmetry *s, const double map[9]) {
  for (size_t i = 0; i < s->count; i++) {
    double off = 0;
    for (int k = 0; k < 9; k++) off = fmax(off, fabs(map[k] - s->map[i][k]));
    if (off < 100 * body_symmetry_tolerance) return true;
  }
  return false;
}

/* False where there are too many. */
static bool try_map(search *s, const mark *c, const mark *d, double side) {
  double from[9], to[9], map[9];
  abbe_vector_frame(s->first->place, s->second->place, 1, from);
  abbe_vector_frame(c->place, d->place, side, to);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) map[3 * i + j] = abbe_vector_dot(&to[3 * i], &from[3 * j]);
  if (is_known(s->found, map) || !keeps_all(s, map)) return true;
  if (s->found->count >= ABBE_BODY_SYMMETRY_MOST) return false;
  memcpy(s->found->map[s->found->count++], map, sizeof map);
  return true;
}

static bool try_all(search *s) {
  const double a = abbe_vector_length(s->first->place), b = abbe_vector_length(s->second->place);
  const double ab = abbe_vector_dot(s->first->place, s->second->place);
  for (size_t i = 0; i < s->count; i++) {
    const mark *c = &s->mark[i];
    if (fabs(abbe_vector_length(c->place) - a) > body_symmetry_tolerance) continue;
    for (size_t j = 0; j < s->count; j++) {
      const mark *d = &s->mark[j];
      if (fabs(abbe_vector_length(d->place) - b) > body_symmetry_tolerance ||
          fabs(abbe_vector_dot(c->place, d->place) - ab) > body_symmetry_tolerance)
        continue;
      if (!try_map(s, c, d, 1) || !try_map(s, c, d, -1)) return false;
    }
  }
  return true;
}

static abbe_result make_room(size_t count, abbe_body_symmetry *out, abbe_error *error) {
  *out = (abbe_body_symmetry){.count = 1};
  out->map = malloc(count * sizeof *out->map);
  if (out->map == NULL) {
    out->count = 0;
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu maps", count);
  }
  memcpy(out->map[0], unit_map, sizeof unit_map);
  return ABBE_OK;
}

abbe_result abbe_body_symmetry_find(const abbe_object *object, const double centre[3],
                                    double radius, abbe_body_symmetry *out, abbe_error *error) {
  ABBE_TRY(make_room(ABBE_BODY_SYMMETRY_MOST, out, error));
  const bool crystal = object->material != NULL && abbe_material_is_crystal(object->material);
  if (object->exact.kind == ABBE_EXACT_SPHERE || crystal || !(radius > 0)) return ABBE_OK;
  search s = {.found = out};
  s.mark = malloc(ABBE_BODY_SYMMETRY_MOST_MARKS * sizeof *s.mark);
  if (s.mark == NULL) {
    abbe_body_symmetry_free(out);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for marks of a shape");
  }
  if (take_marks(object, centre, radius, &s) && body_symmetry_choose_anchors(&s) && !try_all(&s))
    out->count = 1;
  free(s.mark);
  return ABBE_OK;
}

abbe_result abbe_body_symmetry_make(size_t count, const double (*map)[9], abbe_body_symmetry *out,
                                    abbe_error *error) {
  *out = (abbe_body_symmetry){0};
  bool good = count >= 1 && count <= ABBE_BODY_SYMMETRY_MOST;
  for (size_t i = 0; i < count && good; i++)
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++) {
        good = good && fabs(abbe_vector_dot(&map[i][3 * a], &map[i][3 * b]) - (a == b)) <= 1e-6;
        good = good && (i > 0 || fabs(map[0][3 * a + b] - (a == b)) <= 1e-6);
      }
  if (!good)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "%zu maps are no symmetry: it may be 1 to %d turns and reflections, of "
                          "which the first moves nothing",
                          count, ABBE_BODY_SYMMETRY_MOST);
  ABBE_TRY(make_room(count, out, error));
  memcpy(out->map, map, count * sizeof *map);
  out->count = count;
  return ABBE_OK;
}

void abbe_body_symmetry_free(abbe_body_symmetry *symmetry) {
  if (symmetry == NULL) return;
  free(symmetry->map);
  *symmetry = (abbe_body_symmetry){0};
}

size_t abbe_body_symmetry_bring(const abbe_body_symmetry *s, const double direction[3],
                                double out[3]) {
  size_t best = 0;
  double most = -INFINITY;
  memcpy(out, direction, 3 * sizeof *out);
  for (size_t i = 0; i < s->count; i++) {
    double there[3];
    apply(s->map[i], direction, there);
    const double near_pole = abbe_vector_dot(there, pole);
    if (!(near_pole > most)) continue;
    most = near_pole;
    best = i;
    memcpy(out, there, sizeof there);
  }
  return best;
}
