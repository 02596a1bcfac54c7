#include "tests/check.h"

#include "base/maths.h"
#include "scenes/mesh/mesh.h"
#include "scenes/shapes/shape.h"

/* Laws of every mesh: a face's corners lie in its chart's rectangle, and its normal within 60
 * degrees of the rectangle's. */
static void check_laws(const abbe_mesh *mesh, const abbe_mesh_charts *charts) {
  for (size_t i = 0; i < mesh->face_count; i++) {
    double n[3], across[3];
    assert_true(charts->face[i] < charts->count);
    const double *p = charts->parallelogram[charts->face[i]];
    abbe_vector_cross(p + 3, p + 6, across);
    assert_true(abbe_vector_normalise(across));
    for (int c = 0; c < 3; c++) {
      double from[3];
      abbe_vector_subtract(mesh->position[mesh->face[i][c]], p, from);
      for (int edge = 3; edge < 9; edge += 3) {
        const double at = abbe_vector_dot(from, p + edge) / abbe_vector_dot(p + edge, p + edge);
        assert_true(at > -1e-12 && at < 1 + 1e-12);
      }
    }
    abbe_vector_triangle(mesh->position[mesh->face[i][0]], mesh->position[mesh->face[i][1]],
                         mesh->position[mesh->face[i][2]], n);
    assert_true(!abbe_vector_normalise(n) || abbe_vector_dot(n, across) > 0.5 - 1e-12);
  }
}

TEST(a_box_has_a_chart_a_side) {
  const double size[3] = {1, 2, 3};
  MADE(abbe_mesh, box, abbe_shape_box(size, &box, &error));
  MADE(abbe_mesh_charts, charts, abbe_mesh_charts_make(&box, &charts, &error));
  assert_int_equal(charts.count, 6);
  double area = 0;
  for (size_t c = 0; c < charts.count; c++) {
    double across[3];
    abbe_vector_cross(charts.parallelogram[c] + 3, charts.parallelogram[c] + 6, across);
    area += abbe_vector_length(across);
  }
  assert_true(fabs(area - 2 * (1 * 2 + 2 * 3 + 3 * 1)) < 1e-12);
  check_laws(&box, &charts);
}

/* Caps of 60 degrees around x leave bands around y, and those nothing around z but four corners. */
TEST(curved_meshes_have_few) {
  MADE(abbe_mesh, mesh, abbe_shape_sphere(1, 5, &mesh, &error));
  MADE(abbe_mesh_charts, charts, abbe_mesh_charts_make(&mesh, &charts, &error));
  print_message("sphere: %zu charts\n", charts.count);
  assert_int_in_range(charts.count, 6, 6);
  check_laws(&mesh, &charts);
  abbe_mesh_charts_free(&charts);
  abbe_mesh_free(&mesh);
  OK(abbe_shape_ring(1, 0.3, 128, 64, &mesh, &error));
  OK(abbe_mesh_charts_make(&mesh, &charts, &error));
  print_message("ring: %zu charts\n", charts.count);
  assert_int_in_range(charts.count, 8, 16);
  check_laws(&mesh, &charts);
}

/* Split vertices hang together, what only lies side by side does not, and slivers are no charts. */
TEST(what_hangs_together) {
  static const double at[11][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                   {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {7, 0, 0}, {8, 0, 0}};
  static const uint32_t face[4][3] = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 9}};
  MADE(abbe_mesh, mesh, abbe_mesh_make(11, 4, false, &mesh, &error));
  memcpy(mesh.position, at, sizeof at);
  memcpy(mesh.face, face, sizeof face);
  MADE(abbe_mesh_charts, charts, abbe_mesh_charts_make(&mesh, &charts, &error));
  assert_int_equal(charts.count, 2);
  assert_int_equal(charts.face[0], charts.face[1]);
  assert_int_not_equal(charts.face[0], charts.face[2]);
  assert_true(charts.parallelogram[charts.face[2]][0] == 5);
  abbe_mesh_charts_free(&charts);
  mesh.face_count = 1;
  mesh.face[0][1] = mesh.face[0][0];
  OK(abbe_mesh_charts_make(&mesh, &charts, &error));
  assert_int_equal(charts.count, 0);
}
