#include "scenes/shapes/convex.h"

#include "base/number.h"
#include "base/thread/watch.h"
#include "scenes/mesh/mesh_parts.h"
#include "scenes/mesh/topology.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Relative to the mesh's centre. */
typedef struct face_plane {
  double n[3], d;
} face_plane;

typedef struct facet {
  double area;
  uint32_t face;
} facet;

typedef struct search {
  const abbe_mesh *mesh;
  double centre[3], size, tolerance; /* m */
  double thin;                       /* faces of less height have no normal of their own, m */
  facet *order;                      /* faces, the largest first */
  size_t faces;                      /* faces of them that are looked at */
  face_plane *plane;
  uint32_t *plane_of;
  size_t most, count;
} search;

static int by_area(const void *a, const void *b) {
  const facet *x = a, *y = b;
  if (x->area != y->area) return x->area > y->area ? -1 : 1;
  return (x->face > y->face) - (x->face < y->face);
}

static void corners_of(const search *s, size_t face, double corner[3][3]) {
  for (int k = 0; k < 3; k++)
    abbe_vector_subtract(s->mesh->position[s->mesh->face[face][k]], s->centre, corner[k]);
}

static double farthest(const face_plane *plane, const double corner[3][3]) {
  double off = 0;
  for (int k = 0; k < 3; k++)
    off = fmax(off, fabs(abbe_vector_dot(plane->n, corner[k]) - plane->d));
  return off;
}

static double longest_side(const double corner[3][3]) {
  double longest = 0, side[3];
  for (int k = 0; k < 3; k++) {
    abbe_vector_subtract(corner[(k + 1) % 3], corner[k], side);
    longest = fmax(longest, abbe_vector_length(side));
  }
  return longest;
}

static double height_of(const double corner[3][3]) {
  double n[3];
  const double longest = longest_side(corner);
  abbe_vector_triangle(corner[0], corner[1], corner[2], n);
  return longest > 0 ? abbe_vector_length(n) / longest : 0;
}

/* Puts each face into the plane that it lies nearest to, or begins another with it. False where
 * there are more than s->most. What is thin has no plane of its own: it goes with the nearest. */
static bool gather_planes(search *s) {
  const double alike = 0.9999; /* cosine of the angle between normals of one plane */
  s->count = 0;
  for (size_t i = 0; i < s->faces; i++) {
    double corner[3][3], n[3], nearest = INFINITY;
    size_t best = 0;
    corners_of(s, s->order[i].face, corner);
    abbe_vector_triangle(corner[0], corner[1], corner[2], n);
    const double height = height_of((const double(*)[3])corner);
    const bool thin = !(height > s->thin) || !abbe_vector_normalise(n);
    const double least = thin ? -1 : fmin(alike, cos(fmin(2 * s->tolerance / height, 1.5)));
    for (size_t k = 0; k < s->count; k++) {
      if (!thin && abbe_vector_dot(s->plane[k].n, n) < least) continue;
      const double off = farthest(&s->plane[k], (const double(*)[3])corner);
      if (off < nearest) nearest = off, best = k;
    }
    if (nearest > s->tolerance && !(thin && s->count > 0)) {
      if (s->count == s->most) return false;
      if (thin) return false; /* the largest face has no area */
      best = s->count++;
      memcpy(s->plane[best].n, n, sizeof n);
      s->plane[best].d = abbe_vector_dot(n, corner[0]);
    }
    s->plane_of[s->order[i].face] = (uint32_t)best;
  }
  return s->count >= 4;
}

enum { ASKED = 1024 }; /* vertices */

/* By how much a vertex lies in front of a plane at the most, m, and which. */
static double deepest_dent(const search *s, double place[3]) {
  double most = 0;
  for (size_t v = 0; v < s->mesh->vertex_count; v++) {
    double p[3];
    if (v % ASKED == 0 && !abbe_watch_goes_on()) break;
    abbe_vector_subtract(s->mesh->position[v], s->centre, p);
    for (size_t i = 0; i < s->count; i++) {
      const double front = abbe_vector_dot(s->plane[i].n, p) - s->plane[i].d;
      if (!(front > most)) continue;
      most = front;
      memcpy(place, s->mesh->position[v], 3 * sizeof *place);
    }
  }
  return most;
}

/* Whether faces beside a plane's lie clearly off it or meet it at an angle, all that have a plane
 * of their own: the planes that a gentle curve is cut into differ by nothing but the cut. */
static bool planes_are_clear(const search *s, const abbe_topology *t) {
  for (size_t i = 0; i < t->edge_count; i++) {
    const uint32_t *face = t->edge[i].face;
    if (face[1] == ABBE_TOPOLOGY_NONE || s->plane_of[face[0]] == s->plane_of[face[1]]) continue;
    for (int k = 0; k < 2; k++) {
      double corner[3][3];
      corners_of(s, face[k], corner);
      const face_plane *own = &s->plane[s->plane_of[face[k]]];
      const face_plane *beside = &s->plane[s->plane_of[face[1 - k]]];
      const double height = height_of((const double(*)[3])corner);
      if (!(height > 2 * ABBE_CONVEX_CLEAR * s->tolerance)) continue;
      if (!(farthest(beside, (const double(*)[3])corner) > ABBE_CONVEX_CLEAR * s->tolerance) &&
          abbe_vector_dot(own->n, beside->n) > cos(ABBE_CONVEX_CLEAR_RAD))
        return false;
    }
  }
  return true;
}

static abbe_result one_surface(const abbe_mesh *mesh, bool *closed, abbe_error *error) {
  abbe_mesh_report report;
  const abbe_result result = abbe_mesh_check(mesh, &report, error);
  *closed = result == ABBE_OK && report.open_edges == 0 && report.crowded_edges == 0 &&
            report.flipped_edges == 0 && report.shells == 1 && report.volume > 0.0;
  return result == ABBE_NO_MEMORY ? result : ABBE_OK;
}

/* How far the corners' normals are off those of their planes, rad, and where. Thin faces have no
 * normal to speak of: theirs count into *all alone. */
static double most_rounded(const search *s, double *all, double place[3]) {
  double most = 0;
  *all = 0;
  for (size_t f = 0; f < s->mesh->face_count; f++) {
    const double *n = s->plane[s->plane_of[f]].n;
    double corner[3][3];
    corners_of(s, f, corner);
    const bool thin = !(height_of((const double(*)[3])corner) > 2 * s->tolerance);
    for (int k = 0; k < 3; k++) {
      const uint32_t v = s->mesh->face[f][k];
      double across[3];
      abbe_vector_cross(n, s->mesh->normal[v], across);
      const double off = atan2(abbe_vector_length(across), abbe_vector_dot(n, s->mesh->normal[v]));
      *all = fmax(*all, off);
      if (thin || !(off > most)) continue;
      most = off;
      memcpy(place, s->mesh->position[v], 3 * sizeof *place);
    }
  }
  return most;
}

/* One face of every so many, the largest first. */
static void order_faces(search *s, size_t step) {
  const abbe_mesh *mesh = s->mesh;
  s->faces = 0;
  for (size_t f = 0; f < mesh->face_count; f += step) {
    double n[3];
    abbe_vector_triangle(mesh->position[mesh->face[f][0]], mesh->position[mesh->face[f][1]],
                         mesh->position[mesh->face[f][2]], n);
    s->order[s->faces++] = (facet){abbe_vector_length(n), (uint32_t)f};
  }
  qsort(s->order, s->faces, sizeof *s->order, by_area);
}

/* With one tolerance, of the size. A skin has thin faces that are its edge; those of all others are
 * what rounding left. */
static abbe_result attempt(search *s, double tolerance, bool first, bool skin, abbe_convex *out,
                           abbe_error *error) {
  const abbe_result wanted = abbe_watch_check(error);
  if (wanted != ABBE_OK) return wanted;
  s->tolerance = tolerance * s->size;
  s->thin = skin ? 0 : 2 * s->tolerance;
  out->verdict = ABBE_CONVEX_MANY;
  out->tolerance = tolerance;
  const bool few = gather_planes(s);
  out->planes = few ? s->count : s->most;
  if (!few) return ABBE_OK;
  out->off = deepest_dent(s, out->place);
  out->verdict = out->off > s->tolerance ? ABBE_CONVEX_DENTED : ABBE_CONVEX_SOLID;
  if (out->verdict != ABBE_CONVEX_SOLID || first) return ABBE_OK;
  abbe_topology t;
  const abbe_result result = abbe_topology_make(s->mesh, &t, error);
  if (result != ABBE_OK) return result == ABBE_NO_MEMORY ? result : ABBE_OK;
  if (!planes_are_clear(s, &t)) out->verdict = ABBE_CONVEX_CURVED;
  abbe_topology_free(&t);
  return ABBE_OK;
}

/* A sample of a large mesh shows at once that it has too many planes. */
enum { SAMPLE = 4096 };

static abbe_result judge(search *s, abbe_convex *out, abbe_error *error) {
  static const double tolerance[] = ABBE_CONVEX_TOLERANCES;
  const size_t tries = sizeof tolerance / sizeof *tolerance;
  abbe_result result = ABBE_OK;
  s->size = abbe_mesh_diagonal(s->mesh, s->centre);
  out->size = s->size;
  order_faces(s, s->mesh->face_count / SAMPLE + 1);
  if (s->faces < s->mesh->face_count)
    result = attempt(s, tolerance[tries - 1], true, false, out, error);
  if (s->faces == s->mesh->face_count || out->verdict != ABBE_CONVEX_MANY) {
    order_faces(s, 1);
    result = attempt(s, tolerance[0], true, true, out, error);
    for (size_t i = 0; i < tries && result == ABBE_OK; i++)
      if (out->verdict != ABBE_CONVEX_SOLID)
        result = attempt(s, tolerance[i], i == 0, false, out, error);
  }
  if (result == ABBE_OK && out->verdict == ABBE_CONVEX_MANY) {
    out->off = deepest_dent(s, out->place);
    if (out->off > s->tolerance) out->verdict = ABBE_CONVEX_DENTED;
  }
  if (result != ABBE_OK || out->verdict != ABBE_CONVEX_SOLID) return result;
  bool closed = false;
  result = one_surface(s->mesh, &closed, error);
  if (result == ABBE_OK && !closed) out->verdict = ABBE_CONVEX_PARTS;
  if (result != ABBE_OK || !closed) return result;
  double all;
  out->off = most_rounded(s, &all, out->place);
  if (out->off > ABBE_CONVEX_FLAT_RAD)
    out->verdict = ABBE_CONVEX_ROUNDED;
  else
    out->off = all;
  return ABBE_OK;
}

abbe_result abbe_convex_find(const abbe_mesh *mesh, size_t max_planes, double (*plane)[4],
                             uint32_t *plane_of, abbe_convex *out, abbe_error *error) {
  memset(out, 0, sizeof *out);
  if (mesh->face_count == 0 || max_planes == 0 || max_planes > 4096) return ABBE_OK;
  search s = {.mesh = mesh, .most = max_planes};
  s.order = malloc(mesh->face_count * sizeof *s.order);
  s.plane = malloc(max_planes * sizeof *s.plane);
  s.plane_of = calloc(mesh->face_count, sizeof *s.plane_of);
  abbe_result result =
      s.order && s.plane && s.plane_of
          ? judge(&s, out, error)
          : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu planes", max_planes);
  for (size_t i = 0; out->verdict == ABBE_CONVEX_SOLID && i < s.count; i++) {
    memcpy(plane[i], s.plane[i].n, sizeof s.plane[i].n);
    plane[i][3] = s.plane[i].d + abbe_vector_dot(s.plane[i].n, s.centre);
  }
  if (plane_of && out->verdict == ABBE_CONVEX_SOLID)
    memcpy(plane_of, s.plane_of, mesh->face_count * sizeof *plane_of);
  free(s.order);
  free(s.plane);
  free(s.plane_of);
  return result;
}

void abbe_convex_reason(const abbe_convex *c, char *text, size_t size) {
  const double degrees = 180 / ABBE_PI;
  text[0] = '\0';
  switch (c->verdict) {
  case ABBE_CONVEX_UNASKED:
    break;
  case ABBE_CONVEX_SOLID:
    abbe_number_format(text, size, "it has %zu planes, to %g of its size", c->planes, c->tolerance);
    break;
  case ABBE_CONVEX_PARTS:
    snprintf(text, size, "it is not one closed surface");
    break;
  case ABBE_CONVEX_MANY:
    snprintf(text, size, "it is curved, or has more than %zu planes", c->planes);
    break;
  case ABBE_CONVEX_CURVED:
    abbe_number_format(text, size,
                       "it is curved, its faces %g of its size or less off one another's planes",
                       c->tolerance);
    break;
  case ABBE_CONVEX_DENTED:
    abbe_number_format(text, size,
                       "(%.3g, %.3g, %.3g) is %.2g m, %.2g %% of its size, in front of a face",
                       c->place[0], c->place[1], c->place[2], c->off, 100 * c->off / c->size);
    break;
  case ABBE_CONVEX_ROUNDED:
    abbe_number_format(text, size,
                       "its normals are rounded, by up to %.2g degrees at (%.3g, %.3g, %.3g)",
                       degrees * c->off, c->place[0], c->place[1], c->place[2]);
    break;
  }
}
