#include "validation/measure/gem/gem_optimum.h"

#include "scenes/cuts/cut_stretch.h"

#include "tests/validation/measure/gem/gem_stones.h"

static abbe_gem_optimum_desc describe(void) {
  return (abbe_gem_optimum_desc){.crown_from_rad = 30 * DEG,
                                 .crown_to_rad = 40 * DEG,
                                 .pavilion_from_rad = 30 * DEG,
                                 .pavilion_to_rad = 46 * DEG,
                                 .crowns = 3,
                                 .pavilions = 5,
                                 .measure = ABBE_GEM_ISO,
                                 .width_m = 0.0065,
                                 .view = {.side = 32, .repeats = 4, .threads = 2}};
}

/* In quartz a pavilion below the critical angle, 40.5 degrees, is a window: the search leaves it.
 * And what it says of a pair is what a view of that cut says. */
TEST(it_leaves_the_window_behind) {
  const abbe_material quartz = glass(1.54);
  OWNED(judged, j) = judged_make(design_a, &quartz, 1);
  abbe_gem_optimum_desc desc = describe();
  abbe_gem_optimum o;
  OK(abbe_gem_optimum_find(&j.cut, &j.polyhedron, &quartz, &j.wavelengths, &j.weights, &desc, &o,
                           &error));
  assert_near(o.design_crown_rad, 42 * DEG, 1e-9);
  assert_near(o.design_pavilion_rad, 43 * DEG, 1e-9);
  assert_true(o.pavilion_rad[o.best / 3] > 40.5 * DEG);
  for (size_t i = 0; i < 3; i++) assert_true(o.value[i].value < o.value[o.best].value - 0.1);
  abbe_cut cut = design_parse(design_a);
  OK(abbe_gem_optimum_apply(&o, &cut, &j.polyhedron, o.best, &error));
  abbe_gem_stone stone;
  abbe_gem_view view;
  MADE(abbe_cut_polyhedron, p, abbe_cut_polyhedron_make(&cut, 0, &p, &error));
  OK(abbe_gem_stone_make(&cut, &p, &quartz, &j.wavelengths, 0.0065, &stone, &error));
  OK(abbe_gem_view_make(&stone, &j.weights, &desc.view, &view, &error));
  assert_near(abbe_gem_view_amount(&view, ABBE_GEM_ISO).value, o.value[o.best].value, 1e-12);
  const size_t crown = abbe_cut_stretch_main(&cut, &p, ABBE_CUT_CROWN);
  assert_near(cut.tier[crown].angle_deg * DEG, o.crown_rad[o.best % 3], 1e-9);
  abbe_gem_view_free(&view);
  abbe_gem_stone_free(&stone);
  abbe_cut_free(&cut);
  abbe_gem_optimum_free(&o);
  /* the least leakage is where the brightness is greatest */
  desc.measure = ABBE_GEM_DOWN;
  desc.least = true;
  MADE(abbe_gem_optimum, leak,
       abbe_gem_optimum_find(&j.cut, &j.polyhedron, &quartz, &j.wavelengths, &j.weights, &desc,
                             &leak, &error));
  assert_true(leak.pavilion_rad[leak.best / 3] > 40.5 * DEG);
}

TEST(wrong_requests_are_refused) {
  const abbe_material quartz = glass(1.54);
  OWNED(judged, j) = judged_make(design_a, &quartz, 1);
  for (int i = 0; i < 5; i++) {
    abbe_gem_optimum_desc desc = describe();
    if (i == 0) desc.crowns = 0;
    if (i == 1) desc.pavilions = ABBE_GEM_MOST_ANGLES + 1;
    if (i == 2) desc.crown_to_rad = 20 * DEG;
    if (i == 3) desc.pavilion_to_rad = 90 * DEG;
    if (i == 4) desc.measure = ABBE_GEM_AMOUNT_COUNT;
    abbe_gem_optimum o;
    REFUSED(ABBE_INVALID_ARGUMENT, "",
            abbe_gem_optimum_find(&j.cut, &j.polyhedron, &quartz, &j.wavelengths, &j.weights, &desc,
                                  &o, &error));
  }
  judged_free(&j);
  /* a plate has no angle to change */
  j = judged_make(slab, &quartz, 1);
  const abbe_gem_optimum_desc desc = describe();
  abbe_gem_optimum o;
  REFUSED(ABBE_GEOMETRY, "",
          abbe_gem_optimum_find(&j.cut, &j.polyhedron, &quartz, &j.wavelengths, &j.weights, &desc,
                                &o, &error));
}

/* Whatever the order in which pairs become known. */
TEST(the_first_of_equals_is_best) {
  static const size_t orders[2][3] = {{0, 1, 2}, {2, 1, 0}};
  static const double value[3] = {0.2, 0.5, 0.5};
  for (int k = 0; k < 2; k++) {
    abbe_gem_number held[3] = {{NAN, NAN}, {NAN, NAN}, {NAN, NAN}};
    abbe_gem_optimum o = {.crowns = 3, .pavilions = 1, .value = held};
    for (int i = 0; i < 3; i++) {
      const size_t pair = orders[k][i];
      abbe_gem_optimum_know(&o, pair, (abbe_gem_number){value[pair], 0});
    }
    assert_int_equal(o.best, 1);
  }
}
