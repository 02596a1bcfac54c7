/* Polygons of known area, in many planes: every triangle runs around as the polygon does, which,
 * since their edges join up around it, is the same as that they lie inside and not over one
 * another. */
#include "tests/scenes/import/mesh/polygons.h"

#include "base/maths.h"
#include "scenes/import/mesh/mesh_reading.h"

static abbe_result cut(const double (*corner)[3], size_t count, uint32_t (*triangle)[3]) {
  double work = ABBE_POLYGON_WORK;
  return abbe_polygon_cut(corner, count, triangle, &work, &last_error);
}

/* Columns: where the plane's axes lie, and its normal. */
static void place(const test_polygon *p, const double frame[9], double shift, bool narrow,
                  double (*out)[3]) {
  for (size_t i = 0; i < p->count; i++)
    for (int k = 0; k < 3; k++) {
      const double at = frame[3 * k] * p->at[i][0] + frame[3 * k + 1] * p->at[i][1] + shift;
      out[i][k] = narrow ? (double)(float)at : at;
    }
}

/* Each edge of the polygon belongs to one triangle, and each other one to two that differ. */
static void assert_edges_join(const uint32_t (*t)[3], size_t count) {
  static signed char seen[TEST_POLYGON_MOST][TEST_POLYGON_MOST];
  memset(seen, 0, sizeof seen);
  for (size_t i = 0; i + 2 < count; i++)
    for (int k = 0; k < 3; k++) {
      const uint32_t a = t[i][k], b = t[i][(k + 1) % 3];
      assert_true(a < count && b < count && a != b);
      seen[a][b]++;
    }
  for (size_t a = 0; a < count; a++)
    for (size_t b = 0; b < count; b++) {
      const bool side = b == (a + 1) % count, back = a == (b + 1) % count;
      assert_true(side ? seen[a][b] == 1 : back ? seen[a][b] == 0 : seen[a][b] == seen[b][a]);
      assert_true(seen[a][b] <= 1);
    }
}

/* least: of a triangle's area, a share of the square of its longest side. */
static void check(const test_polygon *p, const double frame[9], double shift, bool narrow,
                  double least, const char *name) {
  double at[TEST_POLYGON_MOST][3], sum = 0;
  uint32_t t[TEST_POLYGON_MOST][3];
  const double normal[3] = {frame[2], frame[5], frame[8]};
  place(p, frame, shift, narrow, at);
  for (int reversed = 0; reversed < 2; reversed++) {
    if (reversed)
      for (size_t i = 0, k = p->count - 1; i < k; i++, k--)
        for (int c = 0; c < 3; c++) {
          const double kept = at[i][c];
          at[i][c] = at[k][c];
          at[k][c] = kept;
        }
    if (cut((const double(*)[3])at, p->count, t) != ABBE_OK)
      fail_msg("%s: %s", name, last_error.text);
    sum = 0;
    for (size_t i = 0; i + 2 < p->count; i++) {
      double n[3], longest = 0;
      abbe_vector_triangle(at[t[i][0]], at[t[i][1]], at[t[i][2]], n);
      for (int k = 0; k < 3; k++) {
        double side[3];
        abbe_vector_subtract(at[t[i][k]], at[t[i][(k + 1) % 3]], side);
        longest = fmax(longest, abbe_vector_dot(side, side));
      }
      const double area = abbe_vector_dot(n, normal) / 2 * (reversed ? -1 : 1);
      if (!(area > least * longest))
        fail_msg("%s: triangle %u %u %u has an area of %g (longest side squared %g)", name, t[i][0],
                 t[i][1], t[i][2], area, longest);
      sum += area;
    }
    assert_near(sum, p->area, (narrow ? 1e-5 : 1e-12) * p->area);
    assert_edges_join((const uint32_t(*)[3])t, p->count);
  }
}

static void check_everywhere(const test_polygon *p, const char *name) {
  static const double upright[3][9] = {
      {1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 1, 1, 0, 0, 0, 1, 0}, {0, 1, 0, 0, 0, 1, 1, 0, 0}};
  for (int i = 0; i < 3; i++) check(p, upright[i], 0, false, 0, name);
  uint64_t state = 7;
  for (int i = 0; i < 4; i++) {
    double a[3], b[3], frame[9], turned[9];
    for (int k = 0; k < 3; k++) {
      a[k] = random_normal(&state);
      b[k] = random_normal(&state);
    }
    abbe_vector_frame(a, b, 1, turned);
    memcpy(frame, turned, sizeof frame);
    /* rounded to floats, points in line are so no more: no triangle may be thinner than that */
    check(p, frame, 0.37 * i, true, 1e-3, name);
  }
}

TEST(known_shapes_are_cut) {
  const test_polygon l = {.at = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 6, 3};
  test_polygon p;
  check_everywhere(&l, "L");
  for (int n = 2; n <= 9; n++) {
    test_comb(n, &p);
    check_everywhere(&p, "comb");
  }
  for (int n = 2; n <= 12; n++) {
    test_spiral(n, &p);
    check_everywhere(&p, "spiral");
  }
  for (int n = 3; n <= 9; n++)
    for (int more = 0; more < 4; more++) {
      test_star(n, more, 0.4, &p);
      for (int i = 0; i < 3; i++) check_everywhere(&p, "star");
    }
  for (int n = 1; n <= 4; n++) {
    test_holes(n, &p);
    check_everywhere(&p, "holes");
  }
}

TEST(rectilinear_polygons_are_cut) {
  uint64_t random = 41;
  for (int i = 0; i < (SANITIZED ? 40 : 208); i++) {
    test_polygon p;
    test_rectilinear(&random, i % 2 == 0, &p);
    check_everywhere(&p, i % 2 == 0 ? "cells" : "rectilinear");
  }
}

static bool is_one_of(uint32_t (*t)[3], size_t count, const uint32_t wanted[3]) {
  for (size_t i = 0; i < count; i++)
    for (uint32_t k = 0; k < 3; k++)
      if (t[i][k] == wanted[0] && t[i][(k + 1) % 3] == wanted[1] && t[i][(k + 2) % 3] == wanted[2])
        return true;
  return false;
}

__extension__ typedef __int128 whole;

/* Twice the area, in units of 2^-106: these points are whole multiples of 2^-53 below 32. */
static whole exact(const double *a, const double *b, const double *c) {
  whole d[2][2];
  for (int k = 0; k < 2; k++) {
    d[0][k] = (whole)ldexp(b[k], 53) - (whole)ldexp(a[k], 53);
    d[1][k] = (whole)ldexp(c[k], 53) - (whole)ldexp(a[k], 53);
  }
  return d[0][0] * d[1][1] - d[0][1] * d[1][0];
}

/* A corner that is concave, straight or convex by the last bits of another one's coordinates:
 * doubles take many of these for one another [Kettner2008]. */
TEST(turns_are_told_exactly) {
  for (int i = 0; i < 32 * 32 * 4; i++) {
    const double near[2] = {0.50000000000002531 + ldexp(i % 32, -53),
                            0.5000000000000171 + ldexp(i / 32 % 32, -53)};
    const double ring[4][2] = {{near[0], near[1]},
                               {30, 0},
                               {24.00000000000005, 24.0000000000000517765},
                               {17.300000000000001, 17.300000000000001}};
    double at[4][3] = {{0}};
    uint32_t t[2][3];
    for (int k = 0; k < 4; k++) memcpy(at[(k + i / 1024) % 4], ring[k], sizeof ring[k]);
    OK(cut((const double(*)[3])at, 4, t));
    for (int k = 0; k < 2; k++) assert_true(exact(at[t[k][0]], at[t[k][1]], at[t[k][2]]) > 0);
  }
}

/* The triangles of four corners: those of the first and third, unless that is outside. */
TEST(quadrangles_keep_their_first_corner) {
  const double convex[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0}};
  const double hollow[4][3] = {{0, 0, 0}, {0.2, 0.2, 0}, {1, 0, 0}, {0.2, 1, 0}};
  uint32_t t[2][3];
  OK(cut(convex, 4, t));
  assert_true(is_one_of(t, 2, (const uint32_t[3]){0, 1, 2}));
  assert_true(is_one_of(t, 2, (const uint32_t[3]){0, 2, 3}));
  OK(cut(hollow, 4, t));
  for (int i = 0; i < 2; i++) {
    double n[3];
    abbe_vector_triangle(hollow[t[i][0]], hollow[t[i][1]], hollow[t[i][2]], n);
    assert_true(n[2] > 0);
  }
}

/* They end, with as many triangles of corners that there are. */
TEST(bad_polygons_are_cut_somehow) {
  uint64_t random = 5;
  for (int round = 0; round < 500; round++) {
    double at[40][3];
    uint32_t t[40][3];
    const size_t count = 4 + (size_t)(random_bits(&random) % 36);
    const int kind = (int)(random_bits(&random) % 4);
    for (size_t i = 0; i < count; i++)
      for (int k = 0; k < 3; k++)
        at[i][k] = kind == 0   ? random_normal(&random)
                   : kind == 1 ? (double)(random_bits(&random) % 3)
                   : kind == 2 ? (k == 0 ? (double)(random_bits(&random) % 5) : 1e300)
                               : random_normal(&random) * 1e-300;
    memset(t, 0xff, sizeof t);
    OK(cut((const double(*)[3])at, count, t));
    for (size_t i = 0; i + 2 < count; i++)
      for (int k = 0; k < 3; k++) assert_true(t[i][k] < count);
  }
}

/* A cap of many sides, and a wheel with as many teeth. */
TEST(many_corners_are_cut) {
  enum { MANY = 20000 };
  double(*at)[3] = calloc(MANY, sizeof *at);
  uint32_t(*t)[3] = calloc(MANY, sizeof *t);
  assert_true(at != NULL && t != NULL);
  for (int wheel = 0; wheel < 2; wheel++) {
    double sum = 0, ideal = 0;
    for (int i = 0; i < MANY; i++) {
      const double a = 6.283185307179586 * i / MANY, r = wheel && i % 2 ? 0.9 : 1;
      at[i][0] = r * cos(a);
      at[i][1] = r * sin(a);
    }
    for (int i = 0; i < MANY; i++) {
      const double *p = at[i], *q = at[(i + 1) % MANY];
      ideal += (p[0] * q[1] - p[1] * q[0]) / 2;
    }
    OK(cut((const double(*)[3])at, MANY, t));
    for (size_t i = 0; i + 2 < MANY; i++) {
      double n[3];
      abbe_vector_triangle(at[t[i][0]], at[t[i][1]], at[t[i][2]], n);
      assert_true(n[2] > 0);
      sum += n[2] / 2;
    }
    assert_near(sum, ideal, 1e-9);
  }
  free(at);
  free(t);
}

/* Corners that go to and fro in one line have no ear: each is looked for in vain all around.
 * Polygons of a file share what they may take, so that many of these end as one does. */
TEST(work_has_an_end) {
  enum { LINE = 300, ROUNDS = 1000 };
  double at[LINE][3], work = 1e7;
  uint32_t t[LINE][3];
  for (int i = 0; i < LINE; i++)
    for (int k = 0; k < 3; k++) at[i][k] = i % 2 ? 3 * LINE - 1.37 * i : i;
  abbe_result result = ABBE_OK;
  int cut_so = 0;
  for (; cut_so < ROUNDS && result == ABBE_OK; cut_so++) {
    const double before = work;
    result = abbe_polygon_cut((const double(*)[3])at, LINE, t, &work, &last_error);
    assert_true(work < before);
  }
  assert_int_equal(result, ABBE_UNSUPPORTED);
  assert_contains(last_error.text, "of 300 corners");
  /* a square of the corners each, and no more */
  assert_true(cut_so > 1 && cut_so <= 1e7 / (LINE * LINE));
}
