/* Loop's subdivision [Loop1987], with Warren's weights; open edges follow the cubic curve. */
#include "scenes/mesh/mesh.h"
#include "scenes/mesh/topology.h"

#include <stdlib.h>
#include <string.h>

typedef struct rings {
  double (*sum)[3]; /* neighbours of a point, over its edges */
  uint32_t *valence;
  double (*rim)[3]; /* neighbours over open or crowded edges */
  uint32_t *rim_valence;
} rings;

static void rings_free(rings *r) {
  free(r->sum);
  free(r->valence);
  free(r->rim);
  free(r->rim_valence);
}

static bool is_crease(const abbe_edge *edge) {
  return edge->along + edge->against != 2;
}

static void add_neighbour(rings *r, const abbe_topology *t, uint32_t point, uint32_t neighbour,
                          bool crease) {
  for (int k = 0; k < 3; k++) {
    r->sum[point][k] += t->position[neighbour][k];
    if (crease) r->rim[point][k] += t->position[neighbour][k];
  }
  r->valence[point]++;
  if (crease) r->rim_valence[point]++;
}

static bool rings_make(const abbe_topology *t, rings *r) {
  const size_t n = t->point_count + 1;
  r->sum = calloc(n, sizeof *r->sum);
  r->rim = calloc(n, sizeof *r->rim);
  r->valence = calloc(n, sizeof *r->valence);
  r->rim_valence = calloc(n, sizeof *r->rim_valence);
  if (!r->sum || !r->rim || !r->valence || !r->rim_valence) return false;
  for (size_t e = 0; e < t->edge_count; e++) {
    const abbe_edge *edge = &t->edge[e];
    add_neighbour(r, t, edge->a, edge->b, is_crease(edge));
    add_neighbour(r, t, edge->b, edge->a, is_crease(edge));
  }
  return true;
}

static void move_points(const abbe_topology *t, const rings *r, double (*out)[3]) {
  for (size_t p = 0; p < t->point_count; p++) {
    const double *old = t->position[p];
    const double n = r->valence[p];
    const double beta = n == 3.0 ? 3.0 / 16.0 : 3.0 / (8.0 * n);
    for (int k = 0; k < 3; k++) {
      if (r->rim_valence[p] == 2)
        out[p][k] = 0.75 * old[k] + 0.125 * r->rim[p][k];
      else if (r->rim_valence[p] > 0 || r->valence[p] < 3)
        out[p][k] = old[k];
      else
        out[p][k] = (1.0 - n * beta) * old[k] + beta * r->sum[p][k];
    }
  }
}

static uint32_t far_corner(const abbe_topology *t, uint32_t f, const abbe_edge *edge) {
  for (int k = 0; k < 3; k++)
    if (t->face[f][k] != edge->a && t->face[f][k] != edge->b) return t->face[f][k];
  return edge->a;
}

static void place_edge_points(const abbe_topology *t, double (*out)[3]) {
  for (size_t e = 0; e < t->edge_count; e++) {
    const abbe_edge *edge = &t->edge[e];
    const double *a = t->position[edge->a], *b = t->position[edge->b];
    if (is_crease(edge)) {
      for (int k = 0; k < 3; k++) out[e][k] = 0.5 * (a[k] + b[k]);
      continue;
    }
    const double *c = t->position[far_corner(t, edge->face[0], edge)];
    const double *d = t->position[far_corner(t, edge->face[1], edge)];
    for (int k = 0; k < 3; k++) out[e][k] = 0.375 * (a[k] + b[k]) + 0.125 * (c[k] + d[k]);
  }
}

static void split_faces(const abbe_topology *t, uint32_t (*out)[3]) {
  size_t n = 0;
  for (size_t f = 0; f < t->face_count; f++) {
    if (t->face_edge[f][0] == ABBE_TOPOLOGY_NONE) continue;
    uint32_t mid[3];
    for (int k = 0; k < 3; k++) mid[k] = (uint32_t)t->point_count + t->face_edge[f][k];
    for (int k = 0; k < 3; k++) {
      const uint32_t corner[3] = {t->face[f][k], mid[k], mid[(k + 2) % 3]};
      memcpy(out[n++], corner, sizeof corner);
    }
    memcpy(out[n++], mid, sizeof mid);
  }
}

static abbe_result subdivide_once(abbe_mesh *mesh, abbe_error *error) {
  abbe_topology t;
  rings r = {0};
  abbe_mesh fine = {0};
  abbe_result result = abbe_topology_make(mesh, &t, error);
  if (result != ABBE_OK) return result;
  size_t sound = 0;
  for (size_t f = 0; f < t.face_count; f++) sound += t.face_edge[f][0] != ABBE_TOPOLOGY_NONE;
  result = abbe_mesh_make(t.point_count + t.edge_count, 4 * sound, false, &fine, error);
  if (result == ABBE_OK && !rings_make(&t, &r))
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory to subdivide a mesh");
  if (result == ABBE_OK) {
    move_points(&t, &r, fine.position);
    place_edge_points(&t, fine.position + t.point_count);
    split_faces(&t, fine.face);
    abbe_mesh_free(mesh);
    *mesh = fine;
  } else {
    abbe_mesh_free(&fine);
  }
  rings_free(&r);
  abbe_topology_free(&t);
  return result;
}

abbe_result abbe_mesh_subdivide(abbe_mesh *mesh, size_t levels, abbe_error *error) {
  size_t faces = mesh->face_count;
  for (size_t i = 0; i < levels; i++) {
    if (faces > ABBE_MESH_MAX_FACES / 4)
      return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                            "%zu levels of subdivision of %zu faces pass the limit of %u faces",
                            levels, mesh->face_count, ABBE_MESH_MAX_FACES);
    faces *= 4;
  }
  abbe_result result = ABBE_OK;
  for (size_t i = 0; i < levels && result == ABBE_OK; i++) result = subdivide_once(mesh, error);
  if (result == ABBE_OK && levels > 0)
    result = abbe_mesh_compute_normals(mesh, ABBE_NORMALS_SMOOTH, error);
  return result;
}
