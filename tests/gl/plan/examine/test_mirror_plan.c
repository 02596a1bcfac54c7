/* What a mirror asks of the plan. */
#include "tests/gl/plan/planned.h"

#define SILVERED "materials: default\ncamera: {eye: [0, -1, 0.5], target: [0, 0, 0.05]}\n"
#define MIRROR_BALL(what)                                                                          \
  "- {name: ball, shape: sphere, radius: 0.08, levels: 4, transform: [{translate: [0, 0, 0.2]}], " \
  "mirror: " what "}\n"
#define MIRROR_PANE(what)                                                                          \
  "- {name: pane, shape: rectangle, width: 0.3, height: 0.3, transform: [{rotate: {axis: [0, 1, "  \
  "0], angle: 90}}, {translate: [-0.3, 0, 0.2]}], mirror: " what "}\n"

static void check(const abbe_plan *plan, abbe_plan_item item, size_t index, const char *part) {
  const abbe_plan_entry *entry = abbe_plan_find(plan, item, index);
  assert_non_null(entry);
  assert_true(entry->runs);
  assert_contains(entry->reason, part);
}

TEST(a_grey_ball_asks_for_one_wavelength) {
  FILLED(abbe_plan, plan, plan_text(SILVERED POINT_LIGHT FLOOR MIRROR_BALL("0.9"), NULL, &plan));
  assert_int_equal(plan.refractor_count, 1);
  assert_int_equal(plan.mirror_count, 1);
  assert_true(plan.mirror[0] && plan.multi_refractor_paths && plan.caustics);
  assert_false(plan.colouring || plan.dispersive || plan.absorbing || plan.bvh);
  assert_int_equal(plan.model[0], ABBE_REFRACTOR_SPHERE);
  assert_int_equal(plan.desc.wavelengths, 1);
  check(&plan, ABBE_CHOICE_REFRACTOR_MODEL, 1, "exact sphere: the object is a mirror");
  check(&plan, ABBE_CHOICE_MIRROR, 1, "reflects 0.9 of the light");
  check(&plan, ABBE_CHOICE_MULTI_REFRACTOR_PATHS, 0, "what a mirror sends on");
  check(&plan, ABBE_CHOICE_WAVELENGTHS, 0, "mirrors reflect all wavelengths alike");
}

TEST(a_metal_asks_for_all) {
  FILLED(abbe_plan, plan, plan_text(SILVERED POINT_LIGHT FLOOR MIRROR_BALL("gold"), NULL, &plan));
  assert_true(plan.colouring);
  assert_false(plan.fills || plan.dispersive);
  assert_int_equal(plan.desc.wavelengths, ABBE_PLAN_WAVELENGTHS);
  check(&plan, ABBE_CHOICE_MIRROR, 1, "by wavelength");
  check(&plan, ABBE_CHOICE_WAVELENGTHS, 0, "a mirror's reflectance varies");
  assert_int_equal(abbe_plan_least_wavelengths(&plan), ABBE_PLAN_WAVELENGTHS);
}

/* A path's parts of a band hold what a metal takes between coarse wavelengths. */
TEST(glass_beside_a_metal_asks_for_no_more_wavelengths) {
  OWNED(abbe_plan, plan);
  plan_text(SILVERED POINT_LIGHT FLOOR MIRROR_PANE("gold") BALL("n-bk7"), NULL, &plan);
  assert_true(plan.fills && plan.bvh && plan.mirror[0] && !plan.mirror[1]);
  assert_int_equal(plan.model[0], ABBE_REFRACTOR_BVH);
  assert_int_equal(abbe_plan_least_wavelengths(&plan), 4);
  abbe_plan_free(&plan);
  plan_text(SILVERED POINT_LIGHT FLOOR MIRROR_PANE("0.9") BALL("n-bk7"), NULL, &plan);
  assert_int_equal(abbe_plan_least_wavelengths(&plan), 4);
}

/* A ball is known by its triangles to whom is inside: they have two sides. */
TEST(a_ball_around_the_lamp_is_a_mesh) {
  OWNED(abbe_plan, plan);
  plan_text(SILVERED POINT_LIGHT FLOOR "- {name: ball, shape: sphere, radius: 0.1, transform: "
                                       "[{translate: [0.05, 0.03, 0.6]}], mirror: 0.9}\n",
            NULL, &plan);
  assert_int_equal(plan.model[0], ABBE_REFRACTOR_BVH);
}

TEST(a_metal_is_known_over_the_range) {
  const abbe_render_desc desc = {.min_nm = 380, .max_nm = 1e5};
  refuse_plan(SILVERED POINT_LIGHT FLOOR MIRROR_BALL("gold"), &desc, ABBE_OUT_OF_RANGE, "gold");
}
