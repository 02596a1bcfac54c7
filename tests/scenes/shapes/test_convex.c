#include "tests/scenes/solids.h"

#include "base/maths.h"
#include "scenes/geometry/transform.h"
#include "scenes/shapes/convex.h"
#include "scenes/shapes/shape.h"

static double plane[256][4];

static abbe_convex judge(const abbe_mesh *m) {
  abbe_convex found;
  OK(abbe_convex_find(m, 256, plane, NULL, &found, &error));
  return found;
}

static void assert_reason(const abbe_convex *c, const char *part) {
  char text[128];
  abbe_convex_reason(c, text, sizeof text);
  assert_contains(text, part);
}

static abbe_mesh brilliant(void) {
  const abbe_brilliant cut = {.diameter = 0.01};
  abbe_mesh m;
  OK(abbe_brilliant_make(&cut, &m, &error));
  return m;
}

/* What a file's digits leave of a mesh, whose normals are those of its faces again: the same of one
 * point everywhere. */
static void round_to(abbe_mesh *m, double step) {
  for (size_t v = 0; v < m->vertex_count; v++)
    for (int k = 0; k < 3; k++) m->position[v][k] = step * round(m->position[v][k] / step);
  OK(abbe_mesh_compute_normals(m, ABBE_NORMALS_FLAT, &error));
}

TEST(a_box_far_away_has_its_planes) {
  const double size[3] = {1, 1, 1}, offset[3] = {1000, 0, 0};
  double move[16];
  abbe_convex found;
  MADE(abbe_mesh, m, abbe_shape_box(size, &m, &error));
  abbe_transform_translate(offset, move);
  OK(abbe_mesh_transform(&m, move, &error));
  uint32_t plane_of[12];
  OK(abbe_convex_find(&m, 6, plane, plane_of, &found, &error));
  assert_int_equal(found.verdict, ABBE_CONVEX_SOLID);
  assert_int_equal(found.planes, 6);
  assert_near(found.tolerance, 1e-6, 0);
  assert_near(found.size, sqrt(3), 1e-9);
  assert_reason(&found, "6 planes");
  for (size_t f = 0; f < 12; f++) {
    const double *p = plane[plane_of[f]];
    for (int k = 0; k < 3; k++)
      assert_near(abbe_vector_dot(p, m.position[m.face[f][k]]), p[3], 1e-9);
  }
  OK(abbe_convex_find(&m, 5, plane, NULL, &found, &error));
  assert_int_equal(found.verdict, ABBE_CONVEX_MANY);
  assert_reason(&found, "more than 5 planes");
}

TEST(a_dent_is_measured_and_placed) {
  MADE(abbe_mesh, m, abbe_shape_sphere(1, 1, &m, &error));
  OK(abbe_mesh_compute_normals(&m, ABBE_NORMALS_FLAT, &error));
  abbe_convex found = judge(&m);
  assert_int_equal(found.verdict, ABBE_CONVEX_SOLID);
  assert_int_equal(found.planes, 80);
  const double corner[3] = {m.position[0][0], m.position[0][1], m.position[0][2]};
  for (size_t v = 0; v < m.vertex_count; v++)
    if (memcmp(m.position[v], corner, sizeof corner) == 0)
      for (int k = 0; k < 3; k++) m.position[v][k] *= 0.5;
  found = judge(&m);
  assert_int_equal(found.verdict, ABBE_CONVEX_DENTED);
  /* what is said of it is true: so far is that corner in front of one of the faces there, and no
   * other is farther */
  double most = 0, there = 0;
  for (size_t f = 0; f < m.face_count; f++) {
    const double *a = m.position[m.face[f][0]];
    double n[3], from[3];
    abbe_vector_triangle(a, m.position[m.face[f][1]], m.position[m.face[f][2]], n);
    assert_true(abbe_vector_normalise(n));
    abbe_vector_subtract(found.place, a, from);
    there = fmax(there, abbe_vector_dot(n, from));
    for (size_t v = 0; v < m.vertex_count; v++) {
      abbe_vector_subtract(m.position[v], a, from);
      most = fmax(most, abbe_vector_dot(n, from));
    }
  }
  assert_near(found.off, most, 1e-9);
  assert_near(there, most, 1e-9);
  assert_reason(&found, " m, ");
  assert_reason(&found, "% of its size, in front of a face");
}

TEST(what_is_open_or_several_is_none) {
  const test_box box[2] = {{{0, 0, 0}, {1, 1, 1}, false}, {{5, 0, 0}, {6, 1, 1}, false}};
  OWNED(abbe_mesh, m) = test_boxes(box, 2);
  OK(abbe_mesh_compute_normals(&m, ABBE_NORMALS_FLAT, &error));
  assert_int_equal(judge(&m).verdict, ABBE_CONVEX_DENTED);
  m.face_count = 11;
  m.vertex_count = 33;
  const abbe_convex found = judge(&m);
  assert_int_equal(found.verdict, ABBE_CONVEX_PARTS);
  assert_reason(&found, "not one closed surface");
}

TEST(a_ball_has_too_many_planes) {
  for (size_t levels = 3; levels <= 6; levels += 3) { /* all looked at, and by a sample */
    MADE(abbe_mesh, m, abbe_shape_sphere(1, levels, &m, &error));
    OK(abbe_mesh_compute_normals(&m, ABBE_NORMALS_FLAT, &error));
    const abbe_convex found = judge(&m);
    assert_int_equal(found.verdict, ABBE_CONVEX_MANY);
    assert_reason(&found, "more than 256 planes");
  }
}

/* A stone of 10 mm in a file of so many digits: the tolerance that is needed, and no other. */
TEST(digits_of_a_file_cost_tolerance_and_no_more) {
  static const struct {
    double step, tolerance;
  } files[] = {{1e-9, 1e-6}, {1e-7, 1e-5}, {1e-6, 1e-4}};
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    OWNED(abbe_mesh, m) = brilliant();
    round_to(&m, files[i].step);
    const abbe_convex found = judge(&m);
    assert_int_equal(found.verdict, ABBE_CONVEX_SOLID);
    assert_int_equal(found.planes, 73);
    assert_near(found.tolerance, files[i].tolerance, 0);
  }
  OWNED(abbe_mesh, m) = brilliant();
  round_to(&m, 1e-4);
  assert_int_equal(judge(&m).verdict, ABBE_CONVEX_DENTED);
}

TEST(rounded_normals_are_no_planes) {
  const test_box box = {{0, 0, 0}, {1, 1, 1}, false};
  OWNED(abbe_mesh, m) = test_boxes(&box, 1); /* smooth */
  abbe_convex found = judge(&m);
  assert_int_equal(found.verdict, ABBE_CONVEX_ROUNDED);
  assert_near(found.off, acos(sqrt(1.0 / 3)), 0.3);
  assert_reason(&found, "normals are rounded, by up to ");
  OK(abbe_mesh_compute_normals(&m, ABBE_NORMALS_AUTO, &error));
  assert_int_equal(judge(&m).verdict, ABBE_CONVEX_SOLID);
}

/* A lens of so long a focus that the triangles of its face lie within the greatest tolerance of
 * fewer than 256 planes: it is curved all the same. */
TEST(a_gentle_curve_is_not_cut_into_planes) {
  for (double radius = 4; radius < 60; radius *= 1.5) {
    double profile[43][2] = {{0, 0}};
    for (int i = 0; i <= 40; i++) {
      const double r = 0.5 * (1 - i / 40.0);
      profile[i + 1][0] = r;
      profile[i + 1][1] = 0.1 + sqrt(radius * radius - r * r) - sqrt(radius * radius - 0.25);
    }
    profile[0][0] = 0;
    double closed[43][2];
    memcpy(closed, profile, sizeof closed);
    closed[1][0] = 0.5, closed[1][1] = 0;
    memcpy(closed + 2, profile + 1, 41 * sizeof *closed);
    MADE(abbe_mesh, m, abbe_shape_lathe((const double(*)[2])closed, 43, 96, &m, &error));
    OK(abbe_mesh_compute_normals(&m, ABBE_NORMALS_FLAT, &error));
    const abbe_convex found = judge(&m);
    if (found.verdict != ABBE_CONVEX_MANY && found.verdict != ABBE_CONVEX_CURVED)
      fail_msg("radius %g: verdict %d, %zu planes", radius, found.verdict, found.planes);
  }
}

/* Needles along an edge, as exporters leave them: their own normals are noise. */
TEST(thin_faces_go_with_a_plane) {
  const double at[9][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},
                           {0, 1, 0}, {0, 0, 1}, {1, 0, 1},
                           {1, 1, 1}, {0, 1, 1}, {0.5, 1e-7, 1 + 1e-7}};
  const uint32_t face[14][3] = {{0, 2, 1}, {0, 3, 2}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7},
                                {2, 7, 6}, {3, 0, 4}, {3, 4, 7}, {0, 1, 5}, {0, 5, 4},
                                {4, 5, 8}, {4, 8, 7}, {8, 5, 6}, {8, 6, 7}};
  uint32_t plane_of[14];
  abbe_convex found;
  MADE(abbe_mesh, m, abbe_mesh_make(9, 14, false, &m, &error));
  memcpy(m.position, at, sizeof at);
  memcpy(m.face, face, sizeof face);
  OK(abbe_mesh_compute_normals(&m, ABBE_NORMALS_FLAT, &error));
  OK(abbe_convex_find(&m, 256, plane, plane_of, &found, &error));
  assert_int_equal(found.verdict, ABBE_CONVEX_SOLID);
  assert_int_equal(found.planes, 6);
  assert_true(found.off > 0.5); /* the needle's normal, which the planes' is to replace */
  const double *p = plane[plane_of[10]];
  assert_true(fabs(p[2] - 1) < 1e-6 || fabs(p[1] + 1) < 1e-6);
}

/* A stone drawn by hand: kites folded by a few degrees. Flattened it has the planes that it was to
 * have, is closed, and its corners have hardly moved. */
TEST(a_stone_of_folded_kites_is_flattened) {
  OWNED(abbe_mesh, m) = brilliant();
  for (size_t v = 0; v < m.vertex_count;
       v++) { /* the middle of the crown's kites and the culet's */
    const double *p = m.position[v];
    if (p[2] > 0.0004 && p[2] < 0.0015) m.position[v][2] += 3e-5;
  }
  OK(abbe_mesh_compute_normals(&m, ABBE_NORMALS_FLAT, &error));
  const abbe_convex before = judge(&m);
  assert_int_equal(before.verdict, ABBE_CONVEX_DENTED);
  abbe_mesh_report was, is;
  OK(abbe_mesh_check(&m, &was, &error));
  double moved = 0;
  OK(abbe_convex_flatten(&m, 0.005, 256, &moved, &error));
  OK(abbe_mesh_check(&m, &is, &error));
  assert_int_equal(is.open_edges + is.crowded_edges + is.flipped_edges, 0);
  assert_int_equal(is.shells, 1);
  assert_near(is.volume / was.volume, 1, 0.02);
  assert_true(moved > 0 && moved < 0.01);
  const abbe_convex after = judge(&m);
  assert_int_equal(after.verdict, ABBE_CONVEX_SOLID);
  assert_true(after.planes >= 49 && after.planes <= 73);
  for (size_t v = 0; v < m.vertex_count; v++)
    for (size_t i = 0; i < after.planes; i++)
      assert_true(abbe_vector_dot(plane[i], m.position[v]) <= plane[i][3] + 1e-6 * after.size);
}

/* Planes that all meet in one point: only rounding says in which order. */
TEST(points_of_many_planes_stay_closed) {
  for (size_t sides = 3; sides < 40; sides++) {
    abbe_mesh_report r;
    double moved = 0;
    MADE(abbe_mesh, m, abbe_shape_gem(sides, 1, 0.6, 0.25, 0.5, &m, &error));
    OK(abbe_convex_flatten(&m, 1e-4, 256, &moved, &error));
    assert_true(moved < 1e-9);
    OK(abbe_mesh_check(&m, &r, &error));
    assert_int_equal(r.open_edges + r.crowded_edges + r.flipped_edges, 0);
    assert_int_equal(judge(&m).planes, 3 * sides + 1);
  }
}

TEST(what_is_no_stone_is_not_flattened) {
  double moved;
  MADE(abbe_mesh, m, abbe_shape_ring(1, 0.3, 48, 24, &m, &error));
  const double(*before)[3] = (const double(*)[3])m.position;
  REFUSED(ABBE_INVALID_ARGUMENT, "a mesh cannot be flattened by",
          abbe_convex_flatten(&m, 0, 256, &moved, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "a mesh cannot be flattened by",
          abbe_convex_flatten(&m, 0.021, 256, &moved, &error));
  REFUSED(ABBE_INVALID_ARGUMENT, "a mesh cannot be flattened by nan of its",
          abbe_convex_flatten(&m, NAN, 256, &moved, &error));
  REFUSED(ABBE_GEOMETRY, "more planes than can be followed",
          abbe_convex_flatten(&m, 0.001, 256, &moved, &error));
  REFUSED(ABBE_GEOMETRY, "is no convex solid yet: (",
          abbe_convex_flatten(&m, 0.02, 4096, &moved, &error));
  assert_ptr_equal(before, m.position);
}

TEST(nothing_is_judged_of_nothing) {
  abbe_mesh none = {0};
  abbe_convex found;
  char text[32] = "x";
  OK(abbe_convex_find(&none, 256, plane, NULL, &found, &error));
  assert_int_equal(found.verdict, ABBE_CONVEX_UNASKED);
  abbe_convex_reason(&found, text, sizeof text);
  assert_string_equal(text, "");
}
