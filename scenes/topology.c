#include "scenes/topology.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
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
    t->edge[t->edge_count++] = (abbe_edge){a, b, 0, 0, {ABBE_TOPOLOGY_NONE, ABBE_TOPOLOGY_NONE}};
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

static uint32_t root_of(uint32_t *parent, uint32_t x) {
  while (parent[x] != x) {
    parent[x] = parent[parent[x]];
    x = parent[x];
  }
  return x;
}

static abbe_result find_shells(abbe_topology *t, abbe_error *error) {
  uint32_t *parent = malloc((t->point_count + 1) * sizeof *parent);
  uint32_t *number = malloc((t->point_count + 1) * sizeof *number);
  if (!parent || !number) {
    free(parent);
    free(number);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the parts of a mesh");
  }
  for (size_t p = 0; p < t->point_count; p++) {
    parent[p] = (uint32_t)p;
    number[p] = ABBE_TOPOLOGY_NONE;
  }
  for (size_t f = 0; f < t->face_count; f++)
    for (int k = 1; k < 3; k++)
      parent[root_of(parent, t->face[f][k])] = root_of(parent, t->face[f][0]);
  for (size_t f = 0; f < t->face_count; f++) {
    const uint32_t root = root_of(parent, t->face[f][0]);
    if (number[root] == ABBE_TOPOLOGY_NONE) number[root] = (uint32_t)t->shell_count++;
    t->shell[f] = number[root];
  }
  free(parent);
  free(number);
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
