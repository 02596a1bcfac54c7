#include "scenes/cuts/cut_meets.h"

#include "scenes/cuts/cut_stretch.h"

#include "tests/scenes/cuts/designs.h"

/* The round brilliant has the angles of its five slanted tiers; a square step cut's four tiers
 * lean, and of those that do not reach the girdle three move besides. */
TEST(known_freedoms) {
  static const struct {
    const char *text;
    size_t freedoms;
  } cases[] = {{design_a, 5}, {design_b, 5}, {design_c, 7}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    abbe_cut cut = design_parse(cases[i].text);
    MADE(abbe_cut_polyhedron, p, abbe_cut_polyhedron_make(&cut, 0, &p, &error));
    MADE(abbe_cut_meets, meets, abbe_cut_meets_make(&cut, &p, &meets, &error));
    assert_int_equal(meets.scalars, 2 * cut.tier_count);
    assert_int_equal(meets.freedoms, cases[i].freedoms);
    abbe_cut_free(&cut);
  }
}

/* However far along each freedom: the stone with all that it had, or a sentence and the design as
 * it was. */
TEST(any_way_along_a_freedom_holds_or_is_refused) {
  const char *const designs[] = {design_a, design_c, design_d};
  size_t moved_count = 0, refused = 0;
  for (size_t i = 0; i < 3; i++) {
    OWNED(abbe_cut, cut) = design_parse(designs[i]);
    MADE(abbe_cut_polyhedron, p, abbe_cut_polyhedron_make(&cut, 0, &p, &error));
    MADE(abbe_cut_meets, meets, abbe_cut_meets_make(&cut, &p, &meets, &error));
    for (size_t f = 0; f < meets.freedoms; f++)
      for (double by = 0.02; by < 50; by *= -1.7) {
        OWNED(abbe_cut, other) = design_parse(designs[i]);
        OWNED(abbe_cut_polyhedron, moved) = {0};
        double change[64] = {0};
        for (size_t s = 0; s < meets.scalars; s++)
          change[s] = by * meets.free[f * meets.scalars + s];
        abbe_error error = {0};
        const abbe_result result = abbe_cut_meets_move(&other, &p, change, &moved, &error);
        moved_count += result == ABBE_OK;
        refused += result == ABBE_GEOMETRY;
        if (result == ABBE_OK)
          assert_true(moved.vertex_count == p.vertex_count && moved.edge_count == p.edge_count &&
                      moved.face_count == p.face_count);
        else
          assert_memory_equal(other.facet[0].n, cut.facet[0].n, sizeof cut.facet[0].n);
      }
  }
  assert_true(moved_count > 10 && refused > 10);
}

/* Half a degree along each freedom: the stone has the same facets, corners and edges, its girdle
 * stays, and to the first order it moves as the freedom says. What goes too far is refused. */
TEST(meets_are_kept) {
  abbe_cut cut = design_parse(design_a);
  abbe_cut_measures was, is;
  MADE(abbe_cut_polyhedron, p, abbe_cut_polyhedron_make(&cut, 0, &p, &error));
  MADE(abbe_cut_meets, meets, abbe_cut_meets_make(&cut, &p, &meets, &error));
  abbe_cut_measures_make(&cut, &p, &was);
  for (size_t f = 0; f <= meets.freedoms; f++) {
    abbe_cut other = design_parse(design_a);
    double change[64] = {0};
    for (size_t s = 0; s < meets.scalars && f < meets.freedoms; s++)
      change[s] = 0.01 * meets.free[f * meets.scalars + s];
    if (f == meets.freedoms) change[2] = -0.7;
    if (f == meets.freedoms) {
      abbe_cut_polyhedron none;
      REFUSED(ABBE_GEOMETRY, "", abbe_cut_meets_move(&other, &p, change, &none, &error));
      assert_near(other.tier[1].angle_deg, -44.5, 0);
      abbe_cut_free(&other);
      continue;
    }
    MADE(abbe_cut_polyhedron, moved, abbe_cut_meets_move(&other, &p, change, &moved, &error));
    abbe_cut_measures_make(&other, &moved, &is);
    assert_int_equal(moved.vertex_count, p.vertex_count);
    assert_near(is.width, was.width, 1e-8);
    assert_near(is.crown_edge, was.crown_edge, 1e-8);
    assert_near(is.pavilion_edge, was.pavilion_edge, 1e-8);
    for (size_t i = 0; i < cut.facet_count; i++) {
      double by[4];
      abbe_cut_meets_plane(&cut, i, change, by);
      assert_near(other.facet[i].d - cut.facet[i].d, by[3], 3e-4);
      for (int k = 0; k < 3; k++) assert_near(other.facet[i].n[k] - cut.facet[i].n[k], by[k], 3e-4);
    }
    abbe_cut_free(&other);
  }
  abbe_cut_free(&cut);
}
