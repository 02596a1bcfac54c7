#include "scenes/mesh/mesh.h"

#include "base/maths.h"
#include "scenes/geometry/disjoint_sets.h"
#include "scenes/mesh/topology.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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
