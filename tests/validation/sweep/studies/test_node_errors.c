/* Lights at nodes and between them: where they stand, and that what looks nothing up is off by
 * nothing there. */
#include "tests/gl/frame.h"

#include "base/maths.h"
#include "validation/sweep/studies/node_errors.h"

enum { PLACES = ABBE_NODE_ERRORS_PLACES };

GROUP(make_context, free_context);

TEST(places) {
  abbe_light_nodes nodes;
  const double to_light[3] = {0.36, 0.48, 0.8};
  double node[2 * PLACES][3], (*middle)[3] = node + PLACES;
  OK(abbe_light_nodes_make(42, to_light, &nodes, &error));
  assert_true(abbe_node_errors_places(&nodes, to_light, node));
  abbe_node_blend nearest, three;
  abbe_light_nodes_nearest(&nodes, to_light, &nearest);
  assert_memory_equal(node[0], nodes.direction[nearest.node[0]], sizeof node[0]);
  for (int k = 0; k < PLACES; k++) {
    size_t nearer = 0, same = 0;
    const double own = abbe_vector_dot(node[k], to_light);
    for (size_t i = 0; i < nodes.count; i++) {
      nearer += abbe_vector_dot(nodes.direction[i], to_light) > own;
      same += memcmp(nodes.direction[i], node[k], sizeof node[k]) == 0;
    }
    assert_int_equal(nearer, k);
    assert_int_equal(same, 1);
    /* the three nodes around a middle weigh alike, nearly */
    assert_near(abbe_vector_length(middle[k]), 1, 1e-12);
    abbe_light_nodes_blend(&nodes, middle[k], &three);
    assert_int_equal(three.count, 3);
    for (size_t i = 0; i < 3; i++) assert_near(three.weight[i], 1.0 / 3, 0.02);
    assert_true(k == 0 ||
                abbe_vector_dot(middle[k], to_light) <= abbe_vector_dot(middle[k - 1], to_light));
  }
  abbe_light_nodes_free(&nodes);
  OK(abbe_light_nodes_make(1, to_light, &nodes, &error));
  assert_false(abbe_node_errors_places(&nodes, to_light, node));
  abbe_light_nodes_free(&nodes);
}

TEST(lights_move) {
  const double middle[3] = {1, 2, 3}, to[3] = {0.6, 0, 0.8};
  abbe_light light = {.kind = ABBE_LIGHT_DIRECTIONAL, .direction = {0, 0, -1}}, moved;
  assert_true(abbe_node_errors_move(&light, middle, to, &moved));
  for (int k = 0; k < 3; k++) assert_near(moved.direction[k], -to[k], 0);
  light = (abbe_light){.kind = ABBE_LIGHT_POINT, .position = {1, 2, 8}};
  assert_true(abbe_node_errors_move(&light, middle, to, &moved));
  assert_near(moved.position[0], 4, 1e-15);
  assert_near(moved.position[1], 2, 1e-15);
  assert_near(moved.position[2], 7, 1e-15);
  light.kind = ABBE_LIGHT_SPOT;
  assert_false(abbe_node_errors_move(&light, middle, to, &moved));
}

/* Photons are what they are compared with: fewer are off by little, and drawn again as before. */
TEST(photons_know_no_nodes) {
  OWNED(abbe_scene, scene) = {0};
  OWNED(abbe_image, before);
  OWNED(abbe_image, after);
  abbe_light_nodes nodes;
  const double up[3] = {0, 0, 1};
  abbe_node_errors known = {0};
  load_text(CAMERA SUN FLOOR
            "- {name: orb, shape: sphere, radius: 0.1, levels: 3, material: crown, transform: "
            "[{translate: [0, 0, 0.15]}]}\n",
            &scene);
  OK(abbe_light_nodes_make(162, up, &nodes, &error));
  const abbe_image size = {.width = 24, .height = 24};
  const abbe_sweep sweep = {.context = context, .scene = &scene, .picture = &size};
  const abbe_render_desc desc = {.width = 24, .height = 24, .photons = 48, .aovs = true};
  abbe_renderer *renderer = make_renderer(&scene, &desc);
  double at_node, between;
  draw_frame(renderer);
  read_picture(renderer, false, &before);
  OK(abbe_node_errors_measure(&known, &sweep, &nodes, &desc, renderer, &at_node, &between, &error));
  print_message("%g at nodes, %g between\n", at_node, between);
  assert_int_equal(known.count, 1);
  assert_true(at_node > 1e-3 && between > 1e-3 && at_node < 0.05 && between < 0.05);
  draw_frame(renderer);
  read_picture(renderer, false, &after);
  for (size_t i = 0; i < after.width * after.height * after.channels; i++)
    assert_near((double)before.data[i], (double)after.data[i], 0);
  abbe_renderer_free(renderer);
  abbe_node_errors_free(&known);
  abbe_light_nodes_free(&nodes);
}
