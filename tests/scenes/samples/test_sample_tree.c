/* Trees of samples: what is in them, and what cuts through them make of the irradiance that a
 * mirror square of even light gives, against its closed form and the sum over all samples. */
#include "tests/check.h"

#include "base/maths.h"
#include "scenes/samples/surface_samples.h"
#include "scenes/shapes/shape.h"
#include "tests/random.h"

static void sample(const abbe_mesh *mesh, size_t count, abbe_surface_samples *out,
                   abbe_sample_tree *tree) {
  const abbe_surface_sampling sampling = {count, 3, true, true};
  OK(abbe_surface_samples_make(&mesh, 1, &sampling, out, &error));
  OK(abbe_sample_tree_make(out, tree, &error));
}

static void assert_holds(const abbe_sample_node *node, const abbe_sample_node *below) {
  double apart[3];
  abbe_vector_subtract(below->at.position, node->at.position, apart);
  assert_true(abbe_vector_length(apart) <= node->radius + 1e-12);
  assert_true(abbe_vector_dot(below->at.normal, node->at.normal) >= node->cone - 1e-12);
}

/* What is right below a node sums to its area, and all that is below lies in its ball and cone. */
static void check_node(const abbe_sample_tree *tree, size_t i) {
  const abbe_sample_node *node = &tree->node[i];
  double area = 0;
  size_t children = 0;
  for (size_t k = i + 1; k < node->next; k = tree->node[k].next, children++) {
    assert_true(tree->node[k].next > k && tree->node[k].next <= node->next);
    area += tree->node[k].area;
    if (!node->cluster) assert_true(!tree->node[k].cluster && tree->node[k].sample == node->sample);
  }
  for (size_t k = i + 1; k < node->next; k++) assert_holds(node, &tree->node[k]);
  assert_true(children == 0 || children == 2);
  if (children == 2) assert_near(area, node->area, 1e-12 * node->area);
}

TEST(all_are_in_it_once) {
  static const size_t counts[] = {1, 2, 90};
  MADE(abbe_mesh, ring, abbe_shape_ring(0.03, 0.008, 48, 24, &ring, &error));
  for (size_t k = 0; k < 3; k++) {
    OWNED(abbe_sample_tree, tree) = {0};
    FILLED(abbe_surface_samples, s, sample(&ring, counts[k], &s, &tree));
    FREED size_t *met = calloc(s.count, sizeof *met);
    double leaves = 0;
    assert_int_equal(tree.node[0].next, tree.count);
    for (size_t i = 0; i < tree.count; i++) {
      check_node(&tree, i);
      if (tree.node[i].next == i + 1) leaves += tree.node[i].area;
    }
    for (size_t i = 0; i < tree.count; i = tree.node[i].cluster ? i + 1 : tree.node[i].next) {
      const abbe_sample_node *node = &tree.node[i];
      if (node->cluster) continue;
      met[node->sample]++;
      assert_memory_equal(&node->at, &s.sample[node->sample], sizeof node->at);
      assert_near(node->area, s.share[node->sample], 1e-15);
    }
    for (size_t i = 0; i < s.count; i++) assert_int_equal(met[i], 1);
    assert_near(leaves, s.area, 1e-12);
  }
}

/* Clusters face one way: of a ball no node of less than a sixteenth holds two sides. */
TEST(clusters_face_alike) {
  OWNED(abbe_sample_tree, tree) = {0};
  MADE(abbe_mesh, ball, abbe_shape_sphere(0.02, 4, &ball, &error));
  FILLED(abbe_surface_samples, s, sample(&ball, 256, &s, &tree));
  for (size_t i = 0; i < tree.count; i++)
    if (tree.node[i].area < s.area / 15) assert_true(tree.node[i].cone > 0.3);
}

/* A square 2 a wide and parallel to the floor at a height, facing down. */
static void make_roof(double a, double height, abbe_mesh *out) {
  static const uint32_t face[2][3] = {{0, 2, 1}, {0, 3, 2}};
  OK(abbe_mesh_make(4, 2, false, out, &error));
  for (int i = 0; i < 4; i++) {
    const double place[3] = {i == 1 || i == 2 ? a : -a, i > 1 ? a : -a, height},
                 down[3] = {0, 0, -1};
    memcpy(out->position[i], place, sizeof place);
    memcpy(out->normal[i], down, sizeof down);
  }
  memcpy(out->face, face, sizeof face);
}

/* What a node gives a place x along the floor. */
static double sent_by(const abbe_sample_node *node, double x) {
  const double d[3] = {node->at.position[0] - x, node->at.position[1], node->at.position[2]};
  const double d2 = abbe_vector_dot(d, d), up = d[2] / sqrt(d2);
  return node->area * up * up / d2;
}

/* Nodes whose light is at most a share of a hemisphere's; share 0: the samples. bound: of the sum's
 * difference to all samples. */
static double cut(const abbe_sample_tree *tree, double x, double share, size_t *nodes,
                  double *bound) {
  double sum = 0;
  *bound = 0;
  *nodes = 0;
  for (size_t i = 0; i < tree->count;) {
    const abbe_sample_node *node = &tree->node[i];
    const double d[3] = {node->at.position[0] - x, node->at.position[1], node->at.position[2]};
    const double gap = fmax(abbe_vector_length(d) - node->radius, 0),
                 most = node->area / (gap * gap);
    if (node->cluster && !(most <= ABBE_PI * share)) {
      i++;
      continue;
    }
    sum += sent_by(node, x);
    if (node->cluster) *bound += most;
    ++*nodes;
    i = node->next;
  }
  return sum;
}

/* A quarter's corner straight above: 1/2 (X/sqrt(1+X2) atan(Y/sqrt(1+X2)) + ...) [Howell2021]; of a
 * place x along an axis the square is a difference or sum of rectangles with a corner there. */
static double from_corner(double a, double b, double h) {
  const double x = a / h, y = b / h, p = sqrt(1 + x * x), q = sqrt(1 + y * y);
  return 0.5 * (x / p * atan(y / p) + y / q * atan(x / q));
}

TEST(cuts) {
  static const double places[] = {0, 0.1, 0.3, 1, 3};
  const double a = 0.1, h = 0.15;
  OWNED(abbe_sample_tree, tree) = {0};
  FILLED(abbe_mesh, roof, make_roof(a, h, &roof));
  FILLED(abbe_surface_samples, s, sample(&roof, 256, &s, &tree));
  size_t before = SIZE_MAX;
  for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
    const double x = places[k];
    const double right = 2 * (from_corner(x + a, a, h) - from_corner(x - a, a, h));
    size_t all, few;
    double none, bound, sum = 0;
    for (size_t i = 0; i < tree.count; i = tree.node[i].cluster ? i + 1 : tree.node[i].next)
      if (!tree.node[i].cluster) sum += sent_by(&tree.node[i], x);
    const double whole = cut(&tree, x, 0, &all, &none);
    const double clustered = cut(&tree, x, 1.0 / 200, &few, &bound);
    print_message("at %.1f m: %.6f by %zu samples, %.6f by %zu nodes, %.6f; bound %.4f\n", x, whole,
                  all, clustered, few, right, bound);
    assert_true(whole == sum && none == 0);
    assert_int_equal(all, s.count);
    assert_true(fabs(clustered - whole) <= bound);
    assert_near(clustered, right, ABBE_PI / 200);
    assert_near(whole, right, 0.01 * right);
    assert_true(few <= before && few <= all);
    before = few;
  }
  assert_true(before <= 2);
}

TEST(nothing) {
  const abbe_surface_samples none = {0};
  MADE(abbe_sample_tree, tree, abbe_sample_tree_make(&none, &tree, &error));
  assert_int_equal(tree.count, 0);
  abbe_sample_tree_free(NULL);
}

/* Points in cells: whoever is within a cell's edge is found, once, and wrong cells are refused. */

enum { COUNT = 2000 };

static double at[COUNT][3];
static int times[COUNT];

static bool count(void *user, size_t number) {
  (void)user;
  times[number]++;
  return true;
}

static bool stop_now(void *user, size_t number) {
  (void)number;
  ++*(int *)user;
  return false;
}

TEST(all_near_ones_are_found) {
  uint64_t random = 1;
  const double cell = 0.07;
  MADE(abbe_point_grid, grid, abbe_point_grid_make(cell, COUNT, &grid, &error));
  for (int i = 0; i < COUNT; i++) {
    for (int k = 0; k < 3; k++) at[i][k] = random_between(&random, -0.5, 0.5);
    abbe_point_grid_add(&grid, at[i], (size_t)i);
  }
  for (int q = 0; q < 100; q++) {
    double p[3];
    for (int k = 0; k < 3; k++) p[k] = random_between(&random, -0.6, 0.6);
    memset(times, 0, sizeof times);
    abbe_point_grid_visit(&grid, p, count, NULL);
    for (int i = 0; i < COUNT; i++) {
      double far = 0, wide = 0;
      for (int k = 0; k < 3; k++) {
        far += pow(at[i][k] - p[k], 2);
        wide = fmax(wide, fabs(at[i][k] - p[k]));
      }
      assert_true(times[i] <= 1);
      if (sqrt(far) <= cell) assert_int_equal(times[i], 1);
      if (wide > 2 * cell) assert_int_equal(times[i], 0);
    }
  }
  int seen = 0;
  abbe_point_grid_visit(&grid, at[0], stop_now, &seen);
  assert_int_equal(seen, 1);
}

TEST(wrong_cells) {
  OWNED(abbe_point_grid, grid);
  const double wrong[] = {0, -1, NAN, INFINITY};
  for (size_t i = 0; i < 4; i++)
    REFUSED(ABBE_INVALID_ARGUMENT, "above 0 m", abbe_point_grid_make(wrong[i], 4, &grid, &error));
  abbe_point_grid_free(NULL);
}
