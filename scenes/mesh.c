#include "scenes/mesh.h"

#include "scenes/topology.h"
#include "scenes/transform.h"
#include "scenes/vector.h"

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

static abbe_result smooth_normals(abbe_mesh *mesh, abbe_error *error) {
  abbe_topology t;
  abbe_result result = abbe_topology_make(mesh, &t, error);
  if (result != ABBE_OK) return result;
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
  abbe_result result =
      abbe_mesh_make(3 * mesh->face_count, mesh->face_count, mesh->uv != NULL, &split, error);
  if (result != ABBE_OK) return result;
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

abbe_result abbe_mesh_compute_normals(abbe_mesh *mesh, bool smooth, abbe_error *error) {
  return smooth ? smooth_normals(mesh, error) : face_normals(mesh, error);
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

/* One distinct plane while they are gathered: relative to the mesh's centre. */
typedef struct face_plane {
  double n[3], d, area;
} face_plane;

static bool same_plane(const face_plane *plane, const face_plane *face, const double corner[3][3],
                       double tolerance) {
  if (abbe_vector_dot(plane->n, face->n) < 0.9999) return false;
  for (int k = 0; k < 3; k++)
    if (fabs(abbe_vector_dot(plane->n, corner[k]) - plane->d) > tolerance) return false;
  return true;
}

/* False where there are more than max planes. Of the faces in one plane the largest defines it. */
static bool gather_planes(const abbe_mesh *mesh, const double centre[3], double tolerance,
                          size_t max, face_plane *plane, size_t *count) {
  *count = 0;
  for (size_t f = 0; f < mesh->face_count; f++) {
    double corner[3][3];
    for (int k = 0; k < 3; k++)
      abbe_vector_subtract(mesh->position[mesh->face[f][k]], centre, corner[k]);
    face_plane face;
    abbe_vector_triangle(corner[0], corner[1], corner[2], face.n);
    face.area = abbe_vector_length(face.n);
    if (!abbe_vector_normalise(face.n)) continue;
    face.d = abbe_vector_dot(face.n, corner[0]);
    size_t i = 0;
    while (i < *count && !same_plane(&plane[i], &face, (const double(*)[3])corner, tolerance)) i++;
    if (i == max) return false;
    if (i == *count) plane[(*count)++] = face;
    if (face.area > plane[i].area) plane[i] = face;
  }
  return *count >= 4;
}

static bool inside_planes(const abbe_mesh *mesh, const double centre[3], double tolerance,
                          const face_plane *plane, size_t count) {
  for (size_t v = 0; v < mesh->vertex_count; v++) {
    double p[3];
    abbe_vector_subtract(mesh->position[v], centre, p);
    for (size_t i = 0; i < count; i++)
      if (abbe_vector_dot(plane[i].n, p) > plane[i].d + tolerance) return false;
  }
  return true;
}

static abbe_result closed_solid(const abbe_mesh *mesh, bool *closed, abbe_error *error) {
  abbe_mesh_report report;
  const abbe_result result = abbe_mesh_check(mesh, &report, error);
  *closed = result == ABBE_OK && report.open_edges == 0 && report.crowded_edges == 0 &&
            report.flipped_edges == 0 && report.shells == 1 && report.volume > 0.0;
  return result == ABBE_NO_MEMORY ? result : ABBE_OK;
}

abbe_result abbe_mesh_convex_planes(const abbe_mesh *mesh, size_t max_planes, double (*plane)[4],
                                    size_t *count, abbe_error *error) {
  *count = 0;
  if (mesh->face_count == 0 || max_planes == 0 || max_planes > 4096) return ABBE_OK;
  double low[3], high[3], centre[3], diagonal = 0.0;
  memcpy(low, mesh->position[0], sizeof low);
  memcpy(high, low, sizeof high);
  for (size_t v = 0; v < mesh->vertex_count; v++)
    for (int k = 0; k < 3; k++) {
      low[k] = fmin(low[k], mesh->position[v][k]);
      high[k] = fmax(high[k], mesh->position[v][k]);
    }
  for (int k = 0; k < 3; k++) {
    centre[k] = 0.5 * (low[k] + high[k]);
    diagonal = hypot(diagonal, high[k] - low[k]);
  }
  face_plane *found = malloc(max_planes * sizeof *found);
  if (!found) return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for %zu planes", max_planes);
  size_t n = 0;
  const double tolerance = 1e-6 * diagonal;
  bool convex = gather_planes(mesh, centre, tolerance, max_planes, found, &n) &&
                inside_planes(mesh, centre, tolerance, found, n);
  const abbe_result result = convex ? closed_solid(mesh, &convex, error) : ABBE_OK;
  for (size_t i = 0; convex && i < n; i++) {
    memcpy(plane[i], found[i].n, sizeof found[i].n);
    plane[i][3] = found[i].d + abbe_vector_dot(found[i].n, centre);
  }
  if (convex) *count = n;
  free(found);
  return result;
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
