#include "scenes/mesh/mesh.h"

#include "base/maths.h"
#include "scenes/geometry/digest.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct group {
  uint64_t key; /* key of its cell and side; 0: none */
  double sum[3];
  size_t count;
  double nearest;  /* squared, of the vertex that stands for it; */
  uint32_t vertex; /* before that the first one */
} group;

typedef struct groups {
  const abbe_mesh *mesh;
  double min[3], cell;
  size_t room;  /* a power of two, more than there are vertices */
  group *table; /* [capacity] */
  uint32_t *of; /* [vertices]: where its group is in the table */
  bool *seam;   /* [vertices]: another one stands at the same place; these stay as they are */
} groups;

/* A closed smooth mesh has half as many vertices as faces; each seam in it, as along the rim of
 * water, has some more. */
bool abbe_coarse_mesh_serves(const abbe_mesh *mesh) {
  return mesh->face_count >= 2 * ABBE_COARSE_MESH_FACES &&
         2 * mesh->vertex_count <= mesh->face_count + mesh->face_count / 8;
}

static double area_of(const abbe_mesh *mesh) {
  double sum = 0;
  for (size_t f = 0; f < mesh->face_count; f++) {
    const uint32_t *face = mesh->face[f];
    double n[3];
    abbe_vector_triangle(mesh->position[face[0]], mesh->position[face[1]], mesh->position[face[2]],
                         n);
    sum += 0.5 * abbe_vector_length(n);
  }
  return sum;
}

/* A surface across a grid meets about 1.5 cells for each cell's area, and a closed one has two
 * faces a vertex. */
static bool make_cells(const abbe_mesh *mesh, groups *g) {
  static const double cells = 1.5;
  for (int k = 0; k < 3; k++) {
    g->min[k] = INFINITY;
    for (size_t v = 0; v < mesh->vertex_count; v++)
      g->min[k] = mesh->position[v][k] < g->min[k] ? mesh->position[v][k] : g->min[k];
  }
  g->cell = sqrt(cells * area_of(mesh) / (ABBE_COARSE_MESH_FACES / 2));
  return g->cell > 0 && isfinite(g->cell);
}

/* 20 bits an axis: cells are too large for more, but of a mesh that is a needle. */
static uint64_t key_of(const groups *g, const double p[3]) {
  uint64_t key = 1;
  for (int k = 0; k < 3; k++) {
    const double at = (p[k] - g->min[k]) / g->cell;
    key = key << 20 | (uint64_t)(at < 1048575 ? at : 1048575);
  }
  return key << 1;
}

static uint32_t find(const groups *g, uint64_t key, size_t vertex) {
  const uint64_t mixed = key * 0x9e3779b97f4a7c15u;
  size_t at = (size_t)(mixed ^ mixed >> 32) & (g->room - 1);
  while (g->table[at].key != 0 && g->table[at].key != key) at = (at + 1) & (g->room - 1);
  if (g->table[at].key == 0) g->table[at] = (group){.key = key, .vertex = (uint32_t)vertex};
  return (uint32_t)at;
}

static bool is_same_place(const double a[3], const double b[3]) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* Merged with others, one side of a seam would part from the other. */
static void find_seams(groups *g) {
  const abbe_mesh *mesh = g->mesh;
  memset(g->table, 0, g->room * sizeof *g->table);
  for (size_t v = 0; v < mesh->vertex_count; v++) {
    double p[3];
    for (int k = 0; k < 3; k++) p[k] = mesh->position[v][k] + 0.0; /* one zero */
    size_t at = (size_t)abbe_digest(1, p, sizeof p) & (g->room - 1);
    while (g->table[at].key != 0 && !is_same_place(mesh->position[g->table[at].vertex], p))
      at = (at + 1) & (g->room - 1);
    g->seam[v] = g->table[at].key != 0;
    if (g->seam[v])
      g->seam[g->table[at].vertex] = true;
    else
      g->table[at] = (group){.key = 1, .vertex = (uint32_t)v};
  }
}

/* The group of a vertex in its cell; a normal that points away from the cell's first vertex's
 * belongs to another side of a wall. */
static uint32_t group_of(const groups *g, size_t vertex) {
  const abbe_mesh *mesh = g->mesh;
  if (g->seam[vertex]) return find(g, (uint64_t)1 << 62 | vertex, vertex);
  const uint64_t key = key_of(g, mesh->position[vertex]);
  const uint32_t at = find(g, key, vertex);
  const bool other = abbe_vector_dot(mesh->normal[g->table[at].vertex], mesh->normal[vertex]) < 0;
  return other ? find(g, key | 1, vertex) : at;
}

static void gather(const groups *g) {
  memset(g->table, 0, g->room * sizeof *g->table);
  for (size_t v = 0; v < g->mesh->vertex_count; v++) {
    g->of[v] = group_of(g, v);
    group *own = &g->table[g->of[v]];
    for (int k = 0; k < 3; k++) own->sum[k] += g->mesh->position[v][k] - g->min[k];
    own->count++;
    own->nearest = INFINITY;
  }
  for (size_t v = 0; v < g->mesh->vertex_count; v++) {
    group *own = &g->table[g->of[v]];
    double apart = 0;
    for (int k = 0; k < 3; k++) {
      const double d = g->mesh->position[v][k] - g->min[k] - own->sum[k] / (double)own->count;
      apart += d * d;
    }
    if (!(apart < own->nearest)) continue;
    own->nearest = apart;
    own->vertex = (uint32_t)v;
  }
}

/* Whether the triangle looks to where its corners' normals do; where groups overlap, one that lies
 * folded between two others does not. */
static bool is_upright(const abbe_mesh *mesh, const uint32_t v[3]) {
  double n[3], towards[3];
  abbe_vector_triangle(mesh->position[v[0]], mesh->position[v[1]], mesh->position[v[2]], n);
  for (int k = 0; k < 3; k++)
    towards[k] = mesh->normal[v[0]][k] + mesh->normal[v[1]][k] + mesh->normal[v[2]][k];
  return abbe_vector_dot(n, towards) > 0;
}

static size_t join_faces(const groups *g, uint32_t (*out)[3]) {
  size_t count = 0;
  for (size_t f = 0; f < g->mesh->face_count; f++) {
    uint32_t v[3];
    for (int k = 0; k < 3; k++) v[k] = g->table[g->of[g->mesh->face[f][k]]].vertex;
    const bool there = v[0] != v[1] && v[1] != v[2] && v[2] != v[0];
    if (there && is_upright(g->mesh, v)) memcpy(out[count++], v, sizeof v);
  }
  return count;
}

/* Where large faces are beside small ones, by smaller cells. */
static size_t merge(groups *g, uint32_t (*face)[3]) {
  enum { TRIES = 4 };
  size_t count = 0;
  find_seams(g);
  for (int i = 0; i < TRIES && 3 * count < 2 * ABBE_COARSE_MESH_FACES; i++) {
    gather(g);
    count = join_faces(g, face);
    g->cell *= sqrt((double)count / ABBE_COARSE_MESH_FACES);
    if (count == 0) break;
  }
  return count;
}

abbe_result abbe_coarse_mesh_make(const abbe_mesh *mesh, uint32_t (**face)[3], size_t *count,
                                  abbe_error *error) {
  groups g = {.mesh = mesh, .room = 1};
  *face = NULL;
  *count = 0;
  if (!abbe_coarse_mesh_serves(mesh) || !make_cells(mesh, &g)) return ABBE_OK;
  while (g.room < 2 * mesh->vertex_count) g.room *= 2;
  g.table = malloc(g.room * sizeof *g.table);
  g.of = malloc(mesh->vertex_count * sizeof *g.of);
  g.seam = malloc(mesh->vertex_count * sizeof *g.seam);
  *face = malloc(mesh->face_count * sizeof **face);
  const bool room = g.table != NULL && g.of != NULL && g.seam != NULL && *face != NULL;
  if (room) *count = merge(&g, *face);
  free(g.table);
  free(g.of);
  free(g.seam);
  if (!room || 2 * *count > mesh->face_count) {
    free(*face);
    *face = NULL;
    *count = 0;
  }
  return room ? ABBE_OK : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a coarser mesh");
}
