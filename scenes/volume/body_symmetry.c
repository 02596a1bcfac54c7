#include "scenes/volume/light_exits.h"

#include "base/maths.h"

#include <stdlib.h>
#include <string.h>

static const double tolerance = 1e-5;
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
static bool choose_anchors(search *s) {
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
    if (s->mark[middle].along < along - tolerance)
      low = middle + 1;
    else
      high = middle;
  }
  for (; low < s->count && s->mark[low].along <= along + tolerance; low++)
    if (distance(s->mark[low].place, place) <= tolerance &&
        distance(s->mark[low].way, way) <= 100 * tolerance)
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
    if (off < 100 * tolerance) return true;
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
    if (fabs(abbe_vector_length(c->place) - a) > tolerance) continue;
    for (size_t j = 0; j < s->count; j++) {
      const mark *d = &s->mark[j];
      if (fabs(abbe_vector_length(d->place) - b) > tolerance ||
          fabs(abbe_vector_dot(c->place, d->place) - ab) > tolerance)
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
  abbe_result result = make_room(ABBE_BODY_SYMMETRY_MOST, out, error);
  if (result != ABBE_OK) return result;
  const bool crystal = object->material != NULL && abbe_material_is_crystal(object->material);
  if (object->exact.kind == ABBE_EXACT_SPHERE || crystal || !(radius > 0)) return ABBE_OK;
  search s = {.found = out};
  s.mark = malloc(ABBE_BODY_SYMMETRY_MOST_MARKS * sizeof *s.mark);
  if (s.mark == NULL) {
    abbe_body_symmetry_free(out);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for marks of a shape");
  }
  if (take_marks(object, centre, radius, &s) && choose_anchors(&s) && !try_all(&s)) out->count = 1;
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
  const abbe_result result = make_room(count, out, error);
  if (result != ABBE_OK) return result;
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
