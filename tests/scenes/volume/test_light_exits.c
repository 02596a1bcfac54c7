/* Rays between nodes, of made-up exits: of one sequence of facets they follow a smooth law to the
 * third order, others go alone, each by its share; none leaves a convex body beside it. */
#include "tests/check.h"

#include "base/maths.h"
#include "scenes/volume/half.h"
#include "scenes/volume/light_exits.h"
#include "scenes/volume/sphere_mesh.h"
#include "tests/random.h"

static const double radius = 0.5;

/* A law that is smooth and not linear in the light's direction. */
static void law(const double to_light[3], double place[3], double way[3]) {
  const double *l = to_light;
  const double w[3] = {0.3 - l[0] + 0.4 * l[1] * l[2], 0.4 * l[0] * l[0] - l[1],
                       -l[2] - 0.5 * l[0]};
  for (int k = 0; k < 3; k++) {
    way[k] = w[k];
    place[k] = radius * (0.4 * l[k] + 0.3 * l[(k + 1) % 3] * l[(k + 2) % 3]);
  }
  abbe_vector_normalise(way);
}

static void pack(const double v[3], double scale, uint16_t *half) {
  for (int k = 0; k < 3; k++) half[k] = abbe_half_of(v[k] * scale);
}

static void put_exit(const double node[3], unsigned facets, uint16_t *half) {
  const double step = 1e-4;
  double axis[2][3], place[3], way[3];
  abbe_light_exits_axes(node, axis[0], axis[1]);
  assert_near(abbe_vector_dot(axis[0], axis[1]), 0, 1e-12);
  law(node, place, way);
  pack(place, 1 / radius, half + ABBE_EXIT_PLACE);
  pack(way, 1, half + ABBE_EXIT_WAY);
  for (int a = 0; a < 2; a++) {
    double beside[3], p[3], w[3];
    for (int k = 0; k < 3; k++) beside[k] = node[k] + step * axis[a][k];
    abbe_vector_normalise(beside);
    law(beside, p, w);
    abbe_vector_subtract(p, place, p);
    abbe_vector_subtract(w, way, w);
    pack(p, 1 / radius / step, half + ABBE_EXIT_PLACE_BY + 3 * a);
    pack(w, 1 / step, half + ABBE_EXIT_WAY_BY + 3 * a);
  }
  half[ABBE_EXIT_CARRIED] = abbe_half_of(0.75);
  half[ABBE_EXIT_FACETS] = abbe_half_of(facets);
}

/* One point that faces upwards; every exit by the law. apart: each node has facets of its own. */
static void make_exits(size_t count, bool apart, abbe_light_nodes *nodes, abbe_light_exits *out) {
  abbe_exit_halves point = {0};
  point[ABBE_EXIT_NORMAL + 2] = abbe_half_of(1);
  point[ABBE_EXIT_BIN] = abbe_half_of(77);
  OK(abbe_light_nodes_make(count, (const double[3]){0, 0, 1}, nodes, &error));
  OK(abbe_light_exits_make(nodes, 1, (const abbe_exit_halves *)&point, NULL, radius, 2, 8, out,
                           &error));
  assert_true(out->count > count / 3 && out->count <= count / 2 + 1);
  for (size_t i = 0; i < count; i++)
    if (out->at[i] != 0)
      put_exit(nodes->direction[i], apart ? 1 + (unsigned)i : 5, out->exit[out->at[i] - 1]);
}

static void free_exits(abbe_light_nodes *nodes, abbe_light_exits *exits) {
  abbe_light_nodes_free(nodes);
  abbe_light_exits_free(exits);
}

static void random_light(uint64_t *seed, double least, double to_light[3]) {
  do {
    for (int k = 0; k < 3; k++) to_light[k] = random_between(seed, -1, 1);
  } while (abbe_vector_length(to_light) > 1 || !abbe_vector_normalise(to_light) ||
           to_light[2] < least);
}

/* The largest error over lights from above, of places in radii and of directions. */
static double largest_error(size_t count, bool apart) {
  abbe_light_nodes nodes;
  abbe_light_exits exits;
  uint64_t seed = 3;
  double most = 0;
  make_exits(count, apart, &nodes, &exits);
  for (int i = 0; i < 300; i++) {
    double to_light[3], place[3], way[3], sum = 0;
    abbe_exit_aim aim;
    abbe_exit_ray ray[3];
    random_light(&seed, 0.6, to_light);
    abbe_light_exits_aim(&nodes, to_light, &aim);
    const size_t rays = abbe_light_exits_at(&exits, &aim, 0, NULL, 0, ray);
    assert_int_equal(rays, apart ? 3 : 1);
    law(to_light, place, way);
    for (size_t k = 0; k < rays; k++) {
      double off[3], turn[3];
      abbe_vector_subtract(ray[k].place, place, off);
      abbe_vector_subtract(ray[k].way, way, turn);
      most = fmax(most, fmax(abbe_vector_length(off) / radius, abbe_vector_length(turn)));
      sum += ray[k].share;
    }
    assert_near(sum, 0.75, 1e-6);
  }
  free_exits(&nodes, &exits);
  return most;
}

/* Half the distance between nodes: an eighth of the error where facets are the same, down to
 * halves' steps; a quarter where each ray goes alone. */
TEST(rays_follow_a_smooth_law) {
  const double joint[] = {largest_error(162, false), largest_error(642, false)};
  const double alone[] = {largest_error(162, true), largest_error(642, true)};
  print_message("162 and 642 nodes: joined %.2e, %.2e; alone %.2e, %.2e\n", joint[0], joint[1],
                alone[0], alone[1]);
  assert_true(joint[1] < joint[0] / 4);
  assert_true(alone[1] < alone[0] / 3);
  assert_true(joint[1] < alone[1] / 3);
}

/* Light of a node: what is stored, to its halves. */
TEST(a_node_is_what_is_stored) {
  abbe_light_nodes nodes;
  abbe_light_exits exits;
  make_exits(42, false, &nodes, &exits);
  for (size_t i = 0; i < nodes.count; i++) {
    abbe_exit_aim aim;
    abbe_exit_ray ray[3];
    double place[3], way[3];
    abbe_light_exits_aim(&nodes, nodes.direction[i], &aim);
    const size_t rays = abbe_light_exits_at(&exits, &aim, 0, NULL, 0, ray);
    assert_int_equal(rays, exits.at[i] != 0);
    if (rays == 0) continue;
    law(nodes.direction[i], place, way);
    for (int k = 0; k < 3; k++) {
      assert_near(ray[0].place[k], place[k], 1e-3 * radius);
      assert_near(ray[0].way[k], way[k], 1e-3);
    }
    assert_int_equal(ray[0].facets, 5);
  }
  free_exits(&nodes, &exits);
}

/* Rays of other facets, one of which would leave the body beside it: the others have its light. */
TEST(rays_leave_a_body_on_its_surface) {
  abbe_light_nodes nodes;
  abbe_light_exits exits;
  uint64_t seed = 11;
  size_t cut = 0;
  make_exits(42, true, &nodes, &exits);
  for (int i = 0; i < 100; i++) {
    double to_light[3], sum = 0, n[3] = {1, 0, 0};
    abbe_exit_aim aim;
    abbe_exit_ray all[3], ray[3];
    random_light(&seed, 0.6, to_light);
    abbe_light_exits_aim(&nodes, to_light, &aim);
    assert_int_equal(abbe_light_exits_at(&exits, &aim, 0, NULL, 0, all), 3);
    /* a plane between the first and the others, where there is one */
    const double least = fmin(all[1].place[0], all[2].place[0]);
    const double plane[1][4] = {{n[0], n[1], n[2], 0.5 * (least + all[0].place[0])}};
    const size_t rays = abbe_light_exits_at(&exits, &aim, 0, (const double(*)[4])plane, 1, ray);
    for (size_t k = 0; k < rays; k++) sum += ray[k].share;
    assert_near(sum, 0.75, 1e-6);
    for (size_t k = 0; k < rays && rays < 3; k++)
      assert_true(ray[k].place[0] <= plane[0][3] + 0.01 * radius);
    cut += rays < 3;
  }
  assert_true(cut > 10);
  free_exits(&nodes, &exits);
}

TEST(chances_and_points) {
  double chance[ABBE_LIGHT_EXITS_BINS], sum = 0, place[3], normal[3];
  size_t bin;
  abbe_light_nodes nodes;
  abbe_light_exits exits;
  abbe_light_exits_chances(380, 780, chance);
  for (size_t i = 0; i < ABBE_LIGHT_EXITS_BINS; i++) {
    assert_true(chance[i] > 0.1 / ABBE_LIGHT_EXITS_BINS);
    sum += chance[i];
  }
  assert_near(sum, 1, 1e-12);
  make_exits(42, false, &nodes, &exits);
  abbe_light_exits_point(&exits, 0, place, normal, &bin);
  assert_int_equal(bin, 77);
  assert_near(normal[2], 1, 1e-12);
  assert_int_equal(abbe_light_exits_bytes(&exits), (1 + exits.count) * 2 * ABBE_EXIT_HALVES + 16);
  free_exits(&nodes, &exits);
}

TEST(requests) {
  abbe_light_exits exits;
  abbe_exit_halves point = {0};
  const abbe_exit_halves *p = (const abbe_exit_halves *)&point;
  const double up[3] = {0, 0, 1};
  MADE(abbe_light_nodes, one, abbe_light_nodes_make(1, up, &one, &error));
  MADE(abbe_light_nodes, nodes, abbe_light_nodes_make(12, up, &nodes, &error));
  assert_int_equal(abbe_light_exits_make(&one, 1, p, NULL, 1, 1, 1, &exits, NULL),
                   ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_light_exits_make(&nodes, 0, p, NULL, 1, 1, 1, &exits, NULL),
                   ABBE_INVALID_ARGUMENT);
  assert_int_equal(abbe_light_exits_make(&nodes, 1, p, NULL, 0, 1, 1, &exits, NULL),
                   ABBE_INVALID_ARGUMENT);
  assert_int_equal(
      abbe_light_exits_make(&nodes, ABBE_LIGHT_EXITS_MOST + 1, p, NULL, 1, 1, 1, &exits, NULL),
      ABBE_INVALID_ARGUMENT);
}

/* Light nodes: which stand for a direction, by which weights, and the turns to them. */

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
