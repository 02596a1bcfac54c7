/* Modes of the light's direction: orthogonal, of given values those that made them, and what a cut
 * leaves is what stands behind it. */
#include "tests/check.h"
#include "tests/random.h"

#include "scenes/volume/caustic_volume.h"
#include "scenes/volume/half.h"

enum { NODES = 12, EACH = 300 };

/* What the first `rank` terms leave of the values: sum of squares. */
static double left_by(size_t rank, const uint16_t *value, const double *mode) {
  double left = 0;
  for (size_t i = 0; i < EACH; i++) {
    double term[NODES];
    for (size_t k = 0; k < rank; k++) {
      term[k] = 0;
      for (size_t j = 0; j < NODES; j++)
        term[k] += mode[k * NODES + j] * abbe_half_value(value[j * EACH + i]) / NODES;
    }
    for (size_t j = 0; j < NODES; j++) {
      double rest = abbe_half_value(value[j * EACH + i]);
      for (size_t k = 0; k < rank; k++) rest -= mode[k * NODES + j] * term[k];
      left += rest * rest;
    }
  }
  return left;
}

static void assert_orthogonal(const double *mode) {
  for (size_t a = 0; a < NODES; a++)
    for (size_t b = 0; b < NODES; b++) {
      double sum = 0;
      for (size_t j = 0; j < NODES; j++) sum += mode[a * NODES + j] * mode[b * NODES + j] / NODES;
      assert_near(sum, a == b, 1e-12);
    }
}

TEST(what_a_cut_leaves) {
  uint16_t value[NODES * EACH];
  double singular[NODES], mode[NODES * NODES], all = 0;
  uint64_t seed = 11;
  for (size_t i = 0; i < NODES * EACH; i++) { /* of sizes that differ from node to node */
    const double x = random_between(&seed, -1, 1) * (double)(1 + i / EACH);
    value[i] = abbe_half_of(x);
    all += abbe_half_value(value[i]) * abbe_half_value(value[i]);
  }
  OK(abbe_light_modes_find(NODES, EACH, value, singular, mode, &error));
  assert_orthogonal(mode);
  for (size_t rank = 0; rank <= NODES; rank++) {
    double behind = 0;
    for (size_t k = rank; k < NODES; k++) behind += singular[k] * singular[k];
    assert_near(left_by(rank, value, mode) / all, behind / all, 1e-12);
    if (rank > 0 && rank < NODES) assert_true(singular[rank] <= singular[rank - 1]);
  }
  /* the brighter half of the nodes, kept whole, leaves more */
  double others = 0;
  for (size_t i = 0; i < NODES / 2 * EACH; i++) others += pow(abbe_half_value(value[i]), 2);
  assert_true(left_by(NODES / 2, value, mode) < others);
}

/* Values that are a sum of two products are given back by two modes. */
TEST(two_modes) {
  uint16_t value[NODES * EACH];
  double singular[NODES], mode[NODES * NODES];
  for (size_t j = 0; j < NODES; j++)
    for (size_t i = 0; i < EACH; i++) /* whole numbers that halves hold */
      value[j * EACH + i] =
          abbe_half_of((double)(j % 3) * (double)(i % 5) + (double)j * (double)(i % 7));
  OK(abbe_light_modes_find(NODES, EACH, value, singular, mode, &error));
  assert_true(singular[1] > 1);
  /* squares of the rest are rounding's, of the first one's */
  for (size_t k = 2; k < NODES; k++) assert_near(singular[k] / singular[0], 0, 1e-7);
  assert_near(left_by(2, value, mode), 0, 1e-12 * singular[0] * singular[0]);
}

/* Nothing but dark, one node, and none. */
TEST(awkward) {
  uint16_t dark[NODES * EACH] = {0}, one[3];
  double singular[NODES], mode[NODES * NODES];
  OK(abbe_light_modes_find(NODES, EACH, dark, singular, mode, &error));
  assert_orthogonal(mode);
  for (size_t k = 0; k < NODES; k++) assert_near(singular[k], 0, 0);
  for (int i = 0; i < 3; i++) one[i] = abbe_half_of(i - 1);
  OK(abbe_light_modes_find(1, 3, one, singular, mode, &error));
  assert_near(singular[0], sqrt(2), 1e-15);
  assert_near(fabs(mode[0]), 1, 0);
  REFUSED(ABBE_INVALID_ARGUMENT, "no nodes",
          abbe_light_modes_find(0, 3, one, singular, mode, &error));
}
