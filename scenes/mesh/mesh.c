#include "scenes/mesh/mesh.h"

#include "scenes/geometry/disjoint_sets.h"
#include "scenes/geometry/transform.h"
#include "scenes/mesh/mesh_parts.h"
#include "scenes/mesh/topology.h"

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

/* Cosine to the axis: the six caps of 60 degrees cover all directions. */
static const double least_cosine = 0.5;

enum { AXES = 6, NO_AXIS = AXES };

/* +x, -x, +y and so on: the coordinate along it and the sign. */
static int coordinate(int axis) {
  return axis / 2;
}

static double sign(int axis) {
  return axis % 2 == 0 ? 1 : -1;
}

static void face_normal(const abbe_mesh *mesh, size_t face, double out[3]) {
  const uint32_t *f = mesh->face[face];
  abbe_vector_triangle(mesh->position[f[0]], mesh->position[f[1]], mesh->position[f[2]], out);
}

/* The first axis that a face is near enough to, so that parts are large; joins faces that share
 * one. */
static void choose_axes(const abbe_mesh *mesh, const abbe_topology *t, uint8_t *axis_of,
                        uint32_t *parent) {
  for (size_t i = 0; i < mesh->face_count; i++) {
    double n[3];
    axis_of[i] = NO_AXIS;
    parent[i] = (uint32_t)i;
    face_normal(mesh, i, n);
    if (!abbe_vector_normalise(n)) continue;
    for (int axis = AXES - 1; axis >= 0; axis--)
      if (sign(axis) * n[coordinate(axis)] >= least_cosine) axis_of[i] = (uint8_t)axis;
  }
  for (size_t e = 0; e < t->edge_count; e++) {
    const uint32_t *face = t->edge[e].face;
    if (face[0] == ABBE_TOPOLOGY_NONE || face[1] == ABBE_TOPOLOGY_NONE) continue;
    if (axis_of[face[0]] == axis_of[face[1]] && axis_of[face[0]] != NO_AXIS)
      abbe_disjoint_sets_unite(parent, face[1], face[0]);
  }
}

/* Numbers the parts; their count. */
static size_t number_charts(size_t faces, const uint8_t *axis_of, uint32_t *parent, uint32_t *chart,
                            uint8_t *chart_axis) {
  size_t count = 0;
  for (size_t i = 0; i < faces; i++) {
    chart[i] = 0;
    if (axis_of[i] == NO_AXIS || abbe_disjoint_sets_find(parent, (uint32_t)i) != i) continue;
    chart_axis[count] = axis_of[i];
    chart[i] = (uint32_t)count++;
  }
  for (size_t i = 0; i < faces; i++)
    if (axis_of[i] != NO_AXIS) chart[i] = chart[abbe_disjoint_sets_find(parent, (uint32_t)i)];
  return count;
}

/* The rectangles around what the faces cover. */
static void bound(const abbe_mesh *mesh, const uint8_t *axis_of, const uint8_t *chart_axis,
                  abbe_mesh_charts *out) {
  /* Until its bounds are known, a parallelogram holds the least and the greatest of each. */
  for (size_t c = 0; c < out->count; c++)
    for (int k = 0; k < 3; k++) {
      out->parallelogram[c][k] = INFINITY;
      out->parallelogram[c][3 + k] = -INFINITY;
    }
  for (size_t i = 0; i < mesh->face_count; i++)
    for (int corner = 0; corner < 3 && axis_of[i] != NO_AXIS; corner++)
      for (int k = 0; k < 3; k++) {
        double *of = out->parallelogram[out->face[i]];
        const double at = mesh->position[mesh->face[i][corner]][k];
        of[k] = fmin(of[k], at);
        of[3 + k] = fmax(of[3 + k], at);
      }
  for (size_t c = 0; c < out->count; c++) {
    double *p = out->parallelogram[c], min[3], max[3];
    const int along = coordinate(chart_axis[c]);
    int u = (along + 1) % 3, v = (along + 2) % 3;
    memcpy(min, p, sizeof min);
    memcpy(max, p + 3, sizeof max);
    if (sign(chart_axis[c]) < 0) {
      const int other = u;
      u = v;
      v = other;
    }
    memset(p, 0, sizeof *out->parallelogram);
    memcpy(p, min, sizeof min);
    p[along] = 0.5 * (min[along] + max[along]);
    p[3 + u] = max[u] - min[u];
    p[6 + v] = max[v] - min[v];
  }
}

abbe_result abbe_mesh_charts_make(const abbe_mesh *mesh, abbe_mesh_charts *out, abbe_error *error) {
  abbe_topology t = {0};
  memset(out, 0, sizeof *out);
  abbe_result result = abbe_topology_make(mesh, &t, error);
  if (result != ABBE_OK) return result;
  const size_t faces = mesh->face_count;
  uint8_t *axis_of = malloc(faces + 1), *chart_axis = malloc(faces + 1);
  uint32_t *parent = malloc((faces + 1) * sizeof *parent);
  out->face = malloc((faces + 1) * sizeof *out->face);
  if (axis_of != NULL && chart_axis != NULL && parent != NULL && out->face != NULL) {
    choose_axes(mesh, &t, axis_of, parent);
    out->count = number_charts(faces, axis_of, parent, out->face, chart_axis);
    out->parallelogram = calloc(out->count + 1, sizeof *out->parallelogram);
  }
  if (out->parallelogram == NULL)
    result = abbe_error_set(error, ABBE_NO_MEMORY, "no memory for the charts of %zu faces", faces);
  else
    bound(mesh, axis_of, chart_axis, out);
  free(axis_of);
  free(chart_axis);
  free(parent);
  abbe_topology_free(&t);
  if (result != ABBE_OK) abbe_mesh_charts_free(out);
  return result;
}

void abbe_mesh_charts_free(abbe_mesh_charts *charts) {
  if (charts == NULL) return;
  free(charts->parallelogram);
  free(charts->face);
  memset(charts, 0, sizeof *charts);
}

/* Corners that are meant to be one and lie a little apart, as in files whose faces have each their
 * own, written to few digits. */
/* Shares of the size: the least that closes the mesh is taken. */
static const double share[] = {1e-7, 1e-6, 1e-5, 1e-4, 3e-4};
enum { SHARES = sizeof share / sizeof *share, MOST_POINTS = 1000000 };

typedef struct place {
  double along; /* an axis that few faces stand square on */
  uint32_t point;
} place;

static int by_axis(const void *a, const void *b) {
  const place *x = a, *y = b;
  if (x->along != y->along) return x->along < y->along ? -1 : 1;
  return (x->point > y->point) - (x->point < y->point);
}

static void sort_points(const abbe_topology *t, place *sorted) {
  static const double axis[3] = {0.3713906763541037, 0.5570860145311556, 0.7427813527082074};
  for (size_t i = 0; i < t->point_count; i++)
    sorted[i] = (place){abbe_vector_dot(t->position[i], axis), (uint32_t)i};
  qsort(sorted, t->point_count, sizeof *sorted, by_axis);
}

/* Sets of points that are no farther from one another than `apart`, from neighbour to neighbour. */
static void find_sets(const abbe_topology *t, const place *sorted, double apart, uint32_t *parent) {
  for (size_t i = 0; i < t->point_count; i++) parent[i] = (uint32_t)i;
  for (size_t i = 0; i < t->point_count; i++)
    for (size_t k = i + 1; k < t->point_count && sorted[k].along - sorted[i].along <= apart; k++) {
      double off[3];
      abbe_vector_subtract(t->position[sorted[k].point], t->position[sorted[i].point], off);
      if (abbe_vector_length(off) <= apart)
        abbe_disjoint_sets_unite(parent, sorted[k].point, sorted[i].point);
    }
}

/* Every vertex to the middle of its set. *moved: so many points are now others, the farthest by
 * *farthest. */
static void move_vertices(const abbe_topology *t, uint32_t *parent, double (*middle)[4],
                          abbe_mesh *mesh, size_t *moved, double *farthest) {
  memset(middle, 0, t->point_count * sizeof *middle);
  *moved = 0;
  *farthest = 0;
  for (size_t i = 0; i < t->point_count; i++) {
    double *m = middle[abbe_disjoint_sets_find(parent, (uint32_t)i)];
    for (int k = 0; k < 3; k++) m[k] += t->position[i][k];
    m[3]++;
  }
  for (size_t i = 0; i < t->point_count; i++) {
    const double *m = middle[abbe_disjoint_sets_find(parent, (uint32_t)i)];
    double off[3];
    if (!(m[3] > 1)) continue;
    for (int k = 0; k < 3; k++) off[k] = m[k] / m[3] - t->position[i][k];
    *farthest = fmax(*farthest, abbe_vector_length(off));
    ++*moved;
  }
  for (size_t v = 0; v < mesh->vertex_count; v++) {
    const double *m = middle[abbe_disjoint_sets_find(parent, t->point[v])];
    for (int k = 0; k < 3 && m[3] > 1; k++) mesh->position[v][k] = m[k] / m[3];
  }
}

static abbe_result copy_mesh(const abbe_mesh *mesh, abbe_mesh *out, abbe_error *error) {
  ABBE_TRY(abbe_mesh_make(mesh->vertex_count, mesh->face_count, mesh->uv != NULL, out, error));
  memcpy(out->position, mesh->position, mesh->vertex_count * sizeof *out->position);
  memcpy(out->normal, mesh->normal, mesh->vertex_count * sizeof *out->normal);
  if (mesh->uv != NULL) memcpy(out->uv, mesh->uv, mesh->vertex_count * sizeof *out->uv);
  memcpy(out->face, mesh->face, mesh->face_count * sizeof *out->face);
  out->given_normals = mesh->given_normals;
  return ABBE_OK;
}

static bool is_closed(const abbe_mesh *mesh, const abbe_topology *t, abbe_result *result,
                      abbe_error *error) {
  abbe_mesh_report r = {0};
  *result = abbe_mesh_check_known(mesh, t, &r, error);
  return *result == ABBE_OK && r.open_edges == 0 && r.crowded_edges == 0 && t->edge_count > 0;
}

abbe_result abbe_mesh_join_corners(const abbe_mesh *mesh, const abbe_topology *t, abbe_mesh *joined,
                                   abbe_topology *own, size_t *moved, double *farthest,
                                   abbe_error *error) {
  *joined = (abbe_mesh){0};
  *moved = 0;
  if (t->point_count > MOST_POINTS) return ABBE_OK;
  place *sorted = malloc(t->point_count * sizeof *sorted);
  uint32_t *parent = malloc(t->point_count * sizeof *parent);
  double(*middle)[4] = malloc(t->point_count * sizeof *middle);
  abbe_result result = sorted && parent && middle
                           ? copy_mesh(mesh, joined, error)
                           : abbe_error_set(error, ABBE_NO_MEMORY, "no memory to join corners");
  const double size = abbe_mesh_diagonal(mesh, NULL);
  bool closed = false;
  if (result == ABBE_OK) sort_points(t, sorted);
  for (int i = 0; i < SHARES && result == ABBE_OK && !closed; i++) {
    find_sets(t, sorted, share[i] * size, parent);
    move_vertices(t, parent, middle, joined, moved, farthest);
    if (*moved == 0) continue;
    result = abbe_topology_make(joined, own, error);
    if (result != ABBE_OK) break;
    closed = is_closed(joined, own, &result, error);
    if (!closed) abbe_topology_free(own);
  }
  free(sorted);
  free(parent);
  free(middle);
  if (closed) return ABBE_OK;
  *moved = 0;
  abbe_mesh_free(joined);
  return result;
}
