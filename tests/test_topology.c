#include "scenes/topology.h"

#include "scenes/shape.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

static void a_split_box_has_eight_points_and_eighteen_edges(void **state) {
  (void)state;
  const double size[3] = {1, 2, 3};
  abbe_mesh box;
  abbe_topology t;
  assert_int_equal(abbe_shape_box(size, &box, NULL), ABBE_OK);
  assert_int_equal(abbe_topology_make(&box, &t, NULL), ABBE_OK);
  assert_int_equal(box.vertex_count, 24);
  assert_int_equal(t.point_count, 8);
  assert_int_equal(t.edge_count, 18);
  assert_int_equal(t.shell_count, 1);
  for (size_t e = 0; e < t.edge_count; e++)
    assert_true(t.edge[e].along == 1 && t.edge[e].against == 1);
  abbe_topology_free(&t);
  abbe_topology_free(&t);
  abbe_mesh_free(&box);
}

static void points_join_within_the_tolerance_only(void **state) {
  (void)state;
  abbe_mesh m;
  abbe_topology t;
  assert_int_equal(abbe_mesh_make(6, 2, false, &m, NULL), ABBE_OK);
  const double at[6][3] = {{0, 0, 0},     {1, 0, 0},      {0, 1, 0},
                           {0, 0, 3e-10}, {1, 0, -3e-10}, {0, 1, 1e-7}};
  for (size_t v = 0; v < 6; v++)
    for (int k = 0; k < 3; k++) m.position[v][k] = at[v][k];
  for (uint32_t v = 0; v < 6; v++) m.face[v / 3][v % 3] = v;
  assert_int_equal(abbe_topology_make(&m, &t, NULL), ABBE_OK);
  assert_int_equal(t.point_count, 4);
  assert_int_equal(t.edge_count, 5);
  abbe_topology_free(&t);
  abbe_mesh_free(&m);
}

static void a_large_mesh_is_whole(void **state) {
  (void)state;
  abbe_mesh m;
  abbe_topology t;
  assert_int_equal(abbe_shape_ring(1, 0.3, 256, 128, &m, NULL), ABBE_OK);
  assert_int_equal(abbe_mesh_compute_normals(&m, false, NULL), ABBE_OK);
  assert_int_equal(abbe_topology_make(&m, &t, NULL), ABBE_OK);
  assert_int_equal(t.point_count, 256 * 128);
  assert_int_equal(t.edge_count, 3 * 256 * 128);
  abbe_topology_free(&t);
  abbe_mesh_free(&m);
}

static void bad_indices_and_positions_are_refused(void **state) {
  (void)state;
  abbe_mesh m;
  abbe_topology t;
  abbe_error error;
  assert_int_equal(abbe_shape_rectangle(1, 1, &m, NULL), ABBE_OK);
  m.face[1][2] = 4;
  assert_int_equal(abbe_topology_make(&m, &t, &error), ABBE_INVALID_ARGUMENT);
  assert_non_null(strstr(error.text, "vertex 4 of 4"));
  m.face[1][2] = 3;
  m.position[2][1] = NAN;
  assert_int_equal(abbe_topology_make(&m, &t, &error), ABBE_INVALID_ARGUMENT);
  m.position[2][1] = 1e300;
  assert_int_equal(abbe_topology_make(&m, &t, &error), ABBE_INVALID_ARGUMENT);
  abbe_mesh_free(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_split_box_has_eight_points_and_eighteen_edges),
      cmocka_unit_test(points_join_within_the_tolerance_only),
      cmocka_unit_test(a_large_mesh_is_whole),
      cmocka_unit_test(bad_indices_and_positions_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
