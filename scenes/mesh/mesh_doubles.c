/* Faces that lie on one another, corner on corner. */
#include "scenes/geometry/disjoint_sets.h"
#include "scenes/mesh/mesh_parts.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

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

enum {
  KEPT,
  DROPPED,
  WALL
}; /* a wall: as many faces in either direction, of which one is flagged so */

/* Of faces on the same points one stays, of the side that more of them show; with as many on both
 * sides one is flagged as a wall, and its back is dropped or, where walls stay, kept. */
static void mark(const triple *all, size_t count, bool walls_go, unsigned char *fate,
                 size_t *doubles, size_t *walls) {
  for (size_t from = 0, to; from < count; from = to) {
    size_t odd = 0, kept = 0;
    for (to = from; to < count && same_points(&all[to], &all[from]); to++) odd += all[to].odd;
    const size_t even = to - from - odd;
    if (to - from == 1) continue;
    bool one_of[2] = {even > 0, odd > 0};
    if (walls_go && even != odd) one_of[even > odd] = false;
    const bool wall = one_of[0] && one_of[1];
    *walls += wall;
    for (size_t i = from; i < to; i++) {
      bool *free_place = &one_of[all[i].odd];
      fate[all[i].face] = *free_place ? KEPT : DROPPED;
      if (*free_place && wall && walls_go) fate[all[i].face] = kept == 0 ? WALL : DROPPED;
      kept += *free_place;
      *free_place = false;
    }
    *doubles += to - from - kept;
  }
}

/* What is at an edge. */
typedef struct meeting {
  uint32_t kept, last; /* faces that stay; the last face of a wall */
} meeting;

/* A wall of faces back to back that other faces meet in pairs all around parts two bodies of the
 * same stuff, and goes; where single faces go on from it, or none, it is the skin of one. */
static void judge_walls(const abbe_topology *t, uint32_t *parent, int32_t *vote, meeting *at_edge,
                        unsigned char *fate) {
  for (size_t e = 0; e < t->edge_count; e++) at_edge[e] = (meeting){0, ABBE_TOPOLOGY_NONE};
  for (size_t f = 0; f < t->face_count; f++) {
    parent[f] = (uint32_t)f;
    vote[f] = 0;
    for (int k = 0; k < 3 && fate[f] == KEPT; k++)
      if (t->face_edge[f][k] != ABBE_TOPOLOGY_NONE) at_edge[t->face_edge[f][k]].kept++;
  }
  for (size_t f = 0; f < t->face_count; f++)
    for (int k = 0; k < 3 && fate[f] == WALL; k++) {
      const uint32_t e = t->face_edge[f][k];
      if (e == ABBE_TOPOLOGY_NONE || at_edge[e].kept > 0) continue;
      if (at_edge[e].last != ABBE_TOPOLOGY_NONE)
        abbe_disjoint_sets_unite(parent, (uint32_t)f, at_edge[e].last);
      at_edge[e].last = (uint32_t)f;
    }
  for (size_t f = 0; f < t->face_count; f++)
    for (int k = 0; k < 3 && fate[f] == WALL; k++) {
      const uint32_t e = t->face_edge[f][k];
      if (e != ABBE_TOPOLOGY_NONE && at_edge[e].kept > 0)
        vote[abbe_disjoint_sets_find(parent, (uint32_t)f)] += at_edge[e].kept % 2 == 0 ? 1 : -1;
    }
  for (size_t f = 0; f < t->face_count; f++)
    if (fate[f] == WALL)
      fate[f] = vote[abbe_disjoint_sets_find(parent, (uint32_t)f)] > 0 ? DROPPED : KEPT;
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

static void keep_marked(abbe_mesh *mesh, const unsigned char *fate) {
  size_t kept = 0;
  for (size_t f = 0; f < mesh->face_count; f++)
    if (fate[f] == KEPT) memmove(mesh->face[kept++], mesh->face[f], sizeof mesh->face[0]);
  mesh->face_count = kept;
}

abbe_result abbe_mesh_drop_doubles(abbe_mesh *mesh, bool walls_go, size_t *doubles, size_t *walls,
                                   abbe_error *error) {
  abbe_topology t;
  abbe_result result = abbe_topology_make(mesh, &t, error);
  if (result != ABBE_OK) return result;
  if (!may_have_doubles(&t)) {
    abbe_topology_free(&t);
    return ABBE_OK;
  }
  const size_t faces = mesh->face_count + 1, edges = t.edge_count + 1;
  triple *all = malloc(faces * sizeof *all);
  unsigned char *fate = calloc(faces, 1);
  uint32_t *parent = malloc(faces * sizeof *parent);
  int32_t *vote = malloc(faces * sizeof *vote);
  meeting *at_edge = malloc(edges * sizeof *at_edge);
  if (all && fate && parent && vote && at_edge) {
    for (size_t f = 0; f < mesh->face_count; f++) all[f] = triple_of(&t, (uint32_t)f);
    qsort(all, mesh->face_count, sizeof *all, by_points);
    mark(all, mesh->face_count, walls_go, fate, doubles, walls);
    if (*walls > 0 && walls_go) judge_walls(&t, parent, vote, at_edge, fate);
    if (*doubles > 0 || (*walls > 0 && walls_go)) keep_marked(mesh, fate);
  } else {
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory to fix a mesh");
  }
  free(all);
  free(fate);
  free(parent);
  free(vote);
  free(at_edge);
  abbe_topology_free(&t);
  return result;
}
