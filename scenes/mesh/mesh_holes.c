/* Holes: their rims, and fans that close them. */
#include "base/maths.h"
#include "scenes/mesh/mesh_parts.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Holes that bend are closed only where their rim is shorter than this share of the bounds'
 * diagonal, flat ones of any size where every point is this near the plane of the rim. */
#define SMALL_HOLE 0.15
#define FLAT_HOLE 0.01

/* ---- rims ---- */

/* An open edge in the direction of a face that would close it. */
typedef struct step {
  uint32_t from, to;
} step;

static int by_start(const void *a, const void *b) {
  const step *x = a, *y = b;
  if (x->from != y->from) return x->from < y->from ? -1 : 1;
  return (x->to > y->to) - (x->to < y->to);
}

/* Rims as closed paths that pass no point twice: those of rim i from first[i] to first[i + 1] in
 * point[]. Both arrays are malloc'd. */
typedef struct rims {
  size_t count;
  uint32_t *point;
  size_t *first;
} rims;

static void rims_free(rims *r) {
  free(r->point);
  free(r->first);
  *r = (rims){0};
}

static void add_rim(rims *r, const uint32_t *way, size_t length) {
  const size_t at = r->first[r->count];
  if (length < 3) return;
  memcpy(r->point + at, way, length * sizeof *way);
  r->first[++r->count] = at + length;
}

static size_t step_from(const step *all, size_t count, uint32_t from) {
  size_t low = 0, high = count;
  while (low < high) {
    const size_t middle = (low + high) / 2;
    if (all[middle].from < from)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* Follows open edges; where the path comes to a point of its own, its last closed part is a rim. A
 * path that leads nowhere is dropped. place: of each point on the path, or NONE. */
static void walk_rims(const step *all, size_t count, bool *used, uint32_t *way, uint32_t *place,
                      rims *out) {
  for (size_t start = 0; start < count; start++) {
    size_t length = 0, at = start;
    if (used[start]) continue;
    while (at < count) {
      used[at] = true;
      if (length == 0) {
        way[length++] = all[at].from;
        place[all[at].from] = 0;
      }
      const uint32_t to = all[at].to;
      if (place[to] != ABBE_TOPOLOGY_NONE) {
        const size_t back = place[to];
        add_rim(out, way + back, length - back);
        while (length > back + 1) place[way[--length]] = ABBE_TOPOLOGY_NONE;
      } else {
        place[to] = (uint32_t)length;
        way[length++] = to;
      }
      at = step_from(all, count, to);
      while (at < count && all[at].from == to && used[at]) at++;
      if (at < count && all[at].from != to) at = count;
    }
    while (length > 0) place[way[--length]] = ABBE_TOPOLOGY_NONE;
  }
}

static abbe_result find_rims(const abbe_topology *t, rims *out, abbe_error *error) {
  size_t open = 0, n = 0;
  for (size_t e = 0; e < t->edge_count; e++) open += t->edge[e].along + t->edge[e].against == 1;
  step *all = malloc((open + 1) * sizeof *all);
  bool *used = calloc(open + 1, sizeof *used);
  uint32_t *way = malloc((open + 2) * sizeof *way);
  uint32_t *place = malloc((t->point_count + 1) * sizeof *place);
  *out = (rims){.point = malloc((open + 1) * sizeof *out->point),
                .first = calloc(open + 2, sizeof *out->first)};
  const bool room = all && used && way && place && out->point && out->first;
  if (room) {
    for (size_t e = 0; e < t->edge_count; e++) {
      const abbe_edge *edge = &t->edge[e];
      if (edge->along + edge->against != 1) continue;
      all[n++] = edge->along ? (step){edge->b, edge->a} : (step){edge->a, edge->b};
    }
    if (n > 0) qsort(all, n, sizeof *all, by_start);
    memset(place, 0xff, (t->point_count + 1) * sizeof *place);
    walk_rims(all, n, used, way, place, out);
  } else {
    rims_free(out);
  }
  free(all);
  free(used);
  free(way);
  free(place);
  return room ? ABBE_OK
              : abbe_error_set(error, ABBE_NO_MEMORY, "no memory to close the holes of a mesh");
}

/* ---- a fan ---- */

/* The longest side of its bounds. */
static double across(const abbe_mesh *mesh, const uint32_t *rim, size_t n) {
  double longest = 0;
  for (int k = 0; k < 3; k++) {
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < n; i++) {
      low = fmin(low, mesh->position[rim[i]][k]);
      high = fmax(high, mesh->position[rim[i]][k]);
    }
    longest = fmax(longest, high - low);
  }
  return longest;
}

/* The rim's centre; false where a fan from there would not be safe. */
static bool fan_is_safe(const abbe_mesh *mesh, const uint32_t *rim, size_t n, double diagonal,
                        double centre[3]) {
  double normal[3] = {0}, length = 0.0, part[3], to[3];
  memset(centre, 0, 3 * sizeof *centre);
  for (size_t i = 0; i < n; i++)
    for (int k = 0; k < 3; k++) centre[k] += mesh->position[rim[i]][k] / (double)n;
  for (size_t i = 0; i < n; i++) {
    const double *a = mesh->position[rim[i]], *b = mesh->position[rim[(i + 1) % n]];
    abbe_vector_triangle(centre, a, b, part);
    abbe_vector_subtract(b, a, to);
    length += abbe_vector_length(to);
    for (int k = 0; k < 3; k++) normal[k] += part[k];
  }
  if (!abbe_vector_normalise(normal)) return false;
  const bool small = length <= SMALL_HOLE * diagonal;
  for (size_t i = 0; i < n; i++) {
    const double *a = mesh->position[rim[i]], *b = mesh->position[rim[(i + 1) % n]];
    abbe_vector_triangle(centre, a, b, part);
    abbe_vector_subtract(a, centre, to);
    if (!small && !(abbe_vector_dot(part, normal) > 0.0)) return false;
    if (!small && fabs(abbe_vector_dot(to, normal)) > FLAT_HOLE * length) return false;
  }
  return true;
}

/* Makes capacity for more vertices and faces; the mesh keeps its counts. */
static bool grow(abbe_mesh *mesh, size_t vertices, size_t faces) {
  if (vertices > ABBE_MESH_MAX_VERTICES || faces > ABBE_MESH_MAX_FACES) return false;
  void *position = realloc(mesh->position, vertices * sizeof *mesh->position);
  if (position) mesh->position = position;
  void *normal = realloc(mesh->normal, vertices * sizeof *mesh->normal);
  if (normal) mesh->normal = normal;
  void *face = realloc(mesh->face, faces * sizeof *mesh->face);
  if (face) mesh->face = face;
  return position && normal && face;
}

static abbe_result no_room(abbe_error *error) {
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to close a hole of a mesh");
}

static abbe_result close_by_fan(abbe_mesh *mesh, const uint32_t *rim, size_t n,
                                const double centre[3], abbe_error *error) {
  const bool triangle = n == 3;
  const size_t vertices = mesh->vertex_count + !triangle;
  const size_t faces = mesh->face_count + (triangle ? 1 : n);
  if (!grow(mesh, vertices, faces)) return no_room(error);
  if (triangle) {
    memcpy(mesh->face[mesh->face_count], rim, sizeof mesh->face[0]);
  } else {
    memcpy(mesh->position[mesh->vertex_count], centre, 3 * sizeof(double));
    for (size_t i = 0; i < n; i++) {
      const uint32_t f[3] = {(uint32_t)mesh->vertex_count, rim[i], rim[(i + 1) % n]};
      memcpy(mesh->face[mesh->face_count + i], f, sizeof f);
    }
  }
  mesh->vertex_count = vertices;
  mesh->face_count = faces;
  return ABBE_OK;
}

/* ---- all of them ---- */

/* Rims are in points; the mesh has one vertex a point, in another order perhaps. */
static abbe_result name_vertices(const abbe_mesh *mesh, const abbe_topology *t, rims *r,
                                 abbe_error *error) {
  uint32_t *vertex = malloc((t->point_count + 1) * sizeof *vertex);
  if (!vertex) return no_room(error);
  for (size_t v = 0; v < mesh->vertex_count; v++) vertex[t->point[v]] = (uint32_t)v;
  for (size_t i = 0; i < r->first[r->count]; i++) r->point[i] = vertex[r->point[i]];
  free(vertex);
  return ABBE_OK;
}

abbe_result abbe_mesh_close_holes(abbe_mesh *mesh, size_t *count, double *widest,
                                  abbe_error *error) {
  abbe_topology t;
  rims r = {0};
  double centre[3];
  ABBE_TRY(abbe_topology_make(mesh, &t, error));
  abbe_result result = find_rims(&t, &r, error);
  if (result == ABBE_OK && r.count > 0) result = name_vertices(mesh, &t, &r, error);
  const double diagonal = r.count > 0 ? abbe_mesh_diagonal(mesh, NULL) : 0;
  for (size_t i = 0; result == ABBE_OK && i < r.count; i++) {
    const uint32_t *rim = r.point + r.first[i];
    const size_t n = r.first[i + 1] - r.first[i];
    if (!fan_is_safe(mesh, rim, n, diagonal, centre)) continue;
    result = close_by_fan(mesh, rim, n, centre, error);
    ++*count;
    *widest = fmax(*widest, across(mesh, rim, n));
  }
  rims_free(&r);
  abbe_topology_free(&t);
  return result;
}
