/* Joint cells: nothing lost without a tolerance, no more than it with one, and all flux kept. */
#include "tests/scenes/volume/volumes.h"

#include "scenes/volume/volume_tree.h"

static const abbe_region_desc regions[] = {
    {.kind = ABBE_REGION_GRID, .side = 16, .outer = 3},
    {.kind = ABBE_REGION_GEODESIC, .levels = 3, .shells = 6, .inner = 0.5, .outer = 3},
    {.kind = ABBE_REGION_OCTAHEDRAL, .side = 16, .shells = 6, .inner = 0.5, .outer = 3}};

TEST(trees) {
  static const double tolerances[] = {0, 0.5, 4, 1000};
  for (int i = 0; i < 3; i++) {
    FILLED(abbe_caustic_volume, v, make_volume(ABBE_VOLUME_VECTOR, regions[i], 1, false, &v));
    const size_t cells = v.region.cells;
    /* a part that is dark all over, as most of a caustic's region is */
    for (size_t c = 0; c < cells; c++) {
      double p[3];
      abbe_volume_region_middle(&v.region, c, p);
      if (p[2] > 0) memset(v.value + 9 * c, 0, 18);
    }
    FREED uint16_t *back = calloc(cells * 9, sizeof *back);
    MADE(abbe_volume_order, order, abbe_volume_order_make(&v.region, &order, &error));
    size_t before = cells + 1;
    for (size_t t = 0; t < 4; t++) {
      MADE(abbe_volume_tree, tree,
           abbe_volume_tree_make(&order, 9, v.value, tolerances[t], &tree, &error));
      abbe_volume_tree_expand(&tree, &order, 9, back);
      assert_true(tree.leaves <= before && tree.leaves < cells);
      before = tree.leaves;
      if (t == 0) assert_memory_equal(back, v.value, cells * 18);
      double flux = 0, kept = 0, size = 0;
      for (size_t k = 0; k < cells * 9; k++) {
        const double a = abbe_half_value(v.value[k]), b = abbe_half_value(back[k]);
        assert_true(fabs(a - b) <= tolerances[t]);
        if (k % 9 != 2) continue;
        const double volume = abbe_volume_region_volume(&v.region, k / 9);
        flux += a * volume;
        kept += b * volume;
        size += fabs(a) * volume;
      }
      assert_near(kept / size, flux / size, 0x1p-11);
      for (size_t k = 0; k < cells; k += 97)
        assert_memory_equal(tree.value + 9 * abbe_volume_tree_find(&tree, &order, k), back + 9 * k,
                            18);
      assert_int_equal(abbe_volume_tree_bytes(&tree, 9), tree.leaves * 22);
    }
    /* all that may be joined is: the grid, or twenty faces of a shell, or a shell */
    assert_int_equal(before, i == 0 ? 1 : i == 1 ? 20 * 6 : 6);
  }
}

TEST(sides_are_powers_of_two) {
  abbe_volume_order order;
  const abbe_region_desc odd = {.kind = ABBE_REGION_GRID, .side = 12, .outer = 1};
  MADE(abbe_volume_region, r, abbe_volume_region_make(&odd, &r, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "power of two", abbe_volume_order_make(&r, &order, &error));
}
