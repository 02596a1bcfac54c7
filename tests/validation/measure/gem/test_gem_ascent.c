#include "validation/measure/gem/gem_ascent.h"

#include "tests/validation/measure/gem/gem_stones.h"

static abbe_gem_ascent_desc describe(void) {
  return (abbe_gem_ascent_desc){.search = {.crown_from_rad = 34 * DEG,
                                           .crown_to_rad = 50 * DEG,
                                           .pavilion_from_rad = 39 * DEG,
                                           .pavilion_to_rad = 47 * DEG,
                                           .crowns = 5,
                                           .pavilions = 5,
                                           .measure = ABBE_GEM_COS,
                                           .width_m = 0.0065,
                                           .view = {.side = 24, .repeats = 4, .threads = 2}}};
}

/* Two angles do as well as the best of a grid, whose 21 x 21 would take ten times the stones; and
 * every tier by itself does better, with all facets and corners. */
TEST(derivatives_lead_uphill) {
  const abbe_material quartz = glass(1.54);
  OWNED(judged, j) = judged_make(design_a, &quartz, 1);
  abbe_gem_ascent_desc desc = describe();
  MADE(abbe_gem_optimum, grid,
       abbe_gem_optimum_find(&j.cut, &j.polyhedron, &quartz, &j.wavelengths, &j.weights,
                             &desc.search, &grid, &error));
  MADE(abbe_gem_ascent, pair,
       abbe_gem_ascent_make(&j.cut, &j.polyhedron, &quartz, &j.wavelengths, &j.weights, &desc,
                            &pair, &error));
  const abbe_gem_number best = grid.value[grid.best];
  assert_true(pair.evaluations <= 44);
  assert_near(pair.design.value, grid.design.value, 1e-12);
  assert_true(pair.value.value > best.value - 3 * hypot(best.error, pair.value.error));
  desc.tiers = true;
  MADE(abbe_gem_ascent, tiers,
       abbe_gem_ascent_make(&j.cut, &j.polyhedron, &quartz, &j.wavelengths, &j.weights, &desc,
                            &tiers, &error));
  assert_true(tiers.value.value >
              pair.value.value + 3 * hypot(tiers.value.error, pair.value.error));
  assert_int_equal(tiers.polyhedron.vertex_count, j.polyhedron.vertex_count);
  assert_int_equal(tiers.polyhedron.face_count, j.polyhedron.face_count);
}

TEST(what_has_no_derivative_is_refused) {
  const abbe_material quartz = glass(1.54);
  OWNED(judged, j) = judged_make(design_a, &quartz, 1);
  abbe_gem_ascent_desc desc = describe();
  desc.search.measure = ABBE_GEM_RED;
  abbe_gem_ascent a;
  REFUSED(ABBE_UNSUPPORTED, "derivative",
          abbe_gem_ascent_make(&j.cut, &j.polyhedron, &quartz, &j.wavelengths, &j.weights, &desc,
                               &a, &error));
}
