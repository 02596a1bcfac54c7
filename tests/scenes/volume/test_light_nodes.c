/* Light nodes: which stand for a direction, by which weights, and the turns to them. */
#include "tests/check.h"
#include "tests/random.h"

#include "base/maths.h"
#include "scenes/volume/sphere_mesh.h"

static const double up[3] = {0, 0, 2};

TEST(weights_sum_to_one_and_lie_along_the_light) {
  static const size_t counts[] = {12, 42, 162, 642};
  uint64_t seed = 3;
  for (size_t n = 0; n < 4; n++) {
    MADE(abbe_light_nodes, nodes, abbe_light_nodes_make(counts[n], up, &nodes, &error));
    assert_int_equal(nodes.count, counts[n]);
    for (int i = 0; i < 2000; i++) {
      double l[3], sum[3] = {0}, all = 0, best = -2;
      abbe_node_blend three, one;
      random_unit(&seed, l);
      abbe_light_nodes_blend(&nodes, l, &three);
      abbe_light_nodes_nearest(&nodes, l, &one);
      for (size_t k = 0; k < 3; k++) {
        assert_true(three.weight[k] >= 0);
        all += three.weight[k];
        for (int c = 0; c < 3; c++) sum[c] += three.weight[k] * nodes.direction[three.node[k]][c];
      }
      assert_near(all, 1, 1e-12);
      assert_near(abbe_vector_dot(sum, l), abbe_vector_length(sum), 1e-12);
      for (size_t k = 0; k < nodes.count; k++)
        best = fmax(best, abbe_vector_dot(nodes.direction[k], l));
      assert_int_equal(one.count, 1);
      assert_near(abbe_vector_dot(nodes.direction[one.node[0]], l), best, 1e-12);
    }
  }
}

TEST(at_a_node_it_is_alone) {
  MADE(abbe_light_nodes, nodes, abbe_light_nodes_make(162, up, &nodes, &error));
  for (size_t i = 0; i < nodes.count; i++) {
    abbe_node_blend b;
    double weight = 0;
    abbe_light_nodes_blend(&nodes, nodes.direction[i], &b);
    for (size_t k = 0; k < b.count; k++) weight += b.node[k] == i ? b.weight[k] : 0;
    assert_near(weight, 1, 1e-12);
  }
}

TEST(turns_bring_the_light_to_the_node) {
  uint64_t seed = 5;
  for (int i = 0; i < 1000; i++) {
    double from[3], to[3], turn[9], across[3], axis[3];
    random_unit(&seed, from);
    random_unit(&seed, to);
    for (int k = 0; k < 3 && i % 10 == 0; k++) to[k] = i % 20 == 0 ? from[k] : -from[k];
    abbe_light_nodes_turn(from, to, turn);
    abbe_vector_cross(from, to, axis);
    for (int r = 0; r < 3; r++) {
      assert_near(abbe_vector_dot(&turn[3 * r], from), to[r], 1e-9);
      for (int c = 0; c < 3; c++)
        assert_near(abbe_vector_dot(&turn[3 * r], &turn[3 * c]), r == c, 1e-9);
      assert_near(abbe_vector_dot(&turn[3 * r], axis), axis[r], 1e-9); /* it stays */
    }
    abbe_vector_cross(&turn[0], &turn[3], across);
    assert_near(abbe_vector_dot(across, &turn[6]), 1, 1e-9);
  }
}

TEST(one_node_and_other_counts) {
  abbe_light_nodes nodes;
  abbe_error error = {0};
  abbe_node_blend b;
  assert_int_equal(abbe_light_nodes_make(1, up, &nodes, &error), ABBE_OK);
  assert_near(nodes.direction[0][2], 1, 0);
  abbe_light_nodes_blend(&nodes, (const double[3]){1, 0, 0}, &b);
  assert_int_equal(b.count, 1);
  assert_near(b.weight[0], 1, 0);
  abbe_light_nodes_free(&nodes);
  assert_int_equal(abbe_light_nodes_make(163, up, &nodes, &error), ABBE_INVALID_ARGUMENT);
  assert_contains(error.text, "162");
  assert_int_equal(abbe_light_nodes_make(1, (const double[3]){0}, &nodes, &error),
                   ABBE_INVALID_ARGUMENT);
}
