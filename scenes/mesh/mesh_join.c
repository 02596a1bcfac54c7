/* Corners that are meant to be one and lie a little apart, as in files whose faces have each their
 * own, written to few digits. */
#include "base/maths.h"
#include "scenes/geometry/disjoint_sets.h"
#include "scenes/mesh/mesh_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
  const abbe_result result =
      abbe_mesh_make(mesh->vertex_count, mesh->face_count, mesh->uv != NULL, out, error);
  if (result != ABBE_OK) return result;
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
