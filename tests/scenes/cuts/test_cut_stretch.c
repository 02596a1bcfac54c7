/* Designs at other angles: tangents by one ratio, meets and outline as they were. */
#include "tests/check.h"

#include "scenes/cuts/cut_stretch.h"
#include "tests/scenes/cuts/designs.h"

#define TURN (180 / 3.14159265358979323846)

static abbe_cut_polyhedron stone_of(const abbe_cut *cut) {
  abbe_cut_polyhedron p;
  OK(abbe_cut_polyhedron_make(cut, 0, &p, &error));
  return p;
}

static void check(const char *text, double crown, double pavilion) {
  OWNED(abbe_cut, cut) = design_parse(text), before = design_parse(text);
  OWNED(abbe_cut_polyhedron, p) = stone_of(&cut);
  abbe_cut_measures m, n;
  OK(abbe_cut_stretch_apply(&cut, &p, crown, pavilion, &error));
  OWNED(abbe_cut_polyhedron, q) = stone_of(&cut);
  assert_int_equal(q.vertex_count, p.vertex_count);
  assert_int_equal(q.edge_count, p.edge_count);
  assert_int_equal(q.face_count, p.face_count);
  for (int k = 0; k < 2; k++) {
    assert_near(q.min[k], p.min[k], 1e-9);
    assert_near(q.max[k], p.max[k], 1e-9);
  }
  abbe_cut_measures_make(&cut, &p, &m); /* the planes are new, the faces old: sides are the same */
  abbe_cut_measures_make(&before, &p, &m);
  abbe_cut_measures_make(&cut, &q, &n);
  for (size_t t = 0; t < cut.tier_count; t++) {
    const double was = before.tier[t].angle_deg, is = cut.tier[t].angle_deg;
    const double k = fabs(was) == 90 ? 1 : was > 0 ? crown : pavilion;
    if (fabs(was) == 90)
      assert_near(is, was, 0);
    else
      assert_near(tan(fabs(is) / TURN), k * tan(fabs(was) / TURN), 1e-9);
    assert_int_equal(signbit(is) != 0, signbit(was) != 0);
    assert_near(cut.tier[t].distance, cut.facet[cut.tier[t].first].d, 0);
  }
}

TEST(meets_are_kept) {
  const char *const designs[] = {design_a, design_b, design_c};
  for (size_t i = 0; i < 3; i++) {
    check(designs[i], 0.9, 0.93);
    check(designs[i], 1.2, 0.8);
    check(designs[i], 1, 1);
  }
  check(design_d, 0.9, 0.9); /* its crown and pavilion share corners at several heights */
}

/* Above a level girdle a crown that is stretched by k is k times as high. */
TEST(heights_are_stretched) {
  OWNED(abbe_cut, cut) = design_parse(design_a);
  OWNED(abbe_cut_polyhedron, p) = stone_of(&cut);
  abbe_cut_measures m, n;
  abbe_cut_measures_make(&cut, &p, &m);
  OK(abbe_cut_stretch_apply(&cut, &p, 0.8, 0.9, &error));
  OWNED(abbe_cut_polyhedron, q) = stone_of(&cut);
  abbe_cut_measures_make(&cut, &q, &n);
  assert_near(n.side[ABBE_CUT_CROWN], 0.8 * m.side[ABBE_CUT_CROWN], 1e-6);
  assert_near(n.side[ABBE_CUT_PAVILION], 0.9 * m.side[ABBE_CUT_PAVILION], 1e-6);
  assert_near(n.side[ABBE_CUT_GIRDLE], m.side[ABBE_CUT_GIRDLE], 1e-6);
}

TEST(mains) {
  OWNED(abbe_cut, cut) = design_parse(design_a);
  OWNED(abbe_cut_polyhedron, p) = stone_of(&cut);
  assert_near(cut.tier[abbe_cut_stretch_main(&cut, &p, ABBE_CUT_PAVILION)].angle_deg, -43, 0);
  assert_near(cut.tier[abbe_cut_stretch_main(&cut, &p, ABBE_CUT_CROWN)].angle_deg, 42, 0);
}

static void angles_of(const abbe_cut *cut, const abbe_cut_polyhedron *p, double crown,
                      double pavilion) {
  assert_near(abbe_cut_stretch_main_deg(cut, p, ABBE_CUT_CROWN), crown, 1e-9);
  assert_near(abbe_cut_stretch_main_deg(cut, p, ABBE_CUT_PAVILION), pavilion, 1e-9);
}

/* To main angles, either side alone, and back: as it was. */
TEST(there_and_back) {
  static const double way[][4] = {/* to, and what it is then */
                                  {35, 0, 35, 43},
                                  {0, 40, 35, 40},
                                  {50, 45, 50, 45},
                                  {42, 43, 42, 43}};
  OWNED(abbe_cut, cut) = design_parse(design_a), before = design_parse(design_a);
  for (size_t i = 0; i < sizeof way / sizeof *way; i++) {
    OWNED(abbe_cut_polyhedron, p) = stone_of(&cut);
    OK(abbe_cut_stretch_to(&cut, &p, way[i][0], way[i][1], &error));
    angles_of(&cut, &p, way[i][2], way[i][3]);
  }
  for (size_t i = 0; i < cut.facet_count; i++) {
    for (int k = 0; k < 3; k++) assert_near(cut.facet[i].n[k], before.facet[i].n[k], 1e-9);
    assert_near(cut.facet[i].d, before.facet[i].d, 1e-9);
  }
}

TEST(angles_that_are_none) {
  static const double wrong[] = {-1, 90, 120, NAN};
  OWNED(abbe_cut, cut) = design_parse(design_a);
  OWNED(abbe_cut_polyhedron, p) = stone_of(&cut);
  for (size_t i = 0; i < 4; i++) {
    REFUSED(ABBE_OUT_OF_RANGE, "crown's main angle is between 0 and 90",
            abbe_cut_stretch_to(&cut, &p, wrong[i], 0, &error));
    REFUSED(ABBE_OUT_OF_RANGE, "pavilion's", abbe_cut_stretch_to(&cut, &p, 40, wrong[i], &error));
  }
  angles_of(&cut, &p, 42, 43);
  abbe_cut_polyhedron_free(&p);
  abbe_cut_free(&cut);
  cut = design_parse("g 96 0\na 90 1 96 24 48 72\na 0 0.5 96\na -60 0.5 96 24 48 72\n");
  p = stone_of(&cut);
  angles_of(&cut, &p, 0, 60);
  REFUSED(ABBE_NOT_FOUND, "the crown has no slanted facet",
          abbe_cut_stretch_to(&cut, &p, 40, 0, &error));
}

/* A cube on its corner has no girdle: what one side is told holds for the other too. */
TEST(bound_sides_go_together) {
  for (int i = 0; i < 2; i++) {
    OWNED(abbe_cut, cut) =
        design_parse("g 96 0\na 54.735610 0.5 96 32 64\na -54.735610 0.5 16 48 80\n");
    OWNED(abbe_cut_polyhedron, p) = stone_of(&cut);
    OK(abbe_cut_add_tier(&cut, 30, 1, &error)); /* without facets: of no account */
    OK(abbe_cut_stretch_to(&cut, &p, i == 0 ? 50 : 0, i == 0 ? 0 : 50, &error));
    OWNED(abbe_cut_polyhedron, q) = stone_of(&cut);
    angles_of(&cut, &q, 50, 50);
    assert_false(abbe_cut_stretch_is_flat(&cut.tier[1], 1));
    REFUSED(ABBE_OUT_OF_RANGE, "times what they were, and not",
            abbe_cut_stretch_apply(&cut, &q, 1e6, 1e6, &error));
  }
}

/* Quartz: the critical angle is 40.37 degrees; and a ray that comes straight down onto 43 degrees
 * meets the facet opposite at 180 - 129 = 51. */
TEST(the_window) {
  double low, high;
  abbe_cut_stretch_window(1.544, &low, &high);
  assert_near(sin(low / TURN) * 1.544, 1, 1e-12);
  assert_near(180 - 3 * high, low, 1e-9);
  assert_near(abbe_cut_stretch_angle(43, 1.544, 1.544), 43, 0);
  /* as far from the middle, 30 + a third of the critical angle */
  assert_near(abbe_cut_stretch_angle(43, 1.544, 1.768),
              43 + (asin(1 / 1.768) - asin(1 / 1.544)) * TURN / 3, 1e-9);
  assert_near(abbe_cut_stretch_factor(-43, 41), tan(41 / TURN) / tan(43 / TURN), 1e-12);
}

TEST(what_is_refused) {
  OWNED(abbe_cut, cut) =
      design_parse("g 96 0\na 54.735610 0.5 96 32 64\na -54.735610 0.5 16 48 80\n");
  OWNED(abbe_cut_polyhedron, p) = stone_of(&cut);
  REFUSED(ABBE_UNSUPPORTED, "not at one height",
          abbe_cut_stretch_apply(&cut, &p, 0.9, 0.8, &error));
  assert_near(cut.tier[0].angle_deg, 54.73561, 0);
  OK(abbe_cut_stretch_apply(&cut, &p, 0.9, 0.9, &error));
  REFUSED(ABBE_OUT_OF_RANGE, "times what they were, and not",
          abbe_cut_stretch_apply(&cut, &p, 0, 1, &error));
  REFUSED(ABBE_OUT_OF_RANGE, "times what they were, and not",
          abbe_cut_stretch_apply(&cut, &p, 1, NAN, &error));
  abbe_cut_polyhedron_free(&p);
  abbe_cut_free(&cut);
  /* the centre is far above this girdle: a shallow pavilion would pass it */
  cut = design_parse("g 96 0\na 90 1 96 24 48 72\na 0 0.05 96\na -60 0.1 96 24 48 72\n");
  p = stone_of(&cut);
  const double was = cut.facet[0].d;
  REFUSED(ABBE_OUT_OF_RANGE, "other side of the stone's centre",
          abbe_cut_stretch_apply(&cut, &p, 1, 0.06, &error));
  assert_near(cut.facet[0].d, was, 0);
  assert_near(cut.tier[2].angle_deg, -60, 0);
}

/* The proportions of stones that are known: two brilliants, a step cut, an odd one. */

static abbe_cut_measures measure(const char *text) {
  OWNED(abbe_cut, cut) = design_parse(text);
  abbe_cut_measures m;
  MADE(abbe_cut_polyhedron, p, abbe_cut_polyhedron_make(&cut, 0, &p, &error));
  abbe_cut_measures_make(&cut, &p, &m);
  return m;
}

static void assert_faces(const abbe_cut_measures *m, size_t crown, size_t girdle, size_t pavilion) {
  assert_int_equal(m->faces[ABBE_CUT_CROWN], crown);
  assert_int_equal(m->faces[ABBE_CUT_GIRDLE], girdle);
  assert_int_equal(m->faces[ABBE_CUT_PAVILION], pavilion);
}

TEST(a_brilliant) {
  const abbe_cut_measures m = measure(design_a);
  assert_faces(&m, 33, 16, 24); /* 57 and 16 of the girdle */
  assert_near(m.length / m.width, 1, 1e-9);
  assert_near(m.width, 2.039182, 5e-7);
  assert_near(m.height, 0.473982 + 0.980784, 1e-6);
  assert_near(m.side[0] + m.side[1] + m.side[2], m.height, 1e-12);
  assert_near(m.volume, 2.097983, 5e-7);
  /* lower girdle facets at 44.5 degrees meet the girdle, a circle of 1, where they meet it */
  const double low =
      (sin(44.5 * 3.14159265358979 / 180) - 0.72230678) / cos(44.5 * 3.14159265358979 / 180);
  assert_near(m.girdle_low, low, 1e-7);
  assert_int_equal(m.shared, 0);
  assert_int_equal(m.dead + m.doubled, 0);
}

TEST(a_step_cut) {
  const abbe_cut_measures m = measure(design_c);
  assert_faces(&m, 9, 4, 8);
  assert_near(m.width, 2, 1e-9);
  assert_near(m.length, 2, 1e-9);
  /* the table's edge lies where the tier at 30 degrees meets z = 0.34 */
  const double half = (0.59320508 - 0.34 * cos(3.14159265358979 / 6)) / 0.5;
  assert_near(m.table, 2 * half, 1e-7);
}

/* A step cut, 2 wide and 2 long, lies in a block as it fits best, and has its share of it. */
TEST(a_rough_holds_it_as_it_fits) {
  const abbe_cut_measures m = measure(design_c);
  const double flat[] = {0.008, 0.008, 1}, tight[] = {1, m.height * 0.001, 0.006};
  assert_true(m.height < 2);
  assert_near(abbe_cut_measures_fit(&m, flat), 0.008 / m.height < 0.004 ? 0.008 / m.height : 0.004,
              1e-12);
  assert_near(abbe_cut_measures_fit(&m, tight), 0.001, 1e-12);
  assert_near(abbe_cut_measures_yield(&m, tight), m.volume * 1e-9 / (m.height * 0.001 * 0.006),
              1e-12);
}

TEST(an_odd_one) {
  const abbe_cut_measures m = measure(design_d);
  assert_int_equal(m.dead, 1);
  assert_near(m.length, 1.236009 + 1.393609, 1e-6);
  assert_near(m.width, 2.498093, 1e-6);
  assert_near(m.height, 0.9, 1e-9);
}

/* A cube that stands on its corner has no girdle and shares corners. */
TEST(without_a_girdle) {
  const abbe_cut_measures m =
      measure("g 96 0\na 54.735610 0.5 96 32 64\na -54.735610 0.5 16 48 80\n");
  assert_faces(&m, 3, 0, 3);
  assert_int_equal(m.shared, 6);
  assert_near(m.volume, 1, 1e-5);
  assert_near(m.table, 0, 0);
  assert_near(m.side[ABBE_CUT_GIRDLE], 1 / sqrt(3), 1e-6);
}

/* A carat is a fifth of a gram: 6.5 mm of diamond are known as about one. */
TEST(weight) {
  const abbe_cut_measures m = measure(design_b);
  const double carats = abbe_cut_measures_carats(&m, 6.5e-3, 3.51);
  assert_near(carats, 1.764071 * pow(0.65 / m.width, 3) * 3.51 * 5, 1e-5);
  assert_true(carats > 0.95 && carats < 1.05);
}
