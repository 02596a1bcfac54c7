/* Receivers are hit exactly as long as there is room; others are traversed. */
#include "tests/gl/plan/planned.h"

#include "gl/plan/examine/models.h"

TEST(a_curved_receiver_asks_for_a_hierarchy) {
  FILLED(abbe_plan, plan, plan_text(CAMERA POINT_LIGHT FLOOR HILL BALL("crown"), NULL, &plan));
  assert_int_equal(plan.receivers, ABBE_RECEIVER_BVH);
  assert_int_equal(plan.receiver_model[0], ABBE_RECEIVER_EXACT);
  assert_int_equal(plan.receiver_model[1], ABBE_RECEIVER_BVH);
  assert_int_equal(plan.parallelogram_count, 1);
  assert_false(abbe_plan_find(&plan, ABBE_PASS_RECEIVER_DEPTH, 0)->runs);
  assert_contains(abbe_plan_find(&plan, ABBE_CHOICE_RECEIVER_MODEL, 0)->reason,
                  "'hill' is a general mesh");
}

TEST(too_many_rectangles_are_traversed) {
  double many[97][9];
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT FLOOR BALL("crown"));
  abbe_exact *exact = &scene.object[0].exact, floor = *exact;
  for (size_t i = 0; i < 97; i++) memcpy(many[i], floor.parallelogram[0], sizeof many[i]);
  exact->parallelogram = many;
  exact->count = 96;
  FILLED(abbe_plan, plan, plan_scene(&scene, NULL, &plan));
  assert_int_equal(plan.receivers, ABBE_RECEIVER_EXACT);
  assert_int_equal(plan.parallelogram_count, 96);
  abbe_plan_free(&plan);
  exact->count = 97;
  plan_scene(&scene, NULL, &plan);
  assert_int_equal(plan.receivers, ABBE_RECEIVER_BVH);
  assert_int_equal(plan.parallelogram_count, 0);
  assert_contains(abbe_plan_find(&plan, ABBE_CHOICE_RECEIVER_MODEL, 0)->reason,
                  "with 'floor' there are more than 96 parallelograms");
  *exact = floor;
}
