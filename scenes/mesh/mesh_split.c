/* A mesh whose shells cross, as several that do not. */
#include "base/maths.h"
#include "scenes/mesh/mesh.h"
#include "scenes/mesh/mesh_parts.h"
#include "scenes/mesh/shells.h"
#include "scenes/mesh/topology.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
  const abbe_result result = abbe_mesh_make(vertices, faces, mesh->uv != NULL, out, error);
  if (result != ABBE_OK) return result;
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
  uint32_t *number = malloc((mesh->vertex_count + 1) * sizeof *number);
  *part = calloc(s->solid_count, sizeof **part);
  abbe_result result =
      number && *part ? ABBE_OK
                      : abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the parts of a mesh");
  for (uint32_t i = 0; i < s->solid_count && result == ABBE_OK; i++) {
    *count = i + 1;
    result = take_solid(mesh, t, s, i, number, &(*part)[i], error);
    if (result == ABBE_OK && s->flush_count > 0 && i > 0)
      result = grow(&(*part)[i], GROWTH * i * abbe_mesh_diagonal(mesh, NULL), error);
  }
  free(number);
  return result;
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
