/* Fronts: known ones by hand, the definition itself over random points, and what is picked. */
#include "tests/check.h"

#include "library/choice/picture_choice.h"
#include "tests/random.h"

TEST(a_front_by_hand) {
  static const double cost[] = {1, 2, 3, 3, 4, 2, 5, NAN, 0, 6},
                      error[] = {9, 4, 4, 2, 3, 4, NAN, 0, 0, 2};
  size_t order[10];
  assert_int_equal(abbe_pareto_front_order(cost, error, 10, order), 3);
  assert_int_equal(order[0], 0);
  assert_int_equal(order[1], 1);
  assert_int_equal(order[2], 3);
  assert_int_equal(abbe_pareto_front_order(cost, error, 0, order), 0);
}

/* Every point off the front is beaten by one on it; none on it is; the order falls. */
TEST(the_front_is_what_it_says) {
  enum { COUNT = 200 };
  double cost[COUNT], error[COUNT];
  bool on[COUNT] = {false};
  size_t order[COUNT];
  uint64_t random = 7;
  for (int i = 0; i < COUNT; i++) {
    cost[i] = 1 + floor(random_between(&random, 0, 20));
    error[i] = floor(random_between(&random, 0, 20));
  }
  const size_t count = abbe_pareto_front_order(cost, error, COUNT, order);
  for (size_t k = 0; k < count; k++) {
    on[order[k]] = true;
    if (k == 0) continue;
    assert_true(cost[order[k]] > cost[order[k - 1]]);
    assert_true(error[order[k]] < error[order[k - 1]]);
  }
  for (int i = 0; i < COUNT; i++) {
    bool beaten = false;
    for (size_t k = 0; k < count; k++) {
      size_t j = order[k];
      beaten = beaten || (j != (size_t)i && cost[j] <= cost[i] && error[j] <= error[i]);
    }
    assert_int_equal(beaten, !on[i]);
  }
}

TEST(the_knee_and_the_accurate_end) {
  /* In logarithms (0, 4), (1, 1), (2, 0.9), (4, 0): the line falls by 1 a step. */
  const double cost[] = {1, exp(1), exp(2), exp(4)};
  const double error[] = {exp(4), exp(1), exp(0.9), exp(0)};
  assert_int_equal(abbe_pareto_front_knee(cost, error, 4), 1);
  const double straight[] = {exp(4), exp(3), exp(2), exp(0)};
  assert_int_equal(abbe_pareto_front_knee(cost, straight, 4), 2);
  assert_int_equal(abbe_pareto_front_knee(cost, error, 1), 0);
  assert_int_equal(abbe_pareto_front_knee(cost, error, 2), 1);
  const double exact[] = {1, 0.5, 0.1, 0};
  assert_true(abbe_pareto_front_knee(cost, exact, 4) < 4);
  assert_int_equal(abbe_pareto_front_accurate(error, 4, 0), 3);
  assert_int_equal(abbe_pareto_front_accurate(error, 4, exp(0.9) - 1 + 1e-9), 2);
  assert_int_equal(abbe_pareto_front_accurate(error, 4, 1e9), 0);
}
