/* Normals: one a face, one a point, or one for each smooth part around a point. */
#include "base/maths.h"
#include "base/thread/watch.h"
#include "scenes/geometry/disjoint_sets.h"
#include "scenes/mesh/mesh.h"
#include "scenes/mesh/mesh_parts.h"
#include "scenes/mesh/topology.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static abbe_result smooth_normals(abbe_mesh *mesh, abbe_error *error) {
  abbe_topology t;
  ABBE_TRY(abbe_topology_make(mesh, &t, error));
  double(*sum)[3] = calloc(t.point_count + 1, sizeof *sum);
  if (!sum) {
    abbe_topology_free(&t);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the normals of a mesh");
  }
  double last[3] = {0.0, 0.0, 1.0};
  for (size_t f = 0; f < t.face_count; f++) {
    double n[3];
    abbe_vector_triangle(t.position[t.face[f][0]], t.position[t.face[f][1]],
                         t.position[t.face[f][2]], n);
    for (int corner = 0; corner < 3; corner++)
      for (int k = 0; k < 3; k++) sum[t.face[f][corner]][k] += n[k];
  }
  for (size_t v = 0; v < mesh->vertex_count; v++) {
    if (abbe_vector_normalise(sum[t.point[v]])) memcpy(last, sum[t.point[v]], sizeof last);
    memcpy(mesh->normal[v], last, sizeof last);
  }
  free(sum);
  abbe_topology_free(&t);
  return ABBE_OK;
}

static abbe_result face_normals(abbe_mesh *mesh, abbe_error *error) {
  abbe_mesh split;
  ABBE_TRY(abbe_mesh_make(3 * mesh->face_count, mesh->face_count, mesh->uv != NULL, &split, error));
  for (size_t f = 0; f < mesh->face_count; f++) {
    const uint32_t *corner = mesh->face[f];
    double n[3];
    abbe_vector_triangle(mesh->position[corner[0]], mesh->position[corner[1]],
                         mesh->position[corner[2]], n);
    if (!abbe_vector_normalise(n)) n[0] = n[1] = 0.0, n[2] = 1.0;
    for (uint32_t k = 0; k < 3; k++) {
      const size_t v = 3 * f + k;
      split.face[f][k] = (uint32_t)v;
      memcpy(split.position[v], mesh->position[corner[k]], sizeof split.position[v]);
      memcpy(split.normal[v], n, sizeof split.normal[v]);
      if (split.uv) memcpy(split.uv[v], mesh->uv[corner[k]], sizeof split.uv[v]);
    }
  }
  abbe_mesh_free(mesh);
  *mesh = split;
  return ABBE_OK;
}

/* ---- by angles ---- */

static uint32_t corner_at(const abbe_topology *t, uint32_t face, uint32_t point) {
  uint32_t k = 0;
  while (k < 2 && t->face[face][k] != point) k++;
  return 3 * face + k;
}

/* Unites the corners on both sides of edges over which the surface is smooth. A face without area
 * has no angle to its neighbours and goes with them. */
static void unite_smooth(const abbe_topology *t, const double (*normal)[3], uint32_t *parent) {
  const double least = cos(ABBE_MESH_CREASE_RAD);
  for (size_t i = 0; i < t->edge_count; i++) {
    const abbe_edge *e = &t->edge[i];
    if (e->along != 1 || e->against != 1) continue;
    const double *m = normal[e->face[0]], *n = normal[e->face[1]];
    const bool known = abbe_vector_dot(m, m) > 0 && abbe_vector_dot(n, n) > 0;
    if (known && abbe_vector_dot(m, n) < least) continue;
    for (int end = 0; end < 2; end++) {
      const uint32_t point = end == 0 ? e->a : e->b;
      abbe_disjoint_sets_unite(parent, corner_at(t, e->face[0], point),
                               corner_at(t, e->face[1], point));
    }
  }
}

/* Faces count by their angles at the corner, however they are cut into triangles.
 * [ThuermerWuethrich1998] */
static double angle_at(const abbe_topology *t, size_t corner) {
  const uint32_t *face = t->face[corner / 3];
  double u[3], v[3], across[3];
  const double *at = t->position[face[corner % 3]];
  abbe_vector_subtract(t->position[face[(corner + 1) % 3]], at, u);
  abbe_vector_subtract(t->position[face[(corner + 2) % 3]], at, v);
  abbe_vector_cross(u, v, across);
  return atan2(abbe_vector_length(across), abbe_vector_dot(u, v));
}

abbe_result abbe_mesh_crease_normals(const abbe_mesh *mesh, const abbe_topology *t,
                                     double (*corner)[3], abbe_error *error) {
  const size_t faces = mesh->face_count;
  double(*normal)[3] = malloc((faces + 1) * sizeof *normal);
  uint32_t *parent = malloc((3 * faces + 1) * sizeof *parent);
  if (!normal || !parent) {
    free(normal);
    free(parent);
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the normals of a mesh");
  }
  for (size_t f = 0; f < faces; f++) {
    abbe_vector_triangle(t->position[t->face[f][0]], t->position[t->face[f][1]],
                         t->position[t->face[f][2]], normal[f]);
    abbe_vector_normalise(normal[f]);
  }
  for (size_t c = 0; c < 3 * faces; c++) parent[c] = (uint32_t)c;
  memset(corner, 0, 3 * faces * sizeof *corner);
  unite_smooth(t, (const double(*)[3])normal, parent);
  for (size_t c = 0; c < 3 * faces; c++) {
    double *sum = corner[abbe_disjoint_sets_find(parent, (uint32_t)c)];
    const double angle = angle_at(t, c);
    for (int k = 0; k < 3; k++) sum[k] += angle * normal[c / 3][k];
  }
  for (size_t c = 0; c < 3 * faces; c++)
    if (parent[c] == c && !abbe_vector_normalise(corner[c])) {
      memcpy(corner[c], normal[c / 3], sizeof *corner);
      if (!abbe_vector_normalise(corner[c])) corner[c][0] = corner[c][1] = 0, corner[c][2] = 1;
    }
  for (size_t c = 0; c < 3 * faces; c++)
    memcpy(corner[c], corner[abbe_disjoint_sets_find(parent, (uint32_t)c)], sizeof *corner);
  free(normal);
  free(parent);
  return ABBE_OK;
}

/* ---- from corners to vertices ---- */

typedef struct key {
  double normal[3], uv[2];
  uint32_t point;
} key;

static uint64_t mix(uint64_t x) {
  x ^= x >> 33;
  x *= 0xff51afd7ed558ccdu;
  x ^= x >> 33;
  x *= 0xc4ceb9fe1a85ec53u;
  return x ^ (x >> 33);
}

static uint64_t hash_of(const key *k) {
  uint64_t bits[5], sum = k->point;
  memcpy(bits, k->normal, sizeof k->normal);
  memcpy(bits + 3, k->uv, sizeof k->uv);
  for (int i = 0; i < 5; i++) sum = mix(sum ^ bits[i]);
  return sum;
}

static bool same_key(const key *a, const key *b) {
  return a->point == b->point && memcmp(a->normal, b->normal, sizeof a->normal) == 0 &&
         memcmp(a->uv, b->uv, sizeof a->uv) == 0;
}

static key key_of(const abbe_mesh *mesh, const uint32_t *point, const double (*corner)[3],
                  size_t c) {
  const uint32_t vertex = mesh->face[c / 3][c % 3];
  key k = {.point = point[vertex]};
  for (int i = 0; i < 3; i++) k.normal[i] = corner[c][i] + 0.0; /* one zero */
  if (mesh->uv) memcpy(k.uv, mesh->uv[vertex], sizeof k.uv);
  return k;
}

/* Numbers the corners' vertices in vertex[], in the order of the corners; their first corners in
 * first[]. Their number; slot has a power of two of entries, more than corners. */
static size_t number_corners(const abbe_mesh *mesh, const uint32_t *point,
                             const double (*corner)[3], uint32_t *vertex, uint32_t *first,
                             uint32_t *slot, size_t slots) {
  size_t count = 0;
  memset(slot, 0xff, slots * sizeof *slot);
  for (size_t c = 0; c < 3 * mesh->face_count; c++) {
    const key k = key_of(mesh, point, corner, c);
    size_t i = hash_of(&k) & (slots - 1);
    for (; slot[i] != UINT32_MAX; i = (i + 1) & (slots - 1)) {
      const key known = key_of(mesh, point, corner, first[slot[i]]);
      if (same_key(&known, &k)) break;
    }
    if (slot[i] == UINT32_MAX) {
      slot[i] = (uint32_t)count;
      first[count++] = (uint32_t)c;
    }
    vertex[c] = slot[i];
  }
  return count;
}

static abbe_result build(const abbe_mesh *mesh, const double (*corner)[3], const uint32_t *vertex,
                         const uint32_t *first, size_t count, abbe_mesh *out, abbe_error *error) {
  ABBE_TRY(abbe_mesh_make(count, mesh->face_count, mesh->uv != NULL, out, error));
  for (size_t v = 0; v < count; v++) {
    const uint32_t from = mesh->face[first[v] / 3][first[v] % 3];
    memcpy(out->position[v], mesh->position[from], sizeof *out->position);
    memcpy(out->normal[v], corner[first[v]], sizeof *out->normal);
    if (mesh->uv) memcpy(out->uv[v], mesh->uv[from], sizeof *out->uv);
  }
  for (size_t c = 0; c < 3 * mesh->face_count; c++) out->face[c / 3][c % 3] = vertex[c];
  return ABBE_OK;
}

abbe_result abbe_mesh_take_normals(abbe_mesh *mesh, const uint32_t *point,
                                   const double (*corner)[3], abbe_error *error) {
  const size_t corners = 3 * mesh->face_count;
  size_t slots = 16;
  while (slots < 2 * corners) slots *= 2;
  uint32_t *vertex = malloc((corners + 1) * sizeof *vertex);
  uint32_t *first = malloc((corners + 1) * sizeof *first), *slot = malloc(slots * sizeof *slot);
  abbe_mesh made = {0};
  abbe_result result =
      vertex && first && slot
          ? build(mesh, corner, vertex, first,
                  number_corners(mesh, point, corner, vertex, first, slot, slots), &made, error)
          : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the normals of a mesh");
  free(vertex);
  free(first);
  free(slot);
  if (result != ABBE_OK) return result;
  made.given_normals = mesh->given_normals;
  abbe_mesh_free(mesh);
  *mesh = made;
  return ABBE_OK;
}

static abbe_result angle_normals(abbe_mesh *mesh, abbe_error *error) {
  abbe_topology t;
  ABBE_TRY(abbe_topology_make(mesh, &t, error));
  double(*corner)[3] = malloc((3 * mesh->face_count + 1) * sizeof *corner);
  abbe_result result =
      corner ? abbe_mesh_crease_normals(mesh, &t, corner, error)
             : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the normals of a mesh");
  if (result == ABBE_OK)
    result = abbe_mesh_take_normals(mesh, t.point, (const double(*)[3])corner, error);
  free(corner);
  abbe_topology_free(&t);
  return result;
}

void abbe_mesh_fair_normal(const double normal[3], const double face[3], double out[3]) {
  const double least = 0.05; /* a cosine: what grazes its face more than this means nothing */
  double n[3] = {normal[0], normal[1], normal[2]}, own[3] = {face[0], face[1], face[2]};
  if (!abbe_vector_normalise(own)) own[0] = own[1] = 0, own[2] = 1;
  if (!abbe_vector_normalise(n)) memcpy(n, own, sizeof n);
  const double along = abbe_vector_dot(n, own);
  for (int k = 0; k < 3; k++) out[k] = fabs(along) < least ? own[k] : along < 0 ? -n[k] : n[k];
}

abbe_result abbe_mesh_compute_normals(abbe_mesh *mesh, abbe_mesh_normals normals,
                                      abbe_error *error) {
  const abbe_result wanted = abbe_watch_check(error);
  if (wanted != ABBE_OK) return wanted;
  mesh->given_normals = false;
  return normals == ABBE_NORMALS_FLAT     ? face_normals(mesh, error)
         : normals == ABBE_NORMALS_SMOOTH ? smooth_normals(mesh, error)
                                          : angle_normals(mesh, error);
}
