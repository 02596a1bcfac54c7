#include "scenes/mesh/mesh.h"

#include "base/maths.h"
#include "scenes/mesh/mesh_parts.h"
#include "scenes/mesh/shells.h"
#include "scenes/mesh/topology.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Loop's subdivision [Loop1987], with Warren's weights; open edges follow the cubic curve. */
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
  ABBE_TRY(abbe_topology_make(mesh, &t, error));
  size_t sound = 0;
  for (size_t f = 0; f < t.face_count; f++) sound += t.face_edge[f][0] != ABBE_TOPOLOGY_NONE;
  abbe_result result = abbe_mesh_make(t.point_count + t.edge_count, 4 * sound, false, &fine, error);
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
  for (size_t i = 0; i < levels; i++) ABBE_TRY(subdivide_once(mesh, error));
  if (levels > 0) ABBE_TRY(abbe_mesh_compute_normals(mesh, ABBE_NORMALS_SMOOTH, error));
  return ABBE_OK;
}

/* A mesh whose shells cross, as several that do not. */
/* The faces of one solid with their vertices; number[] has capacity for every vertex. */
static abbe_result take_solid(const abbe_mesh *mesh, const abbe_topology *t, const abbe_shells *s,
                              uint32_t solid, uint32_t *number, abbe_mesh *out, abbe_error *error) {
  size_t faces = 0, vertices = 0;
  memset(number, 0xff, mesh->vertex_count * sizeof *number);
  for (size_t f = 0; f < mesh->face_count; f++) {
    if (s->shell[t->shell[f]].solid != solid) continue;
    faces++;
    for (int k = 0; k < 3; k++)
      if (number[mesh->face[f][k]] == UINT32_MAX) number[mesh->face[f][k]] = (uint32_t)vertices++;
  }
  ABBE_TRY(abbe_mesh_make(vertices, faces, mesh->uv != NULL, out, error));
  out->given_normals = mesh->given_normals;
  for (size_t v = 0; v < mesh->vertex_count; v++) {
    if (number[v] == UINT32_MAX) continue;
    memcpy(out->position[number[v]], mesh->position[v], sizeof *out->position);
    memcpy(out->normal[number[v]], mesh->normal[v], sizeof *out->normal);
    if (mesh->uv) memcpy(out->uv[number[v]], mesh->uv[v], sizeof *out->uv);
  }
  faces = 0;
  for (size_t f = 0; f < mesh->face_count; f++) {
    if (s->shell[t->shell[f]].solid != solid) continue;
    for (int k = 0; k < 3; k++) out->face[faces][k] = number[mesh->face[f][k]];
    faces++;
  }
  return ABBE_OK;
}

/* Faces of two solids on one another are ambiguous: which is met first is a matter of rounding. So
 * of solids that have such the second and those after it grow by this share of the mesh's diagonal,
 * twice, three times as much: they reach into what they touched. */
#define GROWTH 2e-5

/* The mean of the normals around each point, by their angles there, however faces are cut into
 * triangles; and the least cosine between it and one of them. */
static void lean(const abbe_topology *t, double (*mean)[3], double *least) {
  for (int turn = 0; turn < 2; turn++) {
    for (size_t c = 0; c < 3 * t->face_count; c++) {
      const uint32_t *face = t->face[c / 3], p = face[c % 3];
      double n[3], u[3], v[3], across[3];
      abbe_vector_triangle(t->position[face[0]], t->position[face[1]], t->position[face[2]], n);
      if (!abbe_vector_normalise(n)) continue;
      abbe_vector_subtract(t->position[face[(c + 1) % 3]], t->position[p], u);
      abbe_vector_subtract(t->position[face[(c + 2) % 3]], t->position[p], v);
      abbe_vector_cross(u, v, across);
      const double angle = atan2(abbe_vector_length(across), abbe_vector_dot(u, v));
      for (int i = 0; i < 3 && turn == 0; i++) mean[p][i] += angle * n[i];
      if (turn > 0) least[p] = fmin(least[p], abbe_vector_dot(mean[p], n));
    }
    for (size_t p = 0; p < t->point_count && turn == 0; p++) abbe_vector_normalise(mean[p]);
  }
}

/* Moves every face outwards by so much; no corner by more than three times that. */
static abbe_result grow(abbe_mesh *mesh, double by, abbe_error *error) {
  abbe_topology t;
  abbe_result result = abbe_topology_make(mesh, &t, error);
  if (result != ABBE_OK) return result;
  double(*mean)[3] = calloc(t.point_count + 1, sizeof *mean);
  double *least = malloc((t.point_count + 1) * sizeof *least);
  if (mean && least) {
    for (size_t p = 0; p < t.point_count; p++) least[p] = 1;
    lean(&t, mean, least);
    for (size_t v = 0; v < mesh->vertex_count; v++)
      for (int k = 0; k < 3; k++)
        mesh->position[v][k] += by * mean[t.point[v]][k] / fmax(least[t.point[v]], 1.0 / 3);
  } else {
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the parts of a mesh");
  }
  free(mean);
  free(least);
  abbe_topology_free(&t);
  return result;
}

static abbe_result take_all(const abbe_mesh *mesh, const abbe_topology *t, const abbe_shells *s,
                            abbe_mesh **part, size_t *count, abbe_error *error) {
  if (s->solid_count > ABBE_MESH_MAX_SOLIDS)
    return abbe_error_set(
        error, ABBE_UNSUPPORTED,
        "the mesh has %zu parts that all cross one another, at (%.4g, %.4g, %.4g) "
        "for one; at most %u are followed: unite them in a modeller",
        s->solid_count, s->place[0], s->place[1], s->place[2], ABBE_MESH_MAX_SOLIDS);
  ABBE_FREED uint32_t *number = malloc((mesh->vertex_count + 1) * sizeof *number);
  *part = calloc(s->solid_count, sizeof **part);
  if (!(number && *part))
    return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the parts of a mesh");
  for (uint32_t i = 0; i < s->solid_count; i++) {
    *count = i + 1;
    ABBE_TRY(take_solid(mesh, t, s, i, number, &(*part)[i], error));
    if (s->flush_count > 0 && i > 0)
      ABBE_TRY(grow(&(*part)[i], GROWTH * i * abbe_mesh_diagonal(mesh, NULL), error));
  }
  return ABBE_OK;
}

abbe_result abbe_mesh_split(const abbe_mesh *mesh, abbe_mesh **part, size_t *count,
                            abbe_error *error) {
  abbe_topology t;
  abbe_shells shells = {0};
  *part = NULL;
  *count = 0;
  abbe_result result = abbe_topology_make(mesh, &t, error);
  if (result != ABBE_OK) return result;
  if (t.shell_count > 1) result = abbe_shells_find(mesh, &t, &shells, error);
  if (result == ABBE_OK && shells.solid_count > 1)
    result = take_all(mesh, &t, &shells, part, count, error);
  else if (result == ABBE_OK)
    *count = 1;
  if (result != ABBE_OK) {
    for (size_t i = 0; *part && i < *count; i++) abbe_mesh_free(&(*part)[i]);
    free(*part);
    *part = NULL;
    *count = 0;
  }
  abbe_shells_free(&shells);
  abbe_topology_free(&t);
  return result;
}
