/* Sheets of faces that hang on a body, or stand in it, and belong to no surface of it. */
#include "base/maths.h"
#include "scenes/geometry/disjoint_sets.h"
#include "scenes/mesh/mesh_parts.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Faces looked at, pass after pass: some seconds. */
#define MOST_WORK 2e7

enum { LEAST_PASSES = 8 }; /* for however many faces */

/* What hangs together over edges of two faces. */
typedef struct patch {
  double area;
  long fixes;    /* edges that become sound without it, less those that no longer are */
  bool attached; /* to others, at an edge of an odd number of faces */
  bool waits;    /* for a lesser one at one of its edges, without which it is judged anew */
  bool goes;
} patch;

typedef struct visit {
  uint32_t edge, patch;
} visit;

typedef struct sheet {
  double area;
  uint32_t patch;
} sheet;

/* What a pass needs. */
typedef struct desk {
  uint32_t *parent; /* [face_count] what hangs together */
  patch *at;        /* [face_count] by the number of the face that stands for it */
  visit *all;       /* [3 face_count], count of them, edge after edge */
  size_t count;
  sheet *sheet; /* [face_count] */
} desk;

static bool is_bad(uint32_t faces) {
  return faces % 2 != 0;
}

static int by_edge(const void *a, const void *b) {
  const visit *x = a, *y = b;
  if (x->edge != y->edge) return x->edge < y->edge ? -1 : 1;
  return (x->patch > y->patch) - (x->patch < y->patch);
}

static void judge(const abbe_topology *t, desk *d) {
  uint32_t *parent = d->parent;
  patch *at = d->at;
  visit *all = d->all;
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
    p->fixes += (long)is_bad(faces) - (long)is_bad(faces - (uint32_t)(to - from));
    p->attached = p->attached || (faces > 2 && is_bad(faces));
  }
  d->count = count;
}

static int by_area(const void *a, const void *b) {
  const sheet *x = a, *y = b;
  if (x->area != y->area) return x->area < y->area ? -1 : 1;
  return (x->patch > y->patch) - (x->patch < y->patch);
}

static bool had_better_go(const patch *p, double whole) {
  return p->attached && p->fixes > 0 && p->area < 0.5 * whole;
}

/* Among patches that meet at an edge and had better go, all but the least wait. */
static void let_wait(desk *d, double whole) {
  for (size_t from = 0, to; from < d->count; from = to) {
    sheet least = {INFINITY, ABBE_TOPOLOGY_NONE};
    for (to = from; to < d->count && d->all[to].edge == d->all[from].edge; to++) {
      const sheet s = {d->at[d->all[to].patch].area, d->all[to].patch};
      if (had_better_go(&d->at[s.patch], whole) && by_area(&s, &least) < 0) least = s;
    }
    for (size_t i = from; i < to; i++)
      if (d->all[i].patch != least.patch) d->at[d->all[i].patch].waits = true;
  }
}

/* Flags the sheets that go in one pass: none meets another. Each is of less than half of the area
 * that those before it, which are smaller, leave. Returns how many. */
static size_t mark_sheets(const abbe_topology *t, desk *d) {
  double whole = 0;
  size_t count = 0, marked = 0;
  for (size_t f = 0; f < t->face_count; f++) whole += d->at[f].area;
  let_wait(d, whole);
  for (size_t f = 0; f < t->face_count; f++)
    if (had_better_go(&d->at[f], whole) && !d->at[f].waits)
      d->sheet[count++] = (sheet){d->at[f].area, (uint32_t)f};
  if (count > 0) qsort(d->sheet, count, sizeof *d->sheet, by_area);
  for (; marked < count && d->sheet[marked].area < 0.5 * whole; marked++) {
    d->at[d->sheet[marked].patch].goes = true;
    whole -= d->sheet[marked].area;
  }
  return marked;
}

/* Those that meet no other go at once; *dropped of them. */
static abbe_result drop_once(abbe_mesh *mesh, desk *d, size_t *dropped, abbe_error *error) {
  abbe_topology t;
  const abbe_result result = abbe_topology_make(mesh, &t, error);
  if (result != ABBE_OK) return result;
  judge(&t, d);
  *dropped = mark_sheets(&t, d);
  size_t kept = 0;
  for (size_t f = 0; f < mesh->face_count; f++)
    if (!d->at[abbe_disjoint_sets_find(d->parent, (uint32_t)f)].goes)
      memmove(mesh->face[kept++], mesh->face[f], sizeof mesh->face[0]);
  mesh->face_count = kept;
  abbe_topology_free(&t);
  return ABBE_OK;
}

abbe_result abbe_mesh_drop_sheets(abbe_mesh *mesh, size_t *sheets, abbe_error *error) {
  const size_t faces = mesh->face_count;
  desk d = {.parent = malloc((faces + 1) * sizeof *d.parent),
            .at = malloc((faces + 1) * sizeof *d.at),
            .all = malloc((3 * faces + 1) * sizeof *d.all),
            .sheet = malloc((faces + 1) * sizeof *d.sheet)};
  abbe_result result = d.parent && d.at && d.all && d.sheet
                           ? ABBE_OK
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory to fix a mesh");
  double work = 0;
  size_t dropped = 1;
  for (int pass = 0; result == ABBE_OK && dropped > 0; pass++, *sheets += dropped) {
    dropped = 0;
    work += (double)mesh->face_count;
    result = pass >= LEAST_PASSES && work > MOST_WORK
                 ? abbe_error_set(error, ABBE_GEOMETRY,
                                  "sheets hang on sheets of the mesh, too many one on another for "
                                  "'repair: true' to drop: %zu are dropped, and more may be left; "
                                  "drop them where the mesh was made",
                                  *sheets)
                 : drop_once(mesh, &d, &dropped, error);
  }
  free(d.parent);
  free(d.at);
  free(d.all);
  free(d.sheet);
  return result;
}
