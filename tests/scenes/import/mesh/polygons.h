/* polygons.h: concave polygons of known area, for tests: in the plane, counter-clockwise. */
#ifndef ABBE_TESTS_SCENES_IMPORT_MESH_POLYGONS_H
#define ABBE_TESTS_SCENES_IMPORT_MESH_POLYGONS_H

#include "tests/check.h"
#include "tests/random.h"

enum { TEST_POLYGON_MOST = 512, TEST_GRID = 8 };

typedef struct test_polygon {
  double at[TEST_POLYGON_MOST][2];
  size_t count;
  double area;
} test_polygon;

static inline void test_polygon_add(test_polygon *p, double x, double y) {
  assert_true(p->count < TEST_POLYGON_MOST);
  p->at[p->count][0] = x;
  p->at[p->count++][1] = y;
}

static inline bool test_cell(bool cell[TEST_GRID][TEST_GRID], int x, int y) {
  return x >= 0 && y >= 0 && x < TEST_GRID && y < TEST_GRID && cell[x][y];
}

static const int test_step[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};

/* Whether the edge from a point onwards has a cell on its left, and none on its right. */
static inline bool test_is_border(bool cell[TEST_GRID][TEST_GRID], int x, int y, int way) {
  static const int left[4][2] = {{0, 0}, {-1, 0}, {-1, -1}, {0, -1}};
  const int *l = left[way], *r = left[(way + 3) % 4];
  return test_cell(cell, x + l[0], y + l[1]) && !test_cell(cell, x + r[0], y + r[1]);
}

/* Follows the outline of the cells from the origin on; false where it is more than one loop, or
 * passes a point twice. */
static inline bool test_outline(bool cell[TEST_GRID][TEST_GRID], bool every_point,
                                test_polygon *out) {
  bool passed[TEST_GRID + 1][TEST_GRID + 1] = {{false}};
  size_t edges = 0, around = 0;
  int x = 0, y = 0, before = 3;
  for (int i = 0; i <= TEST_GRID; i++)
    for (int k = 0; k <= TEST_GRID; k++)
      for (int d = 0; d < 4; d++) edges += test_is_border(cell, i, k, d);
  while (!passed[x][y]) {
    int way = 0;
    passed[x][y] = true;
    while (way < 3 && !test_is_border(cell, x, y, way)) way++;
    if (every_point || way != before) test_polygon_add(out, x, y);
    x += test_step[way][0];
    y += test_step[way][1];
    before = way;
    around++;
  }
  return x == 0 && y == 0 && around == edges;
}

/* One of cells that grew together at random, with corners at every cell's or at turns alone. Its
 * area is that of its cells. */
static inline void test_rectilinear(uint64_t *state, bool every_point, test_polygon *out) {
  do {
    bool cell[TEST_GRID][TEST_GRID] = {{true}};
    *out = (test_polygon){.area = 1};
    for (int i = 0; i < 300; i++) {
      const int x = (int)(random_bits(state) % TEST_GRID),
                y = (int)(random_bits(state) % TEST_GRID);
      int beside = 0;
      for (int d = 0; d < 4; d++)
        beside += test_cell(cell, x + test_step[d][0], y + test_step[d][1]);
      if (cell[x][y] || beside == 0) continue;
      cell[x][y] = true;
      test_polygon trial = {0};
      if (test_outline(cell, every_point, &trial))
        out->area++;
      else
        cell[x][y] = false;
      if (out->area >= 28) break;
    }
    assert_true(test_outline(cell, every_point, out));
  } while (out->area < 12);
}

/* A square of 10 with count holes of 1, each at the end of a bridge of its own. */
static inline void test_holes(int count, test_polygon *out) {
  *out = (test_polygon){.area = 100 - count};
  test_polygon_add(out, 0, 0);
  for (int i = 0; i < count; i++) {
    const double x = 1 + 2 * i;
    test_polygon_add(out, x, 0);
    test_polygon_add(out, x, 4);
    test_polygon_add(out, x, 5);
    test_polygon_add(out, x + 1, 5);
    test_polygon_add(out, x + 1, 4);
    test_polygon_add(out, x, 4);
    test_polygon_add(out, x, 0);
  }
  test_polygon_add(out, 10, 0);
  test_polygon_add(out, 10, 10);
  test_polygon_add(out, 0, 10);
}

/* Teeth of a width and gaps of the same, with count points in line on the back. */
static inline void test_comb(int teeth, test_polygon *out) {
  *out = (test_polygon){.area = 2 * teeth - 1 + 3 * teeth};
  for (int i = 0; i < 2 * teeth; i++) test_polygon_add(out, i, 0);
  for (int i = teeth - 1; i >= 0; i--) {
    test_polygon_add(out, 2 * i + 1, 4);
    test_polygon_add(out, 2 * i, 4);
    if (i > 0) {
      test_polygon_add(out, 2 * i, 1);
      test_polygon_add(out, 2 * i - 1, 1);
    }
  }
}

/* A corridor of width 1 that winds inwards with a gap of 1: of its length. */
static inline void test_spiral(int turns, test_polygon *out) {
  double side[2][TEST_POLYGON_MOST][2], at[2] = {0, 0};
  *out = (test_polygon){0};
  int count = 0, length = 2 * turns + 1;
  for (int i = 0; i <= turns; i++) {
    const int *in = i > 0 ? test_step[(i - 1) % 4] : test_step[0];
    const int *on = i < turns ? test_step[i % 4] : in;
    const double shift = in == on ? 0.5 : 1,
                 n[2] = {-shift * (in[1] + on[1]) / 2, shift * (in[0] + on[0]) / 2};
    for (int k = 0; k < 2; k++) {
      side[0][count][k] = at[k] - n[k];
      side[1][count][k] = at[k] + n[k];
      if (i < turns) at[k] += length * on[k];
    }
    count++;
    if (i < turns) out->area += length;
    if (i % 2 == 0) length -= 2;
  }
  for (int i = 0; i < count; i++) test_polygon_add(out, side[0][i][0], side[0][i][1]);
  for (int i = count; i-- > 0;) test_polygon_add(out, side[1][i][0], side[1][i][1]);
}

/* Points on two circles in turn, and on each side so many more. */
static inline void test_star(int points, int more, double inner, test_polygon *out) {
  *out = (test_polygon){.area = points * inner * sin(3.14159265358979323846 / points)};
  for (int i = 0; i < 2 * points; i++)
    for (int k = 0; k <= more; k++) {
      const double a = 3.14159265358979323846 * i / points,
                   b = 3.14159265358979323846 * (i + 1) / points, t = k / (more + 1.0);
      const double r = i % 2 ? inner : 1, s = i % 2 ? 1 : inner;
      test_polygon_add(out, (1 - t) * r * cos(a) + t * s * cos(b),
                       (1 - t) * r * sin(a) + t * s * sin(b));
    }
}

#endif
