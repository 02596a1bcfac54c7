/* closed_mesh.h: what is asked of every shape's mesh. */
#ifndef ABBE_TESTS_SCENES_SHAPES_CLOSED_MESH_H
#define ABBE_TESTS_SCENES_SHAPES_CLOSED_MESH_H

#include "tests/check.h"

#include "base/maths.h"
#include "scenes/mesh/mesh.h"

/* One closed shell of unit normals, each within a cosine of its faces'. Returns what was found. */
static inline abbe_mesh_report assert_closed(const abbe_mesh *mesh, double least_cosine) {
  abbe_mesh_report report;
  OK(abbe_mesh_check(mesh, &report, &error));
  assert_int_equal(report.open_edges, 0);
  assert_int_equal(report.crowded_edges, 0);
  assert_int_equal(report.flipped_edges, 0);
  assert_int_equal(report.degenerate_faces, 0);
  assert_int_equal(report.shells, 1);
  assert_true(report.volume > 0);
  for (size_t f = 0; f < mesh->face_count; f++) {
    double n[3];
    abbe_vector_triangle(mesh->position[mesh->face[f][0]], mesh->position[mesh->face[f][1]],
                         mesh->position[mesh->face[f][2]], n);
    abbe_vector_normalise(n);
    for (int k = 0; k < 3; k++) {
      const double *normal = mesh->normal[mesh->face[f][k]];
      assert_true(fabs(abbe_vector_length(normal) - 1) < 1e-12);
      assert_true(abbe_vector_dot(n, normal) > least_cosine);
    }
  }
  return report;
}

#endif
