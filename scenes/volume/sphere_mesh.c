#include "scenes/volume/sphere_mesh.h"

#include "base/maths.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* ---- the octahedral map ---- */

static double sign_of(double x) {
  return x < 0 ? -1 : 1;
}

void abbe_octahedral_place(const double d[3], double uv[2]) {
  const double sum = fabs(d[0]) + fabs(d[1]) + fabs(d[2]);
  const double u = d[0] / sum, v = d[1] / sum;
  uv[0] = d[2] < 0 ? (1 - fabs(v)) * sign_of(u) : u;
  uv[1] = d[2] < 0 ? (1 - fabs(u)) * sign_of(v) : v;
}

void abbe_octahedral_direction(const double uv[2], double d[3]) {
  d[2] = 1 - fabs(uv[0]) - fabs(uv[1]);
  d[0] = d[2] < 0 ? (1 - fabs(uv[1])) * sign_of(uv[0]) : uv[0];
  d[1] = d[2] < 0 ? (1 - fabs(uv[0])) * sign_of(uv[1]) : uv[1];
  abbe_vector_normalise(d);
}

/* ---- making ---- */

typedef struct edge {
  uint32_t low, high, face, side;
} edge;

static int by_corners(const void *a, const void *b) {
  const edge *x = a, *y = b;
  if (x->low != y->low) return x->low < y->low ? -1 : 1;
  return x->high < y->high ? -1 : x->high > y->high;
}

static bool allocate(size_t corners, size_t faces, abbe_sphere_mesh *m) {
  m->corner_count = corners;
  m->face_count = faces;
  m->corner = calloc(corners, sizeof *m->corner);
  m->face = calloc(faces, sizeof *m->face);
  m->next = calloc(faces, sizeof *m->next);
  m->edge = calloc(faces, sizeof *m->edge);
  return m->corner != NULL && m->face != NULL && m->next != NULL && m->edge != NULL;
}

static bool join_faces(abbe_sphere_mesh *m) {
  const size_t count = 3 * m->face_count;
  edge *all = calloc(count, sizeof *all);
  if (all == NULL) return false;
  for (uint32_t i = 0; i < count; i++) {
    const uint32_t face = i / 3, k = i % 3;
    const uint32_t a = m->face[face][k], b = m->face[face][(k + 1) % 3];
    all[i] = (edge){a < b ? a : b, a < b ? b : a, face, k};
  }
  qsort(all, count, sizeof *all, by_corners);
  for (size_t i = 0; i + 1 < count; i += 2) {
    m->next[all[i].face][all[i].side] = all[i + 1].face;
    m->next[all[i + 1].face][all[i + 1].side] = all[i].face;
  }
  free(all);
  return true;
}

/* Orientation, edges' planes, neighbours, table. */
static bool complete(abbe_sphere_mesh *m) {
  for (size_t f = 0; f < m->face_count; f++) {
    uint32_t *face = m->face[f];
    double n[3];
    abbe_vector_cross(m->corner[face[0]], m->corner[face[1]], n);
    if (abbe_vector_dot(n, m->corner[face[2]]) < 0) {
      const uint32_t other = face[1];
      face[1] = face[2];
      face[2] = other;
    }
    for (int k = 0; k < 3; k++) {
      abbe_vector_cross(m->corner[face[k]], m->corner[face[(k + 1) % 3]], m->edge[f][k]);
      abbe_vector_normalise(m->edge[f][k]);
    }
  }
  m->table_side = 4 * (size_t)ceil(sqrt((double)m->face_count));
  m->table = calloc(m->table_side * m->table_side, sizeof *m->table);
  if (m->table == NULL || !join_faces(m)) return false;
  for (size_t i = 0; i < m->table_side * m->table_side; i++) {
    const double side = (double)m->table_side;
    const double uv[2] = {((double)(i % m->table_side) + 0.5) / side * 2 - 1,
                          ((double)(i / m->table_side) + 0.5) / side * 2 - 1};
    double d[3];
    abbe_octahedral_direction(uv, d);
    if (i > 0) m->table[i] = m->table[i - 1]; /* from where the search goes on */
    m->table[i] = (uint32_t)abbe_sphere_mesh_find(m, d);
  }
  return true;
}

static abbe_result give(bool whole, abbe_sphere_mesh *mesh, abbe_sphere_mesh *out,
                        abbe_error *error) {
  if (whole) {
    *out = *mesh;
    return ABBE_OK;
  }
  abbe_sphere_mesh_free(mesh);
  return abbe_error_set(error, ABBE_NO_MEMORY, "no memory for a sphere of triangles");
}

/* The corner halfway between two, made once: beside it in the list of edges that are cut. */
static uint32_t halve(abbe_sphere_mesh *m, const edge *all, size_t count, size_t first, uint32_t a,
                      uint32_t b) {
  const edge key = {a < b ? a : b, a < b ? b : a, 0, 0};
  const edge *found = bsearch(&key, all, count, sizeof key, by_corners);
  const uint32_t at = (uint32_t)(first + (size_t)(found - all));
  for (int k = 0; k < 3; k++) m->corner[at][k] = m->corner[a][k] + m->corner[b][k];
  abbe_vector_normalise(m->corner[at]);
  return at;
}

/* Each face into four. */
static bool subdivide(abbe_sphere_mesh *m) {
  const size_t faces = m->face_count, edges = faces * 3 / 2;
  abbe_sphere_mesh fine = {0};
  edge *all = calloc(2 * edges, sizeof *all);
  bool whole = allocate(m->corner_count + edges, 4 * faces, &fine) && all != NULL;
  for (uint32_t i = 0; whole && i < 3 * faces; i++) {
    const uint32_t a = m->face[i / 3][i % 3], b = m->face[i / 3][(i % 3 + 1) % 3];
    all[i] = (edge){a < b ? a : b, a < b ? b : a, 0, 0};
  }
  if (whole) {
    qsort(all, 2 * edges, sizeof *all, by_corners);
    for (size_t i = 0; i < edges; i++) all[i] = all[2 * i];
    memcpy(fine.corner, m->corner, m->corner_count * sizeof *m->corner);
  }
  for (size_t f = 0; whole && f < faces; f++) {
    const uint32_t *c = m->face[f];
    uint32_t h[3];
    for (int k = 0; k < 3; k++)
      h[k] = halve(&fine, all, edges, m->corner_count, c[k], c[(k + 1) % 3]);
    const uint32_t four[4][3] = {
        {c[0], h[0], h[2]}, {h[0], c[1], h[1]}, {h[2], h[1], c[2]}, {h[0], h[1], h[2]}};
    memcpy(fine.face[4 * f], four, sizeof four);
  }
  free(all);
  abbe_sphere_mesh_free(m);
  *m = fine;
  return whole;
}

static bool make_icosahedron(abbe_sphere_mesh *m) {
  /* three rectangles across each other, of one and the golden ratio */
  static const uint32_t face[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                       {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                       {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                       {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  const double g = (1 + sqrt(5)) / 2;
  const double corner[12][3] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  if (!allocate(12, 20, m)) return false;
  memcpy(m->corner, corner, sizeof corner);
  memcpy(m->face, face, sizeof face);
  for (size_t i = 0; i < 12; i++) abbe_vector_normalise(m->corner[i]);
  return true;
}

abbe_result abbe_sphere_mesh_geodesic(size_t levels, abbe_sphere_mesh *out, abbe_error *error) {
  *out = (abbe_sphere_mesh){0};
  if (levels > ABBE_SPHERE_MESH_MOST_LEVELS)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "an icosahedron is subdivided %zu times; it may be 0 to %d", levels,
                          ABBE_SPHERE_MESH_MOST_LEVELS);
  abbe_sphere_mesh m = {0};
  bool whole = make_icosahedron(&m);
  for (size_t i = 0; whole && i < levels; i++) whole = subdivide(&m);
  return give(whole && complete(&m), &m, out, error);
}

/* Corner (i, j) of the texels; the square's rim is folded onto itself. */
static uint32_t corner_at(size_t side, size_t i, size_t j) {
  if ((j == 0 || j == side) && i > side - i) i = side - i;
  if ((i == 0 || i == side) && j > side - j) j = side - j;
  if ((j == 0 || j == side) && i > side - i) i = side - i;
  return (uint32_t)(j * (side + 1) + i);
}

abbe_result abbe_sphere_mesh_octahedral(size_t side, abbe_sphere_mesh *out, abbe_error *error) {
  *out = (abbe_sphere_mesh){0};
  if (side < 2 || side > ABBE_SPHERE_MESH_MOST_SIDE || side % 2 != 0)
    return abbe_error_set(error, ABBE_INVALID_ARGUMENT,
                          "an octahedral map of %zu texels a side; it may be an even number of 2 "
                          "to %d",
                          side, ABBE_SPHERE_MESH_MOST_SIDE);
  abbe_sphere_mesh m = {0};
  bool whole = allocate((side + 1) * (side + 1), 2 * side * side, &m);
  for (size_t k = 0; whole && k < m.corner_count; k++) {
    const double uv[2] = {2 * (double)(k % (side + 1)) / (double)side - 1,
                          2 * (double)(k / (side + 1)) / (double)side - 1};
    abbe_octahedral_direction(uv, m.corner[k]);
  }
  for (size_t k = 0; whole && k < side * side; k++) {
    const size_t i = k % side, j = k / side;
    const uint32_t a = corner_at(side, i, j), b = corner_at(side, i + 1, j),
                   c = corner_at(side, i + 1, j + 1), d = corner_at(side, i, j + 1);
    /* along the fold, where there is one */
    const bool rises = (2 * i < side) != (2 * j < side);
    const uint32_t two[2][3] = {{a, b, rises ? c : d}, {rises ? a : b, c, d}};
    memcpy(m.face[2 * k], two, sizeof two);
  }
  return give(whole && complete(&m), &m, out, error);
}

void abbe_sphere_mesh_free(abbe_sphere_mesh *m) {
  if (m == NULL) return;
  free(m->corner);
  free(m->face);
  free(m->next);
  free(m->edge);
  free(m->table);
  *m = (abbe_sphere_mesh){0};
}

/* ---- looking up ---- */

size_t abbe_sphere_mesh_look_up(const abbe_sphere_mesh *m, const double d[3]) {
  double uv[2];
  size_t at[2];
  abbe_octahedral_place(d, uv);
  for (int k = 0; k < 2; k++) {
    const double place = (uv[k] + 1) / 2 * (double)m->table_side;
    at[k] = place > 0 ? (size_t)place : 0;
    if (at[k] >= m->table_side) at[k] = m->table_side - 1;
  }
  return m->table[at[1] * m->table_side + at[0]];
}

size_t abbe_sphere_mesh_find(const abbe_sphere_mesh *m, const double d[3]) {
  size_t face = abbe_sphere_mesh_look_up(m, d);
  for (size_t step = 0; step < m->face_count; step++) {
    double least = -1e-15 * (fabs(d[0]) + fabs(d[1]) + fabs(d[2]));
    int over = -1;
    for (int k = 0; k < 3; k++) {
      const double inside = abbe_vector_dot(m->edge[face][k], d);
      if (!(inside < least)) continue;
      least = inside;
      over = k;
    }
    if (over < 0) break;
    face = m->next[face][over];
  }
  return face;
}

void abbe_sphere_mesh_weights(const abbe_sphere_mesh *m, size_t face, const double d[3],
                              double weight[3]) {
  const uint32_t *corner = m->face[face];
  double sum = 0;
  for (int k = 0; k < 3; k++) {
    double across[3];
    abbe_vector_cross(m->corner[corner[(k + 1) % 3]], m->corner[corner[(k + 2) % 3]], across);
    weight[k] = fmax(abbe_vector_dot(across, d), 0);
    sum += weight[k];
  }
  for (int k = 0; k < 3; k++) weight[k] /= sum;
}

double abbe_sphere_mesh_area(const abbe_sphere_mesh *m, size_t face) {
  const double *a = m->corner[m->face[face][0]], *b = m->corner[m->face[face][1]],
               *c = m->corner[m->face[face][2]];
  double across[3];
  abbe_vector_cross(b, c, across);
  return 2 * atan2(fabs(abbe_vector_dot(a, across)),
                   1 + abbe_vector_dot(a, b) + abbe_vector_dot(b, c) + abbe_vector_dot(c, a));
}
