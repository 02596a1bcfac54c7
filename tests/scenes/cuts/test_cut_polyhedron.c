#include "scenes/cuts/cut_polyhedron.h"

#include "base/maths.h"
#include "scenes/shapes/convex.h"
#include "tests/scenes/cuts/designs.h"

static abbe_cut_polyhedron stone(const abbe_cut *cut, double weld) {
  abbe_cut_polyhedron p;
  OK(abbe_cut_polyhedron_make(cut, weld, &p, &error));
  return p;
}

static void expect(const char *text, size_t v, size_t e, size_t f, double volume, double low,
                   double high) {
  OWNED(abbe_cut, cut) = design_parse(text);
  OWNED(abbe_cut_polyhedron, p) = stone(&cut, 0);
  assert_int_equal(p.vertex_count, v);
  assert_int_equal(p.edge_count, e);
  assert_int_equal(p.face_count, f);
  if (volume > 0) assert_near(p.volume, volume, 5e-7);
  assert_near(p.min[2], low, 5e-7);
  if (high > 0) assert_near(p.max[2], high, 5e-7);
}

TEST(designs_have_their_counts) {
  expect(design_a, 57, 128, 73, 2.097983, -0.980784, 0.473982);
  expect(design_b, 57, 128, 73, 1.764071, -0.903536, 0.349458);
  expect(design_b_without_table, 58, 128, 72, 0, -0.903536, 0);
  expect(design_d, 30, 45, 17, 0, -0.55, 0.35);
}

TEST(a_step_cut_is_the_same_at_any_weld) {
  OWNED(abbe_cut, cut) = design_parse(design_c);
  for (double weld = 1e-12; weld < 2e-4; weld *= 10) {
    OWNED(abbe_cut_polyhedron, p) = stone(&cut, weld);
    assert_int_equal(p.vertex_count, 21);
    assert_int_equal(p.edge_count, 40);
    assert_int_equal(p.face_count, 21);
    assert_near(p.volume, 2.811214, 5e-7);
  }
}

TEST(bounds_are_known_and_not_mirrored) {
  abbe_cut cut = design_parse(design_a);
  abbe_cut_polyhedron p = stone(&cut, 0);
  for (int k = 0; k < 2; k++) assert_near(p.max[k] - p.min[k], 2.039182, 5e-7);
  abbe_cut_polyhedron_free(&p);
  abbe_cut_free(&cut);
  cut = design_parse(design_d);
  p = stone(&cut, 0);
  assert_near(p.min[0], -1.236009, 5e-7);
  assert_near(p.max[0], 1.393609, 5e-7);
  assert_near(p.min[1], -1, 5e-7);
  assert_near(p.max[1], 1.498093, 5e-7);
  size_t dead = 0;
  for (size_t i = 0; i < p.facet_count; i++) {
    if (p.fate[i] == ABBE_CUT_FACE) continue;
    dead++;
    assert_int_equal(p.fate[i], ABBE_CUT_DEAD);
    assert_near(cut.facet[i].d, 1.3, 0);
    assert_near(cut.facet[i].index, 10.5, 0);
  }
  assert_int_equal(dead, 1);
  abbe_cut_polyhedron_free(&p);
  abbe_cut_free(&cut);
}

/* Meets of design A are good to its eight digits: without a weld each is parted by rounding. */
TEST(corners_that_nearly_meet_are_one) {
  OWNED(abbe_cut, cut) = design_parse(design_a);
  for (double weld = 1e-12; weld < 2e-4; weld *= 10) {
    OWNED(abbe_cut_polyhedron, p) = stone(&cut, weld);
    assert_int_equal(p.vertex_count + p.face_count, p.edge_count + 2);
    assert_true(weld < 1e-7 ? p.vertex_count >= 57 : p.vertex_count == 57);
  }
}

static void refuse(const abbe_cut *cut, double weld, abbe_result code, const char *part) {
  abbe_cut_polyhedron p;
  REFUSED(code, part, abbe_cut_polyhedron_make(cut, weld, &p, &error));
  assert_null(p.vertex);
  assert_null(p.fate);
}

/* A plate whose corners above and below become one is no stone. */
TEST(what_a_weld_flattens_is_refused) {
  static const char *const sides[] = {"96 24 48 72", "96 16 32 48 64 80"};
  for (int i = 0; i < 2; i++) {
    OWNED(abbe_cut, cut) =
        design_parse(printed("g 96 0\na 90 1 %s\na 0 0.004\na -0 0.004\n", sides[i]));
    refuse(&cut, 0.01, ABBE_GEOMETRY, "take another 'weld'");
    OWNED(abbe_cut_polyhedron, p) = stone(&cut, 1e-4);
    assert_int_equal(p.face_count, i == 0 ? 6 : 8);
  }
}

/* A cutter is told where to look. */
TEST(the_open_side_is_named) {
  static const struct {
    const char *text, *words;
  } designs[] = {{"g 96 0\na 90 1 96 24 48 72\na -0 1\n", "open on top: the crown lacks facets"},
                 {"g 96 0\na 90 1 96 24 48 72\na 0 1\n", "open below: the pavilion lacks facets"},
                 {"g 96 0\na 90 1 96 24 72\na 0 1\na -0 1\n", "at the side, about index 48"}};
  for (size_t i = 0; i < sizeof designs / sizeof *designs; i++) {
    OWNED(abbe_cut, cut) = design_parse(designs[i].text);
    abbe_cut_polyhedron p;
    REFUSED(ABBE_GEOMETRY, designs[i].words, abbe_cut_polyhedron_make(&cut, 0, &p, &error));
  }
}

TEST(open_stones_are_refused) {
  OWNED(abbe_cut, cut) = design_parse(design_c_open);
  refuse(&cut, 0, ABBE_GEOMETRY, "open");
  abbe_cut_free(&cut);
  /* all upright: normals lie in one plane */
  cut = design_parse("g 96 0\na 90 1 96 24 48 72\n");
  refuse(&cut, 0, ABBE_GEOMETRY, "open");
  abbe_cut_free(&cut);
  /* four times one plane */
  cut = design_parse("g 96 0\na 45 1 96 96 96 96\n");
  refuse(&cut, 0, ABBE_GEOMETRY, "open");
  abbe_cut_free(&cut);
  cut = design_parse(design_c);
  refuse(&cut, 0.5, ABBE_INVALID_ARGUMENT, "welded by 0.5");
  refuse(&cut, NAN, ABBE_INVALID_ARGUMENT, "welded by");
  cut.facet[3].d = 0;
  refuse(&cut, 0, ABBE_SCHEMA, "facet 4");
}

TEST(doubles_are_told) {
  OWNED(abbe_cut, cut) = design_parse("g 96 0\na 90 1 96 24 48 72\na 0 1 0\na -0 1 0\na 90 1 24\n");
  OWNED(abbe_cut_polyhedron, p) = stone(&cut, 0);
  assert_int_equal(p.face_count, 6);
  assert_int_equal(p.vertex_count, 8);
  assert_int_equal(p.fate[6], ABBE_CUT_DOUBLE);
  assert_int_equal(p.fate[1], ABBE_CUT_FACE);
  assert_near(p.volume, 8, 1e-12);
  assert_near(p.area, 24, 1e-12);
}

TEST(every_face_lies_in_its_plane) {
  const char *const designs[] = {design_a, design_b, design_c, design_d};
  for (size_t i = 0; i < sizeof designs / sizeof *designs; i++) {
    OWNED(abbe_cut, cut) = design_parse(designs[i]);
    OWNED(abbe_cut_polyhedron, p) = stone(&cut, 0);
    for (size_t f = 0; f < p.face_count; f++) {
      assert_true(p.face[f].area > 0);
      assert_true(f == 0 || p.face[f].facet > p.face[f - 1].facet);
    }
    for (size_t v = 0; v < p.vertex_count; v++)
      for (size_t k = 0; k < cut.facet_count; k++)
        assert_true(abbe_vector_dot(cut.facet[k].n, p.vertex[v]) - cut.facet[k].d < 2e-6);
  }
}

TEST(triangles_are_a_closed_convex_solid) {
  const char *const designs[] = {design_a, design_b, design_c, design_d};
  const size_t planes[] = {73, 73, 21, 17};
  for (size_t i = 0; i < sizeof designs / sizeof *designs; i++) {
    OWNED(abbe_cut, cut) = design_parse(designs[i]);
    OWNED(abbe_cut_polyhedron, p) = stone(&cut, 0);
    abbe_mesh_report report;
    abbe_convex convex;
    double plane[256][4];
    MADE(abbe_mesh, m, abbe_cut_polyhedron_mesh(&cut, &p, 0.01, &m, &error));
    OK(abbe_mesh_check(&m, &report, &error));
    assert_int_equal(report.open_edges + report.crowded_edges + report.flipped_edges, 0);
    assert_int_equal(report.degenerate_faces, 0);
    assert_near(report.volume, p.volume * 1e-6, 1e-10 * p.volume);
    OK(abbe_convex_find(&m, 256, plane, NULL, &convex, &error));
    assert_int_equal(convex.verdict, ABBE_CONVEX_SOLID);
    assert_int_equal(convex.planes, planes[i]);
  }
}
