#include "base/maths.h"

#include "base/number.h"
#include "scenes/geometry/disjoint_sets.h"
#include "scenes/mesh/mesh.h"
#include "scenes/mesh/mesh_parts.h"
#include "scenes/mesh/topology.h"

#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What is wrong with a mesh; mesh_fix.c does something about it. */
bool abbe_mesh_is_sliver(const double *const corner[3], int *tip) {
  double n[3], side[3], longest = 0.0;
  *tip = 0;
  abbe_vector_triangle(corner[0], corner[1], corner[2], n);
  for (int k = 0; k < 3; k++) {
    abbe_vector_subtract(corner[(k + 1) % 3], corner[k], side);
    const double squared = abbe_vector_dot(side, side);
    if (squared > longest) longest = squared, *tip = (k + 2) % 3;
  }
  return !(abbe_vector_length(n) > 1e-9 * longest);
}

double abbe_mesh_diagonal(const abbe_mesh *mesh, double centre[3]) {
  double low[3], high[3], size[3];
  memcpy(low, mesh->position[0], sizeof low);
  memcpy(high, low, sizeof high);
  for (size_t v = 1; v < mesh->vertex_count; v++)
    for (int k = 0; k < 3; k++) {
      low[k] = fmin(low[k], mesh->position[v][k]);
      high[k] = fmax(high[k], mesh->position[v][k]);
    }
  for (int k = 0; k < 3 && centre; k++) centre[k] = 0.5 * (low[k] + high[k]);
  abbe_vector_subtract(high, low, size);
  return abbe_vector_length(size);
}

static void measure_faces(const abbe_topology *t, abbe_mesh_report *report) {
  for (size_t f = 0; f < t->face_count; f++) {
    const double *corner[3] = {t->position[t->face[f][0]], t->position[t->face[f][1]],
                               t->position[t->face[f][2]]};
    double n[3], from_corner[3];
    int tip;
    abbe_vector_triangle(corner[0], corner[1], corner[2], n);
    /* relative to a corner of the bounds: far from the origin nothing cancels */
    abbe_vector_subtract(corner[0], report->min, from_corner);
    report->area += 0.5 * abbe_vector_length(n);
    report->volume += abbe_vector_dot(from_corner, n) / 6.0;
    if (t->face_edge[f][0] != ABBE_TOPOLOGY_NONE && !abbe_mesh_is_sliver(corner, &tip)) continue;
    if (report->degenerate_faces++ == 0)
      memcpy(report->degenerate, corner[0], sizeof report->degenerate);
  }
}

static void ends_of(const abbe_topology *t, const abbe_edge *edge, double ends[2][3]) {
  memcpy(ends[0], t->position[edge->a], sizeof ends[0]);
  memcpy(ends[1], t->position[edge->b], sizeof ends[1]);
}

static void count_edges(const abbe_topology *t, abbe_mesh_report *report) {
  for (size_t e = 0; e < t->edge_count; e++) {
    const abbe_edge *edge = &t->edge[e];
    const uint32_t faces = edge->along + edge->against;
    if (faces == 1) {
      report->open_edges++;
    } else if (faces > 2 && edge->touches) {
      report->touching_edges++;
    } else if (faces > 2) {
      if (report->crowded_edges++ == 0) {
        ends_of(t, edge, report->crowded);
        report->crowded_faces = faces;
      }
    } else if (edge->along != edge->against) {
      if (report->flipped_edges++ == 0) ends_of(t, edge, report->flipped);
    }
  }
}

/* A hole is what open edges make that hang together. */
typedef struct hole {
  size_t edges;
  double low[3], high[3];
} hole;

static void gather_holes(const abbe_topology *t, uint32_t *parent, hole *at) {
  for (size_t p = 0; p < t->point_count; p++) {
    parent[p] = (uint32_t)p;
    at[p].edges = 0;
    for (int k = 0; k < 3; k++) at[p].low[k] = INFINITY, at[p].high[k] = -INFINITY;
  }
  for (size_t e = 0; e < t->edge_count; e++)
    if (t->edge[e].along + t->edge[e].against == 1)
      abbe_disjoint_sets_unite(parent, t->edge[e].a, t->edge[e].b);
  for (size_t e = 0; e < t->edge_count; e++) {
    if (t->edge[e].along + t->edge[e].against != 1) continue;
    hole *h = &at[abbe_disjoint_sets_find(parent, t->edge[e].a)];
    h->edges++;
    for (int end = 0; end < 2; end++)
      for (int k = 0; k < 3; k++) {
        const double x = t->position[end ? t->edge[e].a : t->edge[e].b][k];
        h->low[k] = fmin(h->low[k], x);
        h->high[k] = fmax(h->high[k], x);
      }
  }
}

static abbe_result find_holes(const abbe_topology *t, abbe_mesh_report *report, abbe_error *error) {
  if (report->open_edges == 0) return ABBE_OK;
  uint32_t *parent = malloc((t->point_count + 1) * sizeof *parent);
  hole *at = malloc((t->point_count + 1) * sizeof *at);
  if (parent && at) {
    gather_holes(t, parent, at);
    for (size_t p = 0; p < t->point_count; p++) {
      double across = 0;
      if (at[p].edges == 0) continue;
      for (int k = 0; k < 3; k++) across = fmax(across, at[p].high[k] - at[p].low[k]);
      if (report->holes++ > 0 && across <= report->hole_size) continue;
      report->hole_size = across;
      report->hole_edges = at[p].edges;
      for (int k = 0; k < 3; k++) report->hole[k] = 0.5 * (at[p].low[k] + at[p].high[k]);
    }
  }
  const bool room = parent && at;
  free(parent);
  free(at);
  return room ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for holes of a mesh");
}

abbe_result abbe_mesh_check_known(const abbe_mesh *mesh, const abbe_topology *t,
                                  abbe_mesh_report *report, abbe_error *error) {
  memset(report, 0, sizeof *report);
  for (size_t v = 0; v < mesh->vertex_count; v++)
    for (int k = 0; k < 3; k++) {
      const double x = mesh->position[v][k];
      if (v == 0 || x < report->min[k]) report->min[k] = x;
      if (v == 0 || x > report->max[k]) report->max[k] = x;
    }
  count_edges(t, report);
  report->shells = t->shell_count;
  measure_faces(t, report);
  return find_holes(t, report, error);
}

abbe_result abbe_mesh_check(const abbe_mesh *mesh, abbe_mesh_report *report, abbe_error *error) {
  abbe_topology t;
  abbe_result result = abbe_topology_make(mesh, &t, error);
  memset(report, 0, sizeof *report);
  if (result == ABBE_OK) result = abbe_mesh_check_known(mesh, &t, report, error);
  abbe_topology_free(&t);
  return result;
}

#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
static void
append(char *text, size_t size, const char *format, ...) {
  const size_t used = strlen(text);
  va_list arguments;
  if (used > 0 && used + 2 < size) memcpy(text + used, ", ", 3);
  va_start(arguments, format);
  abbe_number_format_list(text + strlen(text), size - strlen(text), format, arguments);
  va_end(arguments);
}

#define PLACE "(%.4g, %.4g, %.4g)"
#define XYZ(p) (p)[0], (p)[1], (p)[2]

void abbe_mesh_report_faults(const abbe_mesh_report *r, char *text, size_t size) {
  text[0] = '\0';
  if (r->open_edges > 0)
    append(text, size,
           "%zu open edges make %zu hole%s, the widest of %zu edges, %.3g across, around " PLACE,
           r->open_edges, r->holes, r->holes == 1 ? "" : "s", r->hole_edges, r->hole_size,
           XYZ(r->hole));
  if (r->crowded_edges > 0)
    append(text, size, "%zu edge%s with more than two faces, one of %zu from " PLACE " to " PLACE,
           r->crowded_edges, r->crowded_edges == 1 ? "" : "s", r->crowded_faces, XYZ(r->crowded[0]),
           XYZ(r->crowded[1]));
  if (r->flipped_edges > 0)
    append(
        text, size, "%zu edge%s with faces turned against each other, one from " PLACE " to " PLACE,
        r->flipped_edges, r->flipped_edges == 1 ? "" : "s", XYZ(r->flipped[0]), XYZ(r->flipped[1]));
  if (r->degenerate_faces > 0)
    append(text, size, "%zu face%s without area, one at " PLACE, r->degenerate_faces,
           r->degenerate_faces == 1 ? "" : "s", XYZ(r->degenerate));
}

/* The test of [MollerTrumbore1997], with the ray from p along d; counts a hit in front of p. */
static bool ray_hits(const double p[3], const double d[3], const double a[3], const double b[3],
                     const double c[3]) {
  double u[3], v[3], s[3], h[3], q[3];
  abbe_vector_subtract(b, a, u);
  abbe_vector_subtract(c, a, v);
  abbe_vector_cross(d, v, h);
  const double determinant = abbe_vector_dot(u, h);
  if (determinant == 0.0) return false;
  abbe_vector_subtract(p, a, s);
  const double first = abbe_vector_dot(s, h) / determinant;
  if (!(first >= 0.0 && first <= 1.0)) return false;
  abbe_vector_cross(s, u, q);
  const double second = abbe_vector_dot(d, q) / determinant;
  if (!(second >= 0.0 && first + second <= 1.0)) return false;
  return abbe_vector_dot(v, q) / determinant > 0.0;
}

/* On which sides of two planes through a ray a point lies; bits. */
enum { BEFORE_FIRST = 1, BEHIND_FIRST = 2, BEFORE_SECOND = 4, BEHIND_SECOND = 8 };

typedef struct ray_planes {
  double first[3], second[3], at[2];
} ray_planes;

static ray_planes planes_of(const double p[3], const double d[3]) {
  ray_planes r = {.first = {d[1], -d[0], 0}};
  abbe_vector_cross(d, r.first, r.second);
  r.at[0] = abbe_vector_dot(r.first, p);
  r.at[1] = abbe_vector_dot(r.second, p);
  return r;
}

static unsigned side_of(const ray_planes *r, const double p[3]) {
  const double a = abbe_vector_dot(r->first, p) - r->at[0];
  const double b = abbe_vector_dot(r->second, p) - r->at[1];
  return (unsigned)((a > 0) * BEFORE_FIRST + (a < 0) * BEHIND_FIRST + (b > 0) * BEFORE_SECOND +
                    (b < 0) * BEHIND_SECOND);
}

enum { RAYS = 2, RAY_BITS = 4 };

/* Counts hits of rays from p along two directions at once, a bit each: set where the number is odd.
 * side: for the mesh's vertices; NULL: every face is looked at. */
static unsigned odd_hits(const abbe_mesh *mesh, const double p[3], const double *const d[RAYS],
                         unsigned char *side) {
  const ray_planes planes[RAYS] = {planes_of(p, d[0]), planes_of(p, d[1])};
  unsigned odd = 0;
  for (size_t v = 0; side != NULL && v < mesh->vertex_count; v++)
    side[v] = (unsigned char)(side_of(&planes[0], mesh->position[v]) |
                              side_of(&planes[1], mesh->position[v]) << RAY_BITS);
  for (size_t f = 0; f < mesh->face_count; f++) {
    const uint32_t *v = mesh->face[f];
    const unsigned beside = side != NULL ? side[v[0]] & side[v[1]] & side[v[2]] : 0;
    if ((beside & 15) != 0 && beside >> RAY_BITS != 0) continue;
    for (unsigned k = 0; k < RAYS; k++)
      if ((beside >> (RAY_BITS * k) & 15) == 0 &&
          ray_hits(p, d[k], mesh->position[v[0]], mesh->position[v[1]], mesh->position[v[2]]))
        odd ^= 1u << k;
  }
  return odd;
}

bool abbe_mesh_contains(const abbe_mesh *mesh, const double point[3]) {
  /* three odd directions vote, so that a ray through an edge cannot decide alone */
  static const double direction[3][3] = {
      {0.5391, 0.7283, 0.4231}, {-0.8127, 0.3119, 0.4921}, {0.2713, -0.5881, -0.7619}};
  const double *const two[RAYS] = {direction[0], direction[1]};
  const double *const third[RAYS] = {direction[2], direction[2]};
  unsigned char *side = malloc(mesh->vertex_count + 1);
  unsigned odd = odd_hits(mesh, point, two, side);
  if (odd == 1 || odd == 2) odd = odd_hits(mesh, point, third, side);
  free(side);
  return odd != 0;
}

/* Faces that lie on one another, corner on corner. */
typedef struct triple {
  uint32_t point[3], face; /* points in ascending order */
  bool odd;                /* the face is reversed */
} triple;

static triple triple_of(const abbe_topology *t, uint32_t face) {
  triple out = {.face = face};
  memcpy(out.point, t->face[face], sizeof out.point);
  for (int i = 0; i < 3; i++) {
    const int a = i == 1 ? 1 : 0; /* pairs (0,1), (1,2), (0,1) */
    if (out.point[a] <= out.point[a + 1]) continue;
    const uint32_t first = out.point[a];
    out.point[a] = out.point[a + 1];
    out.point[a + 1] = first;
    out.odd = !out.odd;
  }
  return out;
}

static int by_points(const void *a, const void *b) {
  const triple *x = a, *y = b;
  for (int k = 0; k < 3; k++)
    if (x->point[k] != y->point[k]) return x->point[k] < y->point[k] ? -1 : 1;
  return (x->face > y->face) - (x->face < y->face);
}

static bool same_points(const triple *a, const triple *b) {
  return memcmp(a->point, b->point, sizeof a->point) == 0;
}

/* Where faces have the same points, one stays of either side that they show; *doubles counts the
 * rest. */
static void mark(const triple *all, size_t count, bool *dropped, size_t *doubles) {
  for (size_t from = 0, to; from < count; from = to) {
    bool shown[2] = {false, false};
    for (to = from; to < count && same_points(&all[to], &all[from]); to++) {
      dropped[all[to].face] = shown[all[to].odd];
      *doubles += shown[all[to].odd];
      shown[all[to].odd] = true;
    }
  }
}

/* Faces that are there twice have edges of more than two, or of two that run alike. */
static bool may_have_doubles(const abbe_topology *t) {
  for (size_t e = 0; e < t->edge_count; e++)
    if (t->edge[e].along > 1 || t->edge[e].against > 1) return true;
  for (size_t e = 0; e < t->edge_count; e++) {
    const uint32_t *face = t->edge[e].face;
    if (face[1] == ABBE_TOPOLOGY_NONE) continue;
    const triple a = triple_of(t, face[0]), b = triple_of(t, face[1]);
    if (same_points(&a, &b)) return true;
  }
  return false;
}

abbe_result abbe_mesh_drop_doubles(abbe_mesh *mesh, size_t *doubles, abbe_error *error) {
  abbe_topology t;
  ABBE_TRY(abbe_topology_make(mesh, &t, error));
  if (!may_have_doubles(&t)) {
    abbe_topology_free(&t);
    return ABBE_OK;
  }
  abbe_result result = ABBE_OK;
  triple *all = malloc((mesh->face_count + 1) * sizeof *all);
  bool *dropped = calloc(mesh->face_count + 1, sizeof *dropped);
  if (all && dropped) {
    size_t kept = 0;
    for (size_t f = 0; f < mesh->face_count; f++) all[f] = triple_of(&t, (uint32_t)f);
    qsort(all, mesh->face_count, sizeof *all, by_points);
    mark(all, mesh->face_count, dropped, doubles);
    for (size_t f = 0; f < mesh->face_count; f++)
      if (!dropped[f]) memmove(mesh->face[kept++], mesh->face[f], sizeof mesh->face[0]);
    mesh->face_count = kept;
  } else {
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory to fix a mesh");
  }
  free(all);
  free(dropped);
  abbe_topology_free(&t);
  return result;
}
