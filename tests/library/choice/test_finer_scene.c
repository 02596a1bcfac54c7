/* Physics that match the plan: what it follows, and no more. */
#include "tests/check.h"

#include "gl/plan/plan.h"
#include "library/choice/finer_scene.h"
#include "tests/scenes/scene_text.h"

TEST(what_the_plan_follows) {
  abbe_plan plan;
  abbe_physics physics = {0};
  OWNED(abbe_scene, scene) = shipped_scene("gem");
  OK(abbe_matched_physics(&scene, 0, 0, &physics, &error));
  OK(abbe_plan_make(&scene, NULL, &plan, &error));
  assert_true(physics.matched);
  assert_int_equal(physics.orders, plan.desc.exits);
  assert_int_equal(physics.eye_orders, plan.eye_exits);
  assert_near(physics.energy_share, plan.desc.energy_share, 0);
  assert_near(physics.eye_share, plan.eye_share, 0);
  assert_true(physics.orders > 1 && physics.energy_share > 0);
  abbe_plan_free(&plan);
  /* A request that the renderer refuses has no plan to match. */
  assert_int_not_equal(abbe_matched_physics(&scene, 500, 400, &physics, NULL), ABBE_OK);
}
