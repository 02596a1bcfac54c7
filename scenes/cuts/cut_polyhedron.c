#include "scenes/cuts/cut_polyhedron.h"

#include "base/maths.h"
#include "scenes/geometry/disjoint_sets.h"

#include <libqhull_r/libqhull_r.h>

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Where planes meet: a corner before it is welded. */
typedef struct meet {
  double at[3];
  size_t first, count; /* range in plane[] */
} meet;

typedef struct work {
  const abbe_cut *cut;
  size_t planes; /* that are no doubles */
  size_t *facet; /* [planes] */
  double *dual;  /* [planes * 3] */
  size_t meets, room, listed;
  meet *meet;
  uint32_t *plane; /* [capacity] planes of all meets */
  uint32_t *set;   /* [meets] */
} work;

void abbe_cut_polyhedron_free(abbe_cut_polyhedron *p) {
  free(p->vertex);
  free(p->face);
  free(p->corner);
  free(p->fate);
  memset(p, 0, sizeof *p);
}

static void work_free(work *w) {
  free(w->facet);
  free(w->dual);
  free(w->meet);
  free(w->plane);
  free(w->set);
}

static abbe_result no_memory(abbe_error *error) {
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a stone's faces");
}

/* ---- planes ---- */

static bool same_plane(const abbe_cut_facet *a, const abbe_cut_facet *b) {
  const double alike = 1e-10;
  double off[3];
  abbe_vector_subtract(a->n, b->n, off);
  return fabs(a->d - b->d) <= alike * a->d && abbe_vector_length(off) <= alike;
}

static abbe_result gather(work *w, abbe_cut_polyhedron *out, abbe_error *error) {
  const abbe_cut *cut = w->cut;
  double least = INFINITY;
  out->facet_count = cut->facet_count;
  out->fate = malloc(cut->facet_count * sizeof *out->fate);
  w->facet = malloc(cut->facet_count * sizeof *w->facet);
  w->dual = malloc(cut->facet_count * 3 * sizeof *w->dual);
  if (!out->fate || !w->facet || !w->dual) return no_memory(error);
  for (size_t i = 0; i < cut->facet_count; i++) least = fmin(least, cut->facet[i].d);
  for (size_t i = 0; i < cut->facet_count; i++) {
    const abbe_cut_facet *f = &cut->facet[i];
    out->fate[i] = ABBE_CUT_DEAD;
    for (size_t k = 0; k < w->planes && out->fate[i] == ABBE_CUT_DEAD; k++)
      if (same_plane(f, &cut->facet[w->facet[k]])) out->fate[i] = ABBE_CUT_DOUBLE;
    if (out->fate[i] == ABBE_CUT_DOUBLE) continue;
    /* in units of the nearest plane's distance */
    for (int k = 0; k < 3; k++) w->dual[3 * w->planes + (size_t)k] = f->n[k] * (least / f->d);
    w->facet[w->planes++] = i;
  }
  return ABBE_OK;
}

/* ---- where they meet ---- */

/* Whether the stone reaches for ever into the unit direction: no facet lies across it. */
static bool is_open(const abbe_cut *cut, const double direction[3]) {
  for (size_t i = 0; i < cut->facet_count; i++)
    if (abbe_vector_dot(cut->facet[i].n, direction) > 1e-9) return false;
  return true;
}

/* On which side, as a cutter looks for it. */
static abbe_result open_stone(const abbe_cut *cut, abbe_error *error) {
  const double up[3] = {0, 0, 1}, down[3] = {0, 0, -1};
  if (is_open(cut, up))
    return abbe_error_set(error, ABBE_GEOMETRY,
                          "the planes leave the stone open on top: the crown lacks facets, or a "
                          "table (angle 0)");
  if (is_open(cut, down))
    return abbe_error_set(error, ABBE_GEOMETRY,
                          "the planes leave the stone open below: the pavilion lacks facets "
                          "(angles below 0)");
  for (int i = 0; i < 360; i++) {
    const double a = i * ABBE_DEGREE, aside[3] = {cos(a), sin(a), 0};
    if (is_open(cut, aside))
      return abbe_error_set(error, ABBE_GEOMETRY,
                            "the planes leave the stone open at the side, about index %.0f: facets "
                            "are missing there",
                            abbe_cut_index(cut, aside));
  }
  return abbe_error_set(error, ABBE_GEOMETRY,
                        "the planes leave the stone open; facets are missing on one side of it");
}

/* The hull's facets, as corners in units of the nearest plane's distance. */
static abbe_result take_meets(work *w, qhT *qh, abbe_error *error) {
  const double open = -1e-9;
  facetT *facet;
  vertexT *vertex, **vertexp;
  FORALLfacets {
    w->meets++;
    w->room += (size_t)qh_setsize(qh, facet->vertices);
  }
  w->meet = malloc((w->meets + 1) * sizeof *w->meet);
  w->plane = malloc((w->room + 1) * sizeof *w->plane);
  w->set = malloc((w->meets + 1) * sizeof *w->set);
  if (!w->meet || !w->plane || !w->set) return no_memory(error);
  size_t m = 0;
  FORALLfacets {
    if (!(facet->offset < open)) return open_stone(w->cut, error);
    meet *at = &w->meet[m];
    w->set[m] = (uint32_t)m;
    for (int k = 0; k < 3; k++) at->at[k] = -facet->normal[k] / facet->offset;
    at->first = w->listed;
    FOREACHvertex_(facet->vertices) w->plane[w->listed++] = (uint32_t)qh_pointid(qh, vertex->point);
    at->count = w->listed - at->first;
    m++;
  }
  return ABBE_OK;
}

static abbe_result find_meets(work *w, abbe_error *error) {
  char *said = NULL;
  size_t said_size = 0;
  int whole, pieces, code;
  if (w->planes < 4) return open_stone(w->cut, error);
  FILE *messages = open_memstream(&said, &said_size);
  qhT *qh = calloc(1, sizeof *qh);
  abbe_result result = messages && qh ? ABBE_OK : no_memory(error);
  if (result == ABBE_OK) {
    qh_zero(qh, messages);
    code =
        qh_new_qhull(qh, 3, (int)w->planes, w->dual, False, (char[]){"qhull Pp"}, NULL, messages);
    if (code == qh_ERRnone)
      result = take_meets(w, qh, error);
    else if (code == qh_ERRmem)
      result = no_memory(error);
    else if (code == qh_ERRsingular || code == qh_ERRinput)
      result = open_stone(w->cut, error);
    else
      result = abbe_error_set(error, ABBE_GEOMETRY,
                              "the planes are too nearly alike to tell where they meet");
    qh_freeqhull(qh, !qh_ALL);
    qh_memfreeshort(qh, &whole, &pieces);
  }
  free(qh);
  if (messages) fclose(messages);
  free(said);
  return result;
}

/* ---- corners ---- */

static void bound(abbe_cut_polyhedron *p) {
  for (int k = 0; k < 3; k++) p->min[k] = INFINITY, p->max[k] = -INFINITY;
  for (size_t v = 0; v < p->vertex_count; v++)
    for (int k = 0; k < 3; k++) {
      p->min[k] = fmin(p->min[k], p->vertex[v][k]);
      p->max[k] = fmax(p->max[k], p->vertex[v][k]);
    }
}

/* Joins meets that are nearer than tolerance; each set becomes a vertex at their mean. On return
 * set[] holds the vertex of each meet. */
static abbe_result weld(work *w, double share, abbe_cut_polyhedron *out, abbe_error *error) {
  double min[2] = {INFINITY, INFINITY}, max[2] = {-INFINITY, -INFINITY};
  double least = INFINITY;
  for (size_t i = 0; i < w->cut->facet_count; i++) least = fmin(least, w->cut->facet[i].d);
  for (size_t m = 0; m < w->meets; m++)
    for (int k = 0; k < 3; k++) {
      w->meet[m].at[k] *= least;
      if (k == 2) continue;
      min[k] = fmin(min[k], w->meet[m].at[k]);
      max[k] = fmax(max[k], w->meet[m].at[k]);
    }
  const double near = share * 0.5 * fmax(max[0] - min[0], max[1] - min[1]);
  for (size_t a = 0; a < w->meets; a++)
    for (size_t b = a + 1; b < w->meets; b++) {
      double off[3];
      abbe_vector_subtract(w->meet[a].at, w->meet[b].at, off);
      if (fabs(off[0]) <= near && abbe_vector_length(off) <= near)
        abbe_disjoint_sets_unite(w->set, (uint32_t)a, (uint32_t)b);
    }
  uint32_t *number = malloc((w->meets + 1) * sizeof *number);
  size_t *members = calloc(w->meets + 1, sizeof *members);
  out->vertex = calloc(w->meets + 1, sizeof *out->vertex);
  if (!number || !members || !out->vertex) {
    free(number);
    free(members);
    return no_memory(error);
  }
  for (size_t m = 0; m < w->meets; m++)
    if (w->set[m] == m) number[m] = (uint32_t)out->vertex_count++;
  for (size_t m = 0; m < w->meets; m++) {
    const uint32_t v = number[abbe_disjoint_sets_find(w->set, (uint32_t)m)];
    members[v]++;
    for (int k = 0; k < 3; k++) out->vertex[v][k] += w->meet[m].at[k];
  }
  for (size_t v = 0; v < out->vertex_count; v++)
    for (int k = 0; k < 3; k++) out->vertex[v][k] /= (double)members[v];
  for (size_t m = 0; m < w->meets; m++)
    members[m] = number[abbe_disjoint_sets_find(w->set, (uint32_t)m)];
  for (size_t m = 0; m < w->meets; m++) w->set[m] = (uint32_t)members[m];
  free(number);
  free(members);
  bound(out);
  return ABBE_OK;
}

/* ---- faces ---- */

typedef struct placed {
  double turn;
  uint32_t vertex;
} placed;

static int by_turn(const void *a, const void *b) {
  const placed *x = a, *y = b;
  return (x->turn > y->turn) - (x->turn < y->turn);
}

/* Counter-clockwise around the middle, seen from outside. */
static void order(const abbe_cut_polyhedron *p, const double n[3], placed *at, size_t count) {
  double middle[3] = {0}, u[3] = {0}, side[3], v[3];
  int least = 0;
  for (size_t i = 0; i < count; i++)
    for (int k = 0; k < 3; k++) middle[k] += p->vertex[at[i].vertex][k] / (double)count;
  for (int k = 1; k < 3; k++)
    if (fabs(n[k]) < fabs(n[least])) least = k;
  side[0] = side[1] = side[2] = 0;
  side[least] = 1;
  abbe_vector_cross(n, side, u);
  abbe_vector_cross(n, u, v);
  for (size_t i = 0; i < count; i++) {
    double off[3];
    abbe_vector_subtract(p->vertex[at[i].vertex], middle, off);
    at[i].turn = atan2(abbe_vector_dot(off, v), abbe_vector_dot(off, u));
  }
  qsort(at, count, sizeof *at, by_turn);
}

static double area_of(const abbe_cut_polyhedron *p, const double n[3], const placed *at,
                      size_t count) {
  double sum[3] = {0};
  for (size_t i = 1; i + 1 < count; i++) {
    double twice[3];
    abbe_vector_triangle(p->vertex[at[0].vertex], p->vertex[at[i].vertex],
                         p->vertex[at[i + 1].vertex], twice);
    for (int k = 0; k < 3; k++) sum[k] += 0.5 * twice[k];
  }
  return abbe_vector_dot(sum, n);
}

static abbe_result make_faces(const work *w, abbe_cut_polyhedron *out, abbe_error *error) {
  ABBE_FREED placed *at = malloc((w->meets + 1) * sizeof *at);
  ABBE_FREED size_t *seen =
      malloc((out->vertex_count + 1) * sizeof *seen); /* by which plane, last */
  out->face = malloc((w->planes + 1) * sizeof *out->face);
  out->corner = malloc((w->listed + 1) * sizeof *out->corner);
  ABBE_TRY(at && seen && out->face && out->corner ? ABBE_OK : no_memory(error));
  for (size_t v = 0; v < out->vertex_count; v++) seen[v] = SIZE_MAX;
  for (size_t i = 0; i < w->planes; i++) {
    const abbe_cut_facet *f = &w->cut->facet[w->facet[i]];
    size_t count = 0;
    for (size_t m = 0; m < w->meets; m++)
      for (size_t k = 0; k < w->meet[m].count; k++) {
        if (w->plane[w->meet[m].first + k] != i || seen[w->set[m]] == i) continue;
        seen[w->set[m]] = i;
        at[count++].vertex = w->set[m];
      }
    if (count < 3) continue;
    order(out, f->n, at, count);
    abbe_cut_face *face = &out->face[out->face_count++];
    *face = (abbe_cut_face){.facet = w->facet[i],
                            .first = out->corner_count,
                            .count = count,
                            .area = area_of(out, f->n, at, count)};
    for (size_t k = 0; k < count; k++) out->corner[out->corner_count++] = at[k].vertex;
    out->fate[w->facet[i]] = ABBE_CUT_FACE;
    out->area += face->area;
    out->volume += face->area * f->d / 3;
  }
  return ABBE_OK;
}

/* ---- edges ---- */

static int by_value(const void *a, const void *b) {
  const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
  return (x > y) - (x < y);
}

/* Every edge is there once in each direction, and no vertex is left out. */
static abbe_result close_faces(abbe_cut_polyhedron *p, double share, abbe_error *error) {
  uint64_t *edge = malloc((p->corner_count + 1) * sizeof *edge);
  if (!edge) return no_memory(error);
  size_t count = 0;
  for (size_t f = 0; f < p->face_count; f++)
    for (size_t k = 0; k < p->face[f].count; k++) {
      const uint32_t *corner = p->corner + p->face[f].first;
      edge[count++] = (uint64_t)corner[k] << 32 | corner[(k + 1) % p->face[f].count];
    }
  qsort(edge, count, sizeof *edge, by_value);
  bool closed = p->face_count >= 4;
  for (size_t i = 0; i < count && closed; i++) {
    const uint64_t back = edge[i] << 32 | edge[i] >> 32;
    closed = (i == 0 || edge[i] != edge[i - 1]) &&
             bsearch(&back, edge, count, sizeof *edge, by_value) != NULL;
  }
  free(edge);
  p->edge_count = count / 2;
  if (closed && p->vertex_count + p->face_count == p->edge_count + 2) return ABBE_OK;
  return abbe_error_set(error, ABBE_GEOMETRY,
                        "corners nearer than %g of half the stone's width were made one, and its "
                        "faces do not close (%zu corners, %zu edges, %zu faces); take another "
                        "'weld'",
                        share, p->vertex_count, p->edge_count, p->face_count);
}

abbe_result abbe_cut_polyhedron_make(const abbe_cut *cut, double share, abbe_cut_polyhedron *out,
                                     abbe_error *error) {
  memset(out, 0, sizeof *out);
  ABBE_TRY(abbe_cut_check(cut, error));
  if (share == 0) share = ABBE_CUT_WELD;
  if (!(share > 0 && share <= ABBE_CUT_MOST_WELD))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "corners cannot be welded by %g of half the width; it may be above 0, to "
                          "%g",
                          share, ABBE_CUT_MOST_WELD);
  work w = {.cut = cut};
  abbe_result result = gather(&w, out, error);
  if (result == ABBE_OK) result = find_meets(&w, error);
  if (result == ABBE_OK) result = weld(&w, share, out, error);
  if (result == ABBE_OK) result = make_faces(&w, out, error);
  if (result == ABBE_OK) result = close_faces(out, share, error);
  work_free(&w);
  if (result != ABBE_OK) abbe_cut_polyhedron_free(out);
  return result;
}

/* ---- triangles ---- */

/* The corner whose fan has the largest least triangle. */
static size_t best_fan(const abbe_cut_polyhedron *p, const abbe_cut_face *face) {
  const uint32_t *corner = p->corner + face->first;
  double most = -1;
  size_t best = 0;
  for (size_t from = 0; from < face->count; from++) {
    double least = INFINITY, twice[3];
    for (size_t k = 1; k + 1 < face->count; k++) {
      abbe_vector_triangle(p->vertex[corner[from]], p->vertex[corner[(from + k) % face->count]],
                           p->vertex[corner[(from + k + 1) % face->count]], twice);
      least = fmin(least, abbe_vector_length(twice));
    }
    if (least > most) most = least, best = from;
  }
  return best;
}

abbe_result abbe_cut_polyhedron_mesh(const abbe_cut *cut, const abbe_cut_polyhedron *p,
                                     double scale, abbe_mesh *out, abbe_error *error) {
  memset(out, 0, sizeof *out);
  const size_t triangles = p->corner_count - 2 * p->face_count;
  ABBE_TRY(abbe_mesh_make(p->corner_count, triangles, false, out, error));
  size_t triangle = 0;
  for (size_t f = 0; f < p->face_count; f++) {
    const abbe_cut_face *face = &p->face[f];
    for (size_t k = 0; k < face->count; k++) {
      for (int axis = 0; axis < 3; axis++)
        out->position[face->first + k][axis] = scale * p->vertex[p->corner[face->first + k]][axis];
      memcpy(out->normal[face->first + k], cut->facet[face->facet].n, sizeof *out->normal);
    }
    const size_t from = best_fan(p, face);
    for (size_t k = 1; k + 1 < face->count; k++, triangle++) {
      out->face[triangle][0] = (uint32_t)(face->first + from);
      out->face[triangle][1] = (uint32_t)(face->first + (from + k) % face->count);
      out->face[triangle][2] = (uint32_t)(face->first + (from + k + 1) % face->count);
    }
  }
  return ABBE_OK;
}
