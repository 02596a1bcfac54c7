/* The proportions of stones that are known: two brilliants, a step cut, an odd one. */
#include "scenes/cuts/cut_measures.h"

#include "tests/scenes/cuts/designs.h"

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
