#include "tests/scenes/solids.h"

#include "scenes/geometry/transform.h"
#include "scenes/mesh/topology.h"
#include "scenes/shapes/shape.h"

TEST(a_split_box_has_eight_points_and_eighteen_edges) {
  const double size[3] = {1, 2, 3};
  MADE(abbe_mesh, box, abbe_shape_box(size, &box, &error));
  MADE(abbe_topology, t, abbe_topology_make(&box, &t, &error));
  assert_int_equal(box.vertex_count, 24);
  assert_int_equal(t.point_count, 8);
  assert_int_equal(t.edge_count, 18);
  assert_int_equal(t.shell_count, 1);
  for (size_t e = 0; e < t.edge_count; e++)
    assert_true(t.edge[e].along == 1 && t.edge[e].against == 1);
  abbe_topology_free(&t);
}

/* 1.4e-9 here, along each axis. */
TEST(points_join_within_the_tolerance_only) {
  for (int axis = 0; axis < 3; axis++) {
    MADE(abbe_mesh, m, abbe_mesh_make(6, 2, false, &m, &error));
    double at[6][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    at[3][axis] += 1.3e-9;
    at[4][axis] -= 1.3e-9;
    at[5][axis] += 1.6e-9;
    memcpy(m.position, at, sizeof at);
    for (uint32_t v = 0; v < 6; v++) m.face[v / 3][v % 3] = v;
    MADE(abbe_topology, t, abbe_topology_make(&m, &t, &error));
    assert_int_equal(t.point_count, 4);
    assert_int_equal(t.edge_count, 5);
  }
}

TEST(a_large_mesh_is_whole) {
  MADE(abbe_mesh, m, abbe_shape_ring(1, 0.3, 256, 128, &m, &error));
  OK(abbe_mesh_compute_normals(&m, ABBE_NORMALS_FLAT, &error));
  MADE(abbe_topology, t, abbe_topology_make(&m, &t, &error));
  assert_int_equal(t.point_count, 256 * 128);
  assert_int_equal(t.edge_count, 3 * 256 * 128);
}

TEST(bad_indices_and_positions_are_refused) {
  abbe_topology t;
  MADE(abbe_mesh, m, abbe_shape_rectangle(1, 1, &m, &error));
  m.face[1][2] = 4;
  REFUSED(ABBE_INVALID_ARGUMENT, "vertex 4 of 4", abbe_topology_make(&m, &t, &error));
  m.face[1][2] = 3;
  m.position[2][1] = NAN;
  REFUSED(ABBE_INVALID_ARGUMENT, "of the mesh has the coordinate nan, which is",
          abbe_topology_make(&m, &t, &error));
  m.position[2][1] = 1e300;
  REFUSED(ABBE_INVALID_ARGUMENT, "which is not a length in metres that can be",
          abbe_topology_make(&m, &t, &error));
}

static size_t count_touching(const abbe_topology *t) {
  size_t count = 0;
  for (size_t e = 0; e < t->edge_count; e++) count += t->edge[e].touches;
  return count;
}

/* Two boxes along an edge, in any orientation: the edge's four faces pair up around the bodies. */
TEST(bodies_that_touch_along_an_edge_are_two) {
  const double turn[3] = {0.3, -0.8, 0.5};
  for (int i = 0; i < 8; i++) {
    const test_box box[2] = {{{0, 0, 0}, {1, 1, 1}, false},
                             {{1, i & 1 ? -1 : 1, 0}, {2, i & 1 ? 0 : 2, 1}, false}};
    double matrix[16];
    OWNED(abbe_mesh, m) = test_boxes(box, 2);
    abbe_transform_rotate(0.8 * i, turn, matrix);
    OK(abbe_mesh_transform(&m, matrix, &error));
    MADE(abbe_topology, t, abbe_topology_make(&m, &t, &error));
    assert_int_equal(count_touching(&t), 1);
    assert_int_equal(t.shell_count, 2);
    for (size_t f = 0; f < 24; f++) assert_int_equal(t.shell[f], f / 12);
  }
}

/* Back to back, by a whole side; and one corner on another. */
TEST(what_touches_otherwise_is_two_as_well) {
  const test_box side[2] = {{{0, 0, 0}, {1, 1, 1}, false}, {{1, 0, 0}, {2, 1, 1}, false}};
  OWNED(abbe_mesh, m) = test_boxes(side, 2);
  MADE(abbe_topology, t, abbe_topology_make(&m, &t, &error));
  assert_int_equal(t.shell_count, 2);
  assert_int_equal(count_touching(&t), 4 + 1); /* and the diagonal, which both cut alike */
  abbe_topology_free(&t);
  abbe_mesh_free(&m);
  const test_box corner[2] = {{{0, 0, 0}, {1, 1, 1}, false}, {{1, 1, 1}, {2, 2, 2}, false}};
  m = test_boxes(corner, 2);
  OK(abbe_topology_make(&m, &t, &error));
  assert_int_equal(t.point_count, 15);
  assert_int_equal(t.shell_count, 2);
}

/* A fin on an edge; and one of two boxes inside out: nothing pairs up. */
TEST(what_does_not_pair_up_hangs_together) {
  const test_box box[2] = {{{0, 0, 0}, {1, 1, 1}, false}, {{1, 1, 0}, {2, 2, 1}, true}};
  OWNED(abbe_mesh, m) = test_boxes(box, 2);
  m.face[12][0] = 6, m.face[12][1] = 7; /* from the edge x = y = 1 to a corner */
  m.face_count = 13;
  MADE(abbe_topology, t, abbe_topology_make(&m, &t, &error));
  assert_int_equal(count_touching(&t), 0);
  assert_int_equal(t.shell_count, 1);
}
