#include "tests/check.h"

#include "base/maths.h"
#include "scenes/shapes/convex.h"
#include "scenes/shapes/shape.h"

#define DEGREES (180 / 3.14159265358979323846)

static size_t count_planes(const double (*plane)[4], size_t count, double z_low, double z_high) {
  size_t found = 0;
  for (size_t i = 0; i < count; i++) found += plane[i][2] > z_low && plane[i][2] < z_high;
  return found;
}

TEST(has_the_faces_of_a_brilliant) {
  const abbe_brilliant cut = {.diameter = 0.01};
  abbe_mesh_report report;
  double plane[80][4];
  size_t count = 0;
  MADE(abbe_mesh, m, abbe_brilliant_make(&cut, &m, &error));
  OK(abbe_mesh_check(&m, &report, &error));
  assert_int_equal(report.open_edges + report.crowded_edges + report.flipped_edges, 0);
  assert_int_equal(report.degenerate_faces, 0);
  assert_true(report.volume > 0);
  abbe_convex found;
  OK(abbe_convex_find(&m, 80, plane, NULL, &found, &error));
  assert_int_equal(found.verdict, ABBE_CONVEX_SOLID);
  count = found.planes;
  assert_int_equal(count, 73);
  assert_int_equal(count_planes((const double(*)[4])plane, count, 0.999999, 2), 1);
  assert_int_equal(count_planes((const double(*)[4])plane, count, 1e-6, 0.999999), 32);
  assert_int_equal(count_planes((const double(*)[4])plane, count, -1e-6, 1e-6), 16);
  assert_int_equal(count_planes((const double(*)[4])plane, count, -1, -1e-6), 24);
}

TEST(bezels_and_mains_have_their_angles) {
  const abbe_brilliant cut = {
      .diameter = 2, .crown_rad = 33 / DEGREES, .pavilion_rad = 41.2 / DEGREES};
  double plane[80][4];
  size_t count = 0, bezels = 0, mains = 0;
  MADE(abbe_mesh, m, abbe_brilliant_make(&cut, &m, &error));
  abbe_convex found;
  OK(abbe_convex_find(&m, 80, plane, NULL, &found, &error));
  assert_int_equal(found.verdict, ABBE_CONVEX_SOLID);
  count = found.planes;
  for (size_t i = 0; i < count; i++) {
    bezels += fabs(acos(plane[i][2]) * DEGREES - 33) < 1e-9;
    mains += fabs(acos(-plane[i][2]) * DEGREES - 41.2) < 1e-9;
  }
  assert_int_equal(bezels, 8);
  assert_int_equal(mains, 8);
  /* Crown height by the trade's own rule: half of (1 - table) times the bezel's tangent. */
  abbe_mesh_report report;
  OK(abbe_mesh_check(&m, &report, &error));
  assert_true(fabs(report.max[2] - (0.03 + 0.44 * tan(33 / DEGREES))) < 1e-12);
  assert_true(fabs(report.min[2] + 0.03 + tan(41.2 / DEGREES)) < 1e-12);
  assert_true(fabs(report.max[0] - 1) < 1e-12);
}

TEST(refuses_what_is_no_stone) {
  const abbe_brilliant bad[] = {{.diameter = 0},
                                {.diameter = NAN},
                                {.diameter = 1, .table = 1},
                                {.diameter = 1, .star = -0.1},
                                {.diameter = 1, .lower = NAN},
                                {.diameter = 1, .girdle = 2},
                                {.diameter = 1, .crown_rad = 1.5},
                                {.diameter = 1, .pavilion_rad = -1},
                                /* Stars that reach this far lean outwards over their girdle. */
                                {.diameter = 1, .star = 0.05}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    abbe_mesh m;
    REFUSED(ABBE_INVALID_ARGUMENT, "a brilliant", abbe_brilliant_make(&bad[i], &m, &error));
    assert_null(m.position);
    assert_true(strlen(last_error.text) > 20);
  }
}
