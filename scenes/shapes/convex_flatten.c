/* Solids of few planes out of meshes that are nearly such. */
#include "base/maths.h"
#include "scenes/mesh/mesh_parts.h"
#include "scenes/shapes/convex.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Relative to the mesh's centre. n and d are sums until they are finished: by area. */
typedef struct mean_plane {
  double n[3], d;    /* plane of the largest triangle */
  double sum[3], at; /* normals, and offsets along the plane's own */
  double area;
} mean_plane;

typedef struct facet {
  double area;
  size_t face;
} facet;

typedef struct solid {
  const abbe_mesh *mesh;
  double centre[3], size;
  mean_plane *plane;
  size_t count, most;
} solid;

static int by_area(const void *a, const void *b) {
  const facet *x = a, *y = b;
  if (x->area != y->area) return x->area > y->area ? -1 : 1;
  return (x->face > y->face) - (x->face < y->face);
}

static void corners_of(const solid *s, size_t face, double corner[3][3]) {
  for (int k = 0; k < 3; k++)
    abbe_vector_subtract(s->mesh->position[s->mesh->face[face][k]], s->centre, corner[k]);
}

/* A face joins the plane that it lies nearest to, of those within the tolerance whose normal is not
 * more than a quarter of a right angle off; false where there are too many. */
static bool join(solid *s, size_t face, double tolerance) {
  const double alike = 0.92;
  double corner[3][3], n[3], nearest = INFINITY;
  size_t best = s->count;
  corners_of(s, face, corner);
  abbe_vector_triangle(corner[0], corner[1], corner[2], n);
  const double area = abbe_vector_length(n);
  if (!abbe_vector_normalise(n)) return true;
  for (size_t i = 0; i < s->count; i++) {
    double off = 0;
    if (abbe_vector_dot(s->plane[i].n, n) < alike) continue;
    for (int k = 0; k < 3; k++)
      off = fmax(off, fabs(abbe_vector_dot(s->plane[i].n, corner[k]) - s->plane[i].d));
    if (off <= tolerance && off < nearest) nearest = off, best = i;
  }
  if (best == s->count) {
    if (s->count == s->most) return false;
    s->plane[s->count] = (mean_plane){.d = abbe_vector_dot(n, corner[0])};
    memcpy(s->plane[s->count++].n, n, sizeof n);
  }
  mean_plane *p = &s->plane[best];
  p->area += area;
  for (int k = 0; k < 3; k++) {
    p->sum[k] += area * n[k];
    p->at += area * abbe_vector_dot(p->n, corner[k]) / 3;
  }
  return true;
}

/* The mean normals; offsets so that the mean of each plane's triangles lies in it. */
static abbe_result find_planes(solid *s, double tolerance, abbe_error *error) {
  const size_t faces = s->mesh->face_count;
  facet *order = malloc((faces + 1) * sizeof *order);
  if (!order) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for planes");
  for (size_t f = 0; f < faces; f++) {
    double corner[3][3], n[3];
    corners_of(s, f, corner);
    abbe_vector_triangle(corner[0], corner[1], corner[2], n);
    order[f] = (facet){abbe_vector_length(n), f};
  }
  qsort(order, faces, sizeof *order, by_area);
  bool few = true;
  for (size_t i = 0; i < faces && few; i++) few = join(s, order[i].face, tolerance);
  free(order);
  if (!few || s->count < 4)
    return abbe_error_set(error, ABBE_GEOMETRY, "flattened by %g of its size the mesh has %s",
                          tolerance / s->size,
                          few ? "fewer than 4 planes" : "more planes than can be followed");
  for (size_t i = 0; i < s->count; i++) {
    mean_plane *p = &s->plane[i];
    p->d = p->at / p->area;
    if (abbe_vector_normalise(p->sum)) memcpy(p->n, p->sum, sizeof p->n);
  }
  return ABBE_OK;
}

/* ---- from planes to faces ---- */

/* Planes that meet in one point but for rounding would meet in an order that depends on the caller.
 * They are parted by so much of the size, each by another share of it. */
#define PARTED 1e-7

static void part_planes(solid *s) {
  uint64_t x = 1;
  for (size_t i = 0; i < s->count; i++) {
    x = x * 6364136223846793005u + 1442695040888963407u; /* Knuth's generator */
    s->plane[i].d += PARTED * s->size * (double)(x >> 40) / (double)(1 << 24);
  }
}

/* A corner of one plane's face, and the plane along whose edge the face goes on. */
typedef struct turn {
  double at[3];
  uint32_t edge;
} turn;

typedef struct polygon {
  turn *turn;
  size_t count;
} polygon;

#define OUTSIDE UINT32_MAX /* the edge of the square that a face is cut from */

/* Keeps what lies behind plane k; `to` has capacity for one corner more than `from`. */
static void clip(const polygon *from, const mean_plane *by, uint32_t k, polygon *to) {
  to->count = 0;
  for (size_t i = 0; i < from->count; i++) {
    const turn *a = &from->turn[i], *b = &from->turn[(i + 1) % from->count];
    const double in_a = by->d - abbe_vector_dot(by->n, a->at);
    const double in_b = by->d - abbe_vector_dot(by->n, b->at);
    if (in_a >= 0) to->turn[to->count++] = *a;
    if ((in_a >= 0) == (in_b >= 0)) continue;
    turn *cut = &to->turn[to->count++];
    const double t = in_a / (in_a - in_b);
    for (int axis = 0; axis < 3; axis++)
      cut->at[axis] = a->at[axis] + t * (b->at[axis] - a->at[axis]);
    cut->edge = in_a >= 0 ? k : a->edge;
  }
}

/* A square in the plane, far larger than the mesh. */
static void begin(const solid *s, const mean_plane *p, polygon *out) {
  double u[3] = {0, 0, 0}, v[3], axis[3];
  int least = 0;
  for (int k = 1; k < 3; k++)
    if (fabs(p->n[k]) < fabs(p->n[least])) least = k;
  u[least] = 1;
  abbe_vector_cross(p->n, u, v);
  abbe_vector_normalise(v);
  abbe_vector_cross(v, p->n, axis);
  out->count = 4;
  for (int i = 0; i < 4; i++) {
    const double x = i == 0 || i == 3 ? -2 : 2, y = i < 2 ? -2 : 2;
    out->turn[i].edge = OUTSIDE;
    for (int k = 0; k < 3; k++)
      out->turn[i].at[k] = p->d * p->n[k] + s->size * (x * axis[k] + y * v[k]);
  }
}

/* Where three planes meet, the same for every order of them. */
static void meet(const solid *s, uint32_t a, uint32_t b, uint32_t c, double out[3]) {
  uint32_t of[3] = {a, b, c};
  for (int i = 0; i < 3; i++) {
    const int k = i == 1 ? 1 : 0;
    if (of[k] <= of[k + 1]) continue;
    const uint32_t first = of[k];
    of[k] = of[k + 1];
    of[k + 1] = first;
  }
  const mean_plane *p = &s->plane[of[0]], *q = &s->plane[of[1]], *r = &s->plane[of[2]];
  double qr[3], rp[3], pq[3];
  abbe_vector_cross(q->n, r->n, qr);
  abbe_vector_cross(r->n, p->n, rp);
  abbe_vector_cross(p->n, q->n, pq);
  const double determinant = abbe_vector_dot(p->n, qr);
  for (int k = 0; k < 3; k++)
    out[k] = s->centre[k] + (p->d * qr[k] + q->d * rp[k] + r->d * pq[k]) / determinant;
}

/* A fan around the middle of the face; only counted where out has no capacity yet. False: it has no
 * end. */
static bool add_face(const solid *s, uint32_t i, const polygon *face, abbe_mesh *out,
                     size_t *vertices, size_t *faces) {
  double middle[3] = {0, 0, 0};
  for (size_t k = 0; k < face->count; k++) {
    const uint32_t before = face->turn[(k + face->count - 1) % face->count].edge;
    double at[3];
    if (before == OUTSIDE || face->turn[k].edge == OUTSIDE) return false;
    meet(s, i, before, face->turn[k].edge, at);
    for (int axis = 0; axis < 3; axis++) middle[axis] += at[axis] / (double)face->count;
    if (out->position) memcpy(out->position[*vertices + k], at, sizeof at);
    if (!out->face) continue;
    uint32_t *f = out->face[*faces + k];
    f[0] = (uint32_t)(*vertices + face->count);
    f[1] = (uint32_t)(*vertices + k);
    f[2] = (uint32_t)(*vertices + (k + 1) % face->count);
  }
  if (out->position) memcpy(out->position[*vertices + face->count], middle, sizeof middle);
  for (size_t k = 0; k <= face->count && out->normal; k++)
    memcpy(out->normal[*vertices + k], s->plane[i].n, sizeof *out->normal);
  *vertices += face->count + 1;
  *faces += face->count;
  return true;
}

static abbe_result intersect(const solid *s, abbe_mesh *out, abbe_error *error) {
  polygon face[2] = {{malloc((s->count + 8) * sizeof *face[0].turn), 0},
                     {malloc((s->count + 8) * sizeof *face[1].turn), 0}};
  abbe_result result = face[0].turn && face[1].turn
                           ? ABBE_OK
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for planes");
  bool closed = true;
  for (int pass = 0; pass < 2 && result == ABBE_OK && closed; pass++) {
    size_t vertices = 0, faces = 0;
    for (uint32_t i = 0; i < s->count && closed; i++) {
      int now = 0;
      begin(s, &s->plane[i], &face[0]);
      for (uint32_t k = 0; k < s->count && face[now].count > 0; k++) {
        if (k == i) continue;
        clip(&face[now], &s->plane[k], k, &face[!now]);
        now = !now;
      }
      if (face[now].count >= 3) closed = add_face(s, i, &face[now], out, &vertices, &faces);
    }
    if (pass > 0 || !closed || faces == 0) continue;
    result = abbe_mesh_make(vertices, faces, false, out, error);
  }
  free(face[0].turn);
  free(face[1].turn);
  if (result == ABBE_OK && (!closed || !out->face))
    return abbe_error_set(error, ABBE_GEOMETRY, "the mesh's planes do not enclose anything");
  return result;
}

/* How far the mesh's corners lie off the solid: in front of a plane, or behind all of them. */
static double farthest(const solid *s, double place[3]) {
  double most = 0;
  for (size_t v = 0; v < s->mesh->vertex_count; v++) {
    double p[3], nearest = INFINITY;
    abbe_vector_subtract(s->mesh->position[v], s->centre, p);
    for (size_t i = 0; i < s->count; i++)
      nearest = fmin(nearest, s->plane[i].d - abbe_vector_dot(s->plane[i].n, p));
    if (!(fabs(nearest) > most)) continue;
    most = fabs(nearest);
    memcpy(place, s->mesh->position[v], 3 * sizeof *place);
  }
  return most;
}

abbe_result abbe_convex_flatten(abbe_mesh *mesh, double share, size_t max_planes, double *moved,
                                abbe_error *error) {
  if (!(share > 0 && share <= ABBE_CONVEX_MOST_FLATTENED))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a mesh cannot be flattened by %g of its size; it may be above 0, to %g",
                          share, ABBE_CONVEX_MOST_FLATTENED);
  solid s = {.mesh = mesh, .most = max_planes, .plane = malloc(max_planes * sizeof *s.plane)};
  if (!s.plane)
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu planes", max_planes);
  abbe_mesh made = {0};
  double place[3] = {0, 0, 0};
  s.size = abbe_mesh_diagonal(mesh, s.centre);
  abbe_result result = find_planes(&s, share * s.size, error);
  if (result == ABBE_OK) {
    const double off = farthest(&s, place);
    *moved = off / s.size;
    if (off > 3 * share * s.size)
      result = abbe_error_set(error, ABBE_GEOMETRY,
                              "flattened by %g of its size the mesh is no convex solid yet: (%.4g, "
                              "%.4g, %.4g) would move by %.3g, %.2g %% of its size",
                              share, place[0], place[1], place[2], off, 100 * *moved);
  }
  if (result == ABBE_OK) {
    part_planes(&s);
    result = intersect(&s, &made, error);
  }
  free(s.plane);
  if (result != ABBE_OK) {
    abbe_mesh_free(&made);
    return result;
  }
  abbe_mesh_free(mesh);
  *mesh = made;
  return ABBE_OK;
}
