#include "tests/check.h"

#include "scenes/geometry/disjoint_sets.h"

enum { COUNT = 1000 };

static void begin(uint32_t *parent) {
  for (uint32_t i = 0; i < COUNT; i++) parent[i] = i;
}

TEST(numbers_begin_alone_and_join) {
  uint32_t parent[COUNT];
  begin(parent);
  for (uint32_t i = 0; i < COUNT; i++) assert_int_equal(abbe_disjoint_sets_find(parent, i), i);
  abbe_disjoint_sets_unite(parent, 3, 5);
  assert_int_equal(abbe_disjoint_sets_find(parent, 3), 5);
  assert_int_equal(abbe_disjoint_sets_find(parent, 5), 5);
  assert_int_equal(abbe_disjoint_sets_find(parent, 4), 4);
  abbe_disjoint_sets_unite(parent, 5, 3);
  assert_int_equal(abbe_disjoint_sets_find(parent, 3), 5);
}

/* Those alike modulo 7, joined along a chain, by both ends and twice. */
TEST(sets_are_those_of_the_pairs) {
  uint32_t parent[COUNT];
  begin(parent);
  for (uint32_t i = 0; i + 7 < COUNT; i++) {
    abbe_disjoint_sets_unite(parent, i, i + 7);
    if (i % 3 == 0) abbe_disjoint_sets_unite(parent, i + 7, i % 7);
  }
  for (uint32_t i = 0; i < COUNT; i++)
    for (uint32_t k = i % 7; k < COUNT; k += 13)
      assert_int_equal(abbe_disjoint_sets_find(parent, i) == abbe_disjoint_sets_find(parent, k),
                       i % 7 == k % 7);
}
