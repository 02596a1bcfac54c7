/* A number of bytes: each of them counts, and where they are, and how many. */
#include "tests/check.h"

#include "scenes/geometry/digest.h"
#include "scenes/geometry/disjoint_sets.h"

typedef uint64_t (*digest)(uint64_t h, const void *data, size_t size);

TEST(each_byte_and_its_place_count) {
  static const digest kinds[] = {abbe_digest, abbe_digest_long};
  for (size_t kind = 0; kind < 2; kind++)
    for (size_t size = 0; size < 80; size++) {
      unsigned char bytes[80] = {0};
      const uint64_t zeros = kinds[kind](1, bytes, size);
      assert_true(zeros == kinds[kind](1, bytes, size));
      assert_true(size == 0 || zeros != kinds[kind](2, bytes, size));
      for (size_t i = 0; i < size; i++) {
        uint64_t other;
        bytes[i] = 1;
        other = kinds[kind](1, bytes, size);
        assert_true(other != zeros);
        bytes[i] = 0;
        if (i + 1 == size) continue;
        bytes[i + 1] = 1;
        assert_true(other != kinds[kind](1, bytes, size));
        bytes[i + 1] = 0;
      }
    }
}

TEST(arrays_differ_by_their_count) {
  static const double zeros[4] = {0};
  const uint64_t two = abbe_digest_array(1, zeros, 2, sizeof *zeros);
  assert_true(two != abbe_digest_array(1, zeros, 3, sizeof *zeros));
  assert_true(abbe_digest_array(1, zeros, 0, 8) != abbe_digest_array(1, NULL, 0, 8));
}

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
