#include "scenes/mesh/mesh.h"

#include "base/maths.h"
#include "scenes/geometry/transform.h"
#include "scenes/mesh/mesh_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void abbe_mesh_free(abbe_mesh *mesh) {
  if (!mesh) return;
  free(mesh->position);
  free(mesh->normal);
  free(mesh->uv);
  free(mesh->face);
  memset(mesh, 0, sizeof *mesh);
}

abbe_result abbe_mesh_make(size_t vertices, size_t faces, bool with_uv, abbe_mesh *out,
                           abbe_error *error) {
  memset(out, 0, sizeof *out);
  if (vertices == 0 || vertices > ABBE_MESH_MAX_VERTICES || faces == 0 ||
      faces > ABBE_MESH_MAX_FACES)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a mesh of %zu vertices and %zu faces is not possible: each must be "
                          "from 1 to %u",
                          vertices, faces, ABBE_MESH_MAX_FACES);
  out->position = calloc(vertices, sizeof *out->position);
  out->normal = calloc(vertices, sizeof *out->normal);
  out->uv = with_uv ? calloc(vertices, sizeof *out->uv) : NULL;
  out->face = calloc(faces, sizeof *out->face);
  if (!out->position || !out->normal || (with_uv && !out->uv) || !out->face) {
    abbe_mesh_free(out);
    return abbe_error_set(error, ABBE_NO_MEMORY,
                          "no memory for a mesh of %zu vertices and %zu faces", vertices, faces);
  }
  out->vertex_count = vertices;
  out->face_count = faces;
  return ABBE_OK;
}

abbe_result abbe_mesh_drop_unused(abbe_mesh *mesh, abbe_error *error) {
  uint32_t *number = malloc((mesh->vertex_count + 1) * sizeof *number);
  size_t kept = 0;
  if (!number) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the vertices of a mesh");
  memset(number, 0xff, (mesh->vertex_count + 1) * sizeof *number);
  for (size_t c = 0; c < 3 * mesh->face_count; c++) number[mesh->face[c / 3][c % 3]] = 0;
  for (size_t v = 0; v < mesh->vertex_count; v++) {
    if (number[v] != 0) continue;
    number[v] = (uint32_t)kept;
    memmove(mesh->position[kept], mesh->position[v], sizeof *mesh->position);
    memmove(mesh->normal[kept], mesh->normal[v], sizeof *mesh->normal);
    if (mesh->uv) memmove(mesh->uv[kept], mesh->uv[v], sizeof *mesh->uv);
    kept++;
  }
  for (size_t c = 0; c < 3 * mesh->face_count; c++)
    mesh->face[c / 3][c % 3] = number[mesh->face[c / 3][c % 3]];
  mesh->vertex_count = kept;
  free(number);
  return ABBE_OK;
}

abbe_result abbe_mesh_transform(abbe_mesh *mesh, const double matrix[16], abbe_error *error) {
  double normal[9], normal4[16];
  const double determinant = abbe_transform_determinant3(matrix);
  if (!isfinite(determinant) || determinant == 0.0 || !abbe_transform_normal_matrix(matrix, normal))
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "a transform with determinant %g flattens the mesh; every scale must "
                          "differ from zero",
                          determinant);
  abbe_transform_identity(normal4);
  for (int column = 0; column < 3; column++)
    memcpy(normal4 + 4 * column, normal + 3 * column, 3 * sizeof(double));
  for (size_t v = 0; v < mesh->vertex_count; v++) {
    abbe_transform_point(matrix, mesh->position[v], mesh->position[v]);
    abbe_transform_direction(normal4, mesh->normal[v], mesh->normal[v]);
    abbe_vector_normalise(mesh->normal[v]);
  }
  if (determinant < 0.0)
    for (size_t f = 0; f < mesh->face_count; f++) {
      const uint32_t second = mesh->face[f][1];
      mesh->face[f][1] = mesh->face[f][2];
      mesh->face[f][2] = second;
    }
  return ABBE_OK;
}

bool abbe_mesh_is_convex(const abbe_mesh *mesh) {
  double min[3], max[3], size = 0;
  if (mesh->face_count == 0 || mesh->face_count > ABBE_MESH_MAX_CONVEX_FACES) return false;
  for (int k = 0; k < 3; k++) {
    min[k] = max[k] = mesh->position[0][k];
    for (size_t v = 1; v < mesh->vertex_count; v++) {
      min[k] = fmin(min[k], mesh->position[v][k]);
      max[k] = fmax(max[k], mesh->position[v][k]);
    }
    size = fmax(size, max[k] - min[k]);
  }
  for (size_t f = 0; f < mesh->face_count; f++) {
    const uint32_t *corner = mesh->face[f];
    double n[3];
    abbe_vector_triangle(mesh->position[corner[0]], mesh->position[corner[1]],
                         mesh->position[corner[2]], n);
    if (!abbe_vector_normalise(n)) continue;
    double most = abbe_vector_dot(n, mesh->position[corner[0]]) + 1e-6 * size;
    for (size_t v = 0; v < mesh->vertex_count; v++)
      if (abbe_vector_dot(n, mesh->position[v]) > most) return false;
  }
  return true;
}
