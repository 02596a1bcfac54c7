/* What is wrong with a mesh; mesh_mend.c does something about it. */
#include "scenes/mesh.h"
#include "scenes/topology.h"
#include "scenes/vector.h"

#include <math.h>
#include <string.h>

/* A face whose height is under 1e-9 of its longest side has no usable normal. */
static bool no_area(const double a[3], const double b[3], const double c[3]) {
  double n[3], side[3], longest = 0.0;
  abbe_vector_triangle(a, b, c, n);
  const double *corner[3] = {a, b, c};
  for (int k = 0; k < 3; k++) {
    abbe_vector_subtract(corner[(k + 1) % 3], corner[k], side);
    longest = fmax(longest, abbe_vector_dot(side, side));
  }
  return !(abbe_vector_length(n) > 1e-9 * longest);
}

static void measure_faces(const abbe_topology *t, abbe_mesh_report *report) {
  for (size_t f = 0; f < t->face_count; f++) {
    const double *a = t->position[t->face[f][0]], *b = t->position[t->face[f][1]],
                 *c = t->position[t->face[f][2]];
    double n[3], from_corner[3];
    abbe_vector_triangle(a, b, c, n);
    /* relative to a corner of the bounds: far from the origin nothing cancels */
    abbe_vector_subtract(a, report->min, from_corner);
    report->area += 0.5 * abbe_vector_length(n);
    report->volume += abbe_vector_dot(from_corner, n) / 6.0;
    if (t->face_edge[f][0] == ABBE_TOPOLOGY_NONE || no_area(a, b, c)) report->degenerate_faces++;
  }
}

abbe_result abbe_mesh_check(const abbe_mesh *mesh, abbe_mesh_report *report, abbe_error *error) {
  memset(report, 0, sizeof *report);
  abbe_topology t;
  const abbe_result result = abbe_topology_make(mesh, &t, error);
  if (result != ABBE_OK) return result;
  for (size_t v = 0; v < mesh->vertex_count; v++)
    for (int k = 0; k < 3; k++) {
      const double x = mesh->position[v][k];
      if (v == 0 || x < report->min[k]) report->min[k] = x;
      if (v == 0 || x > report->max[k]) report->max[k] = x;
    }
  for (size_t e = 0; e < t.edge_count; e++) {
    const uint32_t along = t.edge[e].along, against = t.edge[e].against;
    if (along + against == 1) report->open_edges++;
    if (along + against > 2) report->crowded_edges++;
    if (along + against == 2 && along != against) report->flipped_edges++;
  }
  report->shells = t.shell_count;
  measure_faces(&t, report);
  abbe_topology_free(&t);
  return ABBE_OK;
}

/* The test of [MollerTrumbore1997], with the ray from p along d; counts a hit in front of p. */
static bool ray_hits(const double p[3], const double d[3], const double a[3], const double b[3],
                     const double c[3]) {
  double u[3], v[3], s[3], h[3], q[3];
  abbe_vector_subtract(b, a, u);
  abbe_vector_subtract(c, a, v);
  abbe_vector_cross(d, v, h);
  const double determinant = abbe_vector_dot(u, h);
  if (determinant == 0.0) return false;
  abbe_vector_subtract(p, a, s);
  const double first = abbe_vector_dot(s, h) / determinant;
  if (!(first >= 0.0 && first <= 1.0)) return false;
  abbe_vector_cross(s, u, q);
  const double second = abbe_vector_dot(d, q) / determinant;
  if (!(second >= 0.0 && first + second <= 1.0)) return false;
  return abbe_vector_dot(v, q) / determinant > 0.0;
}

bool abbe_mesh_contains(const abbe_mesh *mesh, const double point[3]) {
  /* three odd directions vote, so that a ray through an edge cannot decide alone */
  static const double direction[3][3] = {
      {0.5391, 0.7283, 0.4231}, {-0.8127, 0.3119, 0.4921}, {0.2713, -0.5881, -0.7619}};
  int votes = 0;
  for (int i = 0; i < 3; i++) {
    size_t hits = 0;
    for (size_t f = 0; f < mesh->face_count; f++)
      hits += ray_hits(point, direction[i], mesh->position[mesh->face[f][0]],
                       mesh->position[mesh->face[f][1]], mesh->position[mesh->face[f][2]]);
    votes += hits % 2;
  }
  return votes >= 2;
}
