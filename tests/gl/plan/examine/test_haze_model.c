/* What the plan makes of media that scatter, and what it says that it leaves out. */
#include "tests/gl/plan/planned.h"

#include "gl/plan/examine/models.h"

#define MIST(scattering)                                                                           \
  "medium: {scattering: " scattering ", absorption: 0.5, g: 0.4, box: [[-1, -1, 0], [1, 1, 1]]}\n"

TEST(mist_is_a_fact) {
  OWNED(abbe_scene, scene) = scene_of(CAMERA POINT_LIGHT MIST("2") FLOOR BALL("flat"));
  MADE(abbe_plan, plan, abbe_plan_make(&scene, NULL, &plan, &error));
  assert_true(plan.hazy && plan.eye_in_air);
  assert_near(plan.air_haze.scattering, 2, 1e-9);
  assert_near(plan.air_haze.absorption, 0.5, 1e-9);
  assert_near(plan.eye_haze.g, 0.4, 0);
  for (int k = 0; k < ABBE_PLAN_HAZE_BANDS; k++) {
    assert_near(plan.air_haze.scatters[k], 2, 1e-9);
    assert_near(plan.air_haze.takes[k], 2.5, 1e-9);
  }
  assert_true(abbe_plan_find(&plan, ABBE_PASS_EYE_HAZE, 0)->runs);
  assert_true(is_noted(&plan, "scatters light once"));
  assert_false(is_noted(&plan, "taken for white"));
  abbe_plan_free(&plan);
  abbe_scene_free(&scene);
  scene = scene_of(CAMERA POINT_LIGHT FLOOR BALL("flat"));
  OK(abbe_plan_make(&scene, NULL, &plan, &error));
  assert_false(plan.hazy);
  assert_null(abbe_plan_find(&plan, ABBE_PASS_EYE_HAZE, 0));
}

/* Between what it is at the ends, nearer to where X, Y and Z have their middle. */
TEST(a_coloured_medium_is_its_mean) {
  OWNED(abbe_scene, scene) =
      scene_of(CAMERA POINT_LIGHT MIST("[[380, 0], [780, 4]]") FLOOR BALL("flat"));
  MADE(abbe_plan, plan, abbe_plan_make(&scene, NULL, &plan, &error));
  assert_near(plan.air_haze.scattering, 4 * (524 - 380) / 400.0, 0.1);
  assert_true(is_noted(&plan, "taken for white"));
}

/* An object's medium takes of light like an absorbing material. */
TEST(murky_glass_attenuates) {
  OWNED(abbe_scene, scene) =
      scene_of(CAMERA POINT_LIGHT FLOOR
               "- {name: ball, shape: sphere, radius: 0.08, transform: [{translate: [0, 0, 0.2]}], "
               "material: flat, medium: {scattering: 3}}\n");
  MADE(abbe_plan, plan, abbe_plan_make(&scene, NULL, &plan, &error));
  assert_true(plan.hazy && plan.absorbing && !plan.tinting);
  assert_near(plan.eye_haze.scattering, 0, 0);
}

/* Of white light red goes first; what is in the water is seen through its surface. */
TEST(blue_water) {
  OWNED(abbe_scene, scene) = shipped_scene("water/shafts");
  MADE(abbe_plan, plan, abbe_plan_make(&scene, NULL, &plan, &error));
  const abbe_plan_haze *h = &plan.eye_haze;
  assert_true(!plan.eye_in_air && h->absorption > 0.05 && h->absorption < 0.2);
  assert_true(h->takes[8] > 1.5 * h->takes[2] && h->scatters[2] > h->scatters[8]);
  assert_true(plan.shaft_count == 1 && plan.shaft[0].refractor == 0 && !plan.haze_beyond);
  assert_near(plan.shaft[0].g, 0.75, 0);
  assert_true(plan.shaft[0].scattering > h->scatters[3]);
  assert_true(abbe_plan_find(&plan, ABBE_PASS_SHAFTS, 0)->runs);
  assert_true(is_noted(&plan, "taken for white"));
}

TEST(published_methods_refuse_it) {
  abbe_render_desc desc = {.profile = ABBE_PROFILE_THESIS};
  refuse_plan(CAMERA POINT_LIGHT MIST("2") FLOOR BALL("flat"), &desc, ABBE_UNSUPPORTED,
              "of which the thesis profile knows nothing");
  desc.profile = ABBE_PROFILE_SHAH2007;
  refuse_plan(CAMERA POINT_LIGHT MIST("2") FLOOR BALL("flat"), &desc, ABBE_UNSUPPORTED,
              "take the default profile");
}
