#include "scenes/mesh/topology.h"

#include "base/maths.h"
#include "base/thread/watch.h"
#include "scenes/geometry/disjoint_sets.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

void abbe_topology_free(abbe_topology *topology) {
  if (!topology) return;
  free(topology->point);
  free(topology->position);
  free(topology->face);
  free(topology->face_edge);
  free(topology->edge);
  free(topology->shell);
  memset(topology, 0, sizeof *topology);
}

/* Finaliser of splitmix64: every input bit reaches every output bit. */
static uint64_t mix(uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/* Open addressing over indices; at most half full. */
typedef struct slots {
  uint32_t *slot;
  size_t mask;
} slots;

static bool slots_make(slots *table, size_t entries) {
  size_t size = 16;
  while (size < 2 * entries) size *= 2;
  table->slot = malloc(size * sizeof *table->slot);
  if (!table->slot) return false;
  memset(table->slot, 0xff, size * sizeof *table->slot);
  table->mask = size - 1;
  return true;
}

/* The grid that finds near points: cells many tolerances wide, so that a point lies within the
 * tolerance of a cell's border, and needs a second look-up, only rarely. */
typedef struct grid {
  double origin[3], cell, tolerance;
  slots table;
} grid;

static uint64_t hash_cell(const int64_t cell[3]) {
  return mix((uint64_t)cell[0] ^ mix((uint64_t)cell[1] ^ mix((uint64_t)cell[2])));
}

static void cell_of(const grid *g, const double p[3], double shift, int64_t cell[3]) {
  for (int k = 0; k < 3; k++) cell[k] = (int64_t)floor((p[k] - g->origin[k] + shift) / g->cell);
}

static bool near_point(const double a[3], const double b[3], double tolerance) {
  return fabs(a[0] - b[0]) <= tolerance && fabs(a[1] - b[1]) <= tolerance &&
         fabs(a[2] - b[2]) <= tolerance;
}

static uint32_t find_in_cell(const grid *g, const abbe_topology *t, const int64_t cell[3],
                             const double p[3]) {
  for (size_t i = hash_cell(cell) & g->table.mask;; i = (i + 1) & g->table.mask) {
    const uint32_t id = g->table.slot[i];
    if (id == ABBE_TOPOLOGY_NONE) return id;
    if (near_point(t->position[id], p, g->tolerance)) return id;
  }
}

static uint32_t find_point(const grid *g, const abbe_topology *t, const double p[3]) {
  int64_t low[3], high[3], cell[3];
  cell_of(g, p, -g->tolerance, low);
  cell_of(g, p, g->tolerance, high);
  for (cell[0] = low[0]; cell[0] <= high[0]; cell[0]++)
    for (cell[1] = low[1]; cell[1] <= high[1]; cell[1]++)
      for (cell[2] = low[2]; cell[2] <= high[2]; cell[2]++) {
        const uint32_t id = find_in_cell(g, t, cell, p);
        if (id != ABBE_TOPOLOGY_NONE) return id;
      }
  return ABBE_TOPOLOGY_NONE;
}

static void add_point(const grid *g, abbe_topology *t, const double p[3]) {
  int64_t cell[3];
  cell_of(g, p, 0.0, cell);
  size_t i = hash_cell(cell) & g->table.mask;
  while (g->table.slot[i] != ABBE_TOPOLOGY_NONE) i = (i + 1) & g->table.mask;
  g->table.slot[i] = (uint32_t)t->point_count;
  memcpy(t->position[t->point_count++], p, sizeof t->position[0]);
}

static void grid_fit(grid *g, const abbe_mesh *mesh) {
  double high[3] = {0.0, 0.0, 0.0};
  for (size_t v = 0; v < mesh->vertex_count; v++)
    for (int k = 0; k < 3; k++) {
      const double x = mesh->position[v][k];
      if (v == 0 || x < g->origin[k]) g->origin[k] = x;
      if (v == 0 || x > high[k]) high[k] = x;
    }
  double diagonal = 0.0;
  for (int k = 0; k < 3; k++) diagonal = hypot(diagonal, high[k] - g->origin[k]);
  if (!(diagonal > 0.0)) diagonal = 1.0;
  g->tolerance = fmax(1e-9 * diagonal, DBL_MIN); /* below that, cells have no size */
  g->cell = 64.0 * g->tolerance;
}

static abbe_result weld(const abbe_mesh *mesh, abbe_topology *t, abbe_error *error) {
  grid g = {0};
  grid_fit(&g, mesh);
  if (!slots_make(&g.table, mesh->vertex_count))
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory to join the vertices of a mesh");
  for (size_t v = 0; v < mesh->vertex_count; v++) {
    t->point[v] = find_point(&g, t, mesh->position[v]);
    if (t->point[v] != ABBE_TOPOLOGY_NONE) continue;
    t->point[v] = (uint32_t)t->point_count;
    add_point(&g, t, mesh->position[v]);
  }
  free(g.table.slot);
  for (size_t f = 0; f < mesh->face_count; f++)
    for (int k = 0; k < 3; k++) t->face[f][k] = t->point[mesh->face[f][k]];
  return ABBE_OK;
}

static void add_edge(abbe_topology *t, const slots *table, uint32_t face, int corner) {
  const uint32_t from = t->face[face][corner], to = t->face[face][(corner + 1) % 3];
  const uint32_t a = from < to ? from : to, b = from < to ? to : from;
  size_t i = mix((uint64_t)a << 32 | b) & table->mask;
  while (table->slot[i] != ABBE_TOPOLOGY_NONE) {
    const abbe_edge *known = &t->edge[table->slot[i]];
    if (known->a == a && known->b == b) break;
    i = (i + 1) & table->mask;
  }
  if (table->slot[i] == ABBE_TOPOLOGY_NONE) {
    table->slot[i] = (uint32_t)t->edge_count;
    t->edge[t->edge_count++] =
        (abbe_edge){.a = a, .b = b, .face = {ABBE_TOPOLOGY_NONE, ABBE_TOPOLOGY_NONE}};
  }
  abbe_edge *edge = &t->edge[table->slot[i]];
  if (edge->along + edge->against < 2) edge->face[edge->along + edge->against] = face;
  if (from == a)
    edge->along++;
  else
    edge->against++;
  t->face_edge[face][corner] = table->slot[i];
}

static bool repeats(const uint32_t f[3]) {
  return f[0] == f[1] || f[1] == f[2] || f[2] == f[0];
}

static abbe_result find_edges(abbe_topology *t, abbe_error *error) {
  slots table;
  if (!slots_make(&table, 3 * t->face_count))
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the edges of a mesh");
  for (size_t f = 0; f < t->face_count; f++) {
    memset(t->face_edge[f], 0xff, sizeof t->face_edge[f]);
    if (repeats(t->face[f])) continue;
    for (int k = 0; k < 3; k++) add_edge(t, &table, (uint32_t)f, k);
  }
  free(table.slot);
  return ABBE_OK;
}

/* A face at an edge of more than two. */
typedef struct spoke {
  uint32_t edge, face;
  bool along;   /* it runs from the edge's a to its b: its body lies at lesser angles */
  int64_t step; /* the angle around the edge, right-handed from a to b, in steps */
} spoke;

/* What lies on one another closes before it opens: bodies touch there and do not overlap. */
static int by_edge_and_angle(const void *one, const void *other) {
  const spoke *x = one, *y = other;
  if (x->edge != y->edge) return x->edge < y->edge ? -1 : 1;
  if (x->step != y->step) return x->step < y->step ? -1 : 1;
  if (x->along != y->along) return x->along ? -1 : 1;
  return (x->face > y->face) - (x->face < y->face);
}

/* Angles, rad, that are one. The steps are counted from a little off a direction of the axes, where
 * so many models have faces. */
#define ANGLE_STEP 1e-6
#define ANGLE_START 0.0123456

/* Right-handed around the edge, from a direction that is the same for all of its faces. */
static int64_t angle_around(const abbe_topology *t, const abbe_edge *e, uint32_t face) {
  double axis[3], u[3] = {0, 0, 0}, v[3], to[3];
  uint32_t tip = e->a;
  for (int k = 0; k < 3; k++)
    if (t->face[face][k] != e->a && t->face[face][k] != e->b) tip = t->face[face][k];
  abbe_vector_subtract(t->position[e->b], t->position[e->a], axis);
  abbe_vector_subtract(t->position[tip], t->position[e->a], to);
  abbe_vector_normalise(axis);
  int least = 0;
  for (int k = 1; k < 3; k++)
    if (fabs(axis[k]) < fabs(axis[least])) least = k;
  u[least] = 1;
  abbe_vector_cross(axis, u, v);
  abbe_vector_normalise(v);
  abbe_vector_cross(v, axis, u);
  const double turn = 2 * ABBE_PI;
  const double angle = atan2(abbe_vector_dot(to, v), abbe_vector_dot(to, u)) + ANGLE_START;
  return (int64_t)floor((angle < 0 ? angle + turn : angle) / ANGLE_STEP);
}

/* Pairs the faces around one edge as brackets: a body opens at a face that runs against the edge
 * and closes at one along it, of the same patch if there is one, else at the nearest that is free.
 * False where they do not pair up. stack has capacity for them all. */
static bool pair_up(const spoke *at, size_t count, uint32_t *parent, uint32_t *stack) {
  long depth = 0, least = 0;
  size_t first = 0, waiting = 0;
  for (size_t i = 0; i < count; i++) {
    depth += at[i].along ? -1 : 1;
    if (depth >= least) continue;
    least = depth;
    first = i + 1;
  }
  if (depth != 0) return false;
  for (size_t i = 0; i < count; i++) {
    const spoke *s = &at[(first + i) % count];
    if (!s->along) {
      stack[waiting++] = s->face;
      continue;
    }
    size_t k = waiting;
    while (k > 0 && abbe_disjoint_sets_find(parent, stack[k - 1]) !=
                        abbe_disjoint_sets_find(parent, s->face))
      k--;
    const size_t taken = k > 0 ? k - 1 : waiting - 1;
    abbe_disjoint_sets_unite(parent, s->face, stack[taken]);
    memmove(stack + taken, stack + taken + 1, (waiting - taken - 1) * sizeof *stack);
    waiting--;
  }
  return true;
}

/* What meets at edges of more than two faces: by pairs, or else all of it. */
static abbe_result unite_crowds(abbe_topology *t, uint32_t *parent, abbe_error *error) {
  size_t count = 0, next = 0;
  for (size_t e = 0; e < t->edge_count; e++) {
    const uint32_t faces = t->edge[e].along + t->edge[e].against;
    if (faces > 2) count += faces;
  }
  if (count == 0) return ABBE_OK;
  spoke *all = malloc(count * sizeof *all);
  uint32_t *stack = malloc(count * sizeof *stack);
  if (!all || !stack) {
    free(all);
    free(stack);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the edges of a mesh");
  }
  for (size_t f = 0; f < t->face_count; f++)
    for (int k = 0; k < 3; k++) {
      const uint32_t e = t->face_edge[f][k];
      if (e == ABBE_TOPOLOGY_NONE || t->edge[e].along + t->edge[e].against <= 2) continue;
      all[next++] = (spoke){e, (uint32_t)f, t->face[f][k] == t->edge[e].a,
                            angle_around(t, &t->edge[e], (uint32_t)f)};
    }
  qsort(all, count, sizeof *all, by_edge_and_angle);
  for (size_t from = 0, to; from < count; from = to) {
    for (to = from; to < count && all[to].edge == all[from].edge;) to++;
    t->edge[all[from].edge].touches = pair_up(all + from, to - from, parent, stack);
    for (size_t i = from + 1; i < to && !t->edge[all[from].edge].touches; i++)
      abbe_disjoint_sets_unite(parent, all[i].face, all[from].face);
  }
  free(all);
  free(stack);
  return ABBE_OK;
}

/* A face without edges, whose corners are one point, hangs on whatever stands there. */
static void unite_points(const abbe_topology *t, uint32_t *parent, uint32_t *at_point) {
  for (size_t f = 0; f < t->face_count; f++)
    if (t->face_edge[f][0] != ABBE_TOPOLOGY_NONE)
      for (int k = 0; k < 3; k++) at_point[t->face[f][k]] = (uint32_t)f;
  for (size_t f = 0; f < t->face_count; f++) {
    if (t->face_edge[f][0] != ABBE_TOPOLOGY_NONE) continue;
    uint32_t *there = &at_point[t->face[f][0]];
    if (*there == ABBE_TOPOLOGY_NONE) *there = (uint32_t)f;
    abbe_disjoint_sets_unite(parent, (uint32_t)f, *there);
  }
}

static abbe_result find_shells(abbe_topology *t, abbe_error *error) {
  const size_t most = (t->face_count > t->point_count ? t->face_count : t->point_count) + 1;
  ABBE_FREED uint32_t *parent = malloc(most * sizeof *parent);
  ABBE_FREED uint32_t *number = malloc(most * sizeof *number);
  if (!(parent && number))
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the parts of a mesh");
  for (size_t f = 0; f < t->face_count; f++) parent[f] = (uint32_t)f;
  for (size_t e = 0; e < t->edge_count; e++)
    if (t->edge[e].along + t->edge[e].against == 2)
      abbe_disjoint_sets_unite(parent, t->edge[e].face[0], t->edge[e].face[1]);
  ABBE_TRY(unite_crowds(t, parent, error));
  memset(number, 0xff, most * sizeof *number);
  unite_points(t, parent, number);
  memset(number, 0xff, most * sizeof *number);
  for (size_t f = 0; f < t->face_count; f++) {
    const uint32_t root = abbe_disjoint_sets_find(parent, (uint32_t)f);
    if (number[root] == ABBE_TOPOLOGY_NONE) number[root] = (uint32_t)t->shell_count++;
    t->shell[f] = number[root];
  }
  return ABBE_OK;
}

static abbe_result check_input(const abbe_mesh *mesh, abbe_error *error) {
  for (size_t v = 0; v < mesh->vertex_count; v++)
    for (int k = 0; k < 3; k++)
      if (!(fabs(mesh->position[v][k]) < 1e150))
        return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                              "vertex %zu of the mesh has the coordinate %g, which is not a "
                              "length in metres that can be worked with",
                              v, mesh->position[v][k]);
  for (size_t f = 0; f < mesh->face_count; f++)
    for (int k = 0; k < 3; k++)
      if (mesh->face[f][k] >= mesh->vertex_count)
        return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                              "face %zu of the mesh names vertex %u of %zu", f, mesh->face[f][k],
                              mesh->vertex_count);
  return ABBE_OK;
}

abbe_result abbe_topology_make(const abbe_mesh *mesh, abbe_topology *out, abbe_error *error) {
  memset(out, 0, sizeof *out);
  abbe_result result = check_input(mesh, error);
  if (result == ABBE_OK) result = abbe_watch_check(error);
  if (result != ABBE_OK) return result;
  const size_t vertices = mesh->vertex_count + 1, faces = mesh->face_count + 1;
  out->face_count = mesh->face_count;
  out->point = malloc(vertices * sizeof *out->point);
  out->position = malloc(vertices * sizeof *out->position);
  out->face = malloc(faces * sizeof *out->face);
  out->face_edge = malloc(faces * sizeof *out->face_edge);
  out->edge = malloc(3 * faces * sizeof *out->edge);
  out->shell = malloc(faces * sizeof *out->shell);
  if (!out->point || !out->position || !out->face || !out->face_edge || !out->edge || !out->shell)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the topology of %zu faces",
                            mesh->face_count);
  if (result == ABBE_OK) result = weld(mesh, out, error);
  if (result == ABBE_OK) result = find_edges(out, error);
  if (result == ABBE_OK) result = find_shells(out, error);
  if (result != ABBE_OK) abbe_topology_free(out);
  return result;
}
