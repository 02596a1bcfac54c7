/* Sheets of faces that hang on a body, or stand in it, and belong to no surface of it. */
#include "scenes/disjoint_sets.h"
#include "scenes/mesh_parts.h"
#include "scenes/vector.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_SHEETS = 256 };

/* What hangs together over edges of two faces. */
typedef struct patch {
  double area;
  long mends;    /* edges that become sound without it, less those that no longer are */
  bool attached; /* to others, at an edge of an odd number of faces */
} patch;

static bool is_bad(uint32_t faces) {
  return faces % 2 != 0;
}

typedef struct visit {
  uint32_t edge, patch;
} visit;

static int by_edge(const void *a, const void *b) {
  const visit *x = a, *y = b;
  if (x->edge != y->edge) return x->edge < y->edge ? -1 : 1;
  return (x->patch > y->patch) - (x->patch < y->patch);
}

/* parent, at: of every face; all: room for three times as many. */
static void judge(const abbe_topology *t, uint32_t *parent, patch *at, visit *all) {
  size_t count = 0;
  for (size_t f = 0; f < t->face_count; f++) {
    parent[f] = (uint32_t)f;
    at[f] = (patch){0};
  }
  for (size_t e = 0; e < t->edge_count; e++)
    if (t->edge[e].along + t->edge[e].against == 2)
      abbe_disjoint_sets_unite(parent, t->edge[e].face[0], t->edge[e].face[1]);
  for (size_t f = 0; f < t->face_count; f++) {
    double n[3];
    const uint32_t own = abbe_disjoint_sets_find(parent, (uint32_t)f);
    abbe_vector_triangle(t->position[t->face[f][0]], t->position[t->face[f][1]],
                         t->position[t->face[f][2]], n);
    at[own].area += 0.5 * abbe_vector_length(n);
    for (int k = 0; k < 3; k++) {
      const uint32_t e = t->face_edge[f][k];
      if (e == ABBE_TOPOLOGY_NONE || t->edge[e].along + t->edge[e].against == 2) continue;
      all[count++] = (visit){e, own};
    }
  }
  if (count > 0) qsort(all, count, sizeof *all, by_edge);
  for (size_t from = 0, to; from < count; from = to) {
    const uint32_t e = all[from].edge, faces = t->edge[e].along + t->edge[e].against;
    for (to = from; to < count && by_edge(&all[to], &all[from]) == 0;) to++;
    patch *p = &at[all[from].patch];
    p->mends += (long)is_bad(faces) - (long)is_bad(faces - (uint32_t)(to - from));
    p->attached = p->attached || (faces > 2 && is_bad(faces));
  }
}

/* The smallest patch that had better go, of less than half of the area; NONE: there is none. */
static uint32_t find_sheet(const abbe_topology *t, const patch *at) {
  double whole = 0;
  uint32_t best = ABBE_TOPOLOGY_NONE;
  for (size_t f = 0; f < t->face_count; f++) whole += at[f].area;
  for (size_t f = 0; f < t->face_count; f++) {
    if (!at[f].attached || at[f].mends <= 0 || !(at[f].area < 0.5 * whole)) continue;
    if (best == ABBE_TOPOLOGY_NONE || at[f].area < at[best].area) best = (uint32_t)f;
  }
  return best;
}

abbe_result abbe_mesh_drop_sheets(abbe_mesh *mesh, size_t *sheets, abbe_error *error) {
  uint32_t *parent = malloc((mesh->face_count + 1) * sizeof *parent);
  patch *at = malloc((mesh->face_count + 1) * sizeof *at);
  visit *all = malloc((3 * mesh->face_count + 1) * sizeof *all);
  abbe_result result = parent && at && all
                           ? ABBE_OK
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory to mend a mesh");
  bool more = true;
  while (result == ABBE_OK && more && *sheets < MOST_SHEETS) {
    abbe_topology t;
    result = abbe_topology_make(mesh, &t, error);
    if (result != ABBE_OK) break;
    judge(&t, parent, at, all);
    const uint32_t sheet = find_sheet(&t, at);
    more = sheet != ABBE_TOPOLOGY_NONE;
    size_t kept = 0;
    for (size_t f = 0; f < mesh->face_count && more; f++)
      if (abbe_disjoint_sets_find(parent, (uint32_t)f) != sheet)
        memmove(mesh->face[kept++], mesh->face[f], sizeof mesh->face[0]);
    if (more) mesh->face_count = kept;
    *sheets += more;
    abbe_topology_free(&t);
  }
  free(parent);
  free(at);
  free(all);
  return result;
}
