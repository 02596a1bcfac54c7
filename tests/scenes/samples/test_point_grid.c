/* Points in cells: whoever is within a cell's edge is found, once, and wrong cells are refused. */
#include "tests/check.h"
#include "tests/random.h"

#include "scenes/samples/point_grid.h"

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
