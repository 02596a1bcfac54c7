/* Knots: closed, of a tube's volume, with normals of their own surface, and what they refuse. */
#include "tests/check.h"

#include "base/maths.h"
#include "scenes/mesh/mesh.h"
#include "scenes/shapes/convex.h"
#include "scenes/shapes/shape.h"

static const abbe_knot plain = FIELDS(.turns = 2, .coils = 3, .major = 0.05, .minor = 0.025,
                                      .radius = 0.008, .along = 400, .across = 32);

static abbe_mesh_report report_of(const abbe_mesh *m) {
  abbe_mesh_report report;
  OK(abbe_mesh_check(m, &report, &error));
  assert_int_equal(report.open_edges + report.crowded_edges + report.flipped_edges, 0);
  assert_int_equal(report.degenerate_faces, 0);
  assert_int_equal(report.shells, 1);
  return report;
}

/* Of the middle line, by its chords. */
static double length_of(const abbe_knot *k) {
  enum { STEPS = 20000 };
  double sum = 0, before[3] = {0};
  for (int i = 0; i <= STEPS; i++) {
    const double t = 2 * ABBE_PI * i / STEPS, p = (double)k->turns * t, q = (double)k->coils * t;
    const double reach = k->major + k->minor * cos(q);
    const double at[3] = {reach * cos(p), reach * sin(p), k->minor * sin(q)};
    if (i > 0) sum += hypot(hypot(at[0] - before[0], at[1] - before[1]), at[2] - before[2]);
    memcpy(before, at, sizeof at);
  }
  return sum;
}

/* By Pappus: the area across times the length of the middle line. */
TEST(a_tube_has_its_volume) {
  MADE(abbe_mesh, m, abbe_knot_make(&plain, &m, &error));
  assert_int_equal(m.face_count, 2 * 400 * 32);
  const double right = ABBE_PI * 0.008 * 0.008 * length_of(&plain);
  assert_near(report_of(&m).volume / right, 1, 0.01); /* of 32 corners for a circle: -0.0064 */
}

/* A ring, once around: a tube has room up to its hole. */
TEST(a_ring_is_the_simplest_knot) {
  const abbe_knot ring = {.major = 1, .minor = 1e-4, .radius = 0.1, .turns = 1, .coils = 1};
  assert_near(abbe_knot_room(&ring), 1, 1e-3);
}

TEST(spines_stand_out) {
  abbe_knot k = plain;
  abbe_mesh m[2];
  k.radius = 0.006;
  OK(abbe_knot_make(&k, &m[0], &error));
  k.spines = 30;
  k.spine = 0.5;
  OK(abbe_knot_make(&k, &m[1], &error));
  double most = 0;
  for (size_t v = 0; v < m[0].vertex_count; v++) {
    double out[3];
    abbe_vector_subtract(m[1].position[v], m[0].position[v], out);
    most = fmax(most, abbe_vector_length(out));
  }
  assert_near(most, 0.5 * 0.006, 1e-6);
  assert_true(report_of(&m[1]).volume > 1.02 * report_of(&m[0]).volume);
  for (size_t f = 0; f < m[1].face_count; f++) { /* normals are those of the faces, nearly */
    double u[3], v[3], n[3];
    const uint32_t *corner = m[1].face[f];
    abbe_vector_subtract(m[1].position[corner[1]], m[1].position[corner[0]], u);
    abbe_vector_subtract(m[1].position[corner[2]], m[1].position[corner[0]], v);
    abbe_vector_cross(u, v, n);
    abbe_vector_normalise(n);
    for (int k2 = 0; k2 < 3; k2++) {
      assert_near(abbe_vector_length(m[1].normal[corner[k2]]), 1, 1e-12);
      assert_true(abbe_vector_dot(n, m[1].normal[corner[k2]]) > 0.8);
    }
  }
  abbe_mesh_free(&m[0]);
  abbe_mesh_free(&m[1]);
}

TEST(what_is_no_knot) {
  abbe_knot bad[8];
  static const char *const says[8] = {"meets itself", "common divisor", "hole",   "radius 0",
                                      "spines",       "segments",       "spines", "meets itself"};
  for (int i = 0; i < 8; i++) bad[i] = plain;
  bad[0].radius = 0.03;
  bad[1].turns = bad[1].coils = 2;
  bad[2].minor = 0.06;
  bad[3].radius = 0;
  bad[4].spine = 3;
  bad[5].across = 2;
  bad[6].spine = NAN;
  bad[7].spines = 10; /* the tube has room, and its spines have none */
  bad[7].spine = 2;
  for (int i = 0; i < 8; i++) {
    abbe_mesh m;
    REFUSED(ABBE_INVALID_ARGUMENT, "", abbe_knot_make(&bad[i], &m, &error));
    if (strstr(last_error.text, says[i]) == NULL) print_error("%s\n", last_error.text);
    assert_non_null(strstr(last_error.text, says[i]));
  }
}

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
